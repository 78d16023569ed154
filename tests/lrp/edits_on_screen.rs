//! What the screen does with edits and held edits, from stories of records.

use lrp::runtime::command::{Command, OnEdit, OnError, Saves};
use lrp::runtime::record::{Because, Change, Element, Fault, Finding, Held, Level, Log, Op, What};
use lrp::ui::app::{App, Effect};
use lrp::ui::view::{Edit, View};
use serde_json::json;

use crate::frames::{SIZES, check, check_at, frame, go_on, press, screen};
use crate::story::{LINE_FOLLOWER, Story, program};

fn renamed(kind: Element, path: &str, to: &str) -> Change {
    Change { op: Op::Renamed, kind, path: path.into(), to: Some(to.into()) }
}

fn change(op: Op, kind: Element, path: &str) -> Change {
    Change { op, kind, path: path.into(), to: None }
}

fn newest(view: &View, count: usize) -> Vec<String> {
    view.journal.newest_first().take(count).map(|entry| entry.text.clone()).collect()
}

fn searching_renamed() -> (std::sync::Arc<lrp::model::Program>, Vec<Change>) {
    let text = LINE_FOLLOWER.replace("looking", "searching").replace("lookalgo", "sweep");
    let changes = vec![
        renamed(Element::State, "follower/looking", "follower/searching"),
        renamed(Element::Machine, "follower/looking/lookalgo", "follower/searching/sweep"),
    ];
    (program(&text), changes)
}

#[test]
fn a_rename_takes_everything_along() {
    let before = Story::searching().view();
    let mut story = Story::searching();
    let (program, changes) = searching_renamed();
    story.edit(&program, changes, None, &[]);
    let view = story.view();
    let active = view.active("follower/searching/sweep").map(|path| &**path);
    assert_eq!(active, Some("follower/searching/sweep/lookright"));
    assert!(view.is_active("follower/searching"));
    assert_eq!(view.machines["follower/searching/sweep"].spawned_by.as_deref(), Some("follower/searching"));
    assert_eq!(view.states["follower/searching/sweep/lookleft"].visits, 4);
    assert_eq!(view.variables["follower/searching/sweep/time"].value, Some(json!(400)));
    let by = &view.variables["follower/searching/sweep/time"].by;
    assert_eq!(&**by, "follower/searching/sweep/returnright");
    assert_eq!(view.machines.len(), before.machines.len());
    assert_eq!(view.states.len(), before.states.len());
    assert_eq!(view.variables.len(), before.variables.len());
    let moving = view.taken.iter().find(|(_, taken)| *taken.to == *"searching").map(|(_, taken)| taken.clone());
    assert_eq!(moving.map(|taken| taken.from), Some("moving".into()));
    let told = ["saved: 2 renamed", "  renamed state follower/looking to searching"];
    assert_eq!(newest(&view, 2), told);
}

#[test]
fn a_renamed_variable_is_not_the_state_of_that_path() {
    let text = "(machine m (var a := [1]) (state a)) (spawn m a)";
    let mut story = Story::new();
    story.load(&program(text), &[]).spawn("m", None).set("m/a", json!(1), "init").enter("m/a");
    let to = "(machine m (var b := [1]) (state a)) (spawn m a)";
    story.at(9).edit(&program(to), vec![renamed(Element::Variable, "m/a", "m/b")], None, &[]);
    let view = story.view();
    assert_eq!(view.variables["m/b"].value, Some(json!(1)));
    assert!(view.is_active("m/a"));
    assert_eq!(
        view.edit.as_ref().map(|edit| matches!(edit, Edit::Taken(it) if it.summary() == "renamed a to b")),
        Some(true)
    );
}

#[test]
fn selection_folding_and_values_stay_on_what_was_renamed() {
    let mut app = screen(80, 24, &Story::searching());
    press(&mut app, "Down Down Down h 3 Down 1");
    assert!(app.is_folded("follower/looking/lookalgo"));
    assert_eq!(app.selected_value().map(|path| &**path), Some("follower/looking/lookalgo/time"));
    let (program, changes) = searching_renamed();
    go_on(&mut app, 90, |story| _ = story.edit(&program, changes, None, &[]));
    assert_eq!(app.selected().map(|path| &**path), Some("follower/searching/sweep"));
    assert!(app.is_folded("follower/searching/sweep"));
    assert_eq!(app.selected_value().map(|path| &**path), Some("follower/searching/sweep/time"));
}

