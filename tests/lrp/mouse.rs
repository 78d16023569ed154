//! The mouse, as clicks on what is seen: it does what keys do, and nothing besides.

use std::time::{Duration, Instant};

use crossterm::event::{KeyModifiers, MouseButton, MouseEvent, MouseEventKind};
use lrp::runtime::command::{BreakAt, Breaking, Command};
use lrp::runtime::record::{Element, Op, What};
use lrp::ui::action::{self, Action};
use lrp::ui::app::{App, Effect, Event, Overlay};
use lrp::ui::layout::Pane;
use lrp::ui::pointer::{Gesture, Hand, Mouse, Pointer};
use ratatui::buffer::Buffer;
use ratatui::layout::{Position, Rect, Size};

use crate::frames::{check, go_on, press, screen};
use crate::story::{LINE_FOLLOWER, Story, program};

fn searching() -> App {
    screen(120, 40, &Story::searching())
}

pub fn point(app: &mut App, gesture: Gesture, at: Position) -> Vec<Effect> {
    app.event(Event::Pointer(Pointer { at, gesture }))
}

fn painted(app: &App) -> Buffer {
    let Size { width, height } = app.options().size;
    let area = Rect::new(0, 0, width, height);
    let mut buffer = Buffer::empty(area);
    app.paint(area, &mut buffer);
    buffer
}

fn area(app: &App, pane: Pane) -> Rect {
    let Size { width, height } = app.options().size;
    app.layout(Rect::new(0, 0, width, height)).and_then(|layout| layout.area(pane)).expect("the pane is seen")
}

/// The first cell of a text in a part of the screen.
fn place(app: &App, part: Rect, text: &str) -> Position {
    let buffer = painted(app);
    let length = text.chars().count() as u16;
    let starts = |at: &Position| {
        at.x + length <= part.right()
            && (at.x..at.x + length).map(|x| buffer[(x, at.y)].symbol()).collect::<String>() == text
    };
    part.positions().find(starts).unwrap_or_else(|| panic!("{text} is not in\n{}", crate::frames::frame(app)))
}

fn click(app: &mut App, pane: Pane, text: &str) -> Vec<Effect> {
    let at = place(app, area(app, pane), text);
    point(app, Gesture::Click, at)
}

/// Opens the menu of a thing and takes one of its rows.
fn choose(app: &mut App, pane: Pane, text: &str, row: &str) -> Vec<Effect> {
    let at = place(app, area(app, pane), text);
    assert!(point(app, Gesture::RightClick, at).is_empty());
    let at = place(app, painted(app).area, row);
    point(app, Gesture::Click, at)
}

fn command(command: Command) -> Vec<Effect> {
    vec![Effect::Command(command)]
}

fn selected(app: &App) -> &str {
    app.selected().map_or("", |path| path)
}

#[test]
fn a_click_takes_the_focus_and_selects() {
    let mut app = searching();
    click(&mut app, Pane::Machines, "bumpback");
    assert_eq!((app.focus(), selected(&app)), (Pane::Machines, "follower/bumpback"));
    click(&mut app, Pane::Variables, "maxlook");
    assert_eq!((app.focus(), app.selected_value().map(|path| &**path)), (Pane::Variables, Some("maxlook")));
    click(&mut app, Pane::Log, "returnleft");
    assert_eq!(app.focus(), Pane::Log);
    assert!(crate::frames::frame(&app).contains("▸0:08.0  returnleft → lookright"));
    click(&mut app, Pane::Graph, "bumpturn");
    assert_eq!((app.focus(), selected(&app)), (Pane::Graph, "follower/bumpturn"));
    click(&mut app, Pane::Source, "state end");
    assert_eq!((app.focus(), selected(&app)), (Pane::Source, "follower/end"));
    click(&mut app, Pane::World, "⡇");
    assert_eq!((app.focus(), selected(&app)), (Pane::World, "follower/end"));
}

#[test]
fn every_state_has_its_menu_wherever_it_is_seen() {
    for (pane, text) in [(Pane::Machines, "bumpturn"), (Pane::Graph, "bumpturn"), (Pane::Source, "state bumpturn")] {
        let state = || String::from("follower/bumpturn");
        let mut app = searching();
        press(&mut app, "6 End Home");
        if pane == Pane::Source {
            press(&mut app, "PgDn PgDn PgDn");
        }
        let to = choose(&mut app, pane, text, "go to the selected state");
        assert_eq!(to, command(Command::TransitionTo { state: state() }), "{pane:?}");
        let to = choose(&mut app, pane, text, "jump to the selected state");
        assert_eq!(to, command(Command::JumpTo { state: state() }));
        let at = BreakAt::State { state: "follower/bumpturn".into() };
        let to = choose(&mut app, pane, text, "pause at what is selected");
        assert_eq!(to, command(Command::Break { at, mode: Breaking::Set }));
        let to = choose(&mut app, pane, text, "open your editor");
        assert!(matches!(&to[..], [Effect::OpenEditor { line: 35, .. }]), "{to:?} in {pane:?}");
        choose(&mut app, pane, text, "why not");
        assert!(crate::frames::frame(&app).contains("─ detail ─"), "{pane:?}");
    }
}

