//! Where panes stand: on screens of every size, hidden, resized, alone; and the pane of the program's text.

use std::collections::BTreeSet;

use lrp::runtime::command::{BreakAt, Command};
use lrp::runtime::record::{Breakpoint, Setter, What};
use lrp::ui::app::{App, Effect, Event};
use lrp::ui::layout::{Chosen, Extent, Figure, Layout, Pane, Simulated, Wish};
use proptest::prelude::*;
use ratatui::layout::{Position, Rect, Size};

use crate::frames::{SIZES, check, check_at, frame, go_on, press, screen};
use crate::story::{LINE_FOLLOWER, Story, program};

fn wishes() -> impl Strategy<Value = (Pane, Figure, Simulated, usize)> {
    (
        prop::sample::select(Pane::ALL.to_vec()),
        prop::sample::select(vec![Figure::Graph, Figure::World, Figure::Detail, Figure::Source, Figure::Bridge]),
        prop::sample::select(vec![Simulated::Nothing, Simulated::World]),
        0usize..60,
    )
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(512))]

    /// Every cell belongs to one pane, or is between panes; what is hidden is nowhere.
    #[test]
    fn panes_and_rules_fill_every_screen(
        (focus, figure, simulated, tree) in wishes(),
        mut hidden in prop::collection::btree_set(prop::sample::select(Pane::ALL.to_vec()), 0..5),
        moves in prop::collection::vec((0usize..8, -300i32..300), 0..6),
        width in 20u16..260,
        height in 5u16..90,
    ) {
        hidden.remove(&focus);
        let mut chosen = Chosen::default();
        hidden.iter().for_each(|&pane| chosen.hide(pane));
        let area = Rect::new(0, 0, width, height);
        let place = |chosen: &Chosen| {
            let wish = Wish { focus, figure, extent: Extent::Shared, simulated, tree, chosen };
            Layout::new(area, wish).expect("room")
        };
        for (border, to) in moves {
            let layout = place(&chosen);
            layout.borders.get(border).into_iter().for_each(|border| chosen.move_border(border, to));
        }
        let layout = place(&chosen);
        prop_assert!(layout.panes.iter().all(|(pane, _)| !hidden.contains(pane)));
        let seen: BTreeSet<Pane> = layout.panes.iter().map(|&(pane, _)| pane).collect();
        prop_assert_eq!(seen.len(), layout.panes.len(), "each once");
        if !layout.panes.is_empty() {
            for at in Rect::new(0, 1, width, height - 2).positions() {
                let panes = layout.panes.iter().filter(|(_, area)| area.contains(at)).count();
                let rules = layout.rules().filter(|rule| rule.contains(at)).count();
                prop_assert_eq!(panes + rules, 1, "{} in {:?}", at, layout);
            }
        }
    }
}

#[test]
fn every_pane_has_a_place_and_its_title_is_seen() {
    for (width, height) in [(80, 24), (120, 40), (80, 12), (40, 24), (200, 60), (160, 30), (120, 24), (20, 5)] {
        for key in ["1", "2", "3", "4", "5", "6"] {
            let mut app = screen(width, height, &Story::searching());
            press(&mut app, key);
            let layout = app.layout(Rect::new(0, 0, width, height)).expect("room");
            let area = layout.area(app.focus()).unwrap_or_else(|| panic!("{key} in {width}x{height}"));
            assert!(area.height >= 2 && area.width >= 10, "{key} in {width}x{height}: {area}");
        }
    }
}

#[test]
fn the_text_joins_where_there_is_room_and_comes_by_a_key_elsewhere() {
    check_at(&[(80, 24), (120, 40), (80, 12), (40, 24), (160, 30)], "source", &Story::searching(), "Down Down Down 6");
    for (width, height) in [(80, 24), (80, 12), (40, 24)] {
        let mut app = screen(width, height, &Story::searching());
        let before = frame(&app);
        assert!(!before.contains("source  line"));
        press(&mut app, "c");
        assert!(frame(&app).contains("source  line"), "{width}x{height}");
        press(&mut app, "c");
        assert_eq!(frame(&app), before, "{width}x{height}");
    }
    assert!(frame(&screen(120, 40, &Story::searching())).contains("source  line_follower.lrp"));
}

