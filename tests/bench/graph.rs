//! What drawings of state machines cost their readers and the processor: size, crossings, bends, shortened labels, what
//! an edit moves, time. Prints the table of docs/graph.md.

#[path = "graph/edits.rs"]
mod edits;
#[path = "../lrp/graph/machines.rs"]
mod machines;
mod timing;

use std::hint::black_box;
use std::time::Duration;

use edits::{Moved, script};
use lrp::ui::graph::{Drawing, Form, Glyphs, Graph, Options, Part, Place, Rows, draw};
use timing::{best, median, timed};

const FREE: Options = Options {
    form: Form::Boxes,
    glyphs: Glyphs::Unicode,
    max_width: None,
    max_height: None,
    place: Place::Left,
    rows: Rows::Two,
};
/// As the screen has it in a terminal of 80 columns.
const SCREEN: Options = Options { max_width: Some(80), place: Place::Middle, ..FREE };
const ROUNDS: usize = 101;

fn main() {
    println!(
        "| machine | states, edges | size | in 80x24 | in 48x20 | table in 80x24 | in 200x60 | crossings | bends | length | moved by {} edits: states | edges | draw, ms | in 80 columns | redraw |",
        script(&machines::tick_tock()).len()
    );
    println!("|---|---|---|---|---|---|---|---|---|---|---|---|---|---|---|");
    for (name, graph) in machines::fixed_cases().into_iter().chain(machines::large_cases()) {
        report(name, &graph);
    }
}

fn report(name: &str, graph: &Graph) {
    let drawing = draw(graph, &FREE);
    let count = |of: fn(&Part) -> bool| drawing.cells().iter().filter(|cell| of(&cell.part)).count();
    let bends = drawing.cells().iter().filter(|cell| matches!(cell.part, Part::Line(_)) && "┌┐└┘".contains(cell.glyph));
    let length = (0..graph.edges.len()).map(|edge| drawing.edge_cells(edge).count()).sum::<usize>();
    let moved = script(graph).iter().map(|edit| Moved::by(edit, graph, &SCREEN)).fold(Moved::default(), Moved::plus);
    println!(
        "| {name} | {}, {} | {}x{} | {} | {} | {} | {} | {} | {} | {length} | {} | {} | {} | {} | {} |",
        graph.nodes.len(),
        graph.edges.len(),
        drawing.width,
        drawing.height,
        within(graph, Form::Boxes, 80, 24),
        within(graph, Form::Boxes, 48, 20),
        within(graph, Form::Table, 80, 24),
        within(graph, Form::Table, 200, 60),
        count(|part| matches!(part, Part::Crossing { .. })),
        bends.count(),
        moved.states,
        moved.edges,
        time(|| drop(black_box(draw(graph, &FREE)))),
        time(|| drop(black_box(draw(graph, &SCREEN)))),
        time(|| assert!(black_box(redrawn(graph, &drawing)) > 0)),
    );
}

/// How a machine is shown in a terminal of this size: its rows and how many labels and names are shortened.
fn within(graph: &Graph, form: Form, width: u16, height: u16) -> String {
    let (max_width, max_height) = (Some(width), Some(height));
    let narrow = |rows| draw(graph, &Options { form, max_width, max_height, rows, ..SCREEN });
    let two = narrow(Rows::Two);
    let drawing = if two.height > height { narrow(Rows::One) } else { two };
    if drawing.width > width {
        return format!("no: {} columns", drawing.width);
    }
    let fits = if drawing.height <= height { "fits".to_string() } else { format!("{} rows", drawing.height) };
    match cuts(graph, &drawing) {
        0 => fits,
        cuts => format!("{fits}, {cuts} cut"),
    }
}

fn cuts(graph: &Graph, drawing: &Drawing) -> usize {
    let width = usize::from(drawing.width);
    let mut texts = vec![(String::new(), String::new()); graph.nodes.len().max(graph.edges.len())];
    for (i, cell) in drawing.cells().iter().enumerate() {
        let symbol = drawing.symbol((i % width) as u16, (i / width) as u16);
        match cell.part {
            Part::Name(node) => texts[node].0.push_str(&symbol),
            Part::Label(edge) => texts[edge].1.push_str(&symbol),
            _ => {}
        }
    }
    let names = graph.nodes.iter().zip(&texts).filter(|(node, text)| !text.0.contains(&node.name));
    let labels = graph.edges.iter().zip(&texts).filter(|(edge, text)| !text.1.contains(&edge.label));
    names.count() + labels.count()
}

/// What a screen does when something has happened: all symbols, and the edge taken last in heavy lines.
fn redrawn(graph: &Graph, drawing: &Drawing) -> usize {
    let cells = (0..drawing.height).flat_map(|y| (0..drawing.width).map(move |x| (x, y)));
    let symbols: usize = cells.map(|(x, y)| drawing.symbol(x, y).len()).sum();
    symbols + drawing.heavy_line(graph.edges.len() / 2).count()
}

/// The best of many rounds and the median, in milliseconds.
fn time(run: impl Fn()) -> String {
    let rounds: Vec<Duration> = (0..ROUNDS).map(|_| timed(&run)).collect();
    let ms = |time: Duration| time.as_secs_f64() * 1e3;
    format!("{:.2} ({:.2})", ms(best(&rounds)), ms(median(&rounds)))
}
