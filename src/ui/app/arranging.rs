//! What a person does about the panes: hiding them, and moving what is between them.

use super::{App, Effect};
use crate::ui::action::Action;
use crate::ui::layout::{Axis, Chosen, Extent, Figure, Pane, Way};

/// Cells that a key moves a border by.
const WIDTH: i32 = 4;
const HEIGHT: i32 = 2;

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Resize {
    Narrower,
    Wider,
    Shorter,
    Taller,
}

impl App {
    /// The focused pane; what takes the place of the drawing gives it back instead.
    pub(super) fn hide(&mut self) -> Vec<Effect> {
        let hidden = self.focus;
        self.extent = Extent::Shared;
        let beside = self.seen_without_focus();
        if Figure::of(hidden).is_some_and(|figure| figure != Figure::Graph) && !beside.contains(&hidden) {
            self.leave_figure();
            return Vec::new();
        }
        let left = Pane::ALL.into_iter().find(|pane| *pane != hidden && beside.contains(pane));
        let Some(next) = left else { return self.say("the last pane stays") };
        self.chosen.hide(hidden);
        if self.figure.pane() == hidden {
            self.figure = Figure::Graph;
        }
        self.focus_on(next);
        let back = self.keys().name(Action::ShowAll);
        self.say(format!("{} is hidden; {back} shows all panes again", hidden.title()))
    }

    pub(super) fn show_all(&mut self) -> Vec<Effect> {
        self.chosen = Chosen::default();
        self.extent = Extent::Shared;
        self.say("all panes, as large as usual")
    }

    /// Moves the border beside or below the focused pane.
    pub(super) fn resize(&mut self, how: Resize) -> Vec<Effect> {
        let axis = match how {
            Resize::Narrower | Resize::Wider => Axis::Beside,
            Resize::Shorter | Resize::Taller => Axis::Above,
        };
        let Some(layout) = self.layout(self.area()) else { return Vec::new() };
        let Some((border, way)) = layout.border_of(self.focus, axis) else {
            return self.say("there is nothing beside it to take room from");
        };
        let grows = matches!(how, Resize::Wider | Resize::Taller);
        let on = if grows { way } else { way.back() };
        let by = if axis == Axis::Beside { WIDTH } else { HEIGHT };
        let by = if on == Way::On { by } else { -by };
        self.chosen.move_border(border, i32::from(border.first()) + by);
        Vec::new()
    }
}