#[test]
fn a_person_goes_through_the_text_and_selects_what_is_written() {
    let mut app = screen(120, 40, &Story::searching());
    press(&mut app, "6 Home");
    let selected = |app: &App| app.selected().map(|path| path.to_string());
    press(&mut app, "Down");
    assert_eq!(app.selected_value().map(|path| &**path), Some("lightlim"));
    let to = press(&mut app, "Down Down Down Down Down Down Down t");
    assert_eq!(to, [Effect::Command(Command::TransitionTo { state: "follower/moving".into() })]);
    assert_eq!(selected(&app).as_deref(), Some("follower/moving"));
    let at = |effects: Vec<Effect>| match &effects[..] {
        [Effect::Command(Command::Break { at, .. })] => at.to_string(),
        other => format!("{other:?}"),
    };
    assert_eq!(at(press(&mut app, "B")), "state follower/moving");
    let effects = press(&mut app, "Down B");
    assert!(at(effects).contains("tlooking"));
    assert_eq!(
        press(&mut app, "Enter"),
        [Effect::OpenEditor { file: "line_follower.lrp".into(), line: 10, column: 1 }]
    );
    press(&mut app, "End Up Up");
    assert_eq!(selected(&app).as_deref(), Some("follower/end"));
    press(&mut app, "1 Up");
    assert_eq!(selected(&app).as_deref(), Some("follower/bumpturn"), "the tree goes on from there");
    assert!(frame(&app).contains("▸ 35 "), "and the text along");
}

#[test]
fn what_is_wrong_stands_in_its_place() {
    let mut story = Story::searching();
    story.at(81).fault("attempt to index a nil value (field 'range')", "follower/looking/lookalgo/lookright", 19, 12);
    story.fault("it broke", "follower/moving", 9, 1);
    let at = |state: &str| BreakAt::State { state: state.into() };
    story.tell(What::Breakpoints {
        all: vec![
            Breakpoint { at: at("follower/bumpback"), by: Setter::Command },
            Breakpoint { at: at("follower/looking"), by: Setter::Source },
        ],
    });
    check_at(&SIZES, "source_problems", &story, "6 z Home Down Down Down Down Down Down Down Down");
}

#[test]
fn the_text_shows_tabs_long_lines_and_wide_characters() {
    let text = "(var x := [0]) ; ünïcödé 漢字 and a comment that goes on for longer than the pane is wide, by a good deal indeed\n\
                (machine m\n\t(state a\n\t\t(running [if x > 1 then x = 'one' -- Lua\n\t\tend]))\n\t(eps a -> b) (ontime 5 b -> a) (state b))\n\
                (spawn m a)\n";
    let mut story = Story::new();
    story.load(&program(text), &[]).spawn("m", None).enter("m/b");
    check_at(&[(80, 24)], "source_text", &story, "6 z");
    let mut app = screen(80, 24, &story);
    press(&mut app, "6 z Home Right Right Right");
    check("source_text_right_80x24", &app);
    press(&mut app, "l l l l l l l l l l l l l l l l l l l l l l l h h h h h h h h h h h h h h h h h h h h h h h");
    assert!(frame(&app).contains("(machine m"));
}

#[test]
fn the_text_follows_what_happens() {
    let mut app = screen(120, 40, &Story::searching());
    press(&mut app, "f");
    go_on(&mut app, 90, |story| _ = story.enter("follower/bumpback"));
    assert!(frame(&app).contains("▸ 32●"), "{}", frame(&app));
}

#[test]
fn imported_text_is_shown_where_the_selection_is_in_it() {
    use lrp::session::compile::Compiler;
    use lrp::syntax::Source;
    let shelf = crate::shelf::Shelf::of(vec![("arm.lrp".into(), "(machine arm\n  (state up))\n(export arm)\n".into())]);
    let mut compiler = Compiler::new(Vec::new()).with_files(shelf);
    let text = "(import \"arm.lrp\")\n(machine m (state a))\n(spawn m a)\n(spawn arm up)\n";
    let program = compiler.compile(Source::new("line_follower.lrp", text)).unwrap_or_else(|_| panic!("it compiles"));
    let mut story = Story::new();
    story.load(&program.into(), &[]).spawn("m", None).enter("m/a").spawn("arm", None).enter("arm/up");
    let mut app = screen(120, 40, &story);
    assert!(frame(&app).contains("source  line_follower.lrp"));
    press(&mut app, "End");
    assert!(frame(&app).contains("source  arm.lrp") && frame(&app).contains("▸ 2●   (state up))"), "{}", frame(&app));
}

