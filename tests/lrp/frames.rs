//! Whole frames as text, one file each under tests/frames; `UPDATE=1` writes them anew.

use std::fs;
use std::path::PathBuf;

use lrp::runtime::command::Command;
use lrp::runtime::record::{BridgeState, Element, Health, Op, What};
use lrp::ui::action::TABLE;
use lrp::ui::app::{App, Event, Options, Overlay};
use lrp::ui::glyphs::Charset;
use lrp::ui::key::Key;
use lrp::ui::settings::Settings;
use lrp::ui::theme::{Palette, Theme};
use lrp::ui::view::Choices;
use ratatui::Terminal;
use ratatui::backend::TestBackend;
use ratatui::buffer::{Buffer, Cell};
use ratatui::layout::Size;
use ratatui::style::{Color, Modifier};
use serde_json::json;

use crate::story::{LINE_FOLLOWER, Story, program};

/// The screen of a size after some records.
pub fn screen(width: u16, height: u16, story: &Story) -> App {
    screen_with(Settings::default(), Size::new(width, height), story)
}

pub fn screen_with(settings: Settings, size: Size, story: &Story) -> App {
    let (file, choices) = ("line_follower.lrp".into(), Choices::default());
    let mut app = App::new(Options { file, rate: 10.0, choices, settings, size });
    for record in &story.records {
        app.record(record);
    }
    // A screen that is drawn anew tells the very moment.
    app.event(Event::Resize(size));
    app
}

/// Presses keys given as text: `Tab Down t`.
pub fn press(app: &mut App, keys: &str) -> Vec<lrp::ui::app::Effect> {
    let key = |text: &str| Event::Key(text.parse::<Key>().expect("a key").into());
    keys.split_whitespace().flat_map(|text| app.event(key(text))).collect()
}

pub fn frame(app: &App) -> String {
    let Size { width, height } = app.options().size;
    let mut terminal = Terminal::new(TestBackend::new(width, height)).expect("a terminal");
    terminal.draw(|frame| app.draw(frame)).expect("a frame");
    text(terminal.backend().buffer())
}

/// The glyphs, then one letter a cell where a style tells something.
pub fn text(buffer: &Buffer) -> String {
    let rows = buffer.content.chunks(usize::from(buffer.area.width));
    let glyphs = rows.clone().map(|row| line(row.iter().map(|cell| cell.symbol().to_owned())));
    let styles = rows.map(|row| line(row.iter().map(|cell| letter(cell).to_string())));
    let legend = "-- styles: , dim  + bold  r red  g green  y yellow  b blue  m magenta  c cyan  (upper case: bold)  # reversed\n";
    glyphs.chain([legend.to_owned()]).chain(styles).collect()
}

fn line(cells: impl Iterator<Item = String>) -> String {
    let line: String = cells.collect();
    format!("{}\n", line.trim_end())
}

fn letter(cell: &Cell) -> char {
    let letter = match cell.fg {
        Color::Red => 'r',
        Color::Green => 'g',
        Color::Yellow => 'y',
        Color::LightBlue => 'b',
        Color::Magenta => 'm',
        Color::Cyan => 'c',
        _ if cell.modifier.contains(Modifier::REVERSED) => '#',
        _ if cell.modifier.contains(Modifier::BOLD) => '+',
        _ if cell.modifier.contains(Modifier::UNDERLINED) => '_',
        _ if cell.modifier.contains(Modifier::DIM) => ',',
        _ => ' ',
    };
    let blank = cell.symbol() == " " && !cell.modifier.contains(Modifier::REVERSED);
    match (blank, cell.modifier.contains(Modifier::BOLD)) {
        (true, _) => ' ',
        (false, true) => letter.to_ascii_uppercase(),
        (false, false) => letter,
    }
}

pub fn check(name: &str, app: &App) {
    check_frame(name, frame(app));
}

pub fn check_frame(name: &str, seen: String) {
    let path = PathBuf::from(env!("CARGO_MANIFEST_DIR")).join("tests/frames").join(format!("{name}.txt"));
    if std::env::var_os("UPDATE").is_some() {
        return fs::write(path, seen).expect("the frame is written");
    }
    let wanted = fs::read_to_string(&path).unwrap_or_default();
    assert!(seen == wanted, "{name} differs; UPDATE=1 writes it anew:\n{seen}\nwas:\n{wanted}");
}

