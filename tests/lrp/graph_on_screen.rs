//! The drawn machine on the screen: what is shown of what happens, and what lies where.

use lrp::runtime::command::BreakAt;
use lrp::runtime::record::{Breakpoint, Setter, What};
use lrp::ui::app::{App, Event};
use lrp::ui::layout::Pane;
use lrp::ui::panes::graph::{self, Spot};
use lrp::ui::settings::Settings;
use lrp::ui::theme::{Palette, Theme};
use ratatui::buffer::Buffer;
use ratatui::layout::{Position, Rect, Size};
use ratatui::style::Modifier;

use crate::frames::{check_at, go_on, press, screen, screen_with};
use crate::story::{Story, program};
use crate::tracer::trace;

/// The whole screen, and where in it the graph is.
fn painted(app: &App) -> (Buffer, Rect) {
    let size = app.options().size;
    let area = Rect::new(0, 0, size.width, size.height);
    let mut buffer = Buffer::empty(area);
    app.paint(area, &mut buffer);
    (buffer, app.layout(area).and_then(|layout| layout.area(Pane::Graph)).expect("a graph"))
}

/// The cells of a text within an area, wherever it stands there.
fn places(buffer: &Buffer, area: Rect, text: &str) -> Vec<Position> {
    let length = text.chars().count() as u16;
    let is_there = |at: &Position| {
        let cells = (at.x..at.x + length).map(|x| buffer[(x, at.y)].symbol());
        at.x + length <= area.right() && cells.collect::<String>() == text
    };
    area.positions().filter(is_there).flat_map(|at| (at.x..at.x + length).map(move |x| Position { x, ..at })).collect()
}

#[test]
fn a_cell_of_the_drawing_tells_what_it_belongs_to() {
    for (width, height, keys) in [(80, 24, "Down"), (120, 40, ""), (80, 12, "2"), (40, 24, "2 G"), (50, 14, "2")] {
        let mut app = screen(width, height, &Story::searching());
        press(&mut app, keys);
        let (buffer, area) = painted(&app);
        let program = app.program().expect("a program");
        let inside = Rect { y: area.y + 1, height: area.height - 1, ..area };
        for at in area.positions() {
            let (symbol, spot) = (buffer[at].symbol(), graph::at(&app, area, at));
            assert!(symbol == " " || spot.is_some() || at.y == area.y, "{symbol:?} at {at}");
        }
        let name = |at| match graph::at(&app, area, at)? {
            Spot::Machine(machine) => Some(program[machine].name.to_string()),
            Spot::State(state) => Some(program[state].name.to_string()),
            Spot::Transition(id) => program[id].name.as_ref().map(|name| name.to_string()),
        };
        let mut found = 0;
        for text in ["moving", "looking", "bumpturn", "tmoving", "tlooking", "tend"] {
            for at in places(&buffer, inside, text).into_iter().filter(|at| name(*at).is_some()) {
                found += 1;
                assert!(name(at).is_some_and(|name| name.contains(text)), "{text} at {at} of {width}x{height}");
            }
        }
        assert!(found > 12, "{found} in {width}x{height}");
        assert_eq!(graph::at(&app, area, Position::new(area.x, area.y)), None);
        assert_eq!(graph::at(&app, area, Position::new(area.right(), area.bottom())), None);
    }
}

/// A machine called `m` of states `s0`, `s1` … that can all be told apart, each with named transitions to others.
fn machine(states: usize, ways: &[usize]) -> String {
    let mut text = String::from("(machine m (event e [true])\n");
    (0..states).for_each(|i| text += &format!("(state s{i}x)\n"));
    for (from, way) in (0..states).flat_map(|from| ways.iter().map(move |way| (from, way))) {
        let to = (from + way) % states;
        text += &format!("(on e s{from}x -> s{to}x from{from}to{to})\n");
    }
    text + ")\n(spawn m s0x)\n"
}

/// A program that begins in a state of `m`.
fn running(text: &str, state: &str) -> Story {
    let mut story = Story::new();
    story.load(&program(text), &[]).spawn("m", None).enter(&format!("m/{state}"));
    story
}

