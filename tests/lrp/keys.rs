//! Keys as text, and what comes of them.

use std::fs;
use std::path::PathBuf;

use lrp::runtime::command::Command;
use lrp::runtime::record::{Element, Level, Log, Op, What};
use lrp::ui::action;
use lrp::ui::app::{App, Effect};
use lrp::ui::key::Key;
use lrp::ui::keymap::Keymap;
use lrp::ui::layout::Pane;
use serde_json::json;

use crate::frames::{frame, press, screen};
use crate::story::{LINE_FOLLOWER, Story, program};

fn searching() -> App {
    screen(80, 24, &Story::searching())
}

fn command(command: Command) -> Vec<Effect> {
    vec![Effect::Command(command)]
}

fn set(var: &str, value: &str) -> Vec<Effect> {
    command(Command::Set { var: var.into(), value: value.into() })
}

#[test]
fn keys_run_the_program() {
    let mut app = searching();
    assert_eq!(press(&mut app, "Space"), command(Command::Pause));
    assert_eq!(press(&mut app, "s"), command(Command::Pause), "a step needs a pause first");
    assert_eq!(press(&mut app, "+"), command(Command::Rate { hz: 20.0 }));
    assert_eq!(press(&mut app, "-"), command(Command::Rate { hz: 5.0 }));
    assert_eq!(press(&mut app, "Ctrl-R"), command(Command::Restart));
    assert_eq!(press(&mut app, "b"), command(Command::PutAtStart { bridge: "robot".into() }));
    let mut story = Story::searching();
    story.tell(What::Pause { reason: "asked for".into(), at: None });
    let mut app = screen(80, 24, &story);
    assert_eq!(press(&mut app, "Space"), command(Command::Resume));
    assert_eq!(press(&mut app, "s"), command(Command::Step));
}

#[test]
fn rates_end_at_as_fast_as_possible() {
    let mut story = Story::new();
    story.tell(What::Command { command: Command::Rate { hz: 1000.0 } });
    let mut app = screen(80, 24, &story);
    assert_eq!(press(&mut app, "+"), command(Command::Rate { hz: 0.0 }));
    story.tell(What::Command { command: Command::Rate { hz: 0.0 } });
    let mut app = screen(80, 24, &story);
    assert_eq!(press(&mut app, "-"), command(Command::Rate { hz: 1000.0 }));
}

#[test]
fn the_selected_state_is_gone_to() {
    let mut app = searching();
    let state = String::from("follower/moving");
    assert_eq!(press(&mut app, "Down t"), command(Command::TransitionTo { state: state.clone() }));
    assert_eq!(press(&mut app, "J"), command(Command::JumpTo { state }));
    assert_eq!(press(&mut app, "Up t"), Vec::new());
    assert_eq!(app.message(), Some("follower is a machine; select one of its states"));
    let inner = String::from("follower/looking/lookalgo/lookright");
    assert_eq!(press(&mut app, "Down Down Enter Enter t"), command(Command::TransitionTo { state: inner }));
    assert_eq!(press(&mut app, "Backspace Backspace J"), command(Command::JumpTo { state: "follower/looking".into() }));
}

#[test]
fn the_graph_and_the_tree_share_their_selection() {
    let mut app = searching();
    assert_eq!(
        press(&mut app, "2 Down Down Down t"),
        command(Command::TransitionTo { state: "follower/bumpback".into() })
    );
    assert_eq!(press(&mut app, "1 J"), command(Command::JumpTo { state: "follower/bumpback".into() }));
}

#[test]
fn numbers_are_nudged_in_round_steps() {
    let mut app = searching();
    let follower = "3 Down Down";
    assert_eq!(press(&mut app, &format!("{follower} Right")), set("lightlim", "138"));
    assert_eq!(press(&mut app, "Right"), set("lightlim", "148"), "before the first has come back");
    assert_eq!(press(&mut app, "Shift-Left"), set("lightlim", "48"));
    assert_eq!(press(&mut app, "Down l"), set("maxlook", "110"));
    assert_eq!(press(&mut app, "Down >"), set("forward", "0.22"));
    assert_eq!(press(&mut app, "Down Down <"), set("back", "-0.22"));
    assert_eq!(press(&mut app, "Home Left"), set("follower/nobump", "false"));
    assert_eq!(press(&mut app, "End Left"), Vec::new());
    assert_eq!(app.message(), Some("robot:move comes from the robot and can't be set here"));
}

#[test]
fn a_nudge_starts_from_what_the_engine_says() {
    let mut app = searching();
    assert_eq!(press(&mut app, "3 Down Down Right"), set("lightlim", "138"));
    let mut story = Story::searching();
    let from = story.records.len();
    story.at(90).set("lightlim", json!(50), "command");
    story.records[from..].iter().for_each(|record| app.record(record));
    assert_eq!(press(&mut app, "Right"), set("lightlim", "55"));
}

