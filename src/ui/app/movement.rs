//! Moving the selection of the focused pane, and keeping it in sight.

use super::{App, Help, Overlay};
use crate::ui::action::Action;
use crate::ui::layout::{Extent, Figure, Layout, Pane, Wish};
use crate::ui::machine_graph;
use crate::ui::panes::detail;
use crate::ui::tree::{self, Element};
use crate::ui::view::{Path, owner, within};

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Move {
    Up,
    Down,
    PageUp,
    PageDown,
    First,
    Last,
}

impl Move {
    pub fn of(action: Action) -> Option<Move> {
        match action {
            Action::Up => Some(Move::Up),
            Action::Down => Some(Move::Down),
            Action::PageUp => Some(Move::PageUp),
            Action::PageDown => Some(Move::PageDown),
            Action::First => Some(Move::First),
            Action::Last => Some(Move::Last),
            _ => None,
        }
    }

    /// Where it leads in a list of `length` rows, of which `page` are seen; from nowhere to the first.
    pub fn from(self, at: Option<usize>, length: usize, page: usize) -> Option<usize> {
        let last = length.checked_sub(1)?;
        let page = page.max(1);
        let Some(at) = at else { return Some(if self == Move::Last { last } else { 0 }) };
        Some(match self {
            Move::Up => at.saturating_sub(1),
            Move::Down => (at + 1).min(last),
            Move::PageUp => at.saturating_sub(page),
            Move::PageDown => (at + page).min(last),
            Move::First => 0,
            Move::Last => last,
        })
    }
}

impl App {
    pub(super) fn go(&mut self, how: Move) {
        self.take_as_subject(self.focus);
        match self.focus {
            Pane::Machines => self.go_in_tree(how),
            Pane::Graph => self.go_in_graph(how),
            Pane::Variables => self.go_in_values(how),
            Pane::Log => self.go_in_log(how),
            Pane::Detail => self.go_in_detail(how),
            Pane::Source => self.go_in_source(how),
            Pane::Bridge => self.go_in_robots(how),
            Pane::World => (),
        }
    }

    fn go_in_tree(&mut self, how: Move) {
        let rows = self.tree();
        let at = rows.iter().position(|row| Some(&row.path) == self.selected.as_ref());
        if let Some(to) = how.from(at, rows.len(), self.page(Pane::Machines)) {
            self.select(rows[to].path.clone());
        }
    }

    fn go_in_graph(&mut self, how: Move) {
        let Some((program, machine)) = self.program().zip(self.machine()) else { return };
        let states = &program[machine].states;
        let at = states.iter().position(|&state| Some(&program[state].path) == self.selected.as_ref());
        if let Some(to) = how.from(at, states.len(), self.page(Pane::Graph) / 2) {
            let path = program[states[to]].path.clone();
            self.select(path);
        }
    }

    fn go_in_values(&mut self, how: Move) {
        let rows: Vec<Path> = self.values().rows.iter().filter_map(|row| row.path().cloned()).collect();
        let at = rows.iter().position(|path| Some(path) == self.value.as_ref());
        if let Some(to) = how.from(at, rows.len(), self.page(Pane::Variables)) {
            self.value = Some(rows[to].clone());
        }
    }

    fn go_in_detail(&mut self, how: Move) {
        let (length, page) = (detail::lines(self, self.columns(Pane::Detail)).len(), self.page(Pane::Detail));
        self.detail_at = how.from(Some(self.detail_at), length, page).unwrap_or(0);
        self.detail_scroll.settle(Some(self.detail_at), length, page);
    }

    /// Something else is told of.
    pub(super) fn detail_anew(&mut self) {
        self.detail_at = 0;
        self.detail_scroll.rewind();
    }

    /// Lines without a selection only scroll.
    pub(super) fn scroll_overlay(&mut self, how: Move, length: usize) {
        let page = usize::from(self.area().height.saturating_sub(3));
        if let Overlay::Help(Help { top, .. }) | Overlay::Held { top } = &mut self.overlay {
            *top = how.from(Some(*top), length, page).unwrap_or(0).min(length.saturating_sub(page));
        }
    }

    /// Selects a machine or state and unfolds what hides it.
    pub(super) fn select(&mut self, path: Path) {
        self.folded.retain(|folded| !within(&path, folded) || *folded == path);
        self.selected = Some(path);
        self.provisional = false;
        self.detail_anew();
    }

    pub(super) fn go_into(&mut self) {
        let Some((program, selected)) = self.program().zip(self.selected.clone()) else {
            return self.nothing_selected();
        };
        let inner = match tree::element(program, &selected) {
            Some(Element::Machine(machine)) => {
                let active = self.view.active(&selected).cloned();
                active.or_else(|| program[machine].states.first().map(|&state| program[state].path.clone()))
            }
            Some(Element::State(state)) => {
                let spawned = machine_graph::spawned(program, state).into_iter();
                let mut inside = spawned.chain(program[state].machines.iter().copied());
                inside.next().map(|machine| program[machine].path.clone())
            }
            None => None,
        };
        match inner {
            Some(path) => self.select(path),
            None => self.message = Some(format!("{selected} has nothing inside")),
        }
    }

