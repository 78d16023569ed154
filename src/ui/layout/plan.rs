//! Which panes stand where on a screen of which size.

use ratatui::layout::Size;

use super::place::{Divide, Length, Node, above, beside};
use super::{Figure, Pane, Simulated, Wish};

/// For the room between the first line and the last.
pub fn plan(body: Size, wish: Wish) -> Node {
    match (body.width, body.height) {
        (150.., 16..) => three_columns(body, wish),
        (118.., 34..) => with_source(wish),
        (110.., 28..) => two_figures(wish),
        (64.., 16..) => one_figure(wish),
        (64.., 7..) => side_by_side(wish),
        (_, 11..) => one_below_the_other(wish),
        _ => wish.focus.into(),
    }
}

/// 200x60: everything at once.
fn three_columns(body: Size, wish: Wish) -> Node {
    let tall = body.height >= 46;
    let world = (wish.simulated == Simulated::World || wish.figure == Figure::World).then_some(Pane::World);
    let below = if tall { world } else { second(wish).filter(|_| body.height >= 28) };
    let middle = above(Divide::Log, Length::second(2, 5).within(6, 24), drawing(wish, tall, below), Pane::Log);
    let right = match below {
        Some(pane) => above(Divide::Source, Length::first(5, 9), Pane::Source, pane),
        None => Pane::Source.into(),
    };
    let rest = beside(Divide::Right, Length::first(1, 2), middle, right);
    let left = match tall {
        true => above(Divide::Variables, Length::second(2, 5).within(10, 24), overview(wish), Pane::Detail),
        false => overview(wish),
    };
    beside(Divide::Overview, Length::first(1, 4).within(36, 44), left, rest)
}

/// What the largest place shows where the text has one of its own.
fn drawing(wish: Wish, has_detail: bool, below: Option<Pane>) -> Node {
    match wish.figure {
        Figure::World if below != Some(Pane::World) => Pane::World.into(),
        Figure::Bridge if below != Some(Pane::Bridge) => Pane::Bridge.into(),
        Figure::Detail if !has_detail && below != Some(Pane::Detail) => Pane::Detail.into(),
        _ => Pane::Graph.into(),
    }
}

/// 120x40: the drawing and the world above the text.
fn with_source(wish: Wish) -> Node {
    let below = above(Divide::Source, Length::first(5, 9), Pane::Source, Pane::Log);
    let right = above(Divide::Below, Length::first(9, 20), figures(wish), below);
    beside(Divide::Overview, Length::first(1, 3).within(36, 38), overview(wish), right)
}

/// 110x30
fn two_figures(wish: Wish) -> Node {
    let figures = match wish.figure {
        Figure::Source => beside(Divide::Figures, Length::first(5, 9), Pane::Graph, Pane::Source),
        _ => figures(wish),
    };
    let right = above(Divide::Log, Length::first(2, 3), figures, Pane::Log);
    beside(Divide::Overview, Length::first(1, 3).within(36, 38), overview(wish), right)
}

/// The drawing, with what is wanted beside it.
fn figures(wish: Wish) -> Node {
    match second(wish) {
        Some(pane) => beside(Divide::Figures, Length::first(5, 9), Pane::Graph, pane),
        None => Pane::Graph.into(),
    }
}

fn second(wish: Wish) -> Option<Pane> {
    match (wish.figure, wish.simulated) {
        (Figure::Detail, _) => Some(Pane::Detail),
        (Figure::Bridge, _) => Some(Pane::Bridge),
        (Figure::World, _) | (_, Simulated::World) => Some(Pane::World),
        (Figure::Graph | Figure::Source, Simulated::Nothing) => None,
    }
}

/// 80x24
fn one_figure(wish: Wish) -> Node {
    let right = above(Divide::Log, Length::second(1, 3).within(5, 14), wish.figure.pane(), Pane::Log);
    beside(Divide::Overview, Length::first(9, 20).within(30, 38), overview(wish), right)
}

/// 80x12
fn side_by_side(wish: Wish) -> Node {
    let rest = match Figure::of(wish.focus) {
        Some(figure) => figure.pane().into(),
        None => beside(Divide::VariablesBeside, Length::first(1, 2), Pane::Variables, Pane::Log),
    };
    beside(Divide::MachinesBeside, Length::first(3, 8), Pane::Machines, rest)
}

/// 40x24
fn one_below_the_other(wish: Wish) -> Node {
    let rest = match Figure::of(wish.focus) {
        Some(figure) => figure.pane().into(),
        None => above(Divide::VariablesAbove, Length::first(3, 5), Pane::Variables, Pane::Log),
    };
    above(Divide::MachinesAbove, Length::first(9, 20), Pane::Machines, rest)
}

/// The variables have what the machines don't need.
fn overview(wish: Wish) -> Node {
    let needed = if wish.tree == 0 { u16::MAX } else { (wish.tree + 2).min(usize::from(u16::MAX)) as u16 };
    above(Divide::Machines, Length::first(6, 11).within(0, needed), Pane::Machines, Pane::Variables)
}