#[test]
fn a_lone_change_is_named_and_many_are_counted() {
    let summary = |changes: Vec<Change>| {
        let mut story = Story::searching();
        story.edit(&program(LINE_FOLLOWER), changes, None, &[]);
        newest(&story.view(), 1).remove(0)
    };
    assert_eq!(summary(vec![change(Op::Changed, Element::State, "follower/looking")]), "saved: ~state looking");
    let transition = "follower: on outofline moving -> looking tlooking";
    assert_eq!(
        summary(vec![change(Op::Removed, Element::Transition, transition)]),
        "saved: -1 transition",
        "too long to be named"
    );
    let many = ["a", "b", "c"].map(|to| renamed(Element::State, "follower/averylongname", &format!("follower/{to}")));
    assert_eq!(summary(many.to_vec()), "saved: 3 renamed");
    assert_eq!(summary(Vec::new()), "saved: no change");
}

/// Two values set by hand, one set by the program since; then an edit of the active state.
fn tuned() -> Story {
    let mut story = Story::searching();
    story.at(82).set("lightlim", json!(140), "command").set("maxlook", json!(250), "command");
    story.set("forward", json!(0.5), "command").set("forward", json!(0.4), "follower/moving");
    story
}

fn restarted(story: &mut Story, changes: Vec<Change>) {
    story.at(90).edit(&program(LINE_FOLLOWER), changes, Some("active state follower/looking changed"), &[]);
    for (name, value) in [("lightlim", 128.0), ("maxlook", 100.0), ("forward", 0.2)] {
        story.set(name, json!(value), "init");
    }
    story.spawn("follower", None).enter("follower/looking");
}

#[test]
fn tuned_values_that_a_restart_cost_are_offered_back() {
    let mut story = tuned();
    restarted(
        &mut story,
        vec![
            change(Op::Changed, Element::State, "follower/looking"),
            change(Op::Added, Element::Event, "follower/tilted"),
        ],
    );
    check_at(&SIZES, "restarted", &story, "");
    let mut app = screen(80, 24, &story);
    let set = |var: &str, value: &str| Effect::Command(Command::Set { var: var.into(), value: value.into() });
    assert_eq!(press(&mut app, "u"), [set("lightlim", "140"), set("maxlook", "250")]);
    go_on(&mut app, 90, |story| {
        story.set("lightlim", json!(140), "command").set("maxlook", json!(250), "command");
    });
    assert_eq!(press(&mut app, "u"), []);
    assert!(!frame(&app).contains("u tuned"));
}

#[test]
fn news_of_many_changes_stand_out_over_the_log() {
    let mut story = tuned();
    let states = ["moving", "looking", "bumpback", "bumpturn", "finished"];
    restarted(&mut story, states.map(|state| change(Op::Changed, Element::State, &format!("follower/{state}"))).into());
    check("many_changes_80x24", &screen(80, 24, &story));
}

#[test]
fn a_new_initial_value_is_not_a_loss() {
    let mut story = tuned();
    restarted(&mut story, vec![change(Op::Changed, Element::Variable, "lightlim")]);
    let view = story.view();
    let lost: Vec<String> = view.lost().map(|(path, value)| format!("{path} {value}")).collect();
    assert_eq!(lost, ["maxlook 250"]);
}

#[test]
fn a_machine_that_starts_again_is_told() {
    let mut story = Story::searching();
    let algo = "follower/looking/lookalgo";
    story.at(85).set(&format!("{algo}/time"), json!(300), "command");
    let changed = vec![change(Op::Removed, Element::State, &format!("{algo}/lookright"))];
    let text = LINE_FOLLOWER.replace("(state lookright", "(state lookaside");
    story.at(90).edit(&program(&text), changed, None, &[algo]).set(&format!("{algo}/time"), json!(100), "init");
    story.enter(&format!("{algo}/lookleft"));
    check_at(&SIZES, "again", &story, "");
    let view = story.view();
    let lost: Vec<String> = view.lost().map(|(path, value)| format!("{path} {value}")).collect();
    assert_eq!(lost, ["follower/looking/lookalgo/time 300"]);
}

