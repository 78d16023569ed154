//! A variable with its history, or a field of a robot's message.

use serde_json::Value;

use super::{Page, Tone, place};
use crate::ui::curve;
use crate::ui::format;
use crate::ui::scope::Row;
use crate::ui::view::{History, PERIOD_MS};

/// Columns of a curve at most, half a second each, and its rows.
const CURVE: u16 = 64;
const ROWS: usize = 4;
/// Columns of a number beside it.
const LABEL: u16 = 10;

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
                match &variable.value {
                    Some(value) => self.whole(value),
                    None => self.add(Tone::Text, "no value: its machine isn't running"),
                }
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
                if let Some(value) = app.unwritten_value(path) {
                    let text = format!("set to {} by hand; the file doesn't have it (w)", format::value(value));
                    self.add_wrapped(Tone::Aside, &text);
                }
                self.curve(&variable.history);
            }
            None => self.field(path),
        }
    }

    /// Its greatest and least number at the right of it.
    fn curve(&mut self, history: &History) {
        let numbers = history.sampled(self.app.shown_at().t, usize::from(self.width.saturating_sub(LABEL).min(CURVE)));
        if !curve::moves(&numbers) {
            return;
        }
        let (low, high) = curve::bounds(&numbers);
        for (row, text) in curve::rows(&numbers, ROWS).into_iter().enumerate() {
            let label = match row {
                0 => format::number(high),
                _ if row == ROWS - 1 => format::number(low),
                _ => String::new(),
            };
            self.add_at(Tone::Text, text, label);
        }
        let span = format::duration(numbers.len() as f64 * PERIOD_MS);
        self.add(Tone::Aside, format!("the last {span}"));
    }

    /// All of a value, however long, and what it is.
    fn whole(&mut self, value: &Value) {
        self.add_wrapped(Tone::Text, &format::exactly(value));
        self.add(Tone::Aside, format::kind(value));
    }

    fn field(&mut self, path: &str) {
        for row in self.app.values().rows {
            match row {
                Row::Field { path: other, value, at, .. } | Row::Message { path: other, value, at, .. }
                    if *other == *path =>
                {
                    self.whole(&value);
                    self.add(Tone::Aside, format!("at {}", format::clock(at)));
                }
                Row::Item { path: other, value, .. } if *other == *path => self.whole(&value),
                _ => (),
            }
        }
    }
}
