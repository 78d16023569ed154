//! Values on the screen: found, pinned, opened, reset, and written back into the text.

use lrp::runtime::command::Command;
use lrp::runtime::record::{Change, Element, Op, What};
use lrp::runtime::time::Time;
use lrp::session::write_back::NotWritten;
use lrp::ui::app::{App, Effect, WriteBack};
use lrp::ui::curve;
use lrp::ui::view::History;
use serde_json::json;

use crate::frames::{SIZES, check, frame, go_on, press, screen};
use crate::story::{Story, program};

const TEXT: &str = "\
(var gains := [{ p = 0.5, limits = {1, 2} }])
(var period := [100])
(machine m
  (var speed := [0.25])
  (state s (machine n (var turn := [40]) (var twice := [turn * 2]) (state t)) (onentry (spawn n t)))
  (state u))
(machine other (var speed := [7]) (state v))
(spawn m s)
(spawn other v)
";

fn story() -> Story {
    let mut story = Story::new();
    story.load(&program(TEXT), &[]);
    story.set("gains", json!({"p": 0.5, "limits": [1, 2]}), "init").set("period", json!(100), "init");
    story.spawn("m", None).set("m/speed", json!(0.25), "init").enter("m/s");
    look(&mut story);
    story.spawn("other", None).set("other/speed", json!(7), "init").enter("other/v");
    story
}

fn look(story: &mut Story) {
    story.spawn("m/s/n", Some("m/s")).set("m/s/n/turn", json!(40), "init");
    story.set("m/s/n/twice", json!(80), "init").enter("m/s/n/t");
}

fn start() -> App {
    screen(80, 24, &story())
}

fn by_hand(app: &mut App, values: &[(&str, serde_json::Value)]) {
    go_on(app, 10, |story| {
        for (var, value) in values {
            story.set(var, value.clone(), "command");
        }
    });
}

fn unwritten(app: &App) -> Vec<String> {
    app.unwritten().map(|(path, value)| format!("{path} {value}")).collect()
}

/// Presses keys that write one file back.
fn writes(app: &mut App, keys: &str) -> Vec<WriteBack> {
    match press(app, keys).pop() {
        Some(Effect::WriteBack(all)) => all,
        other => panic!("{other:?}, saying {:?}", app.message()),
    }
}

fn refuses(app: &mut App, keys: &str, why: &str) {
    assert_eq!(press(app, keys), []);
    assert_eq!(app.message(), Some(why));
}

#[test]
fn a_tuned_value_is_written_back_and_stays_what_it_is() {
    let mut app = start();
    by_hand(&mut app, &[("m/speed", json!(0.3))]);
    assert!(frame(&app).contains("*speed") && frame(&app).contains("1 unwritten"));
    let written = writes(&mut app, "3 Down w");
    let to = TEXT.replace("0.25", "0.3");
    assert_eq!(written[0].values, [("m/speed".into(), json!(0.3))]);
    let rewrite = &written[0].rewrite;
    assert_eq!((&*rewrite.file, &*rewrite.from, &*rewrite.to), ("line_follower.lrp", TEXT, &*to));
    app.written(written.into_iter().map(|it| (it, Ok(()))).collect());
    assert_eq!(app.message(), Some("written to line_follower.lrp: speed 0.3"));
    assert_eq!(unwritten(&app), [""; 0]);
    go_on(&mut app, 10, |story| {
        story.load(&program(&to), &[(Op::Changed, Element::Variable, "m/speed")]).set("m/speed", json!(0.3), "init");
    });
    assert_eq!(unwritten(&app), [""; 0]);
    assert!(!frame(&app).contains("*speed") && app.farewell().is_empty());
    refuses(&mut app, "w", "m/speed begins with this value already");
}

#[test]
fn what_is_on_its_way_is_written() {
    let mut app = start();
    assert!(!press(&mut app, "3 Down Right").is_empty());
    assert!(writes(&mut app, "w")[0].rewrite.to.contains("(var speed := [0.27])"));
}

#[test]
fn all_tuned_values_are_written_at_once_and_the_others_named() {
    let mut app = start();
    refuses(&mut app, "W", "every value set by hand is in the text");
    let gains = json!({"p": 0.6, "limits": [1, 3]});
    by_hand(
        &mut app,
        &[("other/speed", json!(8)), ("m/speed", json!(0.3)), ("m/s/n/twice", json!(90)), ("gains", gains)],
    );
    assert!(frame(&app).contains("4 unwritten"));
    let written = writes(&mut app, "W");
    let text = TEXT.replace("[7]", "[8]").replace("0.25", "0.3").replace("0.5", "0.6").replace("{1, 2}", "{1, 3}");
    assert_eq!(written[0].rewrite.to, text);
    app.written(written.into_iter().map(|it| (it, Ok(()))).collect());
    let said = app.message().unwrap_or_default();
    assert!(said.contains("speed 0.3, speed 8; m/s/n/twice begins with `turn * 2`, which is no literal"), "{said}");
    assert_eq!(unwritten(&app), ["m/s/n/twice 90"]);
    let farewell = "line_follower.lrp:5: m/s/n/twice was set to 90 by hand; the file still has turn * 2";
    assert_eq!(app.farewell(), [farewell]);
}

