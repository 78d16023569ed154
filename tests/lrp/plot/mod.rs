//! Random programs as data: drawn from a row of numbers, changed a little, written as text. Names are never used twice
//! in a program, so an edit can't turn one thing into another by accident.

mod change;
mod rename;
mod words;

use std::fmt::Write;

use words::{action, condition, exit, expression, transition};

/// Numbers to choose by; at the end of the row it is always the first choice.
pub struct Choices<'a> {
    numbers: &'a [u32],
}

impl<'a> Choices<'a> {
    pub fn new(numbers: &'a [u32]) -> Self {
        Choices { numbers }
    }

    pub fn is_empty(&self) -> bool {
        self.numbers.is_empty()
    }

    pub fn below(&mut self, end: usize) -> usize {
        let Some((&first, rest)) = self.numbers.split_first() else { return 0 };
        self.numbers = rest;
        first as usize % end.max(1)
    }

    pub fn of<'t, T>(&mut self, list: &'t [T]) -> Option<&'t T> {
        list.get(self.below(list.len()))
    }
}

#[derive(Clone, Default)]
pub struct Plot {
    vars: Vec<Var>,
    machines: Vec<Machine>,
    /// Machine and state.
    spawns: Vec<(String, String)>,
    onpause: Option<String>,
    onresume: Option<String>,
    /// Renamed where it is declared, not yet where it is used: the old name, and the new one.
    halfway: Option<(String, String)>,
    names: usize,
}

#[derive(Clone)]
struct Var {
    name: String,
    init: String,
}

#[derive(Clone, Default)]
struct Machine {
    name: String,
    vars: Vec<Var>,
    events: Vec<Var>,
    states: Vec<State>,
    transitions: Vec<String>,
}

#[derive(Clone, Default)]
struct State {
    name: String,
    /// Actions and spawns.
    onentry: Vec<String>,
    running: Vec<String>,
    onexit: Vec<String>,
    machines: Vec<Machine>,
    /// The program pauses where it is entered.
    breaks: bool,
}

impl Plot {
    pub fn draw(choices: &mut Choices) -> Plot {
        let mut plot = Plot::default();
        for _ in 0..choices.below(3) {
            let var = plot.var(choices, &[]);
            plot.vars.push(var);
        }
        for _ in 0..1 + choices.below(2) {
            plot.add_machine(choices);
        }
        for which in [&mut plot.onpause, &mut plot.onresume] {
            if choices.below(4) == 0 {
                *which = Some(action(choices, &[]));
            }
        }
        plot
    }

    fn name(&mut self, kind: &str) -> String {
        self.names += 1;
        format!("{kind}{}", self.names)
    }

    fn var(&mut self, choices: &mut Choices, scope: &[String]) -> Var {
        Var { name: self.name("v"), init: expression(choices, scope) }
    }

    fn globals(&self) -> Vec<String> {
        self.vars.iter().map(|var| var.name.clone()).collect()
    }

    fn add_machine(&mut self, choices: &mut Choices) {
        let scope = self.globals();
        let machine = self.machine(choices, &scope, 2);
        if choices.below(4) > 0 {
            self.spawns.push((machine.name.clone(), machine.states[0].name.clone()));
        }
        self.machines.push(machine);
    }

    fn machine(&mut self, choices: &mut Choices, scope: &[String], depth: usize) -> Machine {
        let mut machine = Machine { name: self.name("m"), ..Machine::default() };
        let mut scope = scope.to_vec();
        for _ in 0..choices.below(3) {
            let var = self.var(choices, &scope);
            scope.push(var.name.clone());
            machine.vars.push(var);
        }
        for _ in 0..choices.below(3) {
            machine.events.push(Var { name: self.name("e"), init: condition(choices, &scope) });
        }
        for _ in 0..1 + choices.below(3) {
            let state = self.state(choices, &scope, depth);
            machine.states.push(state);
        }
        for _ in 0..choices.below(4) {
            let transition = transition(choices, &machine, &scope);
            machine.transitions.push(transition);
        }
        machine
    }

    fn state(&mut self, choices: &mut Choices, scope: &[String], depth: usize) -> State {
        let mut state = State { name: self.name("s"), ..State::default() };
        for list in [&mut state.onentry, &mut state.running, &mut state.onexit] {
            if choices.below(3) == 0 {
                list.push(format!("[{}]", action(choices, scope)));
            }
        }
        for _ in 0..choices.below(depth + 1) {
            let mut machine = self.machine(choices, scope, depth - 1);
            let start = machine.states[0].name.clone();
            if choices.below(3) > 0 {
                state.onentry.push(format!("(spawn {} {start})", machine.name));
            }
            if choices.below(3) == 0 {
                let exit = exit(choices, &machine, scope, &state.name);
                machine.transitions.push(exit);
            }
            state.machines.push(machine);
        }
        if choices.below(6) == 0
            && let Some(top) = choices.of(&self.machines)
            && let Some(start) = top.states.first()
        {
            state.onentry.push(format!("(spawn {} {})", top.name, start.name));
        }
        state
    }

    pub fn text(&self) -> String {
        let mut text = String::from("(bridge robot sim)\n");
        for Var { name, init } in &self.vars {
            let _ = writeln!(text, "(var {name} := [{init}])");
        }
        for machine in &self.machines {
            machine.write(&mut text);
        }
        for (machine, state) in &self.spawns {
            let _ = writeln!(text, "(spawn {machine} {state})");
        }
        for (form, block) in [("onpause", &self.onpause), ("onresume", &self.onresume)] {
            let _ = block.iter().try_for_each(|block| writeln!(text, "({form} [{block}])"));
        }
        text
    }
}

impl Machine {
    fn write(&self, text: &mut String) {
        let _ = writeln!(text, "(machine {}", self.name);
        for Var { name, init } in &self.vars {
            let _ = writeln!(text, "(var {name} := [{init}])");
        }
        for Var { name, init } in &self.events {
            // Both spellings.
            let is = if name.ends_with(['0', '2', '4', '6', '8']) { ":= " } else { "" };
            let _ = writeln!(text, "(event {name} {is}[{init}])");
        }
        for state in &self.states {
            let _ = writeln!(text, "(state {}", state.name);
            state.machines.iter().for_each(|machine| machine.write(text));
            for (form, list) in [("onentry", &state.onentry), ("running", &state.running), ("onexit", &state.onexit)] {
                for item in list {
                    let _ = writeln!(text, "({form} {item})");
                }
            }
            text.push_str(if state.breaks { "(break))\n" } else { ")\n" });
        }
        for transition in &self.transitions {
            let _ = writeln!(text, "{transition}");
        }
        text.push_str(")\n");
    }
}
