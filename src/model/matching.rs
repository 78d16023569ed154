//! Which element of one program is which of another: what goes on through an edit. By path, or renamed.

use std::collections::HashMap;
use std::sync::Arc;

use super::ids::*;
use super::program::*;

/// By old id: the new one, where the element is still there.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Matching {
    machines: Vec<Option<MachineId>>,
    states: Vec<Option<StateId>>,
    events: Vec<Option<EventId>>,
    vars: Vec<Option<VarId>>,
}

impl Matching {
    pub fn of(old: &Program, new: &Program) -> Matching {
        Matching {
            machines: by_path(
                old.machines.iter().map(|it| &it.path),
                new.machines.iter().map(|it| &it.path),
                MachineId,
            ),
            states: by_path(old.states.iter().map(|it| &it.path), new.states.iter().map(|it| &it.path), StateId),
            events: by_path(old.events.iter().map(|it| &it.path), new.events.iter().map(|it| &it.path), EventId),
            vars: by_path(old.vars.iter().map(|it| &it.path), new.vars.iter().map(|it| &it.path), VarId),
        }
    }

    pub fn machine(&self, old: MachineId) -> Option<MachineId> {
        self.machines[old.index()]
    }

    pub fn state(&self, old: StateId) -> Option<StateId> {
        self.states[old.index()]
    }

    pub fn event(&self, old: EventId) -> Option<EventId> {
        self.events[old.index()]
    }

    pub fn var(&self, old: VarId) -> Option<VarId> {
        self.vars[old.index()]
    }
}

fn by_path<'p, Id>(
    old: impl Iterator<Item = &'p Arc<str>>,
    new: impl Iterator<Item = &'p Arc<str>>,
    id: fn(u32) -> Id,
) -> Vec<Option<Id>> {
    let now: HashMap<&str, u32> = new.enumerate().map(|(index, path)| (&**path, index as u32)).collect();
    old.map(|path| now.get(&**path).copied().map(id)).collect()
}
