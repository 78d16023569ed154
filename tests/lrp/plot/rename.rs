//! Renames in random programs: whole ones, and such that are saved in two goes.

use super::{Machine, Plot, State};
use crate::plot::Choices;

impl Plot {
    /// Everywhere, unless another rename is halfway. Gives the old name and the new one.
    pub fn rename(&mut self, choices: &mut Choices) -> Option<(String, String)> {
        if self.halfway.is_some() {
            return None;
        }
        let (old, new) = self.declare_anew(choices)?;
        self.rename_uses(&old, &new);
        Some((old, new))
    }

    /// Where it is declared alone; the next time wherever it is used.
    pub fn rename_half(&mut self, choices: &mut Choices) {
        match self.halfway.take() {
            Some((old, new)) => self.rename_uses(&old, &new),
            None => self.halfway = self.declare_anew(choices),
        }
    }

    fn declare_anew(&mut self, choices: &mut Choices) -> Option<(String, String)> {
        let mut names = Vec::new();
        self.each_name(&mut |name| names.push(name.clone()));
        let old = choices.of(&names)?.clone();
        let new = self.name(&old[..1]);
        self.each_name(&mut |name| {
            if *name == old {
                name.clone_from(&new);
            }
        });
        Some((old, new))
    }

    fn rename_uses(&mut self, old: &str, new: &str) {
        self.each_use(&mut |text| *text = replaced(text, old, new));
    }

    fn each_name(&mut self, with: &mut dyn FnMut(&mut String)) {
        self.vars.iter_mut().for_each(|var| with(&mut var.name));
        self.machines.iter_mut().for_each(|machine| machine.each_name(with));
    }

    fn each_use(&mut self, with: &mut dyn FnMut(&mut String)) {
        self.vars.iter_mut().for_each(|var| with(&mut var.init));
        self.machines.iter_mut().for_each(|machine| machine.each_use(with));
        for (machine, state) in &mut self.spawns {
            with(machine);
            with(state);
        }
        self.onpause.iter_mut().chain(&mut self.onresume).for_each(with);
    }
}

impl Machine {
    fn each_name(&mut self, with: &mut dyn FnMut(&mut String)) {
        with(&mut self.name);
        self.vars.iter_mut().chain(&mut self.events).for_each(|it| with(&mut it.name));
        for state in &mut self.states {
            with(&mut state.name);
            state.machines.iter_mut().for_each(|machine| machine.each_name(with));
        }
    }

    fn each_use(&mut self, with: &mut dyn FnMut(&mut String)) {
        self.vars.iter_mut().chain(&mut self.events).for_each(|it| with(&mut it.init));
        for State { onentry, running, onexit, machines, .. } in &mut self.states {
            onentry.iter_mut().chain(running).chain(onexit).for_each(&mut *with);
            machines.iter_mut().for_each(|machine| machine.each_use(with));
        }
        self.transitions.iter_mut().for_each(with);
    }
}

/// Whole words only.
fn replaced(text: &str, old: &str, new: &str) -> String {
    let words = text.split_inclusive(|c: char| !c.is_alphanumeric());
    let word = |part: &str| {
        let word = part.trim_end_matches(|c: char| !c.is_alphanumeric());
        if word == old { format!("{new}{}", &part[word.len()..]) } else { part.into() }
    };
    words.map(word).collect()
}
