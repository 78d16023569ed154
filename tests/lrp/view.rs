//! The picture on the screen is a fold of the records, and the engine's at any time.

use lrp::runtime::command::{Command, OnEdit};
use lrp::runtime::engine::{Engine, Options};
use lrp::runtime::record::*;
use lrp::runtime::time::Time;
use lrp::ui::view::{Edit, Mode, View};
use proptest::prelude::*;
use serde_json::json;

use crate::picture::agrees;
use crate::story::{LINE_FOLLOWER, Story, program};

#[test]
fn a_view_is_a_fold_of_records() {
    let view = Story::searching().view();
    assert_eq!(view.active("follower").map(|path| &**path), Some("follower/looking"));
    assert_eq!(
        view.active("follower/looking/lookalgo").map(|path| &**path),
        Some("follower/looking/lookalgo/lookright")
    );
    assert_eq!(view.machines["follower/looking/lookalgo"].spawned_by.as_deref(), Some("follower/looking"));
    assert_eq!(view.states["follower/looking/lookalgo/lookleft"].visits, 4);
    assert_eq!(view.variables["follower/looking/lookalgo/time"].value, Some(json!(400)));
    assert_eq!(
        view.variables["follower/looking/lookalgo/time"].history.sampled(view.t, 6),
        [100.0, 200.0, 200.0, 400.0, 400.0, 400.0]
    );
    assert_eq!(view.bridges["robot"].inputs["light"].value, json!({ "data": 142 }));
    assert_eq!(view.world.as_ref().and_then(|world| world.pose).map(|pose| pose.x), Some(3.5));
}

#[test]
fn a_discarded_machine_takes_its_variables_along() {
    let mut story = Story::searching();
    story.at(90).take("follower", "follower/looking", "follower/moving", None, "intheline", 1);
    let view = story.view();
    assert!(!view.is_running("follower/looking/lookalgo"));
    assert_eq!(view.variables["follower/looking/lookalgo/time"].value, None);
    assert_eq!(view.variables["follower/nobump"].value, Some(json!(true)));
}

#[test]
fn a_restart_begins_anew() {
    let mut story = Story::searching();
    story.at(90).tell(What::Restart { reason: "asked for".into() });
    let view = story.view();
    assert!(view.states.is_empty() && !view.is_running("follower"));
    assert!(view.variables.values().all(|variable| variable.value.is_none()));
}

#[test]
fn faults_are_counted_and_go_with_the_next_program() {
    let mut story = Story::searching();
    story.at(90).fault("it broke", "follower/moving", 9, 1);
    story.at(100).fault("it broke", "follower/moving", 9, 11);
    let view = story.view();
    let counts: Vec<u64> = view.problems.iter().map(|problem| problem.count).collect();
    assert_eq!(counts, [11]);
    story.at(110).load(&program(LINE_FOLLOWER), &[]);
    assert!(story.view().problems.is_empty());
}

#[test]
fn an_edit_is_summed_up() {
    let changes = [
        (Op::Changed, Element::Action, "follower/moving"),
        (Op::Added, Element::State, "follower/a"),
        (Op::Added, Element::State, "follower/b"),
        (Op::Removed, Element::Event, "follower/e"),
    ];
    let mut story = Story::searching();
    story.at(90).load(&program(LINE_FOLLOWER), &changes);
    let view = story.view();
    let newest = view.journal.newest_first().next().map(|entry| entry.text.clone());
    assert_eq!(newest.as_deref(), Some("saved: +2 states, -1 event, ~1 action"));
}

#[test]
fn runstop_shows_until_a_person_resumes() {
    let mut story = Story::searching();
    story.tell(What::Command { command: Command::Runstop }).tell(What::Pause { reason: "runstop".into(), at: None });
    assert_eq!(story.view().mode, Mode::Stopped);
    story.tell(What::Resume);
    assert_eq!(story.view().mode, Mode::Running);
}

/// The newest lines of the log, oldest first.
fn newest(view: &View, count: usize) -> Vec<String> {
    let mut lines: Vec<String> = view.journal.newest_first().take(count).map(|entry| entry.text.clone()).collect();
    lines.reverse();
    lines
}

#[test]
fn what_a_person_does_is_in_the_log() {
    let mut story = Story::searching();
    story.at(90).tell(What::Pause { reason: "asked for".into(), at: None }).tell(What::Resume);
    story.tell(What::Command { command: Command::PutAtStart { bridge: "robot".into() } });
    story.tell(What::Pause { reason: "runstop".into(), at: None }).tell(What::Stop { reason: "runstop".into() });
    story.tell(What::Restart { reason: "asked for".into() }).tell(What::Stop { reason: "restart".into() });
    let view = story.view();
    let lines = ["paused", "goes on", "robot put at its start", "robot stopped: runstop", "restarted"];
    assert_eq!(newest(&view, 5), lines);
    assert_eq!(view.edit, Some(Edit::Restarted));
}

