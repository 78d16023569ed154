//! The drawn machine on the screen: what is shown of what happens, and what lies where.

use lrp::ui::app::App;
use lrp::ui::layout::Pane;
use lrp::ui::panes::graph::{self, Spot};
use ratatui::buffer::Buffer;
use ratatui::layout::{Position, Rect};

use crate::frames::{press, screen};
use crate::story::Story;

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
