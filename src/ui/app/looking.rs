//! How the selected machine is drawn: how near, and which part of it is seen. Only a person, an edit and the size of the
//! screen change that, and no more than they have to.

use std::collections::BTreeSet;

use ratatui::layout::Size;

use super::App;
use crate::ui::action::Action;
use crate::ui::graph::Point;
use crate::ui::layout::Pane;
use crate::ui::machine_graph;
use crate::ui::panes::diagram::{Diagram, View};
use crate::ui::panes::graph;
use crate::ui::view::Path;

/// How near a person wants to see machines.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Nearness {
    /// As boxes where they fit, else as tables where that helps.
    #[default]
    Fitting,
    Boxes,
    Table,
    /// The selected state with what leads into and out of it.
    Around,
}

impl Nearness {
    fn next(self) -> Nearness {
        match self {
            Nearness::Fitting => Nearness::Boxes,
            Nearness::Boxes => Nearness::Table,
            Nearness::Table => Nearness::Around,
            Nearness::Around => Nearness::Fitting,
        }
    }

    fn sentence(self) -> &'static str {
        match self {
            Nearness::Fitting => "drawn as boxes where they fit, else as a table where that is lower",
            Nearness::Boxes => "drawn as boxes with lines",
            Nearness::Table => "drawn as a table",
            Nearness::Around => "drawn is the selected state with what leads into and out of it",
        }
    }
}

#[derive(Debug, Default)]
pub(super) struct Looking {
    nearness: Nearness,
    /// The machines that were drawn as tables for want of room.
    tables: BTreeSet<Path>,
    /// The cell of the drawing that a person left in the upper left corner, and what was selected then.
    corner: (u16, u16),
    selected: Option<Path>,
    panned: Panned,
}

/// Whether a person moved the drawing, which then stays so until something else is selected.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
enum Panned {
    #[default]
    No,
    Yes,
}

/// Columns and rows by which a drawing is moved at a time.
const PAN: (isize, isize) = (8, 4);

impl App {
    pub fn nearness(&self) -> Nearness {
        self.looking.nearness
    }

    /// Whether a machine was drawn as a table, though boxes were tried first.
    pub fn was_table(&self, machine: &str) -> bool {
        self.looking.tables.contains(machine)
    }

    /// Which cell of a drawing stands in the upper left corner of a place: moved as little as can be for a node to be in
    /// sight.
    pub fn corner(&self, diagram: &Diagram, node: Option<usize>, room: Size) -> Point {
        let drawing = &diagram.drawing;
        let (left, top) = self.looking.corner;
        let node = node.filter(|_| self.looking.panned == Panned::No).and_then(|node| drawing.node_rect(node));
        let along = |from: u16, span: Option<(u16, u16)>, room: u16, whole: u16| {
            let (start, end) = span.unwrap_or((from, from));
            let least = (end + 1).min(whole).saturating_sub(room);
            from.max(least).min(start.max(least)).min(whole.saturating_sub(room))
        };
        Point {
            x: along(left, node.map(|rect| (rect.x, rect.x + rect.width)), room.width, drawing.width),
            y: along(top, node.map(|rect| (rect.y, rect.y + rect.height)), room.height, drawing.height),
        }
    }

    pub(super) fn look_otherwise(&mut self) {
        self.looking.nearness = self.looking.nearness.next();
        self.looking.panned = Panned::No;
        self.message = Some(self.looking.nearness.sentence().into());
    }

    pub(super) fn pan(&mut self, action: Action) {
        let (across, down) = match action {
            Action::PanLeft => (-PAN.0, 0),
            Action::PanRight => (PAN.0, 0),
            Action::PanUp => (0, -PAN.1),
            _ => (0, PAN.1),
        };
        self.pan_by(across, down);
    }

    /// By so many columns and rows.
    pub(super) fn pan_by(&mut self, across: isize, down: isize) {
        self.settle_drawing();
        let moved = |at: u16, by: isize| u16::try_from(usize::from(at).saturating_add_signed(by)).unwrap_or(u16::MAX);
        let (left, top) = self.looking.corner;
        self.looking.corner = (moved(left, across), moved(top, down));
        self.looking.panned = Panned::Yes;
    }

    /// To the machine that runs beside the selected one.
    pub(super) fn next_beside(&mut self) {
        let next = self.program().zip(self.machine()).and_then(|(program, machine)| {
            let beside = machine_graph::beside(program, machine);
            let at = beside.iter().position(|&other| other == machine)?;
            let next = program[beside[(at + 1) % beside.len()]].path.clone();
            (beside.len() > 1).then_some(next)
        });
        match next {
            Some(path) => self.select(path),
            None => self.message = Some("no machine runs beside this one".into()),
        }
    }

    /// After anything that may have changed what is drawn: what is seen now is what later changes move as little as can be.
    pub(super) fn settle_drawing(&mut self) {
        if self.looking.selected != self.selected {
            self.looking.selected = self.selected.clone();
            self.looking.panned = Panned::No;
        }
        let Some(area) = self.layout(self.area()).and_then(|layout| layout.area(Pane::Graph)) else { return };
        let Some((program, stage)) = self.program().zip(graph::stage(self, area)) else { return };
        let Some(scene) = stage.scenes.first() else { return };
        let path = program[scene.machine].path.clone();
        let (view, Point { x, y }) = (scene.view, scene.corner);
        self.looking.corner = (x, y);
        match (self.looking.nearness, view) {
            (Nearness::Fitting, View::Table) => _ = self.looking.tables.insert(path),
            (Nearness::Fitting, _) => _ = self.looking.tables.remove(&path),
            _ => {}
        }
    }
}