/// What stands in the pane, without its title and what it notes.
fn drawn(app: &App) -> String {
    let (buffer, area) = painted(app);
    let row = |y: u16| (area.x + 1..area.right()).map(|x| buffer[(x, y)].symbol().to_owned()).collect::<String>();
    (area.y + 1..area.bottom()).map(|y| row(y).trim_end().to_owned() + "\n").collect()
}

fn title(app: &App) -> String {
    let (buffer, area) = painted(app);
    (area.x..area.right()).map(|x| buffer[(x, area.y)].symbol().to_owned()).collect()
}

#[test]
fn a_machine_is_seen_from_far_and_near() {
    let full = [1, 2, 3, 4];
    let long = [1, 7];
    for (name, text) in [("five", machine(5, &full)), ("fifty", machine(50, &long))] {
        check_at(&[(80, 24), (200, 60)], name, &running(&text, "s1x"), "");
        check_at(&[(80, 24)], &format!("{name}_around"), &running(&text, "s1x"), "d d d 2");
    }
    let mut app = screen(80, 24, &running(&machine(5, &full), "s1x"));
    assert!(title(&app).contains("table"), "boxes would be 16 rows: {}", title(&app));
    press(&mut app, "d");
    assert!(!title(&app).contains("table") && app.message().is_some_and(|said| said.contains("boxes")));
    press(&mut app, "d d");
    assert!(title(&app).contains("around"), "{}", title(&app));
}

/// What a person reads on the screen is the machine, whichever way it is drawn.
#[test]
fn the_drawing_on_the_screen_is_read_as_it_is() {
    let text = machine(5, &[1, 2, 3, 4]);
    let mut story = Story::new();
    story.load(&program(&text), &[]);
    for (width, height) in [(80, 24), (120, 40), (100, 30), (200, 60)] {
        for keys in ["Down", "d z 2", "d d", "Down d d d", "Down Down d d d"] {
            let mut app = screen(width, height, &story);
            press(&mut app, keys);
            let text = drawn(&app).replace('█', "▌").lines().map(mended).collect::<String>();
            let seen = trace(text.trim_end()).unwrap_or_else(|why| panic!("{keys}: {why}\n{text}"));
            let around = title(&app).contains("around");
            assert_eq!(seen.edges.len(), if around { 8 } else { 20 }, "{keys}\n{text}");
            for (from, to, label) in seen.edges {
                let name = |state: &str| state.trim_matches(['s', 'x']).to_owned();
                assert_eq!(label, format!("from{}to{}", name(&from), name(&to)), "{keys}\n{text}");
            }
        }
    }
}

/// A row of the pane with the borders of the selected state as those of the others are.
fn mended(line: &str) -> String {
    let mut left = false;
    let border = |c: char| match c {
        '▌' => {
            left = !left;
            if left { '▌' } else { '▐' }
        }
        '▐' => {
            left = false;
            c
        }
        _ => c,
    };
    line.chars().map(border).collect::<String>() + "\n"
}

/// A drawing that just fits doesn't change its form to and fro with each edit.
#[test]
fn the_form_of_a_drawing_is_steady() {
    let mut app = screen(80, 24, &running(&machine(5, &[1]), "s1x"));
    let (_, area) = painted(&app);
    let mut forms = Vec::new();
    for states in [5, 6, 7, 8, 9, 8, 7, 6, 5, 4, 3] {
        go_on(&mut app, 9, |story| _ = story.load(&program(&machine(states, &[1])), &[]));
        forms.push((states, title(&app).contains("table")));
    }
    let change = forms.iter().position(|(_, table)| *table).expect("no table");
    let back = change + forms[change..].iter().position(|(_, table)| !table).expect("no boxes again");
    assert!(forms[back].0 < forms[change].0 - 1, "{forms:?} in {area}");
    assert!(forms[back..].iter().all(|(_, table)| !table), "{forms:?}");
}