#[test]
fn news_fades() {
    let mut story = tuned();
    restarted(&mut story, vec![change(Op::Changed, Element::State, "follower/looking")]);
    let mut app = screen(80, 24, &story);
    let news = |app: &App| frame(app).contains("tuned: lightlim 140, maxlook 250");
    assert!(news(&app));
    let mut other = screen(80, 24, &story);
    press(&mut other, "Down");
    assert!(!news(&other));
    for _ in 0..12 {
        assert!(news(&app));
        go_on(&mut app, 90, |story| _ = story.tell(What::Status { rate: 10.0, late: 0.1 }));
    }
    assert!(!news(&app) && frame(&app).contains("u tuned"));
}

pub fn held(restarts: Option<&str>) -> What {
    let finding = Finding {
        severity: "warning".into(),
        code: "unused-event".into(),
        message: "event `tilted` is never used".into(),
        help: None,
        file: "line_follower.lrp".into(),
        line: 33,
        column: 5,
    };
    What::Held(Held {
        changes: vec![
            change(Op::Changed, Element::State, "follower/looking"),
            change(Op::Changed, Element::Variable, "maxlook"),
            change(Op::Added, Element::Event, "follower/tilted"),
        ],
        restarts: restarts.map(Into::into),
        again: if restarts.is_none() { vec!["follower".into()] } else { Vec::new() },
        discarded: Vec::new(),
        because: vec![because("follower", Element::State, "follower/looking", Op::Changed)],
        findings: vec![finding],
    })
}

fn because(machine: &str, kind: Element, path: &str, op: Op) -> Because {
    Because { machine: machine.into(), kind, path: path.into(), op }
}

/// A change is told with what it does itself, whatever words are in its name.
#[test]
fn a_held_edit_tells_which_change_does_what() {
    let changes = vec![
        change(Op::Added, Element::Variable, "active"),
        change(Op::Added, Element::Variable, "state"),
        change(Op::Changed, Element::Variable, "follower/looking"),
        change(Op::Removed, Element::State, "follower/looking"),
        change(Op::Changed, Element::State, "follower/finished"),
    ];
    let looking = because("follower", Element::State, "follower/looking", Op::Removed);
    let held = Held {
        changes,
        restarts: Some(looking.to_string()),
        again: Vec::new(),
        discarded: Vec::new(),
        because: vec![looking],
        findings: Vec::new(),
    };
    let told = |held: Held| {
        let mut story = Story::searching();
        story.tell(What::Held(held));
        let mut app = screen(80, 24, &story);
        press(&mut app, "E");
        frame(&app)
    };
    let undisturbed = |frame: &str| frame.matches("nothing is disturbed").count();
    let restarts = told(held.clone());
    assert!(
        restarts.contains("removed state follower/looking    restarts: active state looking removed"),
        "{restarts}"
    );
    assert_eq!((restarts.matches("restarts: ").count(), undisturbed(&restarts)), (1, 3), "{restarts}");
    let again = told(Held { restarts: None, again: vec!["follower".into()], ..held.clone() });
    assert!(again.contains("removed state follower/looking    again: follower"), "{again}");
    assert_eq!((again.matches("again: ").count(), undisturbed(&again)), (2, 3), "{again}");
    let ends = told(Held { restarts: None, discarded: vec!["follower".into()], ..held.clone() });
    assert!(ends.contains("removed state follower/looking    ends: follower"), "{ends}");
    let without = told(Held { because: Vec::new(), ..held });
    assert!(without.contains("the program begins again: active state follower/looking removed"), "{without}");
}