#[test]
fn a_value_is_typed_as_lua() {
    let mut app = searching();
    assert_eq!(press(&mut app, "3 Down Down e Backspace Backspace 4 0 Enter"), set("lightlim", "140"));
    assert_eq!(press(&mut app, "e Ctrl-U { } Enter"), set("lightlim", "{}"));
    assert_eq!(press(&mut app, "e Esc q"), vec![Effect::Quit]);
    assert_eq!(press(&mut app, "e q"), Vec::new(), "typed, not done");
    assert_eq!(press(&mut app, "! Ctrl-X"), command(Command::Runstop));
    assert_eq!(press(&mut app, "Ctrl-U Enter"), Vec::new());
    assert!(app.message().is_some_and(|message| message.contains("Lua expression")));
}

#[test]
fn a_value_that_can_not_be_set_is_typed_in_vain() {
    let mut story = Story::searching();
    story.at(90).tell(What::Discard { machine: "follower".into() });
    let mut app = screen(80, 24, &story);
    assert_eq!(press(&mut app, "3 Down e q !"), Vec::new(), "letters are no commands");
    assert_eq!(press(&mut app, "Enter"), Vec::new());
    assert_eq!(app.message(), Some("follower/nobump has no value: its machine isn't running"));
    assert_eq!(press(&mut app, "Esc q"), vec![Effect::Quit]);
}

#[test]
fn a_refused_value_can_be_mended() {
    let mut app = searching();
    assert_eq!(press(&mut app, "3 Down Down e 1 + Enter"), set("lightlim", "1+"));
    let mut story = Story::new();
    story.at(83).tell(What::Log(Log {
        level: Level::Error,
        message: "`1+`: unexpected end".into(),
        state: "".into(),
        file: "".into(),
        line: 0,
    }));
    story.records.iter().for_each(|record| app.record(record));
    assert!(frame(&app).contains("lightlim = 1+") && frame(&app).contains("unexpected end"));
    assert_eq!(press(&mut app, "2 Enter"), set("lightlim", "1+2"));
}

#[test]
fn numbers_at_their_limits_stay() {
    for (value, said) in
        [(json!(i64::MAX), "is 9223372036854775807"), (json!("inf"), "is math.huge"), (json!("nan"), "0/0")]
    {
        let mut story = Story::searching();
        story.set("lightlim", value, "init");
        let mut app = screen(80, 24, &story);
        assert_eq!(press(&mut app, "3 Down Down Right"), Vec::new());
        assert!(app.message().is_some_and(|message| message.contains(said)), "{:?}", app.message());
    }
}

#[test]
fn the_log_says_what_the_filter_hides() {
    let mut story = Story::new();
    story.at(1).tell(What::Resume);
    let mut app = screen(80, 24, &story);
    press(&mut app, "4 v v v");
    assert!(frame(&app).contains("No warnings or errors (v shows all)."));
}

#[test]
fn the_robot_is_stopped_from_anywhere() {
    for keys in ["", "?", "2", "3", "4", "5", "i", "z", "3 Down Down", "w"] {
        let mut app = searching();
        press(&mut app, keys);
        assert_eq!(press(&mut app, "!"), command(Command::Runstop), "after {keys}");
        assert_eq!(press(&mut app, "Ctrl-X"), command(Command::Runstop), "after {keys}");
    }
}

#[test]
fn the_editor_opens_where_the_selection_is_written() {
    let mut app = searching();
    let at = |line, column| vec![Effect::OpenEditor { file: "line_follower.lrp".into(), line, column }];
    assert_eq!(press(&mut app, "o"), at(7, 10));
    assert_eq!(press(&mut app, "Down Down o"), at(14, 10));
    assert_eq!(press(&mut app, "3 Down Down o"), at(2, 6));
    assert_eq!(press(&mut app, "4 Down Enter"), at(24, 1));
    assert_eq!(press(&mut app, "Down o"), at(24, 1), "the transition's own line");
}

#[test]
fn nothing_selected_is_said_in_a_sentence() {
    let mut app = screen(80, 24, &Story::new());
    assert_eq!(press(&mut app, "t"), Vec::new());
    assert_eq!(app.message(), Some("no state is selected"));
    assert_eq!(press(&mut app, "3 e"), Vec::new());
    assert!(app.message().is_some_and(|message| message.starts_with("no variable is selected")));
    press(&mut app, "Down");
    assert_eq!(app.message(), None, "it fades at the next key");
}

