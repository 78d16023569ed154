//! Renames saved in two goes, several at once, and those that are in doubt.

use lrp::runtime::OnEdit;

use super::base::{self, act};
use super::pair::{Pair, compiled};
use super::tree::*;

/// What is renamed, and where its name is declared.
type Named = (&'static str, fn(&mut Tree) -> &mut String);

/// Of each kind, at each depth.
const NAMED: &[Named] = &[
    ("global", |tree| &mut tree.vars.iter_mut().find(|var| var.name == "g_inner").expect("it is there").name),
    ("machine variable", |tree| &mut tree.machine("main").vars[0].name),
    ("nested variable", |tree| &mut tree.machine("inner").vars[0].name),
    ("machine", |tree| &mut tree.machine("main").name),
    ("nested machine", |tree| &mut tree.machine("mid").name),
    ("innermost machine", |tree| &mut tree.machine("inner").name),
    ("machine that another's state spawns", |tree| &mut tree.machine("lent").name),
    ("machine that doesn't run", |tree| &mut tree.machine("dorm").name),
    ("state", |tree| &mut tree.state("main_busy").name),
    ("nested state", |tree| &mut tree.state("mid_busy").name),
    ("innermost state", |tree| &mut tree.state("inner_busy").name),
    ("state that isn't active", |tree| &mut tree.state("inner_off").name),
    ("state that a spawn names", |tree| &mut tree.state("mid_start").name),
    ("event", |tree| &mut tree.machine("solo").events[0].name),
    ("nested event", |tree| &mut tree.machine("inner").events[0].name),
];

const NEW: &str = "renamed";

/// The declaration alone; gives the old name.
fn declare(tree: &mut Tree, (_, name): Named) -> String {
    std::mem::replace(name(tree), NEW.into())
}

fn halfway(tree: &Tree, named: Named) -> Tree {
    let mut tree = tree.clone();
    let old = declare(&mut tree, named);
    Tree { halfway: Some((old, NEW.into())), ..tree }
}

fn renamed(tree: &Tree, named: Named) -> Tree {
    let mut tree = tree.clone();
    let old = declare(&mut tree, named);
    tree.rename_uses(&old, NEW);
    tree
}

/// In the middle of a run, with values that were tuned.
fn running(mode: OnEdit) -> Result<Pair, String> {
    let tree = base::program();
    let program = compiled(&tree);
    let mut pair = Pair::new(tree, &program, mode)?;
    pair.until(800)?;
    for var in ["g_inner", "main_b", "inner_b", "lent_b"] {
        pair.tune(var, 7000);
    }
    pair.until(1000)?;
    Ok(pair)
}

/// Each text 200 ms after the last.
fn in_turn(mode: OnEdit, texts: &[Tree]) -> Result<(), String> {
    let mut pair = running(mode)?;
    for text in texts {
        pair.save(text.clone())?;
        pair.until(pair.now() + super::pair::PERIOD)?;
    }
    pair.until(2000)
}

fn each(texts: impl Fn(&Tree, Named) -> Vec<Tree>) {
    let mut failed = String::new();
    for &named in NAMED {
        for mode in [OnEdit::Restart, OnEdit::Keep] {
            if let Err(wrong) = in_turn(mode, &texts(&base::program(), named)) {
                failed += &format!("{} {mode:?}: {wrong}\n", named.0);
            }
        }
    }
    assert!(failed.is_empty(), "{failed}");
}

#[test]
fn in_one_go_and_back() {
    each(|tree, named| vec![renamed(tree, named), tree.clone()]);
}

#[test]
fn the_declaration_first_its_uses_later() {
    each(|tree, named| vec![halfway(tree, named), renamed(tree, named)]);
}

#[test]
fn the_declaration_first_and_then_taken_back() {
    each(|tree, named| vec![halfway(tree, named), tree.clone()]);
}

#[test]
fn other_edits_while_it_is_halfway() {
    each(|tree, named| {
        let mut other = tree.clone();
        let new = other.var("g_new".into(), &["g_side"], 1);
        other.vars.push(new);
        vec![halfway(tree, named), halfway(&other, named), renamed(&other, named)]
    });
}

#[test]
fn other_errors_while_it_is_halfway() {
    let wrong = |tree: &Tree| {
        let mut tree = tree.clone();
        let (trigger, from, to) = (Trigger::After(100_000_000), "solo_off".into(), "nowhere".into());
        tree.machine("solo").transitions.push(Transition { trigger, from, to, name: "lost".into() });
        tree
    };
    each(|tree, named| {
        let behind = halfway(tree, named);
        vec![behind.clone(), wrong(&behind), behind.clone(), renamed(tree, named)]
    });
    each(|tree, named| {
        let behind = halfway(tree, named);
        vec![behind.clone(), wrong(&behind), wrong(&renamed(tree, named)), renamed(tree, named)]
    });
}

#[test]
fn several_at_once() {
    let tree = base::program();
    let mut after = tree.clone();
    for (index, &(_, name)) in NAMED.iter().enumerate() {
        // Names of names that are gone by now can't be looked up.
        if matches!(index, 0 | 2 | 8 | 14) {
            let new = format!("renamed_{index}");
            let old = std::mem::replace(name(&mut after), new.clone());
            after.rename_uses(&old, &new);
        }
    }
    for mode in [OnEdit::Restart, OnEdit::Keep] {
        in_turn(mode, &[after.clone(), tree.clone()]).unwrap_or_else(|wrong| panic!("{wrong}"));
    }
}

/// Gone and new, as each of these is no rename: the element at this name has another identity.
fn doubtful(edit: impl Fn(&mut Tree)) {
    let mut tree = base::program();
    edit(&mut tree);
    for mode in [OnEdit::Restart, OnEdit::Keep] {
        in_turn(mode, &[tree.clone()]).unwrap_or_else(|wrong| panic!("{wrong}"));
    }
}

#[test]
fn a_body_that_changed_too_is_another_element() {
    doubtful(|tree| {
        *tree = renamed(tree, ("state", |tree| &mut tree.state("inner_busy").name));
        let id = tree.id();
        let state = tree.state(NEW);
        state.id = id;
        state.running.push(act("inner_z", Does::Add(1)));
    });
    doubtful(|tree| {
        *tree = renamed(tree, ("variable", |tree| &mut tree.machine("inner").vars[0].name));
        let id = tree.id();
        let var = &mut tree.machine("inner").vars[0];
        (var.id, var.init.and) = (id, 77);
    });
    doubtful(|tree| {
        *tree = renamed(tree, ("event", |tree| &mut tree.machine("inner").events[0].name));
        let id = tree.id();
        let event = &mut tree.machine("inner").events[0];
        (event.id, event.when.limit) = (id, NEVER + 9);
    });
}

#[test]
fn with_two_candidates_it_is_none() {
    doubtful(|tree| {
        *tree = renamed(tree, ("variable", |tree| &mut tree.machine("inner").vars[0].name));
        let (id, twin) = (tree.id(), tree.var("twin_of_it".into(), &[], 1));
        let vars = &mut tree.machine("inner").vars;
        vars[0].id = id;
        vars.push(twin);
    });
    doubtful(|tree| {
        *tree = renamed(tree, ("event", |tree| &mut tree.machine("inner").events[0].name));
        let (id, other) = (tree.id(), tree.id());
        let events = &mut tree.machine("inner").events;
        events[0].id = id;
        let twin = Event { id: other, name: "twin_of_it".into(), ..events[0].clone() };
        events.push(twin);
    });
    doubtful(|tree| {
        *tree = renamed(tree, ("state", |tree| &mut tree.state("inner_busy").name));
        let (id, other) = (tree.id(), tree.id());
        tree.state(NEW).id = id;
        let twin = State { id: other, name: "twin_of_it".into(), ..tree.state(NEW).clone() };
        tree.machine("inner").states.push(twin);
    });
}

#[test]
fn a_use_that_stays_behind_beside_others_that_go_along_is_a_rename_halfway() {
    let tree = base::program();
    let mut after = renamed(&tree, ("event", |tree| &mut tree.machine("inner").events[0].name));
    let left = |it: &&mut Transition| it.name == "inner_event_off";
    let behind = after.machine("inner").transitions.iter_mut().find(left).expect("it is there");
    behind.trigger = Trigger::Event("inner_e".into());
    after.halfway = Some(("inner_e".into(), NEW.into()));
    for mode in [OnEdit::Restart, OnEdit::Keep] {
        let last = renamed(&tree, ("event", |tree| &mut tree.machine("inner").events[0].name));
        in_turn(mode, &[after.clone(), last]).unwrap_or_else(|wrong| panic!("{wrong}"));
    }
}

#[test]
fn a_use_that_now_names_something_else_makes_it_none() {
    doubtful(|tree| {
        let event = Event { id: tree.id(), name: "inner_f".into(), when: base::over("inner_z", NEVER) };
        tree.machine("inner").events.push(event);
        *tree = renamed(tree, ("event", |tree| &mut tree.machine("inner").events[0].name));
        tree.machine("inner").events[0].id = tree.last + 1;
        tree.last += 1;
        let other = tree.machine("inner").transitions.iter_mut().find(|it| it.name == "inner_event_off");
        other.expect("it is there").trigger = Trigger::Event("inner_f".into());
    });
}
