//! The cells of the matrix: what is edited, how, and where.

use std::fmt::{Display, Formatter, Result};

use super::base::{SITES, Site};

#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Kind {
    Bridge,
    Global,
    Variable,
    Machine,
    State,
    Event,
    Transition(On),
    Action(When),
    NestedSpawn,
    TopSpawn,
    Onpause,
    Onresume,
}

#[derive(Clone, Copy, Debug, PartialEq)]
pub enum On {
    Event,
    Block,
    Eps,
    Ontime,
    Exit,
}

#[derive(Clone, Copy, Debug, PartialEq)]
pub enum When {
    Entry,
    Running,
    Exit,
}

#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Op {
    Added,
    Removed,
    Changed,
    Renamed,
    /// To another place among its like.
    Reordered,
    /// To another machine or state.
    Moved,
    /// To what encloses its machine.
    MovedOut,
}

/// Which state of the machine, where that matters: the one that is active when the edit comes, or another.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Of {
    Busy,
    Off,
}

#[derive(Clone, Copy)]
pub struct Cell {
    pub kind: Kind,
    pub op: Op,
    pub site: Site,
    pub of: Of,
}

const KINDS: &[Kind] = &[
    Kind::Bridge,
    Kind::Global,
    Kind::Variable,
    Kind::Machine,
    Kind::State,
    Kind::Event,
    Kind::Transition(On::Event),
    Kind::Transition(On::Block),
    Kind::Transition(On::Eps),
    Kind::Transition(On::Ontime),
    Kind::Transition(On::Exit),
    Kind::Action(When::Entry),
    Kind::Action(When::Running),
    Kind::Action(When::Exit),
    Kind::NestedSpawn,
    Kind::TopSpawn,
    Kind::Onpause,
    Kind::Onresume,
];

const OPS: &[Op] = &[Op::Added, Op::Removed, Op::Changed, Op::Renamed, Op::Reordered, Op::Moved, Op::MovedOut];

/// All of them, also those that make no sense.
pub fn all() -> impl Iterator<Item = Cell> {
    let kinds = KINDS.iter().flat_map(|&kind| OPS.iter().map(move |&op| (kind, op)));
    let sites = kinds.flat_map(|(kind, op)| SITES.iter().map(move |&site| (kind, op, site)));
    sites.flat_map(|(kind, op, site)| [Of::Busy, Of::Off].map(|of| Cell { kind, op, site, of }))
}

impl Display for Cell {
    fn fmt(&self, f: &mut Formatter) -> Result {
        let Cell { kind, op, site, of } = self;
        write!(f, "{kind:?} {op:?} in {} ({}) {of:?}", site.machine, site.at)
    }
}

impl Cell {
    /// Why there is no such cell.
    pub fn senseless(&self) -> Option<&'static str> {
        let Cell { kind, op, site, of, .. } = *self;
        let once = site.machine == "solo";
        let spawning = matches!((site.machine, of), ("main", _) | ("mid" | "side", Of::Busy));
        let spawned_at_top = matches!(site.machine, "main" | "side" | "solo");
        let rules: &[(bool, &str)] = &[
            (!kind.is_of_a_state(op) && of == Of::Off, "it belongs to no state"),
            (kind.is_of_the_program() && !once, "it belongs to the whole program"),
            (kind == Kind::Global && op == Op::Added && !once, "a new global belongs to the whole program"),
            (kind == Kind::Global && op == Op::MovedOut, "nothing encloses the program"),
            (!kind.has_a_name() && op == Op::Renamed, "it has no name"),
            (kind == Kind::Machine && op == Op::Changed, "a machine is changed by what is in it: other cells"),
            (kind.is_of_the_program() && matches!(op, Op::Moved | Op::MovedOut), "it stands at top level only"),
            (
                matches!(kind, Kind::Event | Kind::Machine) && op == Op::MovedOut && site.inside.is_none(),
                "at top level there is nothing further out, or no place for it",
            ),
            (
                matches!(kind, Kind::State | Kind::Transition(_) | Kind::Action(_) | Kind::NestedSpawn)
                    && op == Op::MovedOut,
                "further out it is another machine's: moved",
            ),
            (kind == Kind::Transition(On::Exit) && site.inside.is_none(), "at top level there is nothing to exit from"),
            (
                kind == Kind::Transition(On::Eps) && of == Of::Busy && !matches!(op, Op::Added | Op::Changed),
                "an eps out of the active state would have left it",
            ),
            (kind == Kind::NestedSpawn && op != Op::Added && !spawning, "the state spawns nothing"),
            (
                kind == Kind::NestedSpawn && op == Op::Reordered && (site.machine == "mid" || of == Of::Off),
                "the state spawns just one machine",
            ),
            (kind == Kind::TopSpawn && site.inside.is_some(), "a nested machine is not spawned at top level"),
            (kind == Kind::TopSpawn && op == Op::Moved, "in a state it is a nested spawn: added there"),
            (kind == Kind::TopSpawn && op == Op::MovedOut, "nothing encloses the program"),
            (
                kind == Kind::TopSpawn && op == Op::Added && spawned_at_top,
                "it is spawned already, and a second time is a mistake",
            ),
            (kind == Kind::TopSpawn && op != Op::Added && !spawned_at_top, "it isn't spawned at top level"),
        ];
        rules.iter().find(|(holds, _)| *holds).map(|&(_, why)| why)
    }
}

impl Kind {
    fn is_of_a_state(self, op: Op) -> bool {
        match self {
            Kind::State | Kind::Transition(_) | Kind::Action(_) | Kind::NestedSpawn => true,
            Kind::Machine => op == Op::Added,
            _ => false,
        }
    }

    fn is_of_the_program(self) -> bool {
        matches!(self, Kind::Bridge | Kind::Onpause | Kind::Onresume)
    }

    fn has_a_name(self) -> bool {
        !matches!(self, Kind::Action(_) | Kind::NestedSpawn | Kind::TopSpawn | Kind::Onpause | Kind::Onresume)
    }
}