/// Running, paused, with something wrong, with an edit that waits.
#[test]
fn layouts_in_each_state_of_the_program() {
    const SIZES: [(u16, u16); 3] = [(160, 30), (110, 30), (20, 5)];
    check_at(&SIZES, "running", &Story::searching(), "");
    let mut story = Story::searching();
    story
        .at(82)
        .tell(What::Pause { reason: "breakpoint: state follower/looking".into(), at: Some("follower/looking".into()) });
    check_at(&SIZES, "stopped_at", &story, "");
    let mut story = Story::searching();
    story.at(82).fault("it broke", "follower/looking/lookalgo/lookright", 19, 1);
    check_at(&SIZES, "went_wrong", &story, "");
    let mut story = Story::searching();
    story.at(82).tell(crate::edits_on_screen::held(None));
    check_at(&SIZES, "waits", &story, "");
}

#[test]
fn panes_are_hidden_and_shown_again() {
    let mut app = screen(120, 40, &Story::searching());
    let before = frame(&app);
    press(&mut app, "5 x");
    assert_eq!(app.message(), Some("world is hidden; 0 shows all panes again"));
    assert!(!frame(&app).contains("curve ─"));
    press(&mut app, "6 x 4 x");
    check("hidden_120x40", &app);
    let mut tabs = BTreeSet::new();
    for _ in 0..9 {
        press(&mut app, "Tab");
        tabs.insert(app.focus());
    }
    assert_eq!(tabs, BTreeSet::from([Pane::Machines, Pane::Graph, Pane::Variables]));
    app.event(Event::Resize(Size::new(80, 24)));
    assert!(!frame(&app).contains("─ log"), "hidden at every size");
    app.event(Event::Resize(Size::new(120, 40)));
    press(&mut app, "4");
    assert!(frame(&app).contains("─ log"), "its key shows it again");
    press(&mut app, "0 1 Esc Esc");
    let after = frame(&app);
    assert!(after == before, "{after}\nwas\n{before}");
}

#[test]
fn the_last_pane_stays() {
    for (width, height) in [(80, 24), (120, 40), (200, 60), (40, 24), (80, 12), (30, 8)] {
        let mut app = screen(width, height, &Story::searching());
        for _ in 0..12 {
            press(&mut app, "x");
            let layout = app.layout(Rect::new(0, 0, width, height)).expect("room");
            assert!(layout.area(app.focus()).is_some(), "{width}x{height}\n{}", frame(&app));
        }
        assert_eq!(app.message(), Some("the last pane stays"), "{width}x{height}");
    }
}

#[test]
fn keys_resize_the_focused_pane() {
    let area = |app: &App, pane| {
        let Size { width, height } = app.options().size;
        app.layout(Rect::new(0, 0, width, height)).and_then(|layout| layout.area(pane)).expect("a pane")
    };
    let mut app = screen(120, 40, &Story::searching());
    for pane in ["1", "2", "3", "4", "5", "6"] {
        for (grow, shrink) in [("]", "["), ("}", "{"), ("Alt-Right", "Alt-Left"), ("Alt-Down", "Alt-Up")] {
            press(&mut app, pane);
            let before = area(&app, app.focus());
            press(&mut app, grow);
            let after = area(&app, app.focus());
            assert!(after.width > before.width || after.height > before.height, "{pane} {grow}");
            press(&mut app, shrink);
            assert_eq!(area(&app, app.focus()), before, "{pane} {shrink}");
        }
    }
    press(&mut app, "1 z ]");
    assert_eq!(app.message(), Some("there is nothing beside it to take room from"));
    press(&mut app, "z ] ] ] } }");
    check("resized_120x40", &app);
    let held = area(&app, Pane::Machines);
    app.event(Event::Resize(Size::new(80, 24)));
    app.event(Event::Resize(Size::new(120, 40)));
    assert_eq!(area(&app, Pane::Machines), held);
    press(&mut app, "0");
    assert!(area(&app, Pane::Machines).width < held.width);
}

