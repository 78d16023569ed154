//! The log as it is read: filtered, counted, copied.

use lrp::runtime::record::Level;
use lrp::ui::app::Effect;
use lrp::ui::clipboard::{Between, sequence};
use serde_json::json;

use crate::frames::{check, check_at, frame, press, screen};
use crate::story::Story;

/// A warning that comes back, an error of another machine, a fault.
fn noisy() -> Story {
    let mut story = Story::searching();
    for step in 83..90 {
        story.at(step).log(Level::Warn, "battery low", "follower/looking", 20);
    }
    story.at(90).log(Level::Error, "no line", "follower/looking/lookalgo/lookright", 24);
    story.at(91).fault("attempt to index a nil value (field 'range')", "follower/moving", 9, 3);
    story
}

#[test]
fn what_is_said_again_is_counted() {
    let app = screen(80, 24, &noisy());
    let frame = frame(&app);
    assert_eq!(frame.matches("battery low").count(), 1, "{frame}");
    assert!(frame.contains("battery low") && frame.contains("×7"), "{frame}");
    let mut later = noisy();
    later.at(200).log(Level::Warn, "battery low", "follower/looking", 20);
    assert_eq!(self::frame(&screen(80, 24, &later)).matches("battery low").count(), 2, "that is another time");
}

#[test]
fn lines_are_found_by_their_words() {
    check_at(&[(80, 24), (120, 40)], "log_found", &noisy(), "4 / b a t t");
    let mut app = screen(80, 24, &noisy());
    press(&mut app, "4 / n o Space l i n e Enter");
    assert!(frame(&app).contains("no line") && !frame(&app).contains("battery"));
    assert!(frame(&app).contains("/no line"));
    press(&mut app, "Esc");
    assert!(frame(&app).contains("battery"));
    press(&mut app, "4 / x y z Enter");
    assert!(frame(&app).contains("Nothing says xyz"));
}

#[test]
fn lines_are_chosen_by_severity_and_machine() {
    let mut app = screen(80, 24, &noisy());
    press(&mut app, "4 v v v v");
    let seen = frame(&app);
    assert!(seen.contains("errors only") && seen.contains("no line") && !seen.contains("battery"), "{seen}");
    assert!(seen.contains("attempt to index"), "{seen}");
    press(&mut app, "v 1 Home Down Down Down 4 m");
    let seen = frame(&app);
    assert!(seen.contains("no line") && !seen.contains("attempt to index"), "{seen}");
}

#[test]
fn what_is_selected_is_copied() {
    let copied = |keys: &str| match &press(&mut screen(80, 24, &noisy()), keys)[..] {
        [Effect::Copy(text)] => text.clone(),
        other => panic!("{other:?}"),
    };
    assert_eq!(copied("1 Down Y"), "follower/moving");
    assert_eq!(copied("3 Down Down Y"), "128");
    assert_eq!(copied("4 Down Down Y"), "0:09.0  error  lookright  no line  :24");
    let fault = copied("4 Down Y");
    let words =
        ["error[runtime-error]", "line_follower.lrp:9:27", "attempt to index", "9 │", "^", "help: ask", "3 times"];
    words.iter().for_each(|word| assert!(fault.contains(word), "{word} in\n{fault}"));
    assert!(press(&mut screen(80, 24, &noisy()), "4 Y").is_empty());
}

#[test]
fn a_long_value_is_seen_whole() {
    let mut story = Story::searching();
    let long = json!({ "gains": [0.1, 0.25, 0.123_456_789], "name": "a name that is longer than the pane is wide" });
    story.at(85).set("lightlim", long, "command");
    let mut app = screen(80, 24, &story);
    press(&mut app, "3 Down Down i");
    check("whole_value_80x24", &app);
}

#[test]
fn a_terminal_is_asked_to_take_a_text() {
    assert_eq!(sequence("128", Between::Nothing).as_deref(), Some("\x1b]52;c;MTI4\x07"));
    let tmux = "\x1b]52;c;YQ==\x07\x1bPtmux;\x1b\x1b]52;c;YQ==\x07\x1b\\";
    assert_eq!(sequence("a", Between::Tmux).as_deref(), Some(tmux));
    assert_eq!(sequence("→ab", Between::Nothing).as_deref(), Some("\x1b]52;c;4oaSYWI=\x07"));
    assert_eq!(sequence(&"x".repeat(80_000), Between::Nothing), None);
}