const ALL_SIZES: [(u16, u16); 5] = [(80, 24), (120, 40), (80, 12), (40, 24), (200, 60)];
/// Those that tell most.
pub const SIZES: [(u16, u16); 3] = [(80, 24), (120, 40), (40, 24)];

pub fn check_at(sizes: &[(u16, u16)], name: &str, story: &Story, keys: &str) {
    for &(width, height) in sizes {
        let mut app = screen(width, height, story);
        press(&mut app, keys);
        check(&format!("{name}_{width}x{height}"), &app);
    }
}

#[test]
fn searching() {
    check_at(&ALL_SIZES, "searching", &Story::searching(), "Down Down Down");
}

#[test]
fn the_outer_machine() {
    check_at(&ALL_SIZES, "outer", &Story::searching(), "Down");
}

#[test]
fn with_a_fault() {
    let mut story = Story::searching();
    story.at(81).fault("attempt to index a nil value (field 'range')", "follower/looking/lookalgo/lookright", 19, 12);
    story.tell(What::Pause { reason: "error in lookright".into(), at: None });
    check_at(&ALL_SIZES, "fault", &story, "4 i");
}

#[test]
fn with_a_rejected_edit() {
    let mut story = Story::searching();
    story.at(81).reject(&[("this `(` is never closed", "line_follower.lrp", 15)]);
    check_at(&ALL_SIZES, "rejected", &story, "");
}

#[test]
fn with_findings_of_other_files() {
    let mut story = Story::searching();
    let world = [("`lines` is no word of a world", "worlds/curve.world", 4), ("the file is gone", "lib/turn.lua", 0)];
    story.at(81).reject(&world).fault("it broke", "follower/moving", 9, 1);
    check_one("elsewhere_80x24", &story, "");
    check("elsewhere_20x8", &screen(20, 8, &story));
}

#[test]
fn a_program_that_is_broken_from_the_start() {
    let mut story = Story::new();
    story.reject(&[("this `(` is never closed", "line_follower.lrp", 15)]);
    check_one("broken_80x24", &story, "");
}

#[test]
fn what_is_no_longer_sent_is_not_shown() {
    let mut story = Story::searching();
    assert!(frame(&screen(120, 40, &story)).contains("→move  angular.z -0.80"));
    story.at(95).set("lightlim", json!(5), "follower");
    assert!(frame(&screen(120, 40, &story)).contains("→move  –"));
}

#[test]
fn a_transition_tells_what_its_condition_saw() {
    let mut story = Story::searching();
    story.at(90).input("light", json!({ "data": 90 }));
    story.take("follower", "follower/looking", "follower/moving", Some("tmoving"), "intheline", 1);
    check_one("why_80x24", &story, "4 Down i");
    check_one("came_from_80x24", &story, "Down i");
}

#[test]
fn of_several_sources_the_one_left_is_heavy() {
    let text = "(machine m (state a) (state b) (state d) (state c) (on go (a b) -> c) (event go [true])) (spawn m a)";
    let heavy = |from: &str| {
        let mut story = Story::new();
        story.load(&program(text), &[]).spawn("m", None).enter(from).take("m", from, "m/c", None, "go", 0);
        frame(&screen(80, 24, &story)).chars().filter(|c| "━┃┏┓┗┛".contains(*c)).count()
    };
    assert!(heavy("m/a") > 0 && heavy("m/b") > 0);
    assert_ne!(heavy("m/a"), heavy("m/b"), "the lines differ in length");
    assert_eq!(heavy("m/c"), 0, "it doesn't lead out of c");
}

fn check_one(name: &str, story: &Story, keys: &str) {
    let mut app = screen(80, 24, story);
    press(&mut app, keys);
    check(name, &app);
}

#[test]
fn the_help() {
    check_at(&[(80, 24), (120, 40), (40, 24)], "help", &Story::searching(), "?");
    check_at(&[(40, 24)], "help_variables", &Story::searching(), "3 ?");
    check_at(&[(80, 24), (40, 24)], "help_search", &Story::searching(), "? / b r e a k");
}

