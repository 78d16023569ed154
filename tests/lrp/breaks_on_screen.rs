//! Breakpoints and pauses on the screen, from stories of records.

use lrp::runtime::command::{BreakAt, Breaking, Command};
use lrp::runtime::record::{Breakpoint, Level, Log, Setter, What};
use lrp::ui::app::Effect;

use crate::frames::{SIZES, check, check_at, go_on, press, screen};
use crate::story::Story;

const OUT_OF_LINE: &str = "follower: on outofline moving -> looking tlooking";

fn breakpoints() -> What {
    let state = |state: &str| BreakAt::State { state: state.into() };
    let condition = BreakAt::Condition { condition: "time > 800".into(), machine: "follower/looking/lookalgo".into() };
    let all = [
        (state("follower/looking"), Setter::Command),
        (state("follower/bumpback"), Setter::Source),
        (BreakAt::Transition { transition: OUT_OF_LINE.into() }, Setter::Command),
        (condition, Setter::Command),
    ];
    What::Breakpoints { all: all.map(|(at, by)| Breakpoint { at, by }).to_vec() }
}

#[test]
fn breakpoints_are_marked() {
    let mut story = Story::searching();
    story.tell(breakpoints());
    check_at(&SIZES, "breakpoints", &story, "Down");
    check_at(&SIZES, "breakpoint_list", &story, "D Down Down");
    let mut app = screen(80, 24, &story);
    press(&mut app, "Down i");
    check("breakpoint_detail_80x24", &app);
}

#[test]
fn breakpoints_are_set_where_a_person_is() {
    let mut story = Story::searching();
    story.tell(breakpoints());
    let toggle = |keys: &str, at: BreakAt, mode: Breaking| {
        let mut app = screen(80, 24, &story);
        assert_eq!(press(&mut app, keys), [Effect::Command(Command::Break { at, mode })], "{keys}");
    };
    let state = |state: &str| BreakAt::State { state: state.into() };
    toggle("Down B", state("follower/moving"), Breaking::Set);
    toggle("Down Down B", state("follower/looking"), Breaking::Clear);
    let transition = |text: &str| BreakAt::Transition { transition: text.into() };
    toggle("Down i Tab Down Down Down B", transition(OUT_OF_LINE), Breaking::Clear);
    let sweep = "follower/looking/lookalgo: ontime time returnleft -> lookright tlookright";
    toggle("4 Down Down B", transition(sweep), Breaking::Set);
    let condition = BreakAt::Condition { condition: "nobump".into(), machine: "follower".into() };
    toggle("C n o b u m p Enter", condition, Breaking::Set);
    toggle("D B", state("follower/looking"), Breaking::Clear);
    let mut app = screen(80, 24, &story);
    assert_eq!(press(&mut app, "B"), []);
    assert_eq!(app.message(), Some("follower is a machine; select a state, or type a condition (C)"));
    assert_eq!(press(&mut app, "D Down B").len(), 1);
    assert_eq!(app.message(), Some("its (break) stays in the text: no pause at state follower/bumpback"));
    assert_eq!(press(&mut app, "X").len(), 4, "all of them");
    assert_eq!(press(&mut app, "Esc C Esc"), []);
    check("condition_80x24", &{
        let mut app = screen(80, 24, &story);
        press(&mut app, "C t i m e");
        app
    });
}

#[test]
fn a_mistake_in_what_was_typed_stands_above_it_whole() {
    for (cols, rows) in [(80, 24), (40, 24)] {
        let mut app = screen(cols, rows, &Story::searching());
        press(&mut app, "C t i e m Enter");
        go_on(&mut app, 90, |story| {
            let message = "`tiem`: `tiem` is not a variable in scope here; did you mean `time`?".into();
            story.tell(What::Log(Log { level: Level::Error, message, state: "".into(), file: "".into(), line: 0 }));
        });
        check(&format!("refused_{cols}x{rows}"), &app);
    }
}

#[test]
fn a_breakpoint_that_is_met_is_looked_at() {
    let mut story = Story::searching();
    story.tell(breakpoints());
    let reason = "breakpoint: entered follower/looking".to_string();
    story.at(90).tell(What::Pause { reason, at: Some("follower/looking".into()) });
    check_at(&SIZES, "paused", &story, "");
    let mut app = screen(80, 24, &Story::searching());
    press(&mut app, "h");
    go_on(&mut app, 90, |story| {
        let at = "follower/looking/lookalgo/lookleft".into();
        story.tell(What::Pause { reason: "breakpoint: time > 100".into(), at: Some(at) });
    });
    assert_eq!(app.selected().map(|path| &**path), Some("follower/looking/lookalgo/lookleft"));
    assert!(!app.is_folded("follower"));
}

#[test]
fn an_error_that_pauses_is_looked_at() {
    let mut story = Story::searching();
    let at = "follower/looking/lookalgo/lookright";
    story.at(81).fault("attempt to index a nil value (field 'range')", at, 19, 1);
    story.tell(What::Pause { reason: format!("error in {at}: attempt to index a nil value"), at: Some(at.into()) });
    check_at(&SIZES, "error_paused", &story, "");
    let mut app = screen(80, 24, &story);
    let there = Effect::OpenEditor { file: "line_follower.lrp".into(), line: 19, column: 27 };
    assert_eq!(press(&mut app, "o"), [there]);
    assert_eq!(app.selected().map(|path| &**path), Some(at));
    press(&mut app, "Up");
    assert_ne!(press(&mut app, "o"), [Effect::OpenEditor { file: "line_follower.lrp".into(), line: 19, column: 27 }]);
}
