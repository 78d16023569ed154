//! What is selected as text for other programs: a path, a value, a line of the log, a whole diagnostic, the detail.

use super::{App, Effect, LogRow};
use crate::ui::format;
use crate::ui::layout::Pane;
use crate::ui::panes::{detail, log};
use crate::ui::scope::Row;

/// Columns of what is said of it.
const SAID: u16 = 40;

impl App {
    pub(super) fn copy(&mut self) -> Vec<Effect> {
        let Some(text) = self.selected_text().filter(|text| !text.is_empty()) else {
            return self.say("nothing is selected that could be copied");
        };
        self.say(format!("to the clipboard: {}", format::fit(&text, SAID)));
        vec![Effect::Copy(text)]
    }

    fn selected_text(&self) -> Option<String> {
        match self.focus {
            Pane::Variables => self.value_as_text(),
            Pane::Log => match self.reading.place.as_ref()? {
                LogRow::Problem(_) => Some(detail::text(self)),
                LogRow::Entry(number) => Some(log::text(self, self.view.journal.get(*number)?)),
            },
            Pane::Detail => Some(detail::text(self)),
            _ => self.selected.as_ref().map(ToString::to_string),
        }
    }

    /// As Lua would write it, with all its digits.
    fn value_as_text(&self) -> Option<String> {
        let listing = self.values();
        let value = match listing.row(self.value.as_ref()?)? {
            Row::Heading(_) => return None,
            Row::Variable { path, .. } => self.view.variables.get(path)?.value.as_ref()?,
            Row::Field { value, .. } | Row::Message { value, .. } | Row::Item { value, .. } => value,
        };
        Some(format::exactly(value))
    }
}
