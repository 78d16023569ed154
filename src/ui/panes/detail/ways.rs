//! The ways out of a state, each with what its guard came to: why it is not taken. A row keeps its place whatever is found.

use super::{Lead, Line, Page, Tone, place};
use crate::model::reads::readings;
use crate::model::transition_names::trigger_text;
use crate::model::ways::{guard_block, ways_out};
use crate::model::{Program, Sources, StateId, TransitionId, TransitionKind, Trigger};
use crate::runtime::record::{Answer, Way};
use crate::runtime::time::Time;
use crate::ui::format;
use crate::ui::glyphs;
use crate::ui::panes::breakpoints::mark;
use crate::ui::view::Gravity;

impl Page<'_> {
    pub(super) fn ways_out(&mut self, program: &Program, state: StateId, heading: &str) {
        let ways = ways_out(program, state);
        if ways.is_empty() {
            return;
        }
        self.add(Tone::Heading, heading);
        let targets = ways.iter().map(|&id| format::width(&program[id].target_name)).max().unwrap_or(0);
        let path = &program[state].path;
        let known = self.app.view().guards.get(path).filter(|_| self.app.view().is_active(path));
        for (index, &id) in ways.iter().enumerate() {
            let found = known.and_then(|found| found.get(index));
            self.way_out(program, id, targets, found);
        }
    }

    fn way_out(&mut self, program: &Program, id: TransitionId, targets: u16, found: Option<&Way>) {
        let transition = &program[id];
        let target = &transition.target_name;
        let room = usize::from(targets - format::width(target));
        let name = transition.name.as_ref().map_or(String::new(), |name| format!("  {name}"));
        let text = format!("{} {target}{:room$}  {}{name}", glyphs::RIGHT, "", cause(program, id));
        let place = place(program, transition.span);
        let mark = self.app.view().breaks_at_transition(id).map_or(" ", mark);
        let (answer, tone) = found.map_or((String::new(), Tone::Aside), |found| self.answer(program, id, found));
        let lead = Lead { mark, text: answer, tone };
        self.lines.push(Line { text, place, transition: Some(id), tone: Tone::Text, lead });
        if let Some(block) = guard_block(program, id) {
            let words: Vec<&str> = program[block].code.split_whitespace().collect();
            self.add(Tone::Aside, format!("  {}", words.join(" ")));
        }
        if is_explained(program, id) {
            self.explain(program, id, found);
        }
    }

    /// What it came to, in a column of its own.
    fn answer(&self, program: &Program, id: TransitionId, found: &Way) -> (String, Tone) {
        let left = found.after.map(|after| {
            let elapsed = self.app.view().elapsed(&program[program[id].machine].path, self.app.shown_at().t);
            format::duration((after - elapsed.unwrap_or(Time::ZERO).ms()).max(0.0))
        });
        match (found.guard, left) {
            (Answer::True, _) => ("true".to_string(), Tone::Holds),
            (Answer::False | Answer::Unseen, Some(left)) => (left, Tone::Text),
            (Answer::False, None) => ("false".to_string(), Tone::Text),
            (Answer::Error | Answer::NotBoolean, _) => ("error".to_string(), Tone::Gravity(Gravity::Error)),
            (Answer::NoMessage, _) => ("waits".to_string(), Tone::Aside),
            (Answer::Unseen, None) => (glyphs::DASH.to_string(), Tone::Aside),
        }
    }

    /// What it reads, or what is wrong with it.
    fn explain(&mut self, program: &Program, id: TransitionId, found: Option<&Way>) {
        match found {
            Some(Way { message: Some(message), guard: Answer::Error | Answer::NotBoolean, .. }) => {
                self.add(Tone::Gravity(Gravity::Error), format!("    {message}"));
            }
            Some(Way { message: Some(message), .. }) => self.add(Tone::Text, format!("  {message}")),
            _ => {
                let seen = self.app.view().evidence(program, id);
                self.add(Tone::Text, format!("  {}", seen.join(", ")));
            }
        }
    }
}

/// Whether a line for what it reads is kept free.
fn is_explained(program: &Program, id: TransitionId) -> bool {
    let transition = &program[id];
    let is_wrong = matches!(transition.trigger, Trigger::UnknownEvent(_) | Trigger::AfterUnknown(_));
    let is_exit = transition.kind == TransitionKind::Exit;
    is_wrong || is_exit || transition.target.is_none() || !readings(program, id).is_empty()
}

/// `* bumping`, `ontime time`, `eps`, `exit found`; nothing for a block, which has a line of its own.
fn cause(program: &Program, id: TransitionId) -> String {
    let transition = &program[id];
    let any = if transition.sources == Sources::Any { "*" } else { "" };
    let form = match (transition.kind, &transition.trigger) {
        (TransitionKind::On, _) => "",
        (kind, _) => kind.form(),
    };
    let trigger = match transition.trigger {
        Trigger::Block(_) => String::new(),
        Trigger::AfterBlock(_) => "[..]".to_string(),
        _ => trigger_text(program, &transition.trigger),
    };
    let words: Vec<&str> = [any, form, &trigger].into_iter().filter(|word| !word.is_empty()).collect();
    words.join(" ")
}
