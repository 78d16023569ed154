//! Whatever comes, records, keys and sizes, the screen is drawn.

use lrp::runtime::command::{BreakAt, Command};
use lrp::runtime::record::*;
use lrp::runtime::time::Time;
use lrp::ui::app::{App, Event, Options as Screen};
use lrp::ui::glyphs::Charset;
use lrp::ui::pointer::{Gesture, Pointer};
use lrp::ui::settings::Settings;
use lrp::ui::view::Choices;
use proptest::prelude::*;
use ratatui::buffer::Buffer;
use ratatui::layout::{Position, Rect, Size};
use serde_json::{Value, json};

use crate::frames::press;
use crate::story::{LINE_FOLLOWER, Story, program};
use crate::view::NESTED;

proptest! {
    #![proptest_config(ProptestConfig::with_cases(96))]

    #[test]
    fn any_records_and_keys_are_drawn_at_any_size(
        whats in prop::collection::vec(whats(), 0..40),
        keys in prop::collection::vec(keys(), 0..40),
        sizes in prop::collection::vec((1u16..130, 1u16..50), 1..6),
        pointers in prop::collection::vec(pointers(), 40),
        charset in prop::sample::select(vec![Charset::Unicode, Charset::Ascii]),
    ) {
        let size = Size::new(sizes[0].0, sizes[0].1);
        let settings = Settings { charset, ..Settings::default() };
        let mut app = App::new(Screen { file: "a.lrp".into(), rate: 10.0, choices: Choices::default(), settings, size });
        for record in Story::searching().records.iter().take(whats.len() * 8) {
            app.record(record);
        }
        let mut whats = whats.into_iter();
        let mut sizes = sizes.into_iter().cycle();
        for (step, key) in keys.into_iter().enumerate() {
            press(&mut app, key);
            app.event(Event::Pointer(pointers[step]));
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
    let mut buffer = Buffer::empty(area);
    app.paint(area, &mut buffer);
    if app.options().settings.charset == Charset::Ascii {
        let other = buffer.content.iter().find(|cell| !cell.symbol().is_ascii());
        assert_eq!(other.map(ratatui::buffer::Cell::symbol), None);
    }
}

fn pointers() -> impl Strategy<Value = Pointer> {
    use Gesture::*;
    let gestures = vec![Click, DoubleClick, RightClick, Drag, Release, WheelUp, WheelDown];
    let at = (0u16..140, 0u16..60).prop_map(|(x, y)| Position::new(x, y));
    (prop::sample::select(gestures), at).prop_map(|(gesture, at)| Pointer { at, gesture })
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