#[test]
fn a_variable_has_its_menu() {
    let mut app = searching();
    choose(&mut app, Pane::Variables, "maxlook", "type a value");
    assert!(matches!(app.overlay(), Overlay::Typing(_)));
    press(&mut app, "1 Enter");
    let at = place(&app, area(&app, Pane::Variables), "maxlook");
    point(&mut app, Gesture::RightClick, at);
    check("variable_menu_120x40", &app);
    press(&mut app, "Esc");
    go_on(&mut app, 90, |story| _ = story.set("maxlook", 1.into(), "command"));
    assert!(matches!(&choose(&mut app, Pane::Variables, "maxlook", "into the file")[..], [Effect::WriteBack(_)]));
    let reset = choose(&mut app, Pane::Variables, "maxlook", "the initial value again");
    assert_eq!(reset, command(Command::Reset { var: "maxlook".into() }));
    choose(&mut app, Pane::Variables, "maxlook", "keep it on top");
    assert_eq!(app.arrangement().pinned.len(), 1);
    let at = place(&app, area(&app, Pane::Variables), "pose");
    point(&mut app, Gesture::RightClick, at);
    assert!(!crate::frames::frame(&app).contains("type a value"), "it comes from the robot");
}

#[test]
fn a_transition_is_taken_hold_of_in_the_drawing_and_in_the_text() {
    for (pane, text) in [(Pane::Graph, "tlooking"), (Pane::Source, "outofline moving")] {
        let mut app = searching();
        press(&mut app, "Up Up Up Up Up Up");
        let effects = choose(&mut app, pane, text, "pause at what is selected");
        let [Effect::Command(Command::Break { at: BreakAt::Transition { transition }, .. })] = &effects[..] else {
            panic!("{effects:?}")
        };
        assert!(transition.ends_with("tlooking"), "{transition} in {pane:?}");
    }
}

#[test]
fn menus_work_by_keys() {
    let mut app = searching();
    press(&mut app, "Down Down a");
    check("state_menu_120x40", &app);
    press(&mut app, "Down");
    assert_eq!(press(&mut app, "Enter"), command(Command::JumpTo { state: "follower/looking".into() }));
    assert!(matches!(app.overlay(), Overlay::Nothing));
    press(&mut app, "a");
    assert_eq!(press(&mut app, "t"), command(Command::TransitionTo { state: "follower/looking".into() }));
    press(&mut app, "a");
    assert_eq!(press(&mut app, "!"), command(Command::Runstop), "the robot is stopped from there, too");
    press(&mut app, "a Esc");
    assert!(matches!(app.overlay(), Overlay::Nothing));
    let mut app = screen(40, 24, &Story::searching());
    press(&mut app, "Down Down a");
    check("state_menu_40x24", &app);
    let mut app = screen(80, 24, &Story::new());
    press(&mut app, "a");
    assert_eq!(app.message(), Some("nothing is selected"));
}

#[test]
fn a_click_beside_a_menu_closes_it_and_does_nothing_else() {
    let mut app = searching();
    press(&mut app, "a");
    let before = selected(&app).to_owned();
    point(&mut app, Gesture::Click, Position::new(110, 35));
    assert!(matches!(app.overlay(), Overlay::Nothing));
    assert_eq!(selected(&app), before);
}

/// What is in menus is in the table, and nothing is there twice.
#[test]
fn menus_are_rows_of_the_table() {
    use lrp::ui::menu::Topic;
    for topic in [Topic::State, Topic::Machine, Topic::Transition, Topic::Variable, Topic::Carried, Topic::LogLine] {
        for (i, action) in topic.actions().iter().enumerate() {
            assert!(action::entry(*action).is_some(), "{action:?}");
            assert!(!topic.actions()[..i].contains(action), "{action:?} twice in {topic:?}");
        }
    }
}

