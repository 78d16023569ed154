//! The rows of a spine: where each box and each end of an edge stands. Knows nothing of columns.

use super::ends::{Ends, Flow};
use super::{Run, Side};
use crate::ui::graph::Graph;
use crate::ui::graph::texts::Texts;

/// Rows between two boxes.
const GAP: usize = 1;

/// One box.
#[derive(Clone, Copy, Debug)]
pub struct Level {
    /// Its first row.
    pub top: usize,
    /// In rows.
    pub height: usize,
    /// The row of the name.
    pub name: usize,
}

impl Level {
    fn below(self) -> usize {
        self.top + self.height
    }
}

/// The boxes from top to bottom, and the edges.
pub struct Stack {
    pub levels: Vec<Level>,
    pub runs: Vec<Run>,
    /// In rows.
    pub height: usize,
}

impl Stack {
    pub fn new(graph: &Graph, texts: &Texts) -> Stack {
        let ends = Ends::of(graph);
        let mut levels = Vec::new();
        let mut top = 0;
        for node in 0..graph.nodes.len() {
            let text = texts.rows(node);
            let sides = ends.left[node].len().max(ends.right[node].len());
            let height = text.max(sides);
            let name = top + (height - text) / 2;
            levels.push(Level { top, height, name });
            top += height + GAP;
        }
        let height = levels.last().map_or(0, |level| level.below());
        let runs = runs(graph, &levels, &ends);
        Stack { levels, runs, height }
    }

    /// The index of the box in this row, or of the next one above.
    pub fn box_at(&self, row: usize) -> usize {
        self.levels.partition_point(|level| level.top <= row).saturating_sub(1)
    }
}

fn runs(graph: &Graph, levels: &[Level], ends: &Ends) -> Vec<Run> {
    let mut runs = vec![Run::Nowhere; graph.edges.len()];
    for (level, gap) in levels.iter().zip(&ends.gaps) {
        if let Some(edge) = gap.down {
            let row = level.below();
            runs[edge] = Run::Gap { side: Side::Right, row };
        }
        if let Some(edge) = gap.up {
            let row = level.below();
            runs[edge] = Run::Gap { side: Side::Left, row };
        }
    }
    for (side, ends) in [(Side::Left, &ends.left), (Side::Right, &ends.right)] {
        for (level, ends) in levels.iter().zip(ends) {
            let first = level.top + (level.height - ends.len()) / 2;
            for (row, end) in (first..).zip(ends) {
                runs[end.edge] = joined(runs[end.edge], side, end.flow, row);
            }
        }
    }
    runs
}

/// `run` with one of its ends in `row`. Each end comes once, so the first also stands in for the other.
fn joined(run: Run, side: Side, flow: Flow, row: usize) -> Run {
    let (from, to) = match run {
        Run::Beside { from, to, .. } => (from, to),
        _ => (row, row),
    };
    match flow {
        Flow::Out => Run::Beside { side, from: row, to },
        Flow::In => Run::Beside { side, from, to: row },
    }
}
