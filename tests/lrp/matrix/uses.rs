//! Every place of a tree where a name is used, for renames.

use super::tree::*;

impl Tree {
    pub fn rename_uses(&mut self, from: &str, to: &str) {
        self.each_use(&mut |name| {
            if name == from {
                *name = to.into();
            }
        });
    }

    /// The names in blocks, transitions, spawns: not those that are declared.
    pub fn each_use(&mut self, with: &mut dyn FnMut(&mut String)) {
        self.vars.iter_mut().flat_map(|var| &mut var.init.of).for_each(&mut *with);
        self.machines.iter_mut().for_each(|machine| machine.each_use(with));
        for TopSpawn { spawn, .. } in &mut self.spawns {
            spawn.each_use(with);
        }
        for action in self.onpause.iter_mut().chain(&mut self.onresume) {
            with(&mut action.var);
        }
    }
}

impl Machine {
    fn each_use(&mut self, with: &mut dyn FnMut(&mut String)) {
        self.vars.iter_mut().flat_map(|var| &mut var.init.of).for_each(&mut *with);
        self.events.iter_mut().for_each(|event| with(&mut event.when.var));
        self.states.iter_mut().for_each(|state| state.each_use(with));
        for Transition { trigger, from, to, .. } in &mut self.transitions {
            with(from);
            with(to);
            match trigger {
                Trigger::Event(event) => with(event),
                Trigger::Block(over) | Trigger::Exit(over) => with(&mut over.var),
                Trigger::Eps | Trigger::After(_) => {}
            }
        }
    }
}

impl State {
    fn each_use(&mut self, with: &mut dyn FnMut(&mut String)) {
        let actions = self.onentry.iter_mut().chain(&mut self.running).chain(&mut self.onexit);
        actions.for_each(|action| with(&mut action.var));
        self.spawns.iter_mut().for_each(|spawn| spawn.each_use(with));
        self.machines.iter_mut().for_each(|machine| machine.each_use(with));
    }
}

impl Spawn {
    fn each_use(&mut self, with: &mut dyn FnMut(&mut String)) {
        with(&mut self.machine);
        with(&mut self.state);
    }
}