#[test]
fn keys_in_the_footer_are_pressed() {
    let footer = |app: &App| Rect { y: app.options().size.height - 1, height: 1, ..painted(app).area };
    for (text, key) in [("space pause", "Space"), ("step", "s"), ("STOP", "!"), ("go to state", "t"), ("jump", "J")] {
        let mut app = searching();
        press(&mut app, "Down");
        let at = place(&app, footer(&app), text);
        let mut other = searching();
        assert_eq!(point(&mut app, Gesture::Click, at), press(&mut other, &format!("Down {key}")), "{text}");
    }
    let mut app = searching();
    let at = place(&app, footer(&app), "help");
    point(&mut app, Gesture::Click, at);
    assert!(matches!(app.overlay(), Overlay::Help { .. }));
    let at = place(&app, footer(&app), "back");
    point(&mut app, Gesture::Click, at);
    assert!(matches!(app.overlay(), Overlay::Nothing));
    press(&mut app, "3 Down e");
    let at = place(&app, footer(&app), "STOP");
    assert_eq!(point(&mut app, Gesture::Click, at), command(Command::Runstop), "also while typing");
    let at = place(&app, area(&app, Pane::Machines), "moving");
    point(&mut app, Gesture::Click, at);
    assert!(matches!(app.overlay(), Overlay::Typing(_)), "what is typed isn't lost by a click");
}

#[test]
fn a_double_click_is_enter() {
    let mut app = searching();
    let twice = |app: &mut App, pane, text: &str| {
        let at = place(app, area(app, pane), text);
        point(app, Gesture::Click, at);
        point(app, Gesture::DoubleClick, at)
    };
    twice(&mut app, Pane::Machines, "looking");
    assert_eq!(selected(&app), "follower/looking/lookalgo");
    twice(&mut app, Pane::Variables, "maxlook");
    assert!(matches!(app.overlay(), Overlay::Typing(_)));
    press(&mut app, "Esc");
    let open = twice(&mut app, Pane::Log, "third sweep");
    assert!(matches!(&open[..], [Effect::OpenEditor { line: 24, .. }]));
    let open = twice(&mut app, Pane::Source, "treturnleft");
    assert!(matches!(&open[..], [Effect::OpenEditor { line: 23, .. }]), "{open:?}");
}

#[test]
fn the_wheel_scrolls_what_is_under_it_and_selects_nothing() {
    let mut app = screen(120, 40, &Story::searching());
    let at = area(&app, Pane::Source).as_position();
    let first = |app: &App| {
        let frame = crate::frames::frame(app);
        let row = frame.lines().nth(usize::from(at.y) + 1).unwrap_or_default();
        row.split('│')
            .nth(1)
            .unwrap_or_default()
            .trim_start_matches('▸')
            .split_whitespace()
            .next()
            .unwrap_or("")
            .to_owned()
    };
    let before = first(&app);
    let inside = Position { x: at.x + 2, y: at.y + 2 };
    point(&mut app, Gesture::WheelDown, inside);
    assert_eq!((first(&app).parse::<u32>(), app.focus()), (before.parse::<u32>().map(|n| n + 3), Pane::Machines));
    point(&mut app, Gesture::WheelUp, inside);
    assert_eq!(first(&app), before);
    (0..40).for_each(|_| _ = point(&mut app, Gesture::WheelDown, inside));
    assert!(crate::frames::frame(&app).contains("(spawn follower looking)"));
    press(&mut app, "Down");
    assert!(crate::frames::frame(&app).contains("▸  9 "), "the selection is brought into sight again");
    let mut app = screen(80, 12, &Story::searching());
    let inside = area(&app, Pane::Machines).as_position() + ratatui::layout::Offset { x: 3, y: 3 };
    point(&mut app, Gesture::WheelDown, inside);
    assert_eq!((app.tree_top(), selected(&app)), (2, "follower"), "no further than to the last row");
}

#[test]
fn the_wheel_holds_the_log_and_lets_it_go() {
    let mut app = searching();
    let at = area(&app, Pane::Log).as_position() + ratatui::layout::Offset { x: 3, y: 3 };
    point(&mut app, Gesture::WheelDown, at);
    assert!(app.reading().place.is_some());
    (0..3).for_each(|_| _ = point(&mut app, Gesture::WheelUp, at));
    assert!(app.reading().place.is_none());
}

