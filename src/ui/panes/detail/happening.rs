//! A line of the log: a transition with what it waited for, a problem with its line of the source.

use super::{Page, Tone};
use crate::model::Trigger;
use crate::model::transition_names::trigger_text;
use crate::syntax::Source;
use crate::ui::app::LogRow;
use crate::ui::format;
use crate::ui::glyphs;
use crate::ui::view::{Cause, Kind, Problem};

impl Page<'_> {
    pub(super) fn log_row(&mut self) {
        let app = self.app;
        match &app.reading().place {
            None => (),
            Some(LogRow::Problem(key)) => {
                let problem = app.view().problems.iter().find(|problem| problem.key == *key);
                problem.into_iter().for_each(|problem| self.problem(problem));
            }
            Some(LogRow::Entry(number)) => {
                let Some(entry) = app.view().journal.get(*number) else { return };
                let place = entry.place.as_ref().map_or(String::new(), |(file, line)| {
                    let file = if app.view().is_program(file) { "" } else { format::file_name(file) };
                    format!("{file}:{line}")
                });
                self.add_at(Tone::Heading, format::clock(entry.t), place);
                self.add_wrapped(Tone::Text, &entry.text);
                if entry.times > 1 {
                    self.add(Tone::Aside, format!("{} times, last at {}", entry.times, format::clock(entry.last)));
                }
                match &entry.kind {
                    Kind::Change(cause) => self.cause(cause),
                    _ if entry.state.is_empty() => (),
                    _ => self.add(Tone::Aside, format!("in {}", entry.state)),
                }
            }
        }
    }

    /// What a transition waits for, as far as its program still runs.
    fn cause(&mut self, cause: &Cause) {
        if let Some(name) = &cause.name {
            self.add(Tone::Aside, format!("transition {name}"));
        }
        let app = self.app;
        let known = cause.transition.filter(|&(load, _)| load == app.view().loads);
        let Some((program, (_, id))) = app.program().zip(known) else { return };
        let trigger = &program[id].trigger;
        match trigger {
            Trigger::Event(event) => {
                self.add(Tone::Heading, format!("when {}", program[*event].name));
                self.code(program, program[*event].block);
            }
            Trigger::Block(block) => {
                self.add(Tone::Heading, "when");
                self.code(program, *block);
            }
            Trigger::Always => self.add(Tone::Heading, "at once"),
            Trigger::UnknownEvent(_) => (),
            _ => self.add(Tone::Heading, format!("after {} ms", trigger_text(program, trigger))),
        }
        cause.evidence.iter().for_each(|seen| self.add(Tone::Aside, seen.clone()));
    }

    fn problem(&mut self, problem: &Problem) {
        let key = &problem.key;
        let heading = format!("{}[{}]", problem.gravity.word(), key.code);
        self.add(Tone::Gravity(problem.gravity), heading);
        self.add_wrapped(Tone::Aside, &format!("{}:{}:{}", key.file, key.line, key.column));
        self.add_wrapped(Tone::Text, &problem.message);
        self.source_line(problem);
        if let Some(help) = &problem.help {
            self.add_wrapped(Tone::Text, &format!("help: {help}"));
        }
        if problem.count > 0 {
            let times = if problem.count == 1 { "once".into() } else { format!("{} times", problem.count) };
            let inside = if problem.state.is_empty() { String::new() } else { format!(" in {}", problem.state) };
            self.add_wrapped(Tone::Aside, &format!("{times}{inside}, last at {}", format::clock(problem.last)));
        }
    }

    /// The line it is about with a caret below; not for texts that weren't taken over, which aren't at hand.
    fn source_line(&mut self, problem: &Problem) {
        let Some(program) = self.app.program() else { return };
        let key = &problem.key;
        let source: Option<&Source> = program.sources.iter().find(|source| source.name == key.file);
        let Some(source) = source.filter(|_| !problem.is_of_rejected_text()) else { return };
        let text = source.text[source.line_range(key.line)].replace('\t', " ");
        let indent = text.chars().count() - text.trim_start().chars().count();
        let number = format!("{} {} ", key.line, glyphs::UPRIGHT);
        let room = usize::from(self.width).saturating_sub(number.chars().count());
        let at = key.column.saturating_sub(1);
        let from = indent.min(at).max((at + 2).saturating_sub(room));
        self.add(Tone::Code, number.clone() + &text.chars().skip(from).collect::<String>());
        let before: String = text.chars().take(at).skip(from).collect();
        let columns = number.chars().count() + usize::from(format::width(&before));
        self.add(Tone::Caret(problem.gravity), " ".repeat(columns) + "^");
    }
}
