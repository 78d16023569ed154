//! Transitions have no names: one is the same as before when it says the same, in the machine it was in. Equal ones are
//! told apart by their order.

use std::collections::{HashMap, VecDeque};

use super::{Matching, Reading, Side};
use crate::model::ids::*;
use crate::model::program::*;

pub(super) fn pair(old: &Program, new: &Program, matching: &mut Matching) {
    for (index, machine) in old.machines.iter().enumerate() {
        if let Some(now) = matching.machine(MachineId(index as u32)) {
            pair_lists(old, &machine.transitions, new, &new[now].transitions, matching);
        }
    }
}

fn pair_lists(old: &Program, was: &[TransitionId], new: &Program, now: &[TransitionId], matching: &mut Matching) {
    let unchanged = was.iter().zip(now).take_while(|&(&was, &now)| reads_the_same(old, was, new, now)).count();
    for (was, now) in was.iter().zip(now).take(unchanged) {
        matching.transitions.link(was.0, now.0);
    }
    let (was, now) = (&was[unchanged..], &now[unchanged..]);
    if was.is_empty() || now.is_empty() {
        return;
    }
    let mut there: HashMap<_, VecDeque<TransitionId>> = HashMap::with_capacity(now.len());
    for &id in now {
        let keys = Side::New(new).keys(matching, Reading::Current, |words| words.transition(id));
        there.entry(keys).or_default().push_back(id);
    }
    for &id in was {
        let keys = Side::Old(old, new).keys(matching, Reading::Current, |words| words.transition(id));
        if let Some(now) = there.get_mut(&keys).and_then(VecDeque::pop_front) {
            matching.transitions.link(id.0, now.0);
        }
    }
}

/// Whether the texts are the same, letter by letter: then there is no need to read them.
fn reads_the_same(old: &Program, was: TransitionId, new: &Program, now: TransitionId) -> bool {
    let (was, now) = (old[was].span, new[now].span);
    old.source(was).slice(was) == new.source(now).slice(now)
}