#[test]
fn what_could_not_be_written_is_said_and_stays_marked() {
    let mut app = start();
    by_hand(&mut app, &[("m/speed", json!(0.3))]);
    let written = writes(&mut app, "3 Down w");
    let changed = || NotWritten::Changed { file: "a.lrp".into() };
    app.written(written.into_iter().map(|it| (it, Err(changed()))).collect());
    assert_eq!(app.message(), Some("not written: a.lrp isn't what runs now; save it so that it runs, then again"));
    assert_eq!(unwritten(&app), ["m/speed 0.3"]);
    go_on(&mut app, 10, |story| _ = story.set("m/speed", json!(0.9), "m/s"));
    assert_eq!(unwritten(&app), [""; 0], "the program has given it another value since");
}

#[test]
fn what_was_tuned_in_a_machine_that_starts_anew_can_still_be_written() {
    let mut app = start();
    by_hand(&mut app, &[("m/s/n/turn", json!(55))]);
    go_on(&mut app, 10, |story| {
        story.tell(What::Discard { machine: "m/s/n".into() }).enter("m/u");
        story.enter("m/s");
        look(story);
    });
    press(&mut app, "1 Down Down 3 Down");
    assert!(frame(&app).contains("*turn") && frame(&app).contains("set 55"), "{}", frame(&app));
    assert!(writes(&mut app, "w")[0].rewrite.to.contains("(var turn := [55])"));
}

#[test]
fn an_edit_of_the_initial_value_settles_it() {
    let mut app = start();
    by_hand(&mut app, &[("m/speed", json!(0.3)), ("period", json!(90))]);
    go_on(&mut app, 10, |story| {
        let text = TEXT.replace("0.25", "0.4");
        story.load(&program(&text), &[(Op::Changed, Element::Variable, "m/speed")]).set("m/speed", json!(0.4), "init");
    });
    assert_eq!(unwritten(&app), ["period 90"]);
    go_on(&mut app, 10, |story| {
        let text = TEXT.replace("period", "cycle");
        let change =
            Change { op: Op::Renamed, kind: Element::Variable, path: "period".into(), to: Some("cycle".into()) };
        story.edit(&program(&text), vec![change], None, &[]);
    });
    assert_eq!(unwritten(&app), ["cycle 90"]);
}

#[test]
fn a_variable_is_reset_and_that_is_no_loss() {
    let mut app = start();
    by_hand(&mut app, &[("m/speed", json!(0.3))]);
    let reset = || Command::Reset { var: "m/speed".into() };
    assert_eq!(press(&mut app, "3 Down r"), [Effect::Command(reset())]);
    go_on(&mut app, 10, |story| _ = story.tell(What::Command { command: reset() }).set("m/speed", json!(0.25), "init"));
    assert_eq!(unwritten(&app), [""; 0]);
    assert_eq!(app.view().lost().count(), 0);
    let mut story = Story::searching();
    story.at(90).tell(What::Discard { machine: "follower".into() });
    let mut app = screen(80, 24, &story);
    refuses(&mut app, "3 Down r", "follower/nobump has no value: its machine isn't running");
    refuses(&mut app, "End r", "robot:move comes from the robot and can't be set here");
    refuses(&mut app, "w", "robot:move comes from the robot and has no place in the text");
}

/// The lines of the variables pane.
fn listed(app: &App) -> Vec<String> {
    let frame = frame(app);
    let glyphs = frame.split("-- styles").next().unwrap_or_default();
    let lines = glyphs.lines().map(|line| line.chars().take(36).collect::<String>());
    let below = lines.skip_while(|line| !line.starts_with("─ variables")).take_while(|line| !line.trim().is_empty());
    below.map(|line| line.trim_end_matches(['│', '├', '┤', '─', ' ']).to_owned()).collect()
}

fn names(app: &App) -> Vec<String> {
    let name =
        |line: &String| line.trim_start_matches(['▸', '*', '+', '-', ' ']).split(' ').next().unwrap_or("").to_owned();
    listed(app).iter().skip(1).map(name).filter(|name| !name.is_empty()).collect()
}

