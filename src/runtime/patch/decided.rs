//! Whether a transition that was decided on right after an entry is still to be taken: an edit that has nothing to do with
//! it doesn't disturb it either.

use super::Passage;
use crate::model::diff::same_block;
use crate::model::*;
use crate::runtime::machine::Fired;

impl Passage<'_> {
    /// The same in the new program, unless the transitions up to it have changed: then the next step tests anew.
    pub(super) fn decided(&self, was: StateId, now: StateId, fired: Fired) -> Option<Fired> {
        let before: Vec<TransitionId> = self.old[was].outgoing.iter().chain(&self.old[was].exits).copied().collect();
        let after: Vec<TransitionId> = self.new[now].outgoing.iter().chain(&self.new[now].exits).copied().collect();
        let place = before.iter().position(|&id| id == fired.transition)?;
        let transition = *after.get(place)?;
        let same = before.iter().zip(&after).take(place + 1).all(|(&was, &now)| self.same_guard(was, now));
        let via = match fired.via {
            Some(via) => Some(self.matching.state(via)?),
            None => None,
        };
        let target = self.matching.state(fired.target)?;
        same.then_some(Fired { transition, target, via })
    }

    fn same_guard(&self, was: TransitionId, now: TransitionId) -> bool {
        let same_event = match (&self.old[was].trigger, &self.new[now].trigger) {
            (&Trigger::Event(a), &Trigger::Event(b)) => {
                same_block(self.old, self.old[a].block, self.new, self.new[b].block, self.matching)
            }
            _ => true,
        };
        same_event && self.matching.transition(was) == Some(now)
    }
}
