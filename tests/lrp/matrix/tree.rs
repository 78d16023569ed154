//! A program as the matrix knows it: a small tree whose elements carry an identity that an edit keeps or doesn't. No
//! two names in it are alike, so a name alone says what is meant.

pub type Id = u32;

#[derive(Clone, Debug, Default)]
pub struct Tree {
    pub bridges: Vec<Bridge>,
    pub vars: Vec<Var>,
    pub machines: Vec<Machine>,
    pub spawns: Vec<TopSpawn>,
    pub onpause: Option<Action>,
    pub onresume: Option<Action>,
    /// Top-level forms stand the other way round in the text.
    pub upside_down: bool,
    /// Renamed in the declaration but not yet in every use: the old name, and the new one.
    pub halfway: Option<(String, String)>,
    pub last: Id,
}

#[derive(Clone, Debug)]
pub struct Bridge {
    pub name: String,
    pub config: String,
}

#[derive(Clone, Debug)]
pub struct Var {
    pub id: Id,
    pub name: String,
    pub init: Sum,
}

/// What variables hold at the start: others, and a number.
#[derive(Clone, Debug)]
pub struct Sum {
    pub of: Vec<String>,
    pub and: i64,
}

#[derive(Clone, Debug)]
pub struct Machine {
    pub id: Id,
    pub name: String,
    pub vars: Vec<Var>,
    pub events: Vec<Event>,
    pub states: Vec<State>,
    pub transitions: Vec<Transition>,
}

#[derive(Clone, Debug)]
pub struct State {
    pub id: Id,
    pub name: String,
    pub onentry: Vec<Action>,
    /// After the actions of onentry.
    pub spawns: Vec<Spawn>,
    pub running: Vec<Action>,
    pub onexit: Vec<Action>,
    pub machines: Vec<Machine>,
}

#[derive(Clone, Debug)]
pub struct Spawn {
    pub machine: String,
    pub state: String,
}

#[derive(Clone, Debug)]
pub struct TopSpawn {
    pub id: Id,
    pub spawn: Spawn,
}

#[derive(Clone, Debug)]
pub struct Action {
    pub var: String,
    pub does: Does,
}

#[derive(Clone, Copy, Debug)]
pub enum Does {
    Add(i64),
    Double,
}

#[derive(Clone, Debug)]
pub struct Event {
    pub id: Id,
    pub name: String,
    pub when: Over,
}

/// A variable is greater than a number.
#[derive(Clone, Debug)]
pub struct Over {
    pub var: String,
    pub limit: i64,
}

#[derive(Clone, Debug)]
pub struct Transition {
    pub trigger: Trigger,
    pub from: String,
    pub to: String,
    pub name: String,
}

#[derive(Clone, Debug)]
pub enum Trigger {
    Event(String),
    Block(Over),
    Eps,
    After(i64),
    Exit(Over),
}

/// Greater than all that a variable becomes here.
pub const NEVER: i64 = 1 << 40;

impl Tree {
    pub fn id(&mut self) -> Id {
        self.last += 1;
        self.last
    }

    pub fn machine(&mut self, name: &str) -> &mut Machine {
        find(&mut self.machines, name).unwrap_or_else(|| panic!("there is a machine {name}"))
    }

    /// The state with this name, wherever it is.
    pub fn state(&mut self, name: &str) -> &mut State {
        fn within<'t>(machines: &'t mut [Machine], name: &str) -> Option<&'t mut State> {
            machines.iter_mut().flat_map(|machine| &mut machine.states).find_map(|state| match state.name == name {
                true => Some(state),
                false => within(&mut state.machines, name),
            })
        }
        within(&mut self.machines, name).unwrap_or_else(|| panic!("there is a state {name}"))
    }

    /// The list of machines that holds the one with this name.
    pub fn beside(&mut self, name: &str) -> &mut Vec<Machine> {
        fn within<'t>(machines: &'t mut Vec<Machine>, name: &str) -> Option<&'t mut Vec<Machine>> {
            if machines.iter().any(|machine| machine.name == name) {
                return Some(machines);
            }
            let states = machines.iter_mut().flat_map(|machine| &mut machine.states);
            states.map(|state| &mut state.machines).find_map(|machines| within(machines, name))
        }
        within(&mut self.machines, name).unwrap_or_else(|| panic!("there is a machine {name}"))
    }

    /// What is said of another place is another thing, with all that is in it.
    pub fn renew(&mut self, machine: &mut Machine) {
        machine.id = self.id();
        machine.vars.iter_mut().for_each(|var| var.id = self.id());
        machine.events.iter_mut().for_each(|event| event.id = self.id());
        machine.states.iter_mut().for_each(|state| self.renew_state(state));
    }

    pub fn renew_state(&mut self, state: &mut State) {
        state.id = self.id();
        state.machines.iter_mut().for_each(|machine| self.renew(machine));
    }

    /// Where a name that is declared no longer leads, if a rename is halfway.
    pub fn meant<'t>(&'t self, name: &'t str) -> &'t str {
        self.halfway.as_ref().filter(|(old, _)| old == name).map_or(name, |(_, new)| new)
    }
}

impl Transition {
    pub fn is_exit(&self) -> bool {
        matches!(self.trigger, Trigger::Exit(_))
    }
}

fn find<'t>(machines: &'t mut [Machine], name: &str) -> Option<&'t mut Machine> {
    machines.iter_mut().find_map(|machine| match machine.name == name {
        true => Some(machine),
        false => machine.states.iter_mut().find_map(|state| find(&mut state.machines, name)),
    })
}
