//! Hints in the last line: what brings each, how long it stands, what ends it.

use lrp::runtime::command::Command;
use lrp::runtime::record::{Change, Element, Op, What};
use lrp::ui::app::App;
use lrp::ui::hints::Hint;
use serde_json::json;

use crate::frames::{SIZES, check, frame, go_on, press, screen};
use crate::story::{LINE_FOLLOWER, Story, program};

/// Half seconds go by in which nothing else happens.
fn beats(app: &mut App, step: u64, count: usize) {
    go_on(app, step, |story| {
        for _ in 0..count {
            story.tell(What::Status { rate: 10.0, late: 0.0 });
        }
    });
}

fn paused() -> Story {
    let mut story = Story::searching();
    story.tell(What::Pause { reason: "asked for".into(), at: None });
    story
}

/// Turning away takes 3 s; here the text says twenty.
fn turning() -> Story {
    let text = LINE_FOLLOWER.replace("ontime 3000", "ontime 20000");
    let mut story = Story::new();
    story.load(&program(&text), &[]).spawn("follower", None).enter("follower/bumpturn").at(10);
    story
}

fn tuned() -> Story {
    let mut story = Story::searching();
    story.at(82).set("lightlim", json!(148), "command");
    story
}

fn restarted() -> Story {
    let mut story = Story::searching();
    let changed = Change { op: Op::Changed, kind: Element::Action, path: "follower/looking".into(), to: None };
    story.at(82).edit(&program(LINE_FOLLOWER), vec![changed], Some("active state follower/looking changed"), &[]);
    story.spawn("follower", None).enter("follower/looking");
    story
}

fn failing() -> Story {
    let mut story = Story::searching();
    story.at(82).fault("attempt to index a nil value", "follower/looking/lookalgo/lookright", 19, 3);
    story
}

/// Its guards have been false for a while.
fn staying() -> Story {
    let mut story = Story::new();
    story.load(&program(LINE_FOLLOWER), &[]).spawn("follower", None).enter("follower/moving").at(200);
    story
}

#[test]
fn each_comes_from_what_happens() {
    for (name, story, hint) in [
        ("paused", paused(), Hint::Paused),
        ("waits", turning(), Hint::Waits),
        ("unwritten", tuned(), Hint::Unwritten),
        ("restarted", restarted(), Hint::Restarted),
        ("error", failing(), Hint::Error),
        ("stays", staying(), Hint::Stays),
    ] {
        let step = story.records.last().map_or(0, |record| record.step).max(200 * u64::from(name == "stays"));
        for (width, height) in SIZES {
            let mut app = screen(width, height, &story);
            beats(&mut app, step, 4);
            assert_eq!(app.hint(), Some(hint), "{name}");
            let last = frame(&app).lines().nth(usize::from(height) - 1).unwrap_or_default().to_owned();
            assert!(last.contains("help  ! STOP"), "{last}");
        }
        let mut app = screen(80, 24, &story);
        beats(&mut app, step, 4);
        check(&format!("hint_{name}_80x24"), &app);
    }
}

#[test]
fn in_the_variables_the_one_selected_is_written() {
    let mut app = screen(80, 24, &tuned());
    press(&mut app, "3 Down Down");
    beats(&mut app, 82, 5);
    check("hint_unwritten_selected_80x24", &app);
}

#[test]
fn a_hint_comes_only_to_who_waits_and_stands_a_while() {
    let mut app = screen(80, 24, &paused());
    beats(&mut app, 82, 2);
    press(&mut app, "Down");
    beats(&mut app, 82, 3);
    assert_eq!(app.hint(), None, "a key came between");
    beats(&mut app, 82, 1);
    assert_eq!(app.hint(), Some(Hint::Paused));
    go_on(&mut app, 82, |story| {
        story.tell(What::Resume);
    });
    beats(&mut app, 83, 5);
    assert_eq!(app.hint(), Some(Hint::Paused), "it doesn't flicker");
    beats(&mut app, 83, 1);
    assert_eq!(app.hint(), None);
}

#[test]
fn what_was_followed_twice_or_read_for_long_is_known() {
    let mut app = screen(80, 24, &paused());
    for _ in 0..2 {
        beats(&mut app, 82, 4);
        assert_eq!(app.hint(), Some(Hint::Paused));
        press(&mut app, "s");
    }
    beats(&mut app, 82, 20);
    assert_eq!(app.hint(), None);
    let mut app = screen(80, 24, &paused());
    beats(&mut app, 82, 60);
    assert_eq!(app.hint(), Some(Hint::Paused));
    beats(&mut app, 82, 20);
    assert_eq!(app.hint(), None);
}

#[test]
fn what_matters_more_comes_first() {
    let mut story = failing();
    story.tell(What::Pause { reason: "asked for".into(), at: None });
    let mut app = screen(80, 24, &story);
    beats(&mut app, 82, 4);
    assert_eq!(app.hint(), Some(Hint::Error));
    let mut story = failing();
    story.tell(What::Command { command: Command::Runstop }).tell(What::Pause { reason: "runstop".into(), at: None });
    let mut app = screen(40, 24, &story);
    beats(&mut app, 82, 4);
    assert!(frame(&app).contains("! STOP"));
}