#[test]
fn words_are_found_in_the_text_and_round_its_end() {
    let mut app = screen(120, 40, &Story::searching());
    let at = |app: &App| app.text_line().map(|at| at.line);
    press(&mut app, "6 Home / O n t I m e Enter");
    assert_eq!(at(&app), Some(23));
    press(&mut app, "n n n");
    assert_eq!(at(&app), Some(26));
    press(&mut app, "n");
    assert_eq!(at(&app), Some(37));
    press(&mut app, "n n");
    assert_eq!(at(&app), Some(23), "from the end to the beginning");
    press(&mut app, "N");
    assert_eq!(at(&app), Some(38));
    assert_eq!(press(&mut app, "/ ? ? Enter"), []);
    assert_eq!((app.message(), at(&app)), (Some("`??` isn't in this text"), Some(38)));
    press(&mut app, "/ Esc n");
    assert_eq!(at(&app), Some(38), "the same words");
    let mut app = screen(120, 40, &Story::searching());
    press(&mut app, "6 n");
    assert_eq!(app.message(), Some("nothing is looked for yet"));
}

#[test]
fn nothing_of_the_text_is_missed() {
    let mut app = screen(120, 40, &Story::searching());
    press(&mut app, "6 z Home");
    let mut seen = String::new();
    for _ in 0..3 {
        seen += &frame(&app);
        press(&mut app, "PgDn");
    }
    for line in LINE_FOLLOWER.lines() {
        assert!(seen.contains(line.trim_end()), "{line}");
    }
    assert!(app.layout(Rect::new(0, 0, 120, 40)).is_some_and(|layout| layout.pane_at(Position::new(60, 20)).is_some()));
}

/// What isn't taken over is shown as it was saved, with what is wrong; what runs is marked as far as its lines are there.
#[test]
fn a_text_that_is_not_taken_over_is_shown_with_what_is_wrong() {
    let text = LINE_FOLLOWER.replace("(event outofline [", "; lost\n  (event outofline ");
    let mut story = Story::searching();
    story.at(81).refuse(&text);
    check_at(&SIZES, "refused_text", &story, "Down Down 6");
    let mut app = screen(120, 40, &story);
    press(&mut app, "6 Home PgDn Down Down Down Down");
    assert_eq!(app.selected().map(|path| &**path), Some("follower/looking"), "its line has moved by one");
    assert!(frame(&app).contains("▸ 15●   (state looking"), "{}", frame(&app));
    go_on(&mut app, 90, |story| {
        let text = LINE_FOLLOWER.replace("(event outofline [", "; lost\n  (event outofline [");
        story.load(&program(&text), &[]);
    });
    assert!(!frame(&app).contains("lrp  not taken over") && frame(&app).contains("▸ 15●   (state looking"));
}

#[test]
fn a_program_that_never_ran_is_shown_with_what_keeps_it_from_running() {
    let mut story = Story::new();
    story.refuse(&LINE_FOLLOWER.replacen("(machine lookalgo", "(machine lookalgo (", 1));
    check_at(&[(120, 40)], "broken_text", &story, "");
    let mut app = screen(80, 24, &story);
    press(&mut app, "c Down Down");
    assert!(frame(&app).contains("(machine lookalgo ("), "{}", frame(&app));
}

#[test]
fn lines_are_found_again_around_a_change() {
    use lrp::syntax::Source;
    use lrp::ui::alignment::Alignment;
    let (first, second) = (Source::new("a", "1\n2\n3\n4\n5"), Source::new("b", "1\n2\nx\ny\n4\n5"));
    let alignment = Alignment::of(&first, &second);
    let there: Vec<_> = (1..=5).map(|line| alignment.second(line)).collect();
    assert_eq!(there, [Some(1), Some(2), None, Some(5), Some(6)]);
    let back: Vec<_> = (1..=6).map(|line| alignment.first(line)).collect();
    assert_eq!(back, [Some(1), Some(2), None, None, Some(4), Some(5)]);
    let same = Alignment::of(&first, &first);
    assert!((1..=5).all(|line| same.second(line) == Some(line)));
    assert_eq!(same.second(6), None);
}
