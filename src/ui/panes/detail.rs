//! All about what is selected: a state with its actions and transitions, a variable with its history, a problem with its line.

use ratatui::buffer::Buffer;
use ratatui::layout::Rect;
use ratatui::style::Style;

use super::{Title, draw_nothing};
use crate::model::diff::trigger_text;
use crate::model::{BlockId, Entry, MachineId, Program, Sources, StateId, TransitionKind, Trigger};
use crate::syntax::{Source, Span};
use crate::ui::app::{App, LogRow};
use crate::ui::format;
use crate::ui::layout::Pane;
use crate::ui::pen::Pen;
use crate::ui::scope::Row;
use crate::ui::tree::{self, Element};
use crate::ui::view::{Cause, Gravity, Kind, Problem, name};

/// Words at the left, words at the right, and what they are.
#[derive(Clone, Debug, PartialEq)]
pub struct Line {
    pub text: String,
    pub place: String,
    pub tone: Tone,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Tone {
    Heading,
    Text,
    Aside,
    Code,
    Gravity(Gravity),
    Caret(Gravity),
}

pub fn draw(app: &App, area: Rect, buffer: &mut Buffer) -> Title {
    let lines = lines(app, area.width);
    if lines.is_empty() {
        draw_nothing(app, area, buffer, "Select a state, a variable or a line of the log: here is all about it.");
    }
    let top = app.detail_top().min(lines.len().saturating_sub(usize::from(area.height)));
    for (y, line) in (0..area.height).zip(&lines[top..]) {
        let style = style(app, line.tone);
        let mut pen = Pen::new(buffer, area, y);
        let indent = if matches!(line.tone, Tone::Heading | Tone::Gravity(_)) { " " } else { "   " };
        pen.put_right(" ", style).put_right(&line.place, app.theme().dim());
        pen.put(indent, Style::new()).put(&line.text, style);
    }
    let below = lines.len().saturating_sub(top + usize::from(area.height));
    let note = if below > 0 { format!("{below} more") } else { String::new() };
    Title::new(Pane::Detail.title(), note)
}

fn style(app: &App, tone: Tone) -> Style {
    let theme = app.theme();
    match tone {
        Tone::Heading => theme.bold(),
        Tone::Text | Tone::Code => theme.normal(),
        Tone::Aside => theme.dim(),
        Tone::Gravity(gravity) | Tone::Caret(gravity) => theme.gravity(gravity),
    }
}

/// For a pane of this many columns.
pub fn lines(app: &App, width: u16) -> Vec<Line> {
    let mut page = Page { app, width: width.saturating_sub(4), lines: Vec::new() };
    match app.subject() {
        Pane::Variables => page.variable(),
        Pane::Log => page.log_row(),
        _ => page.element(),
    }
    page.lines
}

struct Page<'a> {
    app: &'a App,
    /// Columns of a line below a heading.
    width: u16,
    lines: Vec<Line>,
}