#[test]
fn the_selection_survives_edits() {
    let mut app = searching();
    press(&mut app, "Down Down Down Down Down");
    assert_eq!(app.selected().map(|path| &**path), Some("follower/looking/lookalgo/returnleft"));
    let edit = |app: &mut App, from: &str, to: &str| {
        let mut story = Story::new();
        let text = LINE_FOLLOWER.replace(from, to);
        story.at(90).load(&program(&text), &[(Op::Changed, Element::State, "follower/looking/lookalgo")]);
        story.records.iter().for_each(|record| app.record(record));
        app.selected().map(ToString::to_string)
    };
    let kept = edit(&mut app, "(state moving", "(state early) (state moving");
    assert_eq!(kept.as_deref(), Some("follower/looking/lookalgo/returnleft"));
    let renamed = edit(&mut app, "returnleft", "backleft");
    assert_eq!(renamed.as_deref(), Some("follower/looking/lookalgo/backleft"));
    let gone = edit(&mut app, "(state returnleft (running [robot.move{angular = {z = -search}}]))", "");
    assert_eq!(gone.as_deref(), Some("follower/looking/lookalgo/lookright"));
}

#[test]
fn the_first_machine_that_runs_is_selected_until_a_person_selects() {
    let text = "(machine idle (state a)) (machine busy (state b)) (machine late (state c)) (spawn busy b)";
    let mut story = Story::new();
    story.load(&program(text), &[]).spawn("busy", None).enter("busy/b");
    let mut app = screen(80, 24, &story);
    assert_eq!(app.selected().map(|path| &**path), Some("busy"));
    press(&mut app, "Up");
    let mut story = Story::new();
    story.spawn("late", None);
    story.records.iter().for_each(|record| app.record(record));
    assert_eq!(app.selected().map(|path| &**path), Some("idle/a"));
}

#[test]
fn following_goes_to_the_innermost_change() {
    let mut app = searching();
    press(&mut app, "f");
    let mut story = Story::new();
    story.at(90).enter("follower/moving");
    story.at(91).enter("follower/looking").enter("follower/looking/lookalgo/lookleft");
    story.records.iter().for_each(|record| app.record(record));
    assert_eq!(app.selected().map(|path| &**path), Some("follower/looking/lookalgo/lookleft"));
}

#[test]
fn the_log_holds_still_while_it_is_read() {
    let mut app = searching();
    press(&mut app, "4 Down Down Down");
    let held =
        |app: &App| frame(app).lines().find_map(|line| line.split_once("▸0:")).map(|(_, entry)| entry.to_owned());
    let row = |app: &App| frame(app).lines().position(|line| line.contains("▸0:"));
    let (before, at) = (held(&app), row(&app));
    assert!(at.is_some());
    let mut story = Story::new();
    for step in 90..95 {
        story.at(step).take("follower", "follower/moving", "follower/moving", None, "eps", 0);
    }
    story.at(95).fault("it broke", "follower/moving", 9, 1);
    story.records.iter().for_each(|record| app.record(record));
    assert_eq!(row(&app), at);
    assert_eq!(held(&app), before);
    press(&mut app, "Esc");
    assert_eq!(row(&app), None);
}

#[test]
fn tab_goes_through_the_panes_and_back() {
    let mut app = searching();
    let mut seen = Vec::new();
    for _ in 0..4 {
        seen.push(app.focus());
        press(&mut app, "Tab");
    }
    assert_eq!(seen, [Pane::Machines, Pane::Graph, Pane::Variables, Pane::Log]);
    assert_eq!(app.focus(), Pane::Machines);
    press(&mut app, "Shift-Tab");
    assert_eq!(app.focus(), Pane::Log);
}

#[test]
fn every_key_is_written_as_it_is_read_and_means_one_thing_in_a_pane() {
    let panes = Pane::ALL;
    for entry in action::TABLE {
        for text in entry.keys {
            let key: Key = text.parse().expect("a key");
            assert_eq!(key.to_string(), *text);
            for pane in panes.into_iter().filter(|&pane| entry.works_in(pane)) {
                let own = matches!(entry.reach, action::Reach::Panes(_));
                let same = action::TABLE.iter().filter(|other| {
                    matches!(other.reach, action::Reach::Panes(_)) == own
                        && other.works_in(pane)
                        && other.keys.contains(text)
                });
                assert_eq!(same.count(), 1, "{text} in {pane:?}");
            }
        }
    }
}

#[test]
fn the_page_of_keys_is_made_from_the_table() {
    let path = PathBuf::from(env!("CARGO_MANIFEST_DIR")).join("docs/keys.md");
    if std::env::var_os("UPDATE").is_some() {
        return fs::write(path, Keymap::default().page()).expect("the page is written");
    }
    let page = fs::read_to_string(&path).unwrap_or_default();
    assert!(page == Keymap::default().page(), "docs/keys.md is not what the table says; UPDATE=1 writes it anew");
}
