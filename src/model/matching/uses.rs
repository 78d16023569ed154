//! The places of a program that name elements, and whether they name a renamed one by its new name.

use std::collections::HashMap;

use super::renames::Rename;
use super::{Key, Matching, Reading, Side};
use crate::model::element::{ElementId, Kind};
use crate::model::ids::*;
use crate::model::program::*;

/// What names others as one piece.
#[derive(Clone, Copy, PartialEq)]
pub(super) enum Place {
    Transition(TransitionId),
    /// Which onentry item of a state.
    Spawn(StateId, usize),
    TopSpawn(usize),
    /// Not one of a transition.
    Block(BlockId),
}

/// A name in a place: what it means, and where it is looked up from.
pub(super) struct Use<'p> {
    pub place: Place,
    pub kind: Kind,
    pub name: &'p str,
    pub found: Option<ElementId>,
    pub scope: Option<ElementId>,
}

/// By element, the places that name it.
type Places = HashMap<ElementId, Vec<Place>>;

pub(super) struct Uses<'p> {
    old: &'p Program,
    new: &'p Program,
    /// In the old program, of what may have been renamed; in the new one, of what it may have become.
    of_old: Places,
    of_new: Places,
    /// Names in the new program that mean nothing, or something that is new: where they are looked up from.
    loose: HashMap<(Kind, &'p str), Vec<Option<ElementId>>>,
}

impl<'p> Uses<'p> {
    pub fn of(old: &'p Program, new: &'p Program, matching: &Matching, renames: &[Rename]) -> Uses<'p> {
        let (of_old, of_new) =
            renames.iter().map(|&(was, now)| ((was, Vec::new()), (now, Vec::new()))).unzip::<_, _, Places, Places>();
        let mut uses = Uses { old, new, of_old, of_new, loose: HashMap::new() };
        if renames.is_empty() {
            return uses;
        }
        each_use(old, &mut |it| note(&mut uses.of_old, &it));
        each_use(new, &mut |it| {
            note(&mut uses.of_new, &it);
            match it.found {
                None => uses.loose.entry((it.kind, it.name)).or_default().push(it.scope),
                Some(found) if matching.was(found).is_none() => {
                    uses.loose.entry((it.kind, new.name(found))).or_default().push(it.scope);
                }
                Some(_) => {}
            }
        });
        uses
    }

    /// Whether every place that named the old element, as far as it is still there, names the new one, and nothing goes
    /// by the old name any more.
    pub fn go_along(&self, matching: &Matching, was: ElementId, now: ElementId) -> bool {
        !self.is_still_named(was, now) && self.are_renamed(matching, was, now)
    }

    fn is_still_named(&self, was: ElementId, now: ElementId) -> bool {
        let Some(from) = self.loose.get(&(was.kind, &**self.old.name(was))) else { return false };
        let Some(scope) = self.new.scope(now) else { return true };
        from.iter().flatten().any(|&from| match was.kind {
            Kind::State => from == scope,
            _ => std::iter::successors(Some(from), |&around| self.new.scope(around)).any(|around| around == scope),
        })
    }

    fn are_renamed(&self, matching: &Matching, was: ElementId, now: ElementId) -> bool {
        let mut there: HashMap<(Option<ElementId>, Vec<Key>), usize> = HashMap::new();
        for &place in self.of_new.get(&now).into_iter().flatten() {
            let keys = place.keys(Side::New(self.new), matching, now);
            *there.entry((place.owner(self.new), keys)).or_default() += 1;
        }
        let mut missing = Vec::new();
        for &place in self.of_old.get(&was).into_iter().flatten() {
            let owner = place.owner(self.old);
            let owner_now = owner.and_then(|owner| matching.now(owner));
            if owner.is_some() && owner_now.is_none() {
                continue;
            }
            let keys = place.keys(Side::Old(self.old, self.new), matching, was);
            match there.get_mut(&(owner_now, keys.clone())).filter(|count| **count > 0) {
                Some(count) => *count -= 1,
                None => missing.push((owner, owner_now, keys)),
            }
        }
        missing.iter().all(|(owner, owner_now, keys)| {
            let before = similar(Side::Old(self.old, self.new), matching, *owner, was, keys);
            let after = similar(Side::New(self.new), matching, *owner_now, now, keys);
            after <= before
        })
    }
}

fn note(places: &mut Places, it: &Use) {
    if let Some(places) = it.found.and_then(|found| places.get_mut(&found))
        && places.last() != Some(&it.place)
    {
        places.push(it.place);
    }
}

/// How many places of an owner say the same as `keys`, only that they name something else instead of `subject`.
fn similar(side: Side, matching: &Matching, owner: Option<ElementId>, subject: ElementId, keys: &[Key]) -> usize {
    let is_name = |key: &Key| match *key {
        Key::Is(element) => element.kind == subject.kind,
        Key::Along(kind) | Key::Unknown(kind, _) | Key::Subject(kind) => kind == subject.kind,
        _ => false,
    };
    let is_similar = |other: &[Key]| {
        let alike = |(key, other): (&Key, &Key)| key == other || (matches!(key, Key::Subject(_)) && is_name(other));
        keys != other && keys.len() == other.len() && keys.iter().zip(other).all(alike)
    };
    let places = places_of(side.program(), owner);
    places.into_iter().filter(|place| is_similar(&place.keys(side, matching, subject))).count()
}