#[test]
fn the_selected_state_stays_in_sight() {
    for keys in ["2 d", "2 d d", "2 d d d", "2"] {
        let mut app = screen(80, 24, &running(&machine(30, &[1, 5]), "s1x"));
        press(&mut app, keys);
        for (i, (width, height)) in
            [(80, 24), (120, 40), (64, 18), (40, 24), (80, 12), (200, 60), (80, 24)].into_iter().enumerate()
        {
            press(&mut app, ["PgDn", "Down", "End", "PgUp", "Home", "Down", "End"][i]);
            app.event(Event::Resize(Size::new(width, height)));
            let selected = app.selected().expect("a state").rsplit('/').next().expect("a name").to_owned();
            let (buffer, area) = painted(&app);
            assert!(!places(&buffer, area, &format!(" {selected} ")).is_empty(), "{selected} in {}", drawn(&app));
        }
    }
}

#[test]
fn a_drawing_is_moved_by_hand_until_something_else_is_selected() {
    let mut app = screen(80, 24, &running(&machine(30, &[1, 5]), "s1x"));
    press(&mut app, "2 d Down");
    let before = drawn(&app);
    press(&mut app, "Shift-Down Shift-Down");
    let moved = drawn(&app);
    assert!(before.contains(" s0x ") && !moved.contains(" s0x "), "{moved}");
    go_on(&mut app, 9, |story| _ = story.take("m", "m/s1x", "m/s2x", Some("from1to2"), "e", 1));
    assert_eq!(drawn(&app).contains(" s0x "), moved.contains(" s0x "));
    press(&mut app, "Shift-Up Shift-Up");
    assert_eq!(drawn(&app).lines().next(), before.lines().next());
    press(&mut app, "Shift-Down Shift-Down Shift-Down Down");
    let selected = app.selected().expect("a state").rsplit('/').next().expect("a name").to_owned();
    assert!(drawn(&app).contains(&format!(" {selected} ")));
}

/// Boxes are as wide as their lines need, whatever the pane; as it fits, there is a table.
#[test]
fn a_wide_drawing_is_moved_sideways() {
    let mut app = screen(40, 24, &running(&machine(12, &[1, 2, 3, 5, 7]), "s1x"));
    press(&mut app, "2");
    assert!(title(&app).contains("table"), "{}", title(&app));
    press(&mut app, "d Down");
    let seen = |app: &App| (drawn(app).contains("┐"), drawn(app).contains("┌"));
    press(&mut app, "Left Left Left Left Left Left Left Left Left");
    let left = (seen(&app), drawn(&app));
    press(&mut app, "Right Right Right Right Right Right Right Right Right Right");
    let right = (seen(&app), drawn(&app));
    assert!(left.0.1 && right.0.0 && left.1 != right.1, "{}\n{}", left.1, right.1);
    press(&mut app, "Down");
    assert!(drawn(&app).contains(" s1x "), "{}", drawn(&app));
}

/// What happens recolours the drawing and makes lines heavier: it moves nothing.
#[test]
fn nothing_moves_when_something_happens() {
    for keys in ["d", "d d", "Down d d d"] {
        let mut app = screen(80, 24, &running(&machine(5, &[1, 2]), "s0x"));
        press(&mut app, keys);
        let light = |app: &App| {
            let heavy = "━┃┅┇╍╏┏┓┗┛●┿╂";
            let plain = "─│┄┆╌╎┌┐└┘○┼┼";
            let pairs: Vec<(char, char)> = heavy.chars().zip(plain.chars()).collect();
            let swap = |c| pairs.iter().find(|(heavy, _)| *heavy == c).map_or(c, |(_, plain)| *plain);
            drawn(app).chars().map(swap).collect::<String>()
        };
        let before = light(&app);
        for step in 0..12 {
            let (from, to) = (format!("m/s{}x", step % 5), format!("m/s{}x", (step + 1) % 5));
            go_on(&mut app, step + 2, |story| _ = story.take("m", &from, &to, None, "e", 2 * (step as u32 % 5)));
            assert_eq!(light(&app), before, "{keys}, step {step}");
        }
    }
}

/// Transitions between two states of a machine of four, by their sources; in the end `s0x` is active.
fn taken(story: &mut Story, sources: &[u32]) {
    for from in sources {
        let (way, to) = if *from == 3 { (7, 1) } else { (3, 3) };
        story.take("m", &format!("m/s{from}x"), &format!("m/s{to}x"), None, "e", way);
        story.tell(What::Exit { state: format!("m/s{to}x").into() }).enter("m/s0x");
    }
}

