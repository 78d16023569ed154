//! Everything by its name: what is offered for what is typed, and that taking it is as good as its key.

use lrp::runtime::command::Command;
use lrp::ui::action::TABLE;
use lrp::ui::app::{App, Effect, Offer, Overlay};
use lrp::ui::fuzzy;
use lrp::ui::layout::Pane;

use crate::frames::{check_at, press, screen};
use crate::story::Story;

fn searching() -> App {
    screen(80, 24, &Story::searching())
}

/// What is offered, by id or path.
fn offered(app: &App) -> Vec<String> {
    let Overlay::Palette(palette) = app.overlay() else { return Vec::new() };
    let word = |offer: &Offer| match offer {
        Offer::Action(entry) => entry.id.to_string(),
        Offer::Place(path) | Offer::Variable(path) => path.to_string(),
    };
    palette.offers.iter().map(word).collect()
}

fn spelt(text: &str) -> String {
    text.chars().map(|c| if c == ' ' { "Space".into() } else { c.to_string() }).collect::<Vec<String>>().join(" ")
}

/// Opens it, types, and tells what is offered.
fn typed(app: &mut App, text: &str) -> Vec<String> {
    press(app, &format!(": {}", spelt(text)));
    offered(app)
}

#[test]
fn it_lists_every_action_once() {
    let mut app = searching();
    let all = typed(&mut app, "");
    for entry in TABLE {
        let rows = TABLE.iter().filter(|other| other.action == entry.action).map(|other| other.id);
        assert_eq!(rows.filter(|id| all.iter().any(|other| other == id)).count(), 1, "{}", entry.id);
    }
    let place = |id: &String| TABLE.iter().position(|entry| entry.id == *id);
    assert!(all.is_sorted_by_key(place), "in the order of the table");
}

#[test]
fn the_best_comes_first() {
    for (text, first) in [
        ("pause", "pause"),
        ("wall", "write-all"),
        ("write all", "write-all"),
        ("tt", "transition-to"),
        ("jump", "jump-to"),
        ("stop", "runstop"),
        ("rst", "restart"),
        ("lookleft", "follower/looking/lookalgo/lookleft"),
        ("lookal", "follower/looking/lookalgo"),
        ("maxlook", "maxlook"),
        ("MAXLOOK", "maxlook"),
        ("follower/mov", "follower/moving"),
    ] {
        assert_eq!(typed(&mut searching(), text).first().map(String::as_str), Some(first), "{text}");
    }
    assert_eq!(typed(&mut searching(), "qqq"), Vec::<String>::new());
}

#[test]
fn a_word_of_the_help_finds_an_action_too() {
    assert!(typed(&mut searching(), "lua").contains(&"edit-value".to_string()));
}

#[test]
fn enter_does_what_the_key_would() {
    for (text, effects) in [
        ("pause", vec![Effect::Command(Command::Pause)]),
        ("runstop", vec![Effect::Command(Command::Runstop)]),
        ("faster", vec![Effect::Command(Command::Rate { hz: 20.0 })]),
        ("quit", vec![Effect::Quit]),
    ] {
        let mut app = searching();
        typed(&mut app, text);
        assert_eq!(press(&mut app, "Enter"), effects, "{text}");
        assert!(matches!(app.overlay(), Overlay::Nothing));
    }
}

#[test]
fn what_belongs_to_a_pane_is_done_there() {
    let mut app = searching();
    press(&mut app, "Down Down 3 Down Down 4");
    typed(&mut app, "increase");
    let set = Command::Set { var: "lightlim".into(), value: "138".into() };
    assert_eq!(press(&mut app, "Enter"), vec![Effect::Command(set)]);
    assert_eq!(app.focus(), Pane::Variables);
    typed(&mut app, "jump");
    let jump = Command::JumpTo { state: "follower/looking".into() };
    assert_eq!(press(&mut app, "Enter"), vec![Effect::Command(jump)]);
    assert_eq!(app.focus(), Pane::Machines);
}

#[test]
fn what_can_not_be_done_says_why_and_moves_nothing() {
    let mut app = searching();
    for (text, why) in [
        ("transition-to", "follower is a machine; select one of its states"),
        ("apply-held", "no edit is held; S holds the next saves"),
        ("pin", "no variable is selected; Down selects the first"),
        ("write-all", "every value set by hand is in the text"),
        ("give-back", "no value set by hand was lost"),
        ("nonsense", "nothing is called nonsense"),
    ] {
        typed(&mut app, text);
        assert_eq!(press(&mut app, "Enter"), Vec::new(), "{text}");
        assert_eq!(app.message(), Some(why));
        assert_eq!(app.focus(), Pane::Machines);
    }
}

#[test]
fn what_was_used_last_comes_first() {
    let mut app = searching();
    typed(&mut app, "step");
    press(&mut app, "Enter");
    typed(&mut app, "zoom");
    press(&mut app, "Enter");
    assert_eq!(typed(&mut app, "")[..3], ["zoom", "step", "runstop"]);
    press(&mut app, "Esc");
    typed(&mut app, "apply-held");
    press(&mut app, "Enter");
    assert_eq!(typed(&mut app, "")[..3], ["zoom", "step", "runstop"], "what wasn't done wasn't used");
}

#[test]
fn a_place_or_a_variable_is_gone_to() {
    let mut app = searching();
    press(&mut app, "3");
    typed(&mut app, "returnr");
    assert_eq!(press(&mut app, "Enter"), Vec::new());
    assert_eq!(app.selected().map(|path| &**path), Some("follower/looking/lookalgo/returnright"));
    assert_eq!(app.focus(), Pane::Machines);
    typed(&mut app, "time");
    press(&mut app, "Enter");
    assert_eq!(app.selected_value().map(|path| &**path), Some("follower/looking/lookalgo/time"));
    assert_eq!(app.focus(), Pane::Variables);
    assert!(app.values().position(app.selected_value()).is_some(), "it is listed");
}

#[test]
fn the_list_is_gone_through_and_left() {
    let mut app = searching();
    typed(&mut app, "");
    press(&mut app, "Down Down Up PgDn Ctrl-N Ctrl-P End Home");
    let Overlay::Palette(palette) = app.overlay() else { panic!("it is left") };
    assert_eq!(palette.at, 13, "Home and End are for the line");
    press(&mut app, "Esc");
    assert!(matches!(app.overlay(), Overlay::Nothing));
    typed(&mut app, "!");
    assert_eq!(press(&mut app, "Ctrl-X"), vec![Effect::Command(Command::Runstop)], "also while typing");
}

#[test]
fn what_fits_is_told_from_what_does_not() {
    assert_eq!(fuzzy::fit("", "anything"), Some(0));
    assert_eq!(fuzzy::fit("xyz", "anything"), None);
    assert_eq!(fuzzy::fit("gna", "anything"), None, "only in order");
    let better = |typed: &str, more: &str, less: &str| {
        let (more, less) = (fuzzy::fit(typed, more), fuzzy::fit(typed, less));
        assert!(more > less && less.is_some(), "{typed}: {more:?} {less:?}");
    };
    better("step", "step", "steps");
    better("st", "step", "reset");
    better("wb", "write-back", "wobbly");
    better("look", "lookleft", "outlook");
    better("ll", "look-left", "pull");
}

#[test]
fn it_is_drawn() {
    let look = format!(": {} Down", spelt("look"));
    check_at(&[(80, 24), (40, 24), (80, 12), (120, 40)], "palette", &Story::searching(), &look);
    check_at(&[(80, 24), (40, 24)], "palette_all", &Story::searching(), ": PgDn PgDn");
}