#[test]
fn a_held_edit_waits_for_a_person() {
    let mut story = Story::searching();
    story.tell(What::Command { command: Command::Saves { mode: Saves::Hold } });
    story.at(83).tell(held(Some("active state follower/looking changed")));
    check_at(&SIZES, "holding", &story, "");
    check_at(&SIZES, "held", &story, "E");
    let mut app = screen(80, 24, &story);
    assert_eq!(press(&mut app, "E A"), [Effect::Command(Command::ApplyHeld)]);
    assert_eq!(press(&mut app, "X"), [Effect::Command(Command::DropHeld)]);
    assert_eq!(press(&mut app, "E !"), [Effect::Command(Command::Runstop)]);
    assert_eq!(press(&mut app, "M"), [Effect::Command(Command::OnEdit { mode: OnEdit::Keep })]);
    go_on(&mut app, 90, |story| _ = story.tell(held(None)));
    assert!(frame(&app).contains("again: follower"), "the list stays and tells what it would do now");
    go_on(&mut app, 90, |story| _ = story.edit(&program(LINE_FOLLOWER), Vec::new(), None, &[]));
    assert!(!frame(&app).contains("held edit"));
    assert_eq!(press(&mut app, "A"), []);
    assert_eq!(app.message(), Some("no edit is held; S holds the next saves"));
}

#[test]
fn a_held_edit_that_is_told_again_is_no_news() {
    let mut story = Story::searching();
    story.tell(held(None)).reject(&[("this `(` is never closed", "line_follower.lrp", 15)]);
    story.at(84).tell(held(Some("active state follower/looking changed")));
    let view = story.view();
    assert!(matches!(view.edit, Some(Edit::Rejected { .. })));
    assert!(view.held.is_some_and(|held| held.restarts.is_some()));
    assert!(newest(&story.view(), 1)[0].starts_with("not taken over"));
}

#[test]
fn a_dropped_edit_is_forgotten() {
    let mut story = Story::searching();
    story.tell(held(None)).tell(What::Command { command: Command::DropHeld });
    let view = story.view();
    assert_eq!((view.held.is_none(), &view.edit), (true, &Some(Edit::Dropped)));
}

#[test]
fn what_was_chosen_is_seen() {
    let mut story = Story::searching();
    story.tell(What::Command { command: Command::OnEdit { mode: OnEdit::Keep } });
    story.tell(What::Command { command: Command::Saves { mode: Saves::Hold } });
    story.tell(What::Command { command: Command::OnError { mode: OnError::Pause } });
    check_at(&SIZES, "chosen", &story, "");
    let mut app = screen(80, 24, &story);
    let command = |command| vec![Effect::Command(command)];
    assert_eq!(press(&mut app, "M"), command(Command::OnEdit { mode: OnEdit::Restart }));
    assert_eq!(press(&mut app, "S"), command(Command::Saves { mode: Saves::Apply }));
    assert_eq!(press(&mut app, "P"), command(Command::OnError { mode: OnError::Continue }));
}

#[test]
fn another_file_is_named_and_opened() {
    let mut story = Story::searching();
    let fault = |file: &str| {
        What::Error(Fault {
            code: "runtime-error".into(),
            message: "it broke".into(),
            help: None,
            file: file.into(),
            line: 7,
            column: 3,
            state: "follower/moving".into(),
            count: 1,
        })
    };
    let log =
        Log { level: Level::Warn, message: "slow".into(), state: "".into(), file: "lib/turn.lrp".into(), line: 5 };
    story.tell(fault("line_follower.lrp")).tell(fault("lib/turn.lrp")).tell(What::Log(log));
    let mut app = screen(80, 24, &story);
    let seen = frame(&app);
    assert!(seen.contains("✗ moving: it broke") && seen.contains("✗ turn.lrp: moving: it broke"), "{seen}");
    assert!(seen.contains(" turn.lrp:5"), "{seen}");
    let there = Effect::OpenEditor { file: "lib/turn.lrp".into(), line: 7, column: 3 };
    let first = Effect::OpenEditor { file: "line_follower.lrp".into(), line: 7, column: 3 };
    assert_eq!(press(&mut app, "4 o"), [first], "nothing is selected");
    assert_eq!(press(&mut app, "Down Down o"), [there]);
}