    pub(super) fn go_out(&mut self) {
        let Some(selected) = self.selected.clone() else { return self.nothing_selected() };
        let spawner = self.view.machines.get(&selected).and_then(|machine| machine.spawned_by.clone());
        match owner(&selected).map(Path::from).or(spawner) {
            Some(outer) => self.select(outer),
            None => self.message = Some(format!("{selected} is outermost")),
        }
    }

    pub(super) fn fold(&mut self) {
        let Some(selected) = self.selected.clone() else { return self.nothing_selected() };
        let rows = self.tree();
        let open = rows.iter().any(|row| row.path != selected && within(&row.path, &selected));
        if open {
            self.folded.insert(selected);
        } else if let Some(outer) = owner(&selected) {
            self.select(outer.into());
        }
    }

    pub(super) fn unfold(&mut self) {
        let Some(selected) = self.selected.clone() else { return self.nothing_selected() };
        if !self.folded.remove(&selected) {
            let rows = self.tree();
            let inner = rows.iter().find(|row| row.path != selected && within(&row.path, &selected));
            if let Some(path) = inner.map(|row| row.path.clone()) {
                self.select(path);
            }
        }
    }

    pub(super) fn nothing_selected(&mut self) {
        self.message = Some("nothing is selected".into());
    }

    pub(super) fn focus_on(&mut self, pane: Pane) {
        if let Some(figure) = Figure::of(pane) {
            self.figure = figure;
        }
        self.take_as_subject(pane);
        self.chosen.show(pane);
        self.focus = pane;
    }

    /// The pane whose selection the detail tells of, where it has one.
    pub(super) fn take_as_subject(&mut self, pane: Pane) {
        if self.subject != pane && !matches!(pane, Pane::Detail | Pane::World | Pane::Source | Pane::Bridge) {
            self.subject = pane;
            self.detail_anew();
        }
    }

    /// The panes a person can go through with Tab: those seen, and where there is no place for it the graph.
    pub(super) fn next_pane(&mut self, step: isize) {
        let seen = self.seen();
        let round: Vec<Pane> =
            Pane::ALL.into_iter().filter(|pane| seen.contains(pane) || *pane == self.focus).collect();
        let at = round.iter().position(|&pane| pane == self.focus).unwrap_or(0) as isize;
        let next = (at + step).rem_euclid(round.len().max(1) as isize) as usize;
        if let Some(&pane) = round.get(next) {
            self.focus_on(pane);
        }
    }

    /// Every pane that has a place when nothing is asked for in particular.
    fn seen(&self) -> Vec<Pane> {
        let every = [Pane::Machines, self.figure.pane(), Pane::Variables, Pane::Log];
        let shared = match self.extent {
            Extent::Alone => None,
            Extent::Shared => self.layout(self.area()),
        };
        let shown = shared.iter().flat_map(|layout| layout.panes.iter().map(|&(pane, _)| pane));
        shown.chain(every).filter(|&pane| !self.chosen.hides(pane)).collect()
    }

    /// The panes that are seen while the machines have the focus.
    pub(super) fn seen_without_focus(&self) -> Vec<Pane> {
        let wish = Wish { focus: Pane::Machines, extent: Extent::Shared, ..self.wish() };
        let layout = Layout::new(self.area(), wish);
        layout.map_or_else(Vec::new, |layout| layout.panes.iter().map(|&(pane, _)| pane).collect())
    }

    pub(super) fn shows_detail(&self) -> bool {
        self.layout(self.area()).is_some_and(|layout| layout.area(Pane::Detail).is_some())
    }

    /// Rows a pane has for its list.
    pub(super) fn page(&self, pane: Pane) -> usize {
        self.seen_rows(pane).unwrap_or(1)
    }

    /// The same of a pane that is seen.
    pub(super) fn seen_rows(&self, pane: Pane) -> Option<usize> {
        let area = self.layout(self.area()).and_then(|layout| layout.area(pane))?;
        Some(usize::from(area.height.saturating_sub(1)))
    }

    /// Columns a pane has.
    pub(super) fn columns(&self, pane: Pane) -> u16 {
        let area = self.layout(self.area()).and_then(|layout| layout.area(pane));
        area.map_or(0, |area| area.width)
    }

    /// After anything that may have moved a selection: brings it into sight.
    pub(super) fn settle(&mut self) {
        if let Some(height) = self.seen_rows(Pane::Machines) {
            let rows = self.tree();
            let at = rows.iter().position(|row| Some(&row.path) == self.selected.as_ref());
            self.tree_scroll.settle(at, rows.len(), height);
        }
        if let Some(height) = self.seen_rows(Pane::Variables) {
            let listing = self.values();
            let (rows, height) = listing.shares(height).upper;
            let at = listing.position(self.value.as_ref()).filter(|at| rows.contains(at)).map(|at| at - rows.start);
            self.values_scroll.settle(at, rows.len(), height);
        }
        if let Some(height) = self.seen_rows(Pane::Source) {
            self.settle_source(height);
        }
        if let Some(height) = self.seen_rows(Pane::Bridge) {
            self.settle_robots(height);
        }
        self.settle_drawing();
    }
}
