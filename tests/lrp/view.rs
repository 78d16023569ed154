//! The picture on the screen is the engine's, at any time; and whatever comes, the screen is drawn.

use lrp::runtime::command::{BreakAt, Command, OnEdit};
use lrp::runtime::engine::{Engine, Options};
use lrp::runtime::record::*;
use lrp::runtime::time::Time;
use lrp::ui::app::{App, Event, Options as Screen};
use lrp::ui::theme::Theme;
use lrp::ui::view::{Choices, Edit, Mode, View};
use proptest::prelude::*;
use ratatui::buffer::Buffer;
use ratatui::layout::{Rect, Size};
use serde_json::{Value, json};

use crate::frames::press;
use crate::story::{LINE_FOLLOWER, Story, program};

#[test]
fn a_view_is_a_fold_of_records() {
    let view = view_of(&Story::searching());
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
    let view = view_of(&story);
    assert!(!view.is_running("follower/looking/lookalgo"));
    assert_eq!(view.variables["follower/looking/lookalgo/time"].value, None);
    assert_eq!(view.variables["follower/nobump"].value, Some(json!(true)));
}

#[test]
fn a_restart_begins_anew() {
    let mut story = Story::searching();
    story.at(90).tell(What::Restart { reason: "asked for".into() });
    let view = view_of(&story);
    assert!(view.states.is_empty() && !view.is_running("follower"));
    assert!(view.variables.values().all(|variable| variable.value.is_none()));
}

#[test]
fn faults_are_counted_and_go_with_the_next_program() {
    let mut story = Story::searching();
    story.at(90).fault("it broke", "follower/moving", 9, 1);
    story.at(100).fault("it broke", "follower/moving", 9, 11);
    let view = view_of(&story);
    let counts: Vec<u64> = view.problems.iter().map(|problem| problem.count).collect();
    assert_eq!(counts, [11]);
    story.at(110).load(&program(LINE_FOLLOWER), &[]);
    assert!(view_of(&story).problems.is_empty());
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
    let view = view_of(&story);
    let newest = view.journal.newest_first().next().map(|entry| entry.text.clone());
    assert_eq!(newest.as_deref(), Some("saved: +2 states, -1 event, ~1 action"));
}

#[test]
fn runstop_shows_until_a_person_resumes() {
    let mut story = Story::searching();
    story.tell(What::Command { command: Command::Runstop }).tell(What::Pause { reason: "runstop".into(), at: None });
    assert_eq!(view_of(&story).mode, Mode::Stopped);
    story.tell(What::Resume);
    assert_eq!(view_of(&story).mode, Mode::Running);
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
    let view = view_of(&story);
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
    assert_eq!(newest(&view_of(&story), 2), ["follower sent to looking", "lookalgo spawned in lookright"]);
}

#[test]
fn nudging_again_and_again_is_one_line() {
    let mut story = Story::searching();
    for (step, value) in [(90, 138), (91, 148), (92, 158)] {
        story.at(step).set("lightlim", json!(value), "command").log(Level::Info, "between", "", 0);
    }
    story.at(200).set("lightlim", json!(100), "command");
    let lines = ["lightlim 128 → 158 (×3)", "between", "between", "between", "lightlim 158 → 100"];
    assert_eq!(newest(&view_of(&story), 5), lines);
}

fn view_of(story: &Story) -> View {
    let mut view = View::new(10.0);
    story.records.iter().for_each(|record| view.apply(record));
    view
}

const NESTED: &str = "
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