impl Page<'_> {
    fn add(&mut self, tone: Tone, text: impl Into<String>) {
        self.add_at(tone, text, String::new());
    }

    fn add_at(&mut self, tone: Tone, text: impl Into<String>, place: String) {
        self.lines.push(Line { text: text.into(), place, tone });
    }

    /// In as many lines as it needs.
    fn add_wrapped(&mut self, tone: Tone, text: &str) {
        format::wrap(text, self.width).into_iter().for_each(|line| self.add(tone, line));
    }

    fn element(&mut self) {
        let Some((program, path)) = self.app.program().zip(self.app.selected()) else { return };
        match tree::element(program, path) {
            Some(Element::Machine(machine)) => self.machine(program, machine),
            Some(Element::State(state)) => self.state(program, state),
            None => (),
        }
        for problem in self.app.view().problems.iter().filter(|problem| problem.concerns(path)) {
            self.add_at(Tone::Gravity(problem.gravity), &problem.message, line_of(problem));
        }
    }

    fn machine(&mut self, program: &Program, id: MachineId) {
        let machine = &program[id];
        self.add_at(Tone::Heading, format!("machine {}", machine.name), place(program, machine.name_span));
        let view = self.app.view();
        match view.machines.get(&machine.path).filter(|machine| machine.running) {
            None => self.add(Tone::Text, "not running"),
            Some(running) => {
                let by = running.spawned_by.as_ref().map_or("at top level".into(), |by| format!("by {}", name(by)));
                self.add(Tone::Text, format!("running, spawned {by}"));
                let active = running.active.as_ref().map_or("no state", |state| name(state));
                self.add(Tone::Text, format!("in {active} since {}", format::clock(running.entered)));
            }
        }
        if !machine.events.is_empty() {
            self.add(Tone::Heading, "events");
        }
        for &event in &machine.events {
            let event = &program[event];
            self.add_at(Tone::Code, event.name.to_string(), place(program, event.span));
            self.code(program, event.block);
        }
    }

    fn state(&mut self, program: &Program, id: StateId) {
        let state = &program[id];
        self.add_at(Tone::Heading, format!("state {}", state.name), place(program, state.name_span));
        self.times(program, id);
        for entry in &state.onentry {
            match entry {
                Entry::Action(block) => self.action(program, "onentry", *block),
                Entry::Spawn(spawn) => {
                    let text = format!("onentry spawns {} in {}", spawn.machine_name, spawn.state_name);
                    self.add_at(Tone::Heading, text, place(program, spawn.span));
                }
            }
        }
        state.running.iter().for_each(|&block| self.action(program, "running", block));
        state.onexit.iter().for_each(|&block| self.action(program, "onexit", block));
        if !state.outgoing.is_empty() || !state.exits.is_empty() {
            self.add(Tone::Heading, "ways out");
        }
        for &id in state.outgoing.iter().chain(&state.exits) {
            let transition = &program[id];
            let form = match (transition.kind, &transition.sources) {
                (TransitionKind::On, Sources::Any) => "* on",
                (TransitionKind::Ontime, Sources::Any) => "* ontime",
                (TransitionKind::Eps, Sources::Any) => "* eps",
                (TransitionKind::On, _) => "on",
                (TransitionKind::Eps, _) => "eps",
                (TransitionKind::Ontime, _) => "ontime",
                (TransitionKind::Exit, _) => "exit",
            };
            let trigger = trigger_text(program, &transition.trigger);
            let name = transition.name.as_ref().map_or(String::new(), |name| format!("  {name}"));
            let cause = format!("{form} {trigger}");
            let text = format!("{} → {}{name}", cause.trim_end(), transition.target_name);
            self.add_at(Tone::Text, text, place(program, transition.span));
            if let Trigger::Event(event) = transition.trigger {
                let code = program[program[event].block].code.trim();
                self.add(Tone::Aside, format!("  {code}"));
            }
        }
    }

    fn times(&mut self, program: &Program, id: StateId) {
        let (view, state) = (self.app.view(), &program[id]);
        let seen = view.states.get(&state.path);
        let visits = seen.map_or(0, |state| state.visits);
        let left = seen.and_then(|state| state.last_left).map(format::clock);
        let now = if view.is_active(&state.path) {
            let elapsed = view.elapsed(&program[state.machine].path).map_or(0.0, |elapsed| elapsed.ms());
            format!("active for {}", format::duration(elapsed))
        } else {
            left.map_or("never left".into(), |left| format!("left at {left}"))
        };
        let text = match visits {
            0 => "not entered yet".into(),
            1 => format!("entered once, {now}"),
            n => format!("entered {n} times, {now}"),
        };
        self.add(Tone::Text, text);
        self.way_in(program, id);
    }

    /// The transition by which an active state was entered.
    fn way_in(&mut self, program: &Program, id: StateId) {
        let (view, state) = (self.app.view(), &program[id]);
        let machine = &program[state.machine].path;
        let running = view.machines.get(machine).filter(|_| view.is_active(&state.path));
        let Some(entered) = running.map(|machine| machine.entered) else { return };
        let latest = view.taken.iter().rev().find(|(_, taken)| taken.machine == *machine);
        if let Some((_, taken)) = latest.filter(|(t, taken)| *t == entered && name(&taken.to) == &*state.name) {
            let name = taken.name.as_ref().map_or(String::new(), |name| format!(" ({name})"));
            self.add_wrapped(Tone::Text, &format!("came from {} by {}{name}", taken.from, taken.trigger));
        }
    }

    fn action(&mut self, program: &Program, kind: &str, block: BlockId) {
        self.add_at(Tone::Heading, kind, place(program, program[block].span));
        self.code(program, block);
    }

    fn code(&mut self, program: &Program, block: BlockId) {
        for line in dedented(&program[block].code) {
            self.add(Tone::Code, line);
        }
    }

    fn variable(&mut self) {
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

    fn log_row(&mut self) {
        let app = self.app;
        match &app.reading().place {
            None => (),
            Some(LogRow::Problem(key)) => {
                let problem = app.view().problems.iter().find(|problem| problem.key == *key);
                problem.into_iter().for_each(|problem| self.problem(problem));
            }
            Some(LogRow::Entry(number)) => {
                let Some(entry) = app.view().journal.get(*number) else { return };
                let place = entry.place.as_ref().map_or(String::new(), |(file, line)| format!("{file}:{line}"));
                self.add_at(Tone::Heading, format::clock(entry.t), place);
                self.add_wrapped(Tone::Text, &entry.text);
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
        let word = match problem.gravity {
            Gravity::Error => "error",
            Gravity::Warning => "warning",
            Gravity::Hint => "hint",
        };
        let key = &problem.key;
        let heading = format!("{word}[{}]", key.code);
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
        let number = format!("{} │ ", key.line);
        let room = usize::from(self.width).saturating_sub(number.chars().count());
        let at = key.column.saturating_sub(1);
        let from = indent.min(at).max((at + 2).saturating_sub(room));
        self.add(Tone::Code, number.clone() + &text.chars().skip(from).collect::<String>());
        let before: String = text.chars().take(at).skip(from).collect();
        let columns = number.chars().count() + usize::from(format::width(&before));
        self.add(Tone::Caret(problem.gravity), " ".repeat(columns) + "^");
    }
}

fn line_of(problem: &Problem) -> String {
    format!(":{}", problem.key.line)
}

fn place(program: &Program, span: Span) -> String {
    program
        .sources
        .get(usize::from(span.file.0))
        .map_or(String::new(), |source| format!(":{}", source.line(span.start as usize)))
}

/// The lines of a block without the indentation they share.
fn dedented(code: &str) -> Vec<String> {
    let code = code.trim_end();
    let indent = |line: &str| line.len() - line.trim_start().len();
    let rest = code.lines().skip(1).filter(|line| !line.trim().is_empty());
    let shared = rest.map(indent).min().unwrap_or(0);
    let strip = |(i, line): (usize, &str)| {
        let cut = if i == 0 { indent(line) } else { shared.min(indent(line)) };
        line.get(cut..).unwrap_or(line).trim_end().to_owned()
    };
    code.lines().enumerate().map(strip).filter(|line| !line.is_empty()).collect()
}