#[test]
fn the_help_is_gone_through_and_searched() {
    let mut app = screen(40, 24, &Story::searching());
    press(&mut app, "3 ?");
    let mut seen = frame(&app);
    for _ in 0..12 {
        press(&mut app, "PgDn");
        seen += &frame(&app);
    }
    for entry in TABLE {
        for word in entry.help.split(' ') {
            assert!(seen.contains(word), "{}: {word}", entry.id);
        }
    }
    press(&mut app, "/ v a l u e Enter");
    assert!(matches!(app.overlay(), Overlay::Help(help) if help.search.value() == "value"));
    assert!(frame(&app).contains("type a value"), "{}", frame(&app));
    press(&mut app, "/ Esc");
    assert!(matches!(app.overlay(), Overlay::Help(help) if help.search.value().is_empty()));
    press(&mut app, "/ x q x q");
    assert!(frame(&app).contains("No action has this"));
    press(&mut app, "Esc Esc");
    assert!(matches!(app.overlay(), Overlay::Nothing));
}

#[test]
fn the_world_in_place_of_the_drawing() {
    check_one("world_80x24", &Story::searching(), "w");
    let mut app = screen(80, 12, &Story::searching());
    press(&mut app, "w");
    check("world_80x12", &app);
}

#[test]
fn an_active_state_out_of_sight_is_named() {
    let mut story = Story::searching();
    story.at(90).take("follower", "follower/looking", "follower/bumpturn", None, "ontime", 5);
    let app = screen(80, 12, &story);
    check("out_of_sight_80x12", &app);
}

#[test]
fn a_value_being_typed() {
    check_one("typing_80x24", &Story::searching(), "3 Down Down e");
}

#[test]
fn a_value_that_was_set() {
    let mut story = Story::searching();
    story.at(82).set("lightlim", json!(148), "command");
    check_one("set_80x24", &story, "3 Down Down i");
}

#[test]
fn a_state_inspected() {
    check_one("inspect_80x24", &Story::searching(), "Down Down i");
}

#[test]
fn the_robot_stopped_and_lost() {
    let mut story = Story::searching();
    story.at(90).tell(What::Command { command: Command::Runstop });
    story.tell(What::Pause { reason: "runstop".into(), at: None });
    story.tell(What::Bridge(BridgeState {
        bridge: "robot".into(),
        kind: "sim".into(),
        state: Health::Lost,
        message: Some("no answer for 2 s".into()),
        world: None,
    }));
    check_one("stopped_80x24", &story, "");
}

#[test]
fn a_robot_that_is_lost() {
    let mut story = Story::searching();
    story.at(90).tell(What::Bridge(BridgeState {
        bridge: "robot".into(),
        kind: "sim".into(),
        state: Health::Lost,
        message: Some("no answer for 2 s".into()),
        world: None,
    }));
    check_at(&ALL_SIZES, "lost", &story, "");
}

#[test]
fn a_screen_with_hardly_any_room() {
    for (width, height) in [(20, 5), (19, 5), (30, 8)] {
        check(&format!("tiny_{width}x{height}"), &screen(width, height, &Story::searching()));
    }
}

#[test]
fn an_edit_that_restarts() {
    let mut story = Story::searching();
    let changes = [(Op::Added, Element::State, "follower/a"), (Op::Added, Element::State, "follower/b")];
    story.at(90).load(&program(LINE_FOLLOWER), &changes);
    check_one("edited_80x24", &story, "Down Down z");
}

#[test]
fn weight_alone_tells_without_colours() {
    let settings = Settings { theme: Theme::of(Palette::Mono), ..Settings::default() };
    check("plain_80x24", &screen_with(settings, Size::new(80, 24), &Story::searching()));
}

#[test]
fn ascii_is_enough() {
    let settings = Settings { charset: Charset::Ascii, ..Settings::default() };
    for (name, width, height) in [("ascii_80x24", 80, 24), ("ascii_40x24", 40, 24), ("ascii_200x60", 200, 60)] {
        check(name, &screen_with(settings.clone(), Size::new(width, height), &Story::searching()));
    }
}

#[test]
fn light_ground_has_colours_of_its_own() {
    let settings = Settings { theme: Theme::of(Palette::Light), ..Settings::default() };
    check("light_80x24", &screen_with(settings, Size::new(80, 24), &Story::searching()));
}

#[test]
fn an_empty_program() {
    check_at(&ALL_SIZES, "empty", &Story::new(), "");
}

/// What a story goes on with, from a step on, reaches a screen that has seen its beginning.
pub fn go_on(app: &mut App, step: u64, tell: impl FnOnce(&mut Story)) {
    let mut story = Story::new();
    tell(story.at(step));
    story.records.iter().for_each(|record| app.record(record));
}