fn check_picture(engine: &Engine, view: &View) {
    let mut active: Vec<String> = engine.active();
    active.sort();
    let machines = view.machines.values().filter(|machine| machine.running);
    let mut shown: Vec<String> =
        machines.filter_map(|machine| machine.active.as_ref().map(ToString::to_string)).collect();
    shown.sort();
    assert_eq!(shown, active);
    let shown = view.variables.iter().filter_map(|(path, variable)| Some((path.to_string(), variable.value.clone()?)));
    let mut values = engine.values();
    values.sort_by(|a, b| a.0.cmp(&b.0));
    assert_eq!(shown.collect::<Vec<_>>(), values);
    for state in &engine.program().states {
        let shown = view.states.get(&state.path).map_or(0, |state| state.visits);
        assert_eq!(Some(shown), engine.visits(&state.path), "visits of {}", state.path);
    }
    for machine in view.machines.iter().filter(|(_, machine)| machine.running) {
        assert_eq!(Some(machine.1.entered), engine.entered(machine.0), "{}", machine.0);
    }
    assert_eq!(view.mode != Mode::Running, engine.is_paused());
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
            check_picture(&engine, &view);
        }
    }

    #[test]
    fn any_records_and_keys_are_drawn_at_any_size(
        whats in prop::collection::vec(whats(), 0..40),
        keys in prop::collection::vec(keys(), 0..40),
        sizes in prop::collection::vec((1u16..130, 1u16..50), 1..6),
    ) {
        let size = Size::new(sizes[0].0, sizes[0].1);
        let options = Screen { file: "a.lrp".into(), rate: 10.0, choices: Choices::default(), theme: Theme::Colours, size };
        let mut app = App::new(options);
        for record in Story::searching().records.iter().take(whats.len() * 8) {
            app.record(record);
        }
        let mut whats = whats.into_iter();
        let mut sizes = sizes.into_iter().cycle();
        for (step, key) in keys.into_iter().enumerate() {
            press(&mut app, key);
            for what in whats.by_ref().take(2) {
                app.record(&Record { step: step as u64, t: Time(step as u64 * 100_000), what });
            }
            if step % 5 == 4 {
                let (width, height) = sizes.next().unwrap_or((1, 1));
                app.event(Event::Resize(Size::new(width, height)));
            }
            draw(&app, app.options().size);
        }
        draw(&app, Size::new(1, 1));
    }
}

#[test]
fn every_size_is_drawn() {
    let app = crate::frames::screen(80, 24, &Story::searching());
    for width in 1..130 {
        for height in [1, 2, 3, 4, 5, 6, 7, 8, 10, 12, 13, 17, 18, 24, 30, 60] {
            draw(&app, Size::new(width, height));
        }
    }
}

fn draw(app: &App, size: Size) {
    let area = Rect::new(0, 0, size.width, size.height);
    app.paint(area, &mut Buffer::empty(area));
}

fn keys() -> impl Strategy<Value = &'static str> {
    let table = lrp::ui::action::TABLE.iter().flat_map(|entry| entry.keys.iter().copied());
    prop::sample::select(table.chain(["x", "7", "(", "Delete", "F5"]).collect::<Vec<_>>())
}

fn paths() -> impl Strategy<Value = std::sync::Arc<str>> {
    let paths = [
        "",
        "/",
        "follower",
        "follower/moving",
        "follower/looking/lookalgo",
        "follower/looking/lookalgo/lookleft",
        "a/b/c/d/e",
        "ü/漢字",
    ];
    prop::sample::select(paths.to_vec()).prop_map(Into::into)
}

fn values() -> impl Strategy<Value = Value> {
    let leaf = prop_oneof![
        Just(Value::Null),
        any::<bool>().prop_map(Value::from),
        any::<i64>().prop_map(Value::from),
        any::<f64>().prop_map(|n| json!(n)),
        "\\PC{0,12}".prop_map(Value::from),
        Just(json!({ "lua": "function" })),
        Just(json!({ "x": 1e300, "y": -1e300, "theta": 1e9 })),
    ];
    leaf.prop_recursive(3, 12, 4, |inner| {
        prop_oneof![
            prop::collection::vec(inner.clone(), 0..4).prop_map(Value::from),
            prop::collection::vec(("[a-z ]{1,4}", inner), 0..4).prop_map(|fields| fields.into_iter().collect()),
        ]
    })
}