/// Each of what may be so with a state or a transition shows, with colours and without.
#[test]
fn all_is_seen_without_colours() {
    let text = machine(4, &[1, 2]);
    let what = |state: &str| BreakAt::State { state: format!("m/{state}").into() };
    let break_at = |at: BreakAt| What::Breakpoints { all: vec![Breakpoint { at, by: Setter::Command }] };
    type Tell<'t> = Box<dyn Fn(&mut Story) + 't>;
    let tells: Vec<(&str, Tell)> = vec![
        ("", Box::new(|_: &mut Story| ())),
        (
            "another active",
            Box::new(|story: &mut Story| _ = story.tell(What::Exit { state: "m/s0x".into() }).enter("m/s2x")),
        ),
        ("an error", Box::new(|story: &mut Story| _ = story.fault("it broke", "m/s1x", 2, 1))),
        ("a breakpoint", Box::new(|story: &mut Story| _ = story.tell(break_at(what("s1x"))))),
        (
            "a breakpoint at a transition",
            Box::new(|story: &mut Story| {
                let transition = "m: on e s1x -> s2x from1to2".into();
                _ = story.tell(break_at(BreakAt::Transition { transition }));
            }),
        ),
        ("a transition", Box::new(|story: &mut Story| taken(story, &[3]))),
        ("two transitions", Box::new(|story: &mut Story| taken(story, &[1, 3]))),
    ];
    for (palette, keys) in
        [Palette::Mono, Palette::Dark].into_iter().flat_map(|it| [(it, "d"), (it, "d d"), (it, "d d d")])
    {
        let mut frames: Vec<(&str, Buffer)> = Vec::new();
        let settings = Settings { theme: Theme::of(palette), ..Settings::default() };
        for (name, tell) in &tells {
            let mut story = running(&text, "s0x");
            tell(&mut story);
            let mut app = screen_with(settings.clone(), Size::new(120, 50), &story);
            press(&mut app, &format!("Down Down {keys}"));
            let (buffer, area) = painted(&app);
            let mut part = Buffer::empty(area);
            area.positions().for_each(|at| part[at] = buffer[at].clone());
            if let Some((same, _)) = frames.iter().find(|(_, other)| *other == part) {
                panic!("{name} looks like {same} ({palette:?}, {keys})");
            }
            frames.push((name, part));
        }
    }
}

/// The transition taken last is heavy, those before it are bold for a while.
#[test]
fn what_was_taken_fades() {
    let mut app = screen(120, 40, &running(&machine(6, &[1, 2]), "s0x"));
    let weight = |app: &App, label: &str| {
        let (buffer, area) = painted(app);
        let at = places(&buffer, area, label)[0];
        (buffer[at].modifier.contains(Modifier::BOLD), drawn(app).contains('┃'))
    };
    for i in 0..6 {
        let (from, to) = (format!("m/s{i}x"), format!("m/s{}x", (i + 2) % 6));
        go_on(&mut app, i + 2, |story| _ = story.take("m", &from, &to, None, "e", 2 * i as u32 + 1));
        assert_eq!(weight(&app, &format!("from{i}to{}", (i + 2) % 6)), (true, true));
        if let Some(old) = i.checked_sub(2) {
            assert!(weight(&app, &format!("from{old}to{}", (old + 2) % 6)).0, "{old} after {i}");
        }
        if let Some(old) = i.checked_sub(3) {
            assert!(!weight(&app, &format!("from{old}to{}", (old + 2) % 6)).0, "{old} after {i}");
        }
    }
    // An edit that puts a transition before them leaves them as they are.
    let before = weight(&app, "from5to1");
    let text =
        machine(6, &[1, 2]).replace("(on e s0x -> s1x from0to1)", "(on e s5x -> s3x more) (on e s0x -> s1x from0to1)");
    go_on(&mut app, 20, |story| _ = story.load(&program(&text), &[]));
    assert_eq!((weight(&app, "from5to1"), weight(&app, "more").0), (before, false));
}

