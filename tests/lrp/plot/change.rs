//! Small changes of random programs.

use super::words::{action, condition, expression, transition};
use super::{Choices, Machine, Plot, State, Var};

impl Plot {
    /// One small change somewhere.
    pub fn change(&mut self, choices: &mut Choices) {
        let scope = self.globals();
        match choices.below(12) {
            0 => {
                let var = self.var(choices, &scope);
                self.vars.push(var);
            }
            1 => self.add_machine(choices),
            2 => drop(remove(&mut self.machines, choices)),
            3 => drop(remove(&mut self.spawns, choices)),
            8 => reorder(&mut self.vars, choices),
            9 => reorder(&mut self.machines, choices),
            10 => reorder(&mut self.spawns, choices),
            11 => self.onpause = Some(action(choices, &scope)).filter(|_| self.onpause.is_none()),
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
        match choices.below(17) {
            0 => machine.vars.push(self.var(choices, &scope)),
            1 => drop(remove(&mut machine.vars, choices)),
            2 => machine.events.push(Var { name: self.name("e"), init: condition(choices, &scope) }),
            3 => drop(remove(&mut machine.events, choices)),
            4 => machine.states.push(self.state(choices, &scope, 1)),
            5 if machine.states.len() > 1 => drop(remove(&mut machine.states, choices)),
            6 => machine.transitions.push(transition(choices, machine, &scope)),
            7 => drop(remove(&mut machine.transitions, choices)),
            10 => reorder(&mut machine.vars, choices),
            11 => reorder(&mut machine.states, choices),
            12 => reorder(&mut machine.transitions, choices),
            13 => self.move_out(machine, choices),
            15 => break_at(&mut machine.transitions, choices),
            16 => respace(&mut machine.transitions),
            14 if !machine.events.is_empty() => {
                let index = choices.below(machine.events.len());
                machine.events[index].init = condition(choices, &scope);
            }
            _ => {
                let index = choices.below(machine.states.len());
                let mut state = std::mem::take(&mut machine.states[index]);
                self.change_state(&mut state, choices, &scope);
                machine.states[index] = state;
            }
        }
    }

    fn change_state(&mut self, state: &mut State, choices: &mut Choices, scope: &[String]) {
        match choices.below(9) {
            0 => state.running.push(format!("[{}]", action(choices, scope))),
            1 => drop(remove(&mut state.onexit, choices)),
            2 => state.machines.push(self.machine(choices, scope, 0)),
            5 => reorder(&mut state.onentry, choices),
            6 => state.onentry.push(format!("[{}]", action(choices, scope))),
            7 => state.breaks = !state.breaks,
            8 => drop(remove(&mut state.onentry, choices)),
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

    /// To top level, or from there into the last machine's first state.
    fn move_out(&mut self, machine: &mut Machine, choices: &mut Choices) {
        let index = choices.below(machine.states.len());
        match (remove(&mut machine.states[index].machines, choices), self.machines.last_mut()) {
            (Some(nested), _) => self.machines.push(nested),
            (None, Some(last)) => drop(remove(&mut machine.vars, choices).map(|var| last.vars.push(var))),
            (None, None) => drop(remove(&mut machine.vars, choices).map(|var| self.vars.push(var))),
        }
    }
}

fn remove<T>(list: &mut Vec<T>, choices: &mut Choices) -> Option<T> {
    let index = choices.below(list.len());
    (index < list.len()).then(|| list.remove(index))
}

fn reorder<T>(list: &mut Vec<T>, choices: &mut Choices) {
    if let Some(one) = remove(list, choices) {
        list.insert(choices.below(list.len() + 1), one);
    }
}

/// The program pauses when one of these is taken, or no longer.
fn break_at(transitions: &mut [String], choices: &mut Choices) {
    let index = choices.below(transitions.len());
    if let Some(transition) = transitions.get_mut(index) {
        *transition = match transition.strip_suffix(" (break))") {
            Some(without) => format!("{without})"),
            None => format!("{} (break))", &transition[..transition.len() - 1]),
        };
    }
}

/// White space in strings counts.
fn respace(transitions: &mut [String]) {
    for transition in transitions {
        *transition = match transition.contains("'a b'") {
            true => transition.replace("'a b'", "'a  b'"),
            false => transition.replace("'a  b'", "'a b'"),
        };
    }
}
