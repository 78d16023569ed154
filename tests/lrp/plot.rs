//! Random programs as data: drawn from a row of numbers, changed a little, written as text. Names are never used twice
//! in a program, so an edit can't turn one thing into another by accident.

use std::fmt::Write;

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
                machine.transitions.push(format!("(exit [{}] * -> {})", condition(choices, scope), state.name));
            }
            state.machines.push(machine);
        }
        state
    }

    /// One small change somewhere.
    pub fn change(&mut self, choices: &mut Choices) {
        let scope = self.globals();
        match choices.below(8) {
            0 => {
                let var = self.var(choices, &scope);
                self.vars.push(var);
            }
            1 => self.add_machine(choices),
            2 => drop(remove(&mut self.machines, choices)),
            3 => drop(remove(&mut self.spawns, choices)),
            4 if !self.vars.is_empty() => {
                let index = choices.below(self.vars.len());
                self.vars[index].init = expression(choices, &scope[..index]);
            }
            _ if !self.machines.is_empty() => {
                let index = choices.below(self.machines.len());
                let mut machine = std::mem::take(&mut self.machines[index]);
                self.change_machine(&mut machine, choices, &scope);
                self.machines[index] = machine;
            }
            _ => self.add_machine(choices),
        }
    }

    fn change_machine(&mut self, machine: &mut Machine, choices: &mut Choices, scope: &[String]) {
        let mut scope = scope.to_vec();
        scope.extend(machine.vars.iter().map(|var| var.name.clone()));
        match choices.below(10) {
            0 => machine.vars.push(self.var(choices, &scope)),
            1 => drop(remove(&mut machine.vars, choices)),
            2 => machine.events.push(Var { name: self.name("e"), init: condition(choices, &scope) }),
            3 => drop(remove(&mut machine.events, choices)),
            4 => machine.states.push(self.state(choices, &scope, 1)),
            5 if machine.states.len() > 1 => drop(remove(&mut machine.states, choices)),
            6 => machine.transitions.push(transition(choices, machine, &scope)),
            7 => drop(remove(&mut machine.transitions, choices)),
            _ => {
                let index = choices.below(machine.states.len());
                let mut state = std::mem::take(&mut machine.states[index]);
                self.change_state(&mut state, choices, &scope);
                machine.states[index] = state;
            }
        }
    }

    fn change_state(&mut self, state: &mut State, choices: &mut Choices, scope: &[String]) {
        match choices.below(5) {
            0 => state.running.push(format!("[{}]", action(choices, scope))),
            1 => drop(remove(&mut state.onexit, choices)),
            2 => state.machines.push(self.machine(choices, scope, 0)),
            _ if state.machines.is_empty() => {}
            3 => drop(remove(&mut state.machines, choices)),
            _ => {
                let index = choices.below(state.machines.len());
                let mut machine = std::mem::take(&mut state.machines[index]);
                self.change_machine(&mut machine, choices, scope);
                state.machines[index] = machine;
            }
        }
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
            let _ = writeln!(text, "(event {name} [{init}])");
        }
        for state in &self.states {
            let _ = writeln!(text, "(state {}", state.name);
            state.machines.iter().for_each(|machine| machine.write(text));
            for (form, list) in [("onentry", &state.onentry), ("running", &state.running), ("onexit", &state.onexit)] {
                for item in list {
                    let _ = writeln!(text, "({form} {item})");
                }
            }
            text.push_str(")\n");
        }
        for transition in &self.transitions {
            let _ = writeln!(text, "{transition}");
        }
        text.push_str(")\n");
    }
}

fn remove<T>(list: &mut Vec<T>, choices: &mut Choices) -> Option<T> {
    let index = choices.below(list.len());
    (index < list.len()).then(|| list.remove(index))
}

fn name(choices: &mut Choices, scope: &[String]) -> String {
    choices.of(scope).cloned().unwrap_or_else(|| "nothing".into())
}

fn expression(choices: &mut Choices, scope: &[String]) -> String {
    let var = name(choices, scope);
    match choices.below(7) {
        0 | 1 => choices.below(5).to_string(),
        2 => format!("({var} or 1) / 3"),
        3 => format!("{var} + 0.1"),
        4 => format!("{{ n = type({var}) }}"),
        5 => "function() return 1 end".into(),
        _ => "nil + 1".into(),
    }
}

fn condition(choices: &mut Choices, scope: &[String]) -> String {
    let var = name(choices, scope);
    match choices.below(6) {
        0 => format!("elapsed() >= {}", 100 * choices.below(6)),
        1 => format!("{var} > 2"),
        2 => format!("type({var}) == 'table'"),
        3 => "robot.light.data > 1".into(),
        4 => "now() % 300 == 0".into(),
        _ => "1".into(),
    }
}

fn action(choices: &mut Choices, scope: &[String]) -> String {
    let var = name(choices, scope);
    match choices.below(6) {
        0 => format!("{var} = ({var} or 0) + 1"),
        1 => format!("{var} = {}", expression(choices, scope)),
        2 => format!("{var}.n = now()"),
        3 => format!("log.info({var})"),
        4 => "robot.move{ linear = { x = 0.1 } }".into(),
        _ => "error 'oh'".into(),
    }
}

fn transition(choices: &mut Choices, machine: &Machine, scope: &[String]) -> String {
    let state = |choices: &mut Choices| choices.of(&machine.states).map_or("gone".into(), |state| state.name.clone());
    let (from, to) = (state(choices), state(choices));
    let from = if choices.below(5) == 0 { "*".into() } else { from };
    match choices.below(5) {
        0 => format!("(eps {from} -> {to})"),
        1 => format!("(ontime {} {from} -> {to})", 100 * choices.below(5)),
        2 => format!("(ontime {} {from} -> {to})", name(choices, scope)),
        3 => format!("(on [{}] {from} -> {to})", condition(choices, scope)),
        _ => match choices.of(&machine.events) {
            Some(event) => format!("(on {} {from} -> {to})", event.name),
            None => format!("(on missing {from} -> {to})"),
        },
    }
}
