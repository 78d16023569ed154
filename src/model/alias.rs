//! A rename that is saved in two goes: the declaration has its new name, the uses still say the old one. Found by
//! comparing with the program that runs.

use super::element::{Alias, ElementId, Kind};
use super::matching::{Key, Matching, Side};
use super::program::Program;

/// What went by another name in the program that runs, where it is still there and nothing else is called so by now.
/// Whatever else is wrong with the program, what named it goes on.
pub fn carry(running: &Program, program: &Program) -> Option<Alias> {
    let Alias { name, means } = running.alias.as_ref()?;
    if !Matching::unresolved(program).contains(&(means.kind, &**name)) {
        return None;
    }
    let now = Matching::of(running, program).now(*means)?;
    let mut beside = program.all(now.kind).filter(|&it| program.scope(it) == program.scope(now));
    beside.all(|it| program.name(it) != name).then(|| Alias { name: name.clone(), means: now })
}

/// Whether with its alias a program gives more names a meaning than without, and to the element that had it before.
pub fn serves(running: &Program, program: &Program, without: &Program) -> bool {
    let means = |program: &Program| program.alias.as_ref().map(|alias| alias.means);
    let is_the_same = means(running).and_then(|was| Matching::of(running, program).now(was)) == means(program);
    is_the_same && Matching::unresolved(program).len() < Matching::unresolved(without).len()
}

/// The one element that the one missing name of a program could mean, going by what it meant in the program that runs.
/// Where an export is what still says the old name, the new one is missing elsewhere as well.
pub fn propose(running: &Program, program: &Program) -> Option<Alias> {
    let (kind, missing) = missing(program)?;
    let matching = Matching::of(running, program);
    missing.iter().find_map(|&name| {
        let means = meaning(running, program, &matching, kind, name)?;
        let is_it = |other: &str| other == name || *other == **program.name(means);
        missing.iter().all(|other| is_it(other)).then(|| Alias { name: name.into(), means })
    })
}

fn meaning(running: &Program, program: &Program, matching: &Matching, kind: Kind, name: &str) -> Option<ElementId> {
    let renamed = running.alias(kind, name);
    // An export left behind doesn't keep a machine from being matched as renamed.
    let has_it = |now: ElementId| **program.name(now) == *name;
    let named = running.all(kind).filter(|&was| **running.name(was) == *name && !matching.now(was).is_some_and(has_it));
    let mut found = named.chain(renamed).filter_map(|was| match matching.now(was) {
        Some(now) => Some(now),
        None => twin(running, was, program, matching, name),
    });
    let means = found.next()?;
    found.next().is_none().then_some(means)
}

/// Whether a program that was resolved with an alias shows it to be a rename: all names mean something now.
pub fn holds(running: &Program, program: &Program) -> bool {
    let Some(alias) = &program.alias else { return true };
    let was = Matching::of(running, program).was(alias.means);
    let had_it =
        |was: ElementId| *running.name(was) == alias.name || running.alias(alias.means.kind, &alias.name) == Some(was);
    was.is_some_and(had_it) && Matching::unresolved(program).is_empty()
}

/// The names that the errors of a program are about, where all of them are about names of one kind, and two at most.
fn missing(program: &Program) -> Option<(Kind, Vec<&str>)> {
    let mut of_kind = None;
    let mut names = Vec::new();
    for finding in program.findings.iter().filter(|finding| finding.is_error()) {
        let kind = Kind::missing(finding.code)?;
        if *of_kind.get_or_insert(kind) != kind {
            return None;
        }
        let name = program.source(finding.span).slice(finding.span);
        if !names.contains(&name) {
            names.push(name);
        }
    }
    (names.len() <= 2).then_some((of_kind?, names))
}

/// The one new element beside an element that is gone with the same text, which may still use the old name.
fn twin(running: &Program, was: ElementId, program: &Program, matching: &Matching, name: &str) -> Option<ElementId> {
    let (old, new) = (Side::Old(running, program), Side::New(program));
    let scope = running.scope(was);
    let scope_now = match scope {
        Some(scope) => Some(matching.now(scope)?),
        None => None,
    };
    let wanted = text(old, matching, was, name);
    let gone = running.all(was.kind).filter(|&it| running.scope(it) == scope && matching.now(it).is_none());
    let added = program.all(was.kind).filter(|&it| program.scope(it) == scope_now && matching.was(it).is_none());
    let is_only_one = gone.filter(|&it| text(old, matching, it, name) == wanted).count() == 1;
    let mut twins = added.filter(|&it| text(new, matching, it, name) == wanted);
    let twin = twins.next().filter(|_| is_only_one);
    twin.filter(|_| twins.next().is_none())
}

/// An element's text, where the missing name may mean what is gone, the element itself included.
fn text<'p>(side: Side<'p>, matching: &Matching, element: ElementId, missing: &str) -> Vec<Key<'p>> {
    let mut keys = side.body(matching, element);
    let mut of_itself = false;
    for key in &mut keys {
        let after_itself = std::mem::replace(&mut of_itself, *key == Key::Subject(Kind::Machine));
        match *key {
            // Nothing is known of a state of a machine that isn't known.
            Key::Called(kind, name) if after_itself => *key = Key::Unknown(kind, name),
            Key::Subject(kind) => *key = Key::Along(kind),
            Key::Unknown(kind, name) if kind == element.kind && name == missing => *key = Key::Along(kind),
            _ => {}
        }
    }
    keys
}
