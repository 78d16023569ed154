//! A machine with its events; a state with its actions, its times and the ways out of it.

use super::{Page, Tone, place};
use crate::model::{BlockId, Entry, MachineId, Program, StateId};
use crate::runtime::record::Setter;
use crate::ui::format;
use crate::ui::panes::breakpoints::mark;
use crate::ui::tree::{self, Element};
use crate::ui::view::name;

impl Page<'_> {
    pub(super) fn element(&mut self) {
        let Some((program, path)) = self.app.program().zip(self.app.selected()) else { return };
        match tree::element(program, path) {
            Some(Element::Machine(machine)) => self.machine(program, machine),
            Some(Element::State(state)) => self.state(program, state),
            None => (),
        }
        for problem in self.app.view().problems.iter().filter(|problem| problem.concerns(path)) {
            let file = &problem.key.file;
            let file = if self.app.view().is_program(file) { "" } else { format::file_name(file) };
            let place = format!("{file}:{}", problem.key.line);
            self.add_at(Tone::Gravity(problem.gravity), &problem.message, place);
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
        let active = self.app.view().active(&machine.path).and_then(|path| program.state(path));
        if let Some(state) = active {
            self.ways_out(program, state, &format!("why not, in {}", program[state].name));
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
        match self.app.view().breaks_at_state(&state.path) {
            Some(by @ Setter::Command) => self.add(Tone::Text, format!("{} pauses when entered", mark(by))),
            Some(by @ Setter::Source) => self.add(Tone::Text, format!("{} pauses when entered, as written", mark(by))),
            None => (),
        }
        let heading = if self.app.view().is_active(&state.path) { "why not" } else { "ways out" };
        self.ways_out(program, id, heading);
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
    }

    fn times(&mut self, program: &Program, id: StateId) {
        let (view, state) = (self.app.view(), &program[id]);
        let seen = view.states.get(&state.path);
        let visits = seen.map_or(0, |state| state.visits);
        let left = seen.and_then(|state| state.last_left).map(format::clock);
        let now = if view.is_active(&state.path) {
            let elapsed =
                view.elapsed(&program[state.machine].path, self.app.shown_at().t).map_or(0.0, |elapsed| elapsed.ms());
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
}