impl Place {
    /// What it is written in; none at top level.
    fn owner(self, program: &Program) -> Option<ElementId> {
        match self {
            Place::Transition(transition) => Some(program[transition].machine.into()),
            Place::Spawn(state, _) => Some(state.into()),
            Place::TopSpawn(_) => None,
            Place::Block(block) => match program[block].owner {
                Owner::Program => None,
                Owner::Var(var) => Some(var.into()),
                Owner::Event(event) => Some(event.into()),
                Owner::State(state) => Some(state.into()),
                Owner::Transition(transition) => Some(program[transition].machine.into()),
            },
        }
    }

    fn keys<'p>(self, side: Side<'p>, matching: &Matching, subject: ElementId) -> Vec<Key<'p>> {
        let program = side.program();
        side.keys(matching, Reading::Use(subject), |words| match self {
            Place::Transition(transition) => words.transition(transition),
            Place::Spawn(state, index) => {
                if let Entry::Spawn(spawn) = &program[state].onentry[index] {
                    words.spawn(spawn);
                }
            }
            Place::TopSpawn(index) => words.spawn(&program.spawns[index]),
            Place::Block(block) => words.block(block),
        })
    }
}

fn places_of(program: &Program, owner: Option<ElementId>) -> Vec<Place> {
    let blocks = |blocks: &[BlockId]| blocks.iter().copied().map(Place::Block).collect::<Vec<_>>();
    let Some(ElementId { kind, index }) = owner else {
        let hooks = program.on_pause.into_iter().chain(program.on_resume).map(Place::Block);
        return (0..program.spawns.len()).map(Place::TopSpawn).chain(hooks).collect();
    };
    match kind {
        Kind::Machine => program[MachineId(index)].transitions.iter().copied().map(Place::Transition).collect(),
        Kind::Event => blocks(&[program[EventId(index)].block]),
        Kind::Var => blocks(&[program[VarId(index)].init]),
        Kind::State => {
            let state = &program[StateId(index)];
            let entries = state.onentry.iter().enumerate().map(|(at, entry)| match entry {
                Entry::Spawn(_) => Place::Spawn(StateId(index), at),
                Entry::Action(block) => Place::Block(*block),
            });
            entries.chain(blocks(&state.running)).chain(blocks(&state.onexit)).collect()
        }
    }
}

/// Every name in a program, place by place.
pub(super) fn each_use<'p>(program: &'p Program, each: &mut impl FnMut(Use<'p>)) {
    for index in 0..program.transitions.len() {
        names_in_transition(program, TransitionId(index as u32), each);
    }
    for (index, state) in program.states.iter().enumerate() {
        let id = StateId(index as u32);
        for (at, entry) in state.onentry.iter().enumerate() {
            if let Entry::Spawn(spawn) = entry {
                names_in_spawn(spawn, Place::Spawn(id, at), Some(id.into()), each);
            }
        }
    }
    for (index, spawn) in program.spawns.iter().enumerate() {
        names_in_spawn(spawn, Place::TopSpawn(index), None, each);
    }
    for (index, block) in program.blocks.iter().enumerate() {
        let place = match block.owner {
            Owner::Transition(transition) => Place::Transition(transition),
            _ => Place::Block(BlockId(index as u32)),
        };
        let (kind, scope) = (Kind::Var, block.machine.map(ElementId::from));
        for &var in &block.uses {
            each(Use { place, kind, name: program.name(var), found: Some(var.into()), scope });
        }
        for name in &block.missing {
            each(Use { place, kind, name, found: None, scope });
        }
    }
}

fn names_in_transition<'p>(program: &'p Program, id: TransitionId, each: &mut impl FnMut(Use<'p>)) {
    let transition = &program[id];
    let place = Place::Transition(id);
    let machine = Some(transition.machine.into());
    let target_in = match transition.kind {
        TransitionKind::Exit => program.enclosing(transition.machine).map(ElementId::from),
        _ => machine,
    };
    let mut name = |kind, name: &'p str, found, scope| each(Use { place, kind, name, found, scope });
    for (source, state) in program.sources_of(transition) {
        name(Kind::State, source, state.map(ElementId::from), machine);
    }
    name(Kind::State, &transition.target_name, transition.target.map(ElementId::from), target_in);
    match &transition.trigger {
        Trigger::Event(event) => name(Kind::Event, program.name(*event), Some((*event).into()), machine),
        Trigger::UnknownEvent(event) => name(Kind::Event, event, None, machine),
        Trigger::AfterVar(var) => name(Kind::Var, program.name(*var), Some((*var).into()), machine),
        Trigger::AfterUnknown(var) => name(Kind::Var, var, None, machine),
        Trigger::Always | Trigger::After(_) | Trigger::Block(_) | Trigger::AfterBlock(_) => {}
    }
}

fn names_in_spawn<'p>(spawn: &'p Spawn, place: Place, by: Option<ElementId>, each: &mut impl FnMut(Use<'p>)) {
    let (machine, name) = (spawn.machine.map(ElementId::from), &spawn.machine_name);
    each(Use { place, kind: Kind::Machine, name, found: machine, scope: by });
    let state = spawn.target.map(|(_, state)| state.into());
    each(Use { place, kind: Kind::State, name: &spawn.state_name, found: state, scope: machine });
}
