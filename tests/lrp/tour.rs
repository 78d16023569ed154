//! The tour: what ends each task, that nothing leads to a dead end, how its strip looks, and a newcomer at a terminal who
//! goes all the way.

use std::fs;
use std::path::Path;

use lrp::runtime::command::{Command, Saves};
use lrp::runtime::record::{Change, Element, Forced, Held, Op, What};
use lrp::ui::action::{self, Action};
use lrp::ui::app::{App, Options};
use lrp::ui::keymap::Keymap;
use lrp::ui::settings::Settings;
use lrp::ui::tour::{Need, STEPS, Tour, folder};
use lrp::ui::view::Choices;
use portable_pty::CommandBuilder;
use ratatui::layout::Size;
use serde_json::json;

use crate::binary::lrp;
use crate::frames::{check, frame, go_on, press};
use crate::story::{LINE_FOLLOWER, Story, program};
use crate::terminal::pty::Pty;

/// The screen with a tour that was taken so far.
fn guided(width: u16, height: u16, progress: &str, story: &Story) -> App {
    let app = App::new(Options {
        file: "line_follower.lrp".into(),
        rate: 10.0,
        choices: Choices::default(),
        settings: Settings::default(),
        size: Size::new(width, height),
    });
    let mut app = app.guided(Tour::new("lrp-tour/tour.lrp", progress));
    story.records.iter().for_each(|record| app.record(record));
    app
}

/// Everything before a task is done.
fn until(id: &str) -> String {
    STEPS.iter().take_while(|step| step.id != id).map(|step| format!("done {}\n", step.id)).collect()
}

fn at(app: &App) -> &'static str {
    app.tour().and_then(Tour::step).map_or("through", |(_, step)| step.id)
}

fn change() -> (Op, Element, &'static str) {
    (Op::Changed, Element::Variable, "forward")
}

fn hold(story: &mut Story) {
    story.tell(What::Command { command: Command::Saves { mode: Saves::Hold } });
    let changes = vec![Change { op: Op::Changed, kind: Element::Variable, path: "search".into(), to: None }];
    story.tell(What::Held(Held {
        changes,
        restarts: None,
        again: Vec::new(),
        discarded: Vec::new(),
        because: Vec::new(),
        findings: Vec::new(),
    }));
}

fn pause(story: &mut Story) {
    story.tell(What::Pause { reason: "asked for".into(), at: None });
}

/// What ends a task, as records or keys.
fn do_it(app: &mut App, id: &str) {
    match id {
        "look" => _ = press(app, "w w"),
        "why" => _ = press(app, "y y"),
        "write" => {
            let effects = press(app, "W");
            let lrp::ui::app::Effect::WriteBack(all) = effects.into_iter().next().expect("a file to write") else {
                panic!("something else is done");
            };
            app.written(all.into_iter().map(|it| (it, Ok(()))).collect());
        }
        _ => go_on(app, 90, |story| match id {
            "edit" => _ = story.load(&program(LINE_FOLLOWER), &[change()]),
            "break" => _ = story.reject(&[("this `(` is never closed", "line_follower.lrp", 15)]),
            "mend" => _ = story.load(&program(LINE_FOLLOWER), &[]),
            "tune" => _ = story.set("forward", json!(0.3), "command"),
            "jump" => {
                story.tell(What::Force { state: "follower/moving".into(), how: Forced::Jump }).enter("follower/moving");
            }
            "pause" => pause(story),
            "step" => (0..3).for_each(|_| _ = story.tell(What::Command { command: Command::Step })),
            "run" => _ = story.tell(What::Resume),
            "hold" => hold(story),
            "apply" => {
                story.load(&program(LINE_FOLLOWER), &[change()]);
                story.tell(What::Command { command: Command::Saves { mode: Saves::Apply } });
            }
            "stop" => _ = story.tell(What::Command { command: Command::Runstop }),
            _ => panic!("{id} is not known here"),
        }),
    }
}