#[test]
fn pinned_variables_stay_on_top_whatever_is_selected() {
    let mut app = start();
    assert_eq!(names(&app), ["speed", "global", "gains", "period"]);
    press(&mut app, "3 Down Down Down p");
    assert_eq!(names(&app), ["period", "m", "speed", "global", "gains"]);
    press(&mut app, "Down p 1 End");
    assert_eq!(
        names(&app),
        ["period", "m/speed", "other", "speed", "global", "gains"].map(|name| name.replace("m/speed", "speed"))
    );
    press(&mut app, "3 Home Down Down p");
    assert_eq!(names(&app), ["period", "m/speed", "other/speed", "global", "gains"]);
    press(&mut app, "p p Home p");
    assert_eq!(names(&app), ["m/speed", "other/speed", "global", "gains", "period"]);
}

#[test]
fn variables_are_found_in_every_machine() {
    let mut app = start();
    press(&mut app, "3 /");
    press(&mut app, "s p e");
    assert_eq!(names(&app), ["speed", "other", "speed"]);
    assert!(listed(&app)[0].starts_with("─ variables  /spe  m"));
    press(&mut app, "Enter Down Down Right");
    assert_eq!(app.selected_value().map(|path| &**path), Some("other/speed"));
    press(&mut app, "/ x Enter");
    assert!(frame(&app).contains("Nothing is called so (Esc: all)."));
    press(&mut app, "Esc");
    assert_eq!(names(&app), ["speed", "global", "gains", "period"]);
    press(&mut app, "/ g a Esc");
    assert_eq!(names(&app), ["speed", "global", "gains", "period"]);
}

#[test]
fn tables_open_as_trees() {
    let mut app = start();
    press(&mut app, "3 Down Down Right");
    assert_eq!(names(&app), ["speed", "global", "gains", "limits", "p", "period"]);
    press(&mut app, "Down Right Down");
    assert_eq!(names(&app), ["speed", "global", "gains", "limits", "1", "2", "p", "period"]);
    refuses(&mut app, "Right", "gains.limits.1 is part of a table; e at gains types the whole of it");
    assert!(press(&mut app, "p").is_empty());
    assert_eq!(names(&app)[0], "gains", "the whole of it");
    press(&mut app, "p Left Left Left");
    assert_eq!(app.selected_value().map(|path| &**path), Some("gains"));
    assert_eq!(names(&app), ["speed", "global", "gains", "limits", "p", "period"]);
    press(&mut app, "Left");
    assert_eq!(names(&app), ["speed", "global", "gains", "period"]);
    let mut app = screen(120, 40, &Story::searching());
    press(&mut app, "3 End Up Right");
    assert!(frame(&app).contains("-pose") && frame(&app).contains("   theta "), "{}", frame(&app));
}

#[test]
fn a_curve_moves_with_program_time_alone() {
    let mut history = History::default();
    let at = |ms: u64| Time(ms * 1000);
    for (ms, number) in [(0, 1.0), (100, 2.0), (1600, 3.0), (1900, 4.0)] {
        history.remember(number, at(ms));
    }
    assert_eq!(history.sampled(at(1900), 10), [2.0, 2.0, 2.0, 4.0]);
    assert_eq!(history.sampled(at(1999), 10), history.sampled(at(1500), 10));
    assert_eq!(history.sampled(at(2600), 3), [4.0, 4.0, 4.0]);
    for ms in 0..100_000 {
        history.remember(ms as f64, at(ms));
    }
    assert_eq!(history.sampled(at(100_000), 1000).len(), 129, "bounded");
}

#[test]
fn a_curve_reaches_from_the_least_to_the_greatest() {
    assert_eq!(curve::sparkline(&[0.0, 7.0, 3.0]), "▁█▄");
    assert_eq!(curve::rows(&[0.0, 15.0, 7.0], 2), [" █ ", "▁██"]);
    assert_eq!(curve::rows(&[5.0, 5.0], 1), ["▁▁"]);
    assert_eq!(curve::rows(&[-f64::MAX, f64::MAX], 1), ["▁█"]);
    assert!(!curve::moves(&[1.0, 1.0]) && !curve::moves(&[]) && curve::moves(&[1.0, 2.0]));
}

#[test]
fn tuned_values_on_the_screen() {
    for (width, height) in SIZES {
        let mut story = Story::searching();
        story.at(82).set("lightlim", json!(140), "command");
        let mut app = screen(width, height, &story);
        press(&mut app, "3 Down Down Down p Down Down Down");
        check(&format!("tuned_{width}x{height}"), &app);
        press(&mut app, "/ l i g");
        check(&format!("found_{width}x{height}"), &app);
    }
    let mut app = screen(80, 24, &{
        let mut story = Story::searching();
        for step in 83..110 {
            story.at(step).set(
                "follower/looking/lookalgo/time",
                json!(step * 7 % 400),
                "follower/looking/lookalgo/lookleft",
            );
        }
        story
    });
    press(&mut app, "Enter Enter 3 Down i");
    check("curve_80x24", &app);
}
