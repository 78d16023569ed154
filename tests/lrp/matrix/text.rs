//! The tree as a program's text.

use std::fmt::{Display, Formatter, Result};

use super::tree::*;

impl Display for Tree {
    fn fmt(&self, f: &mut Formatter) -> Result {
        let mut forms: Vec<String> = Vec::new();
        forms.extend(self.bridges.iter().map(|it| format!("(bridge {} sim [{}])", it.name, it.config)));
        forms.push(self.vars.iter().map(|var| format!("{var}\n")).collect());
        forms.extend(self.machines.iter().map(Machine::to_string));
        forms.push(self.spawns.iter().map(|it| format!("{}\n", it.spawn)).collect());
        forms.extend(self.onpause.iter().map(|action| format!("(onpause {action})")));
        forms.extend(self.onresume.iter().map(|action| format!("(onresume {action})")));
        if self.upside_down {
            forms.reverse();
        }
        forms.iter().try_for_each(|form| writeln!(f, "{form}"))
    }
}

impl Display for Var {
    fn fmt(&self, f: &mut Formatter) -> Result {
        write!(f, "(var {} := [{}])", self.name, self.init)
    }
}

impl Display for Sum {
    fn fmt(&self, f: &mut Formatter) -> Result {
        self.of.iter().try_for_each(|var| write!(f, "{var} + "))?;
        write!(f, "{}", self.and)
    }
}

impl Display for Machine {
    fn fmt(&self, f: &mut Formatter) -> Result {
        writeln!(f, "(machine {}", self.name)?;
        self.vars.iter().try_for_each(|var| writeln!(f, "{var}"))?;
        self.events.iter().try_for_each(|event| writeln!(f, "(event {} [{}])", event.name, event.when))?;
        self.states.iter().try_for_each(|state| write!(f, "{state}"))?;
        self.transitions.iter().try_for_each(|it| writeln!(f, "({it})"))?;
        writeln!(f, ")")
    }
}

impl Display for State {
    fn fmt(&self, f: &mut Formatter) -> Result {
        writeln!(f, "(state {}", self.name)?;
        self.onentry.iter().try_for_each(|action| writeln!(f, "(onentry {action})"))?;
        self.spawns.iter().try_for_each(|spawn| writeln!(f, "(onentry {spawn})"))?;
        self.running.iter().try_for_each(|action| writeln!(f, "(running {action})"))?;
        self.onexit.iter().try_for_each(|action| writeln!(f, "(onexit {action})"))?;
        self.machines.iter().try_for_each(|machine| write!(f, "{machine}"))?;
        writeln!(f, ")")
    }
}

impl Display for Spawn {
    fn fmt(&self, f: &mut Formatter) -> Result {
        write!(f, "(spawn {} {})", self.machine, self.state)
    }
}

impl Display for Action {
    fn fmt(&self, f: &mut Formatter) -> Result {
        let var = &self.var;
        match self.does {
            Does::Add(n) => write!(f, "[{var} = {var} + {n}]"),
            Does::Double => write!(f, "[{var} = {var} * 2]"),
        }
    }
}

impl Display for Over {
    fn fmt(&self, f: &mut Formatter) -> Result {
        write!(f, "{} > {}", self.var, self.limit)
    }
}

/// As lists of changes name it, without its machine.
impl Display for Transition {
    fn fmt(&self, f: &mut Formatter) -> Result {
        match &self.trigger {
            Trigger::Event(event) => write!(f, "on {event}")?,
            Trigger::Block(over) => write!(f, "on [{over}]")?,
            Trigger::Eps => write!(f, "eps")?,
            Trigger::After(ms) => write!(f, "ontime {ms}")?,
            Trigger::Exit(over) => write!(f, "exit [{over}]")?,
        }
        write!(f, " {} -> {} {}", self.from, self.to, self.name)
    }
}