#[test]
fn borders_are_dragged_and_stay_where_they_were_put() {
    let mut app = searching();
    let (machines, source) = (area(&app, Pane::Machines), area(&app, Pane::Source));
    let rule = Position::new(machines.right(), 20);
    point(&mut app, Gesture::Click, rule);
    point(&mut app, Gesture::Drag, Position { x: rule.x + 10, ..rule });
    point(&mut app, Gesture::Release, Position { x: rule.x + 10, ..rule });
    assert_eq!(area(&app, Pane::Machines).width, machines.width + 10);
    let title = Position::new(source.x + 20, source.y);
    point(&mut app, Gesture::Click, title);
    assert_eq!(app.focus(), Pane::Source, "a click on a title takes the focus");
    point(&mut app, Gesture::Drag, Position { y: title.y - 5, ..title });
    point(&mut app, Gesture::Drag, Position { y: title.y - 6, ..title });
    point(&mut app, Gesture::Release, Position { y: title.y - 6, ..title });
    assert_eq!(area(&app, Pane::Source).y, source.y - 6);
    point(&mut app, Gesture::Drag, Position { y: title.y + 9, ..title });
    assert_eq!(area(&app, Pane::Source).y, source.y - 6, "it was let go");
    let before = (area(&app, Pane::Machines), area(&app, Pane::Source));
    for (width, height) in [(80, 24), (40, 24), (200, 60), (10, 3), (120, 40)] {
        app.event(Event::Resize(Size::new(width, height)));
    }
    assert_eq!((area(&app, Pane::Machines), area(&app, Pane::Source)), before);
    point(&mut app, Gesture::Click, Position::new(before.0.right(), 20));
    point(&mut app, Gesture::Drag, Position::new(0, 20));
    assert!(area(&app, Pane::Machines).width >= 8, "something is left of every pane");
}

#[test]
fn the_mouse_can_be_the_terminals() {
    let mut app = searching();
    assert_eq!(press(&mut app, "T"), [Effect::Mouse(Mouse::Terminals)]);
    assert_eq!(press(&mut app, "T"), [Effect::Mouse(Mouse::Ours)]);
}

#[test]
fn a_list_of_breakpoints_is_clicked() {
    let mut app = searching();
    go_on(&mut app, 90, |story| {
        let at = |state: &str| BreakAt::State { state: state.into() };
        let set = |at| lrp::runtime::record::Breakpoint { at, by: lrp::runtime::record::Setter::Command };
        story.tell(What::Breakpoints { all: vec![set(at("follower/moving")), set(at("follower/looking"))] });
    });
    press(&mut app, "D");
    let at = place(&app, painted(&app).area, "follower/looking");
    assert!(point(&mut app, Gesture::Click, at).is_empty());
    let clear = Command::Break { at: BreakAt::State { state: "follower/looking".into() }, mode: Breaking::Clear };
    assert_eq!(point(&mut app, Gesture::DoubleClick, at), command(clear));
}

#[test]
fn the_text_that_is_read_stays_through_an_edit() {
    let mut app = searching();
    press(&mut app, "Down Down Down Down");
    click(&mut app, Pane::Source, "state returnleft");
    let text = LINE_FOLLOWER.replace("(var search", "; turning\n(var search");
    go_on(&mut app, 90, |story| _ = story.load(&program(&text), &[(Op::Changed, Element::Variable, "search")]));
    assert_eq!(selected(&app), "follower/looking/lookalgo/returnleft");
    let frame = crate::frames::frame(&app);
    assert!(frame.lines().any(|line| line.contains("▸ 19 ") && line.contains("(state returnleft")), "{frame}");
}

#[test]
fn clicks_are_counted_by_place_and_time() {
    let mut hand = Hand::default();
    let begun = Instant::now();
    let mut at = |column: u16, ms: u64, kind| {
        let event = MouseEvent { kind, column, row: 1, modifiers: KeyModifiers::NONE };
        hand.read(event, begun + Duration::from_millis(ms)).map(|pointer| pointer.gesture)
    };
    let (down, up) = (MouseEventKind::Down(MouseButton::Left), MouseEventKind::Up(MouseButton::Left));
    assert_eq!(at(1, 0, down), Some(Gesture::Click));
    assert_eq!(at(1, 50, up), Some(Gesture::Release));
    assert_eq!(at(1, 200, down), Some(Gesture::DoubleClick));
    assert_eq!(at(1, 300, down), Some(Gesture::Click), "a third one begins anew");
    assert_eq!(at(2, 400, down), Some(Gesture::Click), "elsewhere");
    assert_eq!(at(2, 1000, down), Some(Gesture::Click), "too late");
    assert_eq!(at(2, 1100, MouseEventKind::ScrollDown), Some(Gesture::WheelDown));
    assert_eq!(at(2, 1200, down), Some(Gesture::Click), "the wheel came between");
    assert_eq!(at(2, 1300, MouseEventKind::Moved), None);
}

#[test]
fn every_action_of_a_menu_has_a_key() {
    assert!(action::entry(Action::Menu).is_some_and(|entry| entry.keys == ["a"]));
}