#[test]
fn each_task_ends_when_it_is_done_and_with_nothing_less() {
    let mut app = guided(80, 24, "", &Story::searching());
    for step in STEPS {
        assert_eq!(at(&app), step.id);
        go_on(&mut app, 85, |story| {
            story.tell(What::Status { rate: 10.0, late: 0.0 }).input("light", json!({ "data": 99 }));
        });
        press(&mut app, "Down 1");
        assert_eq!(at(&app), step.id, "by doing something else");
        do_it(&mut app, step.id);
        assert_eq!(app.tour().and_then(Tour::praise), Some(step.praise), "{}", step.id);
    }
    assert_eq!(at(&app), "through");
    let progress = app.tour().map(Tour::progress).unwrap_or_default();
    assert_eq!(at(&guided(80, 24, &progress, &Story::searching())), "through", "it is remembered");
}

#[test]
fn what_was_done_already_is_not_asked_for() {
    let mut story = Story::searching();
    story.at(82).reject(&[("this `(` is never closed", "line_follower.lrp", 15)]);
    let mut app = guided(80, 24, &until("edit"), &story);
    assert!(frame(&app).contains("The text can't be taken over"), "the edit waits for that");
    go_on(&mut app, 83, |story| _ = story.load(&program(LINE_FOLLOWER), &[change()]));
    assert_eq!(at(&app), "break");
    let mut story = Story::searching();
    pause(&mut story);
    assert_eq!(at(&guided(80, 24, &until("pause"), &story)), "step");
    let mut story = Story::searching();
    hold(&mut story);
    assert_eq!(at(&guided(80, 24, &until("hold"), &story)), "apply");
}

/// Whatever is not as a task needs it, its strip says the way back.
#[test]
fn there_is_no_dead_end() {
    for step in STEPS {
        for &need in step.needs {
            let mut story = Story::searching();
            match need {
                Need::Taken => hold(&mut story),
                Need::Sound => _ = story.reject(&[("this `(` is never closed", "line_follower.lrp", 15)]),
                Need::Alive => {
                    story.tell(What::Discard { machine: "follower/looking/lookalgo".into() });
                    story.tell(What::Discard { machine: "follower".into() });
                }
                Need::Going => pause(&mut story),
            }
            let app = guided(80, 24, &until(step.id), &story);
            let begins = need.way_back().split(['{', ',', ';', '.']).next().unwrap_or_default();
            assert!(!begins.is_empty() && frame(&app).contains(begins), "{}: {need:?}\n{}", step.id, frame(&app));
        }
        let mut app = guided(80, 24, &until(step.id), &Story::searching());
        press(&mut app, "n");
        assert_ne!(at(&app), step.id, "it can be skipped");
    }
    let mut story = Story::new();
    story.reject(&[("this `(` is never closed", "tour.lrp", 15)]);
    for id in ["tune", "jump", "why", "step"] {
        assert!(frame(&guided(80, 24, &until(id), &story)).contains("Mend it in your editor"), "{id}");
    }
}

#[test]
fn what_was_skipped_is_taken_up_at_the_end() {
    let mut app = guided(80, 24, &until("stop"), &Story::searching());
    press(&mut app, "n");
    assert_eq!(at(&app), "through");
    check("tour_skipped_80x24", &app);
    let progress = app.tour().map(Tour::progress).unwrap_or_default();
    let mut app = guided(80, 24, &progress, &Story::searching());
    press(&mut app, "n");
    assert_eq!(at(&app), "stop");
    do_it(&mut app, "stop");
    check("tour_through_80x24", &app);
    press(&mut app, "n");
    assert_eq!(at(&app), "look", "all again");
}

#[test]
fn a_file_of_progress_may_hold_anything() {
    for text in ["done look\r\n\u{0}\nskipped edit\ndone nothing\nlook\n", " done look\nskipped edit"] {
        assert_eq!(Tour::new("x", text).step().map(|(number, _)| number), Some(3), "{text:?}");
    }
    assert_eq!(Tour::new("x", "undone look").step().map(|(number, _)| number), Some(1));
}