fn whats() -> impl Strategy<Value = What> {
    let bridge = || Just(std::sync::Arc::<str>::from("robot"));
    let programs = prop::sample::select(vec![LINE_FOLLOWER, NESTED]);
    prop_oneof![
        paths().prop_map(|state| What::Enter { state }),
        paths().prop_map(|state| What::Exit { state }),
        (paths(), prop::option::of(paths())).prop_map(|(machine, by)| What::Spawn { machine, by }),
        paths().prop_map(|machine| What::Discard { machine }),
        (paths(), values(), paths()).prop_map(|(var, value, by)| What::Set { var, value, by }),
        (bridge(), prop::sample::select(vec!["pose", "light"]), values())
            .prop_map(|(bridge, name, value)| What::Input { bridge, name: name.into(), value }),
        (bridge(), paths(), values()).prop_map(|(bridge, name, value)| What::Output { bridge, name, value }),
        ("\\PC{0,20}", prop::option::of(paths())).prop_map(|(reason, at)| What::Pause { reason, at }),
        (paths(), paths(), any::<bool>()).prop_map(|(path, to, restarted)| {
            let kinds = [Element::State, Element::Machine, Element::Variable];
            let change = |kind| Change { op: Op::Renamed, kind, path: path.clone(), to: Some(to.clone()) };
            What::Load(Load {
                changes: kinds.map(change).to_vec(),
                restarted,
                reason: None,
                again: vec![path.clone()],
                discarded: vec![to.clone()],
                because: Vec::new(),
                findings: Vec::new(),
                files: Vec::new(),
                program: None,
            })
        }),
        (paths(), paths()).prop_map(|(path, to)| {
            let change = Change { op: Op::Renamed, kind: Element::State, path: path.clone(), to: Some(to) };
            What::Held(Held {
                changes: vec![change],
                restarts: Some(format!("active state {path} changed")),
                again: vec![path],
                discarded: Vec::new(),
                because: Vec::new(),
                findings: Vec::new(),
            })
        }),
        (paths(), "\\PC{0,20}").prop_map(|(state, text)| {
            let state_break = BreakAt::State { state: state.clone() };
            let condition = BreakAt::Condition { condition: text.into(), machine: state };
            let all = [(state_break, Setter::Source), (condition, Setter::Command)];
            What::Breakpoints { all: all.map(|(at, by)| Breakpoint { at, by }).to_vec() }
        }),
        Just(What::Resume),
        "\\PC{0,20}".prop_map(|reason| What::Restart { reason }),
        (any::<f64>(), any::<f64>()).prop_map(|(rate, late)| What::Status { rate, late }),
        any::<f64>().prop_map(|hz| What::Command { command: Command::Rate { hz } }),
        Just(What::Command { command: Command::Runstop }),
        ("\\PC{0,30}", paths(), 0usize..60, 0usize..90, any::<u64>()).prop_map(
            |(message, state, line, column, count)| {
                What::Error(Fault {
                    code: "runtime-error".into(),
                    message,
                    help: None,
                    file: "line_follower.lrp".into(),
                    line,
                    column,
                    state,
                    count,
                })
            }
        ),
        ("\\PC{0,30}", paths(), 0usize..60).prop_map(|(message, state, line)| {
            What::Log(Log { level: Level::Warn, message, state, file: "line_follower.lrp".into(), line })
        }),
        (paths(), paths(), paths(), prop::option::of(paths()), any::<u32>()).prop_map(
            |(machine, from, to, via, index)| {
                What::Transition(Taken { machine, from, to, name: None, trigger: "eps".into(), via, index })
            }
        ),
        programs.prop_map(|text| {
            let mut story = Story::new();
            story.load(&program(text), &[]);
            story.records.remove(0).what
        }),
    ]
}
