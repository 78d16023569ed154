//! A variable with its history, or a field of a robot's message.

use super::{Page, Tone, place};
use crate::ui::format;
use crate::ui::scope::Row;

impl Page<'_> {
    pub(super) fn variable(&mut self) {
        let Some(path) = self.app.selected_value() else { return };
        let app = self.app;
        let declared = app.program().and_then(|program| Some((program, program.var(path)?)));
        match declared {
            Some((program, id)) => {
                let var = &program[id];
                self.add_at(Tone::Heading, format!("variable {}", var.path), place(program, var.name_span));
                self.add(Tone::Aside, format!("begins with {}", program[var.init].code.trim()));
            }
            None => self.add(Tone::Heading, path.to_string()),
        }
        match app.view().variables.get(path) {
            Some(variable) => {
                let value = variable.value.as_ref().map_or("no value: its machine isn't running".into(), format::value);
                self.add(Tone::Text, value);
                if let Some(previous) = &variable.previous {
                    let text = format!("was {}", format::value(previous));
                    self.add(Tone::Aside, text);
                }
                let by = match &*variable.by {
                    "command" => "by hand",
                    "init" => "at its beginning",
                    by => &format!("by {by}"),
                };
                self.add_wrapped(Tone::Aside, &format!("set at {} {by}", format::clock(variable.changed)));
                let history: Vec<f64> = variable.history.iter().copied().collect();
                self.add(Tone::Text, format::sparkline(&history, 32));
            }
            None => self.field(path),
        }
    }

    fn field(&mut self, path: &str) {
        for row in self.app.values().rows {
            if let Row::Field { path: other, value, at, .. } | Row::Message { path: other, value, at, .. } = row
                && *other == *path
            {
                self.add_wrapped(Tone::Text, &format::value(&value));
                self.add(Tone::Aside, format!("at {}", format::clock(at)));
            }
        }
    }
}