#[test]
fn its_strip_leaves_the_rest_where_it_is() {
    for (width, height) in [(80, 24), (80, 11), (40, 24), (120, 40)] {
        let mut app = guided(width, height, "", &Story::searching());
        let machines = |app: &App| frame(app).lines().position(|line| line.contains("─ machines "));
        let first = machines(&app);
        assert!(first.is_some(), "{width}x{height}");
        for step in STEPS {
            assert_eq!(machines(&app), first, "{} at {width}x{height}", step.id);
            assert!(!frame(&app).lines().next().unwrap_or_default().is_empty());
            press(&mut app, "n");
        }
        check(&format!("tour_{width}x{height}"), &guided(width, height, &until("write"), &Story::searching()));
    }
    // In half of a terminal of 24 rows, beside the editor, there is room for two lines and three panes.
    let half = frame(&guided(80, 11, "", &Story::searching()));
    assert!(half.lines().nth(2).is_some_and(|line| line.contains("RUN")) && half.contains("─ log"), "{half}");
    let mut app = guided(80, 24, &until("jump"), &Story::searching());
    do_it(&mut app, "jump");
    check("tour_praise_80x24", &app);
    let mut app = guided(80, 11, &until("jump"), &Story::searching());
    do_it(&mut app, "jump");
    check("tour_praise_80x11", &app);
    press(&mut app, "N");
    assert_eq!(app.message(), Some("N shows the tour again"));
    press(&mut app, "1");
    check("tour_hidden_80x11", &app);
    for (width, height) in [(20, 5), (20, 6), (10, 3), (300, 7)] {
        frame(&guided(width, height, "", &Story::searching()));
    }
}

#[test]
fn the_table_holds_what_its_texts_promise() {
    let mut ids: Vec<&str> = STEPS.iter().map(|step| step.id).collect();
    ids.sort_unstable();
    ids.dedup();
    assert_eq!(ids.len(), STEPS.len());
    let texts = STEPS.iter().map(|step| step.task);
    for text in texts.chain([Need::Taken, Need::Sound, Need::Alive, Need::Going].map(Need::way_back)) {
        let names = text.split('{').skip(1).filter_map(|rest| rest.split_once('}')).map(|(name, _)| name);
        for name in names.filter(|&name| name != "file") {
            assert!(action::TABLE.iter().any(|entry| entry.id == name), "{name} is no action");
        }
    }
    assert!(STEPS.iter().all(|step| step.praise.split(' ').count() == 3), "three words");
    assert!(
        Tour::outlook(&Keymap::default()).lines().all(|line| line.chars().count() < 80),
        "{}",
        Tour::outlook(&Keymap::default())
    );
    assert!(!Tour::outlook(&Keymap::default()).contains('{'));
}

#[test]
fn without_a_tour_its_keys_say_so() {
    let mut app = crate::frames::screen(80, 24, &Story::searching());
    for keys in ["n", "N"] {
        press(&mut app, keys);
        assert_eq!(app.message(), Some("no tour is going on; `lrp tour` begins one"));
    }
    assert_ne!(Action::TourNext, Action::TourStrip);
}

#[test]
fn its_folder_is_never_overwritten() {
    let outer = tempfile::tempdir().unwrap();
    let inner = outer.path().join("a/b");
    let file = folder::open(&inner).unwrap();
    assert_eq!(folder::begun(&inner), None);
    fs::write(&file, "mine").unwrap();
    fs::remove_file(inner.join("room.world")).unwrap();
    fs::write(inner.join("progress"), "done look\nskipped edit\n").unwrap();
    folder::open(&inner).unwrap();
    assert_eq!(fs::read_to_string(&file).unwrap(), "mine");
    assert!(inner.join("room.world").exists(), "what is missing is made again");
    let tour = folder::resume(&inner);
    assert_eq!(tour.step().map(|(_, step)| step.id), Some("break"));
    assert_eq!(folder::begun(&inner).as_deref(), Some(&*format!("1 of {}", STEPS.len())));
    folder::keep(&inner, &tour).unwrap();
    assert_eq!(fs::read_to_string(inner.join("progress")).unwrap(), "done look\nskipped edit\n");
    assert!(folder::open(&file).is_err(), "a file is no folder");
}