/// What is shortened is told in full, where the state is selected that it belongs to.
#[test]
fn whatever_is_shortened_can_be_read() {
    let text = "(machine m (event e [true]) (state a) (state b) (state averyverylongnameofastate)
        (on e a -> b themostimportanttransitionofall) (on e b -> a theonethatleadsback)
        (on e b -> averyverylongnameofastate somethinglongaswell) (on e averyverylongnameofastate -> a and))
        (spawn m a)";
    for (keys, texts) in [
        ("2 Down", &["themostimportanttransitionofall", "theonethatleadsback"][..]),
        ("2 Down Down", &["theonethatleadsback", "somethinglongaswell"][..]),
        ("2 Down Down Down", &["averyverylongnameofastate"][..]),
        ("2 d d Down", &["themostimportanttransitionofall"][..]),
        ("2 d d d Down", &["themostimportanttransitionofall"][..]),
    ] {
        let mut app = screen(40, 40, &running(text, "a"));
        press(&mut app, keys);
        for text in texts {
            assert!(drawn(&app).replace('\n', "").contains(text), "{text} after {keys}\n{}", drawn(&app));
        }
    }
}

const LIGHTHOUSE: &str = include_str!("../../behaviors/concurrent.lrp");

/// The lighthouse at night.
fn night() -> Story {
    let mut story = Story::new();
    story.load(&program(LIGHTHOUSE), &[]).spawn("keeper", None).enter("keeper/day");
    story.spawn("tide", None).enter("tide/ebb");
    story.at(100).take("keeper", "keeper/day", "keeper/night", Some("dusk"), "ontime", 0);
    story.spawn("lamp", Some("keeper/night")).enter("lamp/dark");
    story.spawn("horn", Some("keeper/night")).enter("horn/silent");
    story
}

#[test]
fn machines_stand_side_by_side() {
    check_at(&[(80, 24), (120, 40)], "side_by_side", &night(), "");
    let mut app = screen(80, 24, &night());
    press(&mut app, "2");
    assert!(drawn(&app).contains("keeper: night") && drawn(&app).contains("tide: ebb"), "{}", drawn(&app));
    press(&mut app, "Down Down Enter");
    assert!(title(&app).contains("keeper / night / lamp"), "{}", title(&app));
    assert!(drawn(&app).contains("lamp: dark") && drawn(&app).contains("horn: silent"), "{}", drawn(&app));
    let name_of = |app: &App| app.machine().map(|machine| app.program().expect("a program")[machine].name.to_string());
    press(&mut app, ".");
    assert_eq!(name_of(&app).as_deref(), Some("horn"));
    press(&mut app, ". . Backspace");
    assert_eq!(app.selected().map(|path| path.to_string()).as_deref(), Some("keeper/night"));
    let (buffer, area) = painted(&app);
    let tab = places(&buffer, area, "tide: ebb")[0];
    let tide = app.program().and_then(|program| program.machine("tide")).expect("a machine");
    assert_eq!(graph::at(&app, area, tab), Some(Spot::Machine(tide)));
    press(&mut app, "f");
    go_on(&mut app, 120, |story| _ = story.take("lamp", "lamp/dark", "lamp/lit", None, "ontime", 0));
    assert_eq!(name_of(&app).as_deref(), Some("lamp"), "it follows the deepest machine that changes");
    assert!(title(&app).contains("follow"));
}

/// Where there is no room for all, the others are tabs with the states they are in.
#[test]
fn machines_stand_behind_each_other() {
    let text = machine(12, &[1, 3]) + "(machine other (state one) (state two) (eps one -> two))\n(spawn other one)\n";
    let mut story = running(&text, "s1x");
    story.spawn("other", None).enter("other/one");
    check_at(&[(80, 24)], "tabs", &story, "");
    let mut app = screen(80, 24, &story);
    assert!(drawn(&app).starts_with("m: s1x    other: one"), "{}", drawn(&app));
    press(&mut app, "2 .");
    assert!(drawn(&app).contains("eps") && drawn(&app).starts_with("m: s1x    other: one"), "{}", drawn(&app));
}