#[test]
fn a_forced_state_tells_of_the_machines_on_the_way() {
    let mut story = Story::searching();
    story.at(90).take("follower", "follower/looking", "follower/moving", None, "intheline", 1);
    let state = "follower/looking/lookalgo/lookright".into();
    story.tell(What::Force { state, how: Forced::Transition });
    assert_eq!(newest(&story.view(), 2), ["follower sent to looking", "lookalgo spawned in lookright"]);
}

#[test]
fn nudging_again_and_again_is_one_line() {
    let mut story = Story::searching();
    for (step, value) in [(90, 138), (91, 148), (92, 158)] {
        story.at(step).set("lightlim", json!(value), "command").log(Level::Info, &format!("between {step}"), "", 0);
    }
    story.at(200).set("lightlim", json!(100), "command");
    let lines = ["lightlim 128 → 158 (×3)", "between 90", "between 91", "between 92", "lightlim 158 → 100"];
    assert_eq!(newest(&story.view(), 5), lines);
}

pub const NESTED: &str = "
(var limit := [3]) (var seen := [0])
(machine outer
  (var count := [limit])
  (event often [count > 2])
  (on often a -> b)
  (ontime 300 b -> a)
  (state a (running [count = count + 1]) (onentry [count = 0]))
  (state b
    (machine inner
      (var twice := [count * 2])
      (state c (onexit [seen = seen + 1]))
      (state d (onentry [twice = twice + 1]))
      (eps c -> d)
      (ontime 200 d -> c)
      (exit [twice > 12] d -> a))
    (onentry (spawn inner c))))
(machine other (state x) (state y) (eps x -> y) (ontime [limit * 100] y -> x))
(spawn outer a)
(spawn other x)";

/// What the engine is made to do, and the changes of the text it is given.
#[derive(Clone, Debug)]
enum Deed {
    Steps(u8),
    Load(usize),
    Command(Command),
}

fn deeds() -> impl Strategy<Value = Deed> {
    let states =
        prop::sample::select(vec!["outer/a", "outer/b", "outer/b/inner/c", "outer/b/inner/d", "other/x", "other/y"]);
    let vars = prop::sample::select(vec!["limit", "seen", "outer/count", "outer/b/inner/twice"]);
    let jump = states.clone().prop_map(|state| Command::JumpTo { state: state.into() });
    let transition = states.prop_map(|state| Command::TransitionTo { state: state.into() });
    let reset = vars.clone().prop_map(|var| Command::Reset { var: var.into() });
    let set = (vars, -3i32..20).prop_map(|(var, value)| Command::Set { var: var.into(), value: value.to_string() });
    let mut plain = vec![Command::Pause, Command::Resume, Command::Restart, Command::Runstop];
    plain.extend([OnEdit::Keep, OnEdit::Restart].map(|mode| Command::OnEdit { mode }));
    let plain = prop::sample::select(plain);
    prop_oneof![
        4 => (1u8..8).prop_map(Deed::Steps),
        1 => (0..7usize).prop_map(Deed::Load),
        2 => prop_oneof![jump, transition, set, reset, plain].prop_map(Deed::Command),
    ]
}

fn variant(which: usize) -> String {
    match which {
        0 => NESTED.into(),
        1 => NESTED.replace("(state x)", "(state x) (state extra)"),
        2 => NESTED.replace("[limit]", "[limit + 1]"),
        5 => NESTED.replace("inner", "deep").replace("count", "tally"),
        6 => NESTED
            .replace("(state x)", "(state z)")
            .replace("eps x", "eps z")
            .replace("y -> x", "y -> z")
            .replace("other x", "other z"),
        3 => NESTED.replace("(machine other", "(var more := [1]) (machine other").replace("(spawn other x)", ""),
        _ => NESTED.replace("(running [count = count + 1])", "(running [count = count + 2])"),
    }
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(96))]

    #[test]
    fn the_picture_is_the_engines(deeds in prop::collection::vec(deeds(), 1..30)) {
        let options = Options::default();
        let (mut engine, mut view, mut now) = (Engine::new(options), View::new(10.0), 0);
        for deed in [Deed::Load(0)].into_iter().chain(deeds) {
            match deed {
                Deed::Load(which) => {
                    let _ = engine.command(Command::Load(program(&variant(which)).into()));
                }
                Deed::Command(command) => {
                    let _ = engine.command(command);
                }
                Deed::Steps(count) if !engine.is_paused() => {
                    for _ in 0..count {
                        now += 100;
                        engine.step(Time::from_ms(f64::from(now)), &[]);
                        engine.drain(|record| view.apply(&record));
                    }
                }
                Deed::Steps(_) => (),
            }
            engine.drain(|record| view.apply(&record));
            agrees(&view, &engine).map_err(TestCaseError::fail)?;
        }
    }
}