#[test]
fn its_program_is_sound_and_never_ends() {
    let outer = tempfile::tempdir().unwrap();
    folder::open(outer.path()).unwrap();
    let said = lrp(outer.path(), &["check", "tour.lrp"]);
    assert_eq!((said.code, &*said.out), (Some(0), "tour.lrp: no problems found\n"));
    let said = lrp(outer.path(), &["run", "--virtual", "--for", "30m", "--trace", "-", "tour.lrp"]);
    assert_eq!((said.code, &*said.err), (Some(0), ""));
    let dances = said.out.matches(r#""to":"dancing""#).count();
    assert!((4..=5).contains(&dances), "{dances} dances in half an hour");
    let last = said.out.rfind(r#""to":"turning""#).expect("it turns");
    assert!(last > said.out.len() * 19 / 20, "and goes on to the end");
}

/// All of it with the real program: keys are pressed, the file is saved, nothing else is told.
#[test]
fn a_newcomer_goes_all_the_way() {
    let outer = tempfile::tempdir().unwrap();
    let mut pty = Pty::new();
    let start = |pty: &Pty| {
        let mut command = CommandBuilder::new(env!("CARGO_BIN_EXE_lrp"));
        command.arg("tour");
        command.cwd(outer.path());
        command.env("TERM", "xterm-256color");
        pty.run(command)
    };
    let comes_to = |pty: &Pty, number: usize| {
        let heading = format!("tour {number} of {}  {}", STEPS.len(), STEPS[number - 1].title);
        pty.wait_for(&heading, |screen| screen.contents().contains(&heading));
    };
    let running = start(&pty);
    comes_to(&pty, 1);
    let file = outer.path().join("lrp-tour/tour.lrp");
    let save = |from: &str, to: &str| {
        let text = fs::read_to_string(&file).unwrap();
        assert!(text.contains(from), "{from}");
        fs::write(&file, text.replacen(from, to, 1)).unwrap();
    };
    pty.wait_for("the program", |screen| screen.contents().contains("● driving"));
    pty.type_in("ww");
    comes_to(&pty, 2);
    save("speed := [0.2]", "speed := [0.4]");
    comes_to(&pty, 3);
    save("(spawn rover", "spawn rover");
    comes_to(&pty, 4);
    pty.type_in("q");
    assert_eq!(running.wait().exit_code(), 0);
    pty.wait_for("where she was", |screen| {
        screen.contents().contains("3 of 14 tasks are done. `lrp tour` goes on with 11.")
    });
    // The text is still broken, and so nothing runs; but the tour goes on with that.
    let running = start(&pty);
    comes_to(&pty, 4);
    save("spawn rover", "(spawn rover");
    comes_to(&pty, 5);
    pty.wait_for("the program", |screen| screen.contents().contains("● driving"));
    pty.type_in("3/speed\rj>");
    comes_to(&pty, 6);
    pty.type_in("w");
    comes_to(&pty, 7);
    pty.wait_for("its load", |screen| screen.contents().contains("saved: ~variable speed"));
    pty.type_in("1GJ");
    comes_to(&pty, 8);
    pty.type_in("yy");
    comes_to(&pty, 9);
    pty.type_in(" ");
    comes_to(&pty, 10);
    pty.type_in("sss");
    comes_to(&pty, 11);
    pty.type_in(" ");
    comes_to(&pty, 12);
    pty.type_in("S");
    pty.wait_for("holding", |screen| screen.contents().contains("hold"));
    save("spin := [0.8]", "spin := [1.8]");
    comes_to(&pty, 13);
    pty.type_in("EA");
    pty.wait_for("nothing held", |screen| !screen.contents().contains("edit held"));
    pty.type_in("S");
    comes_to(&pty, 14);
    pty.type_in("!");
    pty.wait_for("the end", |screen| screen.contents().contains("That was the tour."));
    pty.type_in("q");
    assert_eq!(running.wait().exit_code(), 0);
    pty.wait_for("the outlook", |screen| {
        screen.contents().contains("What it ran is yours, in lrp-tour.") && screen.contents().contains("breakpoints")
    });
    assert!(Path::new(&file).exists());
}
