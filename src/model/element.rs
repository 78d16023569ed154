//! Elements that have a name, of whichever kind, and a second name that one of them may go by.

use std::sync::Arc;

use super::ids::*;
use super::program::Program;
use crate::syntax::Code;

#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum Kind {
    Machine,
    State,
    Event,
    Var,
}

impl Kind {
    /// Of what a name doesn't name, where that is what a finding is about.
    pub fn missing(code: Code) -> Option<Kind> {
        match code {
            Code::UnknownMachine => Some(Kind::Machine),
            Code::UnknownState => Some(Kind::State),
            Code::UnknownEvent => Some(Kind::Event),
            Code::UnknownVariable => Some(Kind::Var),
            _ => None,
        }
    }
}

/// The id of an element of any kind, valid for one program only.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub struct ElementId {
    pub kind: Kind,
    pub index: u32,
}

macro_rules! kinds {
    ($($id:ident => $kind:ident,)*) => {$(
        impl From<$id> for ElementId {
            fn from(id: $id) -> ElementId {
                ElementId { kind: Kind::$kind, index: id.0 }
            }
        }
    )*};
}

kinds! {
    MachineId => Machine,
    StateId => State,
    EventId => Event,
    VarId => Var,
}

impl Program {
    pub fn name(&self, element: impl Into<ElementId>) -> &Arc<str> {
        let ElementId { kind, index } = element.into();
        match kind {
            Kind::Machine => &self[MachineId(index)].name,
            Kind::State => &self[StateId(index)].name,
            Kind::Event => &self[EventId(index)].name,
            Kind::Var => &self[VarId(index)].name,
        }
    }

    pub fn path(&self, element: impl Into<ElementId>) -> &Arc<str> {
        let ElementId { kind, index } = element.into();
        match kind {
            Kind::Machine => &self[MachineId(index)].path,
            Kind::State => &self[StateId(index)].path,
            Kind::Event => &self[EventId(index)].path,
            Kind::Var => &self[VarId(index)].path,
        }
    }

    /// The machine or state that an element is written in; none at top level.
    pub fn scope(&self, element: impl Into<ElementId>) -> Option<ElementId> {
        let ElementId { kind, index } = element.into();
        match kind {
            Kind::Machine => self[MachineId(index)].parent.map(ElementId::from),
            Kind::State => Some(self[StateId(index)].machine.into()),
            Kind::Event => Some(self[EventId(index)].machine.into()),
            Kind::Var => self[VarId(index)].machine.map(ElementId::from),
        }
    }

    pub fn all(&self, kind: Kind) -> impl Iterator<Item = ElementId> + use<> {
        let count = match kind {
            Kind::Machine => self.machines.len(),
            Kind::State => self.states.len(),
            Kind::Event => self.events.len(),
            Kind::Var => self.vars.len(),
        };
        (0..count as u32).map(move |index| ElementId { kind, index })
    }

    /// What goes by this name besides its own.
    pub fn alias(&self, kind: Kind, name: &str) -> Option<ElementId> {
        self.alias.as_ref().filter(|alias| alias.means.kind == kind && *alias.name == *name).map(|alias| alias.means)
    }

    /// Whether what a name was found to mean is really called so.
    pub fn is_called(&self, found: Option<impl Into<ElementId>>, name: &str) -> bool {
        found.is_some_and(|found| **self.name(found) == *name)
    }
}

/// A name that an element had in the program before, where uses of it still say so.
#[derive(Clone, Debug, PartialEq)]
pub struct Alias {
    pub name: Arc<str>,
    pub means: ElementId,
}
