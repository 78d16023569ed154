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
        let same = before.iter().zip(&after).take(place + 1).all(|(&a, &b)| self.same(&self.old[a], &self.new[b]));
        let via = match fired.via {
            Some(via) => Some(self.matching.state(via)?),
            None => None,
        };
        let target = self.matching.state(fired.target)?;
        same.then_some(Fired { transition, target, via })
    }

    fn same(&self, a: &Transition, b: &Transition) -> bool {
        let target = a.target.and_then(|target| self.matching.state(target));
        target == b.target && self.same_sources(&a.sources, &b.sources) && self.same_trigger(&a.trigger, &b.trigger)
    }

    fn same_sources(&self, a: &Sources, b: &Sources) -> bool {
        match (a, b) {
            (Sources::Any, Sources::Any) => true,
            (Sources::These { states: a, .. }, Sources::These { states: b, .. }) => {
                a.len() == b.len() && a.iter().zip(b).all(|(&a, &b)| self.matching.state(a) == Some(b))
            }
            _ => false,
        }
    }

    fn same_trigger(&self, a: &Trigger, b: &Trigger) -> bool {
        let same = |a, b| same_block(self.old, a, self.new, b, self.matching);
        match (a, b) {
            (Trigger::Always, Trigger::Always) => true,
            (&Trigger::Event(a), &Trigger::Event(b)) => {
                self.matching.event(a) == Some(b) && same(self.old[a].block, self.new[b].block)
            }
            (&Trigger::Block(a), &Trigger::Block(b)) | (&Trigger::AfterBlock(a), &Trigger::AfterBlock(b)) => same(a, b),
            (Trigger::After(a), Trigger::After(b)) => a == b,
            (&Trigger::AfterVar(a), &Trigger::AfterVar(b)) => self.matching.var(a) == Some(b),
            _ => false,
        }
    }
}
