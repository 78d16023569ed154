//! Reads a printed drawing of a state machine as a person would: finds the boxes and walks each line back from its
//! arrow head. Knows nothing of how the drawing was made; it sees the text alone, and refuses what could be read in two ways.

mod arrows;
mod legend;
mod list;
mod page;
mod star;
mod table;

use std::collections::BTreeMap;

use legend::Legend;
pub use page::columns;
use page::{At, Column, Page, Script};

/// What a drawing says.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Seen {
    /// From top to bottom, with whether it is marked as having a nested machine.
    pub states: Vec<(String, bool)>,
    /// Source, target and label, sorted.
    pub edges: Vec<(String, String, String)>,
}

/// What a drawing with its legend says; an error if that is nothing, or could be two things.
pub fn trace(text: &str) -> Result<Seen, String> {
    let (lines, legend) = Legend::split(text)?;
    let page = Page::new(&lines);
    let readings = [spine(&page), table::trace(&page), star::trace(&page), list::trace(&page)];
    let mut seen: Vec<&Seen> = readings.iter().flatten().collect();
    seen.dedup();
    match seen[..] {
        [seen] => legend.applied(seen.clone()),
        [] => Err(readings.into_iter().filter_map(Result::err).collect::<Vec<_>>().join("; or else: ")),
        _ => Err(format!("may be read in several ways: {seen:?}")),
    }
}

/// A state from what its box says, with whether it is marked.
fn named(text: &str, script: &Script) -> (String, bool) {
    let bare = text.strip_suffix(script.nested);
    (bare.unwrap_or(text).to_owned(), bare.is_some())
}

/// Where edges end at a name, each state has a name of its own and each edge ends at one.
fn known_targets(seen: Seen) -> Result<Seen, String> {
    let named = |name: &String| seen.states.iter().filter(move |(known, _)| known == name).count();
    if let Some((name, _)) = seen.states.iter().find(|(name, _)| name.is_empty() || named(name) > 1) {
        return Err(format!("a box with no name, or another's: {name:?}"));
    }
    match seen.edges.iter().find(|(_, to, _)| named(to) == 0) {
        Some((_, to, _)) => Err(format!("no box is {to:?}")),
        None => Ok(seen),
    }
}

fn spine(page: &Page) -> Result<Seen, String> {
    let Some(column) = Column::find(page)? else {
        return match page.cells.iter().flatten().find(|cell| *cell != " ") {
            Some(cell) => Err(format!("{cell:?} without a box")),
            None => Ok(Seen { states: Vec::new(), edges: Vec::new() }),
        };
    };
    let mut tracer = Tracer { page, column: &column, owners: BTreeMap::new() };
    let mut edges = tracer.edges()?;
    tracer.nothing_is_left()?;
    edges.sort();
    let states = column.boxes.iter().map(|b| (b.name.clone(), b.nested)).collect();
    Ok(Seen { states, edges })
}

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Way {
    Left,
    Right,
    Up,
    Down,
}

impl Way {
    fn across(self) -> bool {
        matches!(self, Way::Left | Way::Right)
    }

    fn back(self) -> Way {
        match self {
            Way::Left => Way::Right,
            Way::Right => Way::Left,
            Way::Up => Way::Down,
            Way::Down => Way::Up,
        }
    }

    fn from(self, (x, y): At) -> Result<At, String> {
        let next = match self {
            Way::Left => x.checked_sub(1).map(|x| (x, y)),
            Way::Right => Some((x + 1, y)),
            Way::Up => y.checked_sub(1).map(|y| (x, y)),
            Way::Down => Some((x, y + 1)),
        };
        next.ok_or_else(|| format!("a line leaves the page at {x},{y}"))
    }
}

/// Who uses a cell: lines across and down may cross, anything else is alone.
#[derive(Clone, Copy, PartialEq, Eq)]
enum Use {
    Whole,
    Across,
    Down,
}

struct Tracer<'p> {
    page: &'p Page,
    column: &'p Column,
    owners: BTreeMap<At, Vec<Use>>,
}

impl Tracer<'_> {
    fn edges(&mut self) -> Result<Vec<(String, String, String)>, String> {
        let Column { left, right, .. } = *self.column;
        let rows = 0..self.page.cells.len();
        let mut edges = Vec::new();
        for y in rows.clone().filter(|&y| self.column.at(y).is_some()) {
            if self.is_head(0, (right + 1, y)) {
                edges.push(self.walk((right + 1, y), Way::Right)?);
            }
            if left > 0 && self.is_head(1, (left - 1, y)) {
                edges.push(self.walk((left - 1, y), Way::Left)?);
            }
        }
        // Arrows in a gap stand on both sides of the boxes' middle. The lines are known by now, so no label runs into one.
        let middle = self.column.middle();
        for y in rows.filter(|&y| self.column.at(y).is_none()) {
            if self.is_head(2, (middle - 1, y)) {
                edges.push(self.arrow_up((middle - 1, y))?);
            }
            if self.is_head(3, (middle + 1, y)) {
                edges.push(self.arrow_down((middle + 1, y))?);
            }
        }
        Ok(edges)
    }

    fn is_head(&self, way: usize, at: At) -> bool {
        let glyph = self.page.at(at);
        !glyph.is_empty() && self.page.script.heads[way].contains(glyph)
    }

    fn arrow_up(&mut self, (x, y): At) -> Result<(String, String, String), String> {
        let (above, below) = self.neighbours((x, y))?;
        self.take((x, y), Use::Whole)?;
        let label = self.label_beside((x, y), Way::Left)?;
        Ok((below, above, label))
    }

    fn arrow_down(&mut self, (x, y): At) -> Result<(String, String, String), String> {
        let (above, below) = self.neighbours((x, y))?;
        self.take((x, y), Use::Whole)?;
        let label = self.label_beside((x, y), Way::Right)?;
        Ok((above, below, label))
    }

    /// The names of the boxes right above and below an arrow.
    fn neighbours(&self, (x, y): At) -> Result<(String, String), String> {
        let name = |y: Option<usize>| y.and_then(|y| self.column.at(y)).map(|b| b.name.clone());
        match (name(y.checked_sub(1)), name(Some(y + 1))) {
            (Some(above), Some(below)) if self.column.left < x && x < self.column.right => Ok((above, below)),
            _ => Err(format!("the arrow at {x},{y} is not between two boxes")),
        }
    }

    /// A label one blank away from an arrow; two blanks or the page's end finish it, a line must not.
    fn label_beside(&mut self, arrow: At, way: Way) -> Result<String, String> {
        let mut clusters: Vec<String> = Vec::new();
        let Ok(mut at) = way.from(arrow) else {
            return Ok(String::new());
        };
        let mut blanks = 0;
        loop {
            let cluster = self.page.at(at).to_owned();
            blanks = if cluster == " " { blanks + 1 } else { 0 };
            if self.owners.contains_key(&at) {
                // The other arrow of the gap may follow at once where there is no label between the two.
                let other_arrow = clusters == [" "] && at.1 == arrow.1 && self.is_arrow(at);
                return if other_arrow {
                    Ok(String::new())
                } else {
                    Err(format!("the label of the arrow at {arrow:?} touches a line at {at:?}"))
                };
            }
            clusters.push(cluster);
            if clusters.len() == 1 && blanks == 0 {
                return Err(format!("something touches the arrow at {arrow:?}"));
            }
            if blanks == 2 || way.from(at).is_err() || at.0 > self.page.cells[at.1].len() {
                break;
            }
            at = way.from(at)?;
        }
        if way == Way::Left {
            clusters.reverse();
        }
        let label = clusters.concat().trim_matches(' ').to_owned();
        for step in 0..columns(&label) {
            let x = if way == Way::Left { arrow.0 - 2 - step } else { arrow.0 + 2 + step };
            self.take((x, arrow.1), Use::Whole)?;
        }
        Ok(label)
    }

    fn is_arrow(&self, at: At) -> bool {
        self.is_head(2, at) || self.is_head(3, at)
    }

    /// Follows a line from its head, `way` leading away from the target, to its source.
    fn walk(&mut self, head: At, mut way: Way) -> Result<(String, String, String), String> {
        let target = self.box_at(head.1)?;
        self.take(head, Use::Whole)?;
        let (mut at, mut turns, mut style) = (head, 0, Style([true; 3]));
        loop {
            at = way.from(at)?;
            if turns == 2 && !self.is_line(at) {
                let label = self.label_in_line(at, way, style)?;
                return Ok((self.box_at(at.1)?, target, label));
            }
            let glyph = self.page.at(at);
            if glyph == self.page.script.crossing {
                self.take(at, if way.across() { Use::Across } else { Use::Down })?;
            } else if let Some(found) = self.style(glyph, way) {
                style = style.and(found).ok_or_else(|| format!("the line changes its style at {at:?}"))?;
                self.take(at, Use::Whole)?;
            } else {
                way = self.turn(at, way)?;
                turns += 1;
                self.take(at, Use::Whole)?;
            }
            if turns > 2 {
                return Err(format!("a third corner at {at:?}"));
            }
        }
    }

    fn is_line(&self, at: At) -> bool {
        let glyph = self.page.at(at);
        glyph == self.page.script.crossing || self.style(glyph, Way::Left).is_some()
    }

    fn style(&self, glyph: &str, way: Way) -> Option<Style> {
        let glyphs = if way.across() { self.page.script.across } else { self.page.script.down };
        let style = Style(glyphs.map(|g| g == glyph));
        (style != Style([false; 3])).then_some(style)
    }

    /// Where a line goes on that enters a corner.
    fn turn(&self, at: At, way: Way) -> Result<Way, String> {
        let sides = match self.page.at(at) {
            "┌" => [Way::Right, Way::Down],
            "┐" => [Way::Left, Way::Down],
            "└" => [Way::Right, Way::Up],
            "┘" => [Way::Left, Way::Up],
            "." if self.page.script.padded => [self.open_side(at)?, Way::Down],
            "'" if self.page.script.padded => [self.open_side(at)?, Way::Up],
            other => return Err(format!("a line ends at {other:?} at {at:?}")),
        };
        match sides.iter().position(|side| *side == way.back()) {
            Some(0) => Ok(sides[1]),
            Some(1) => Ok(sides[0]),
            _ => Err(format!("the corner at {at:?} doesn't join")),
        }
    }

    /// The side on which something across joins an ASCII corner.
    fn open_side(&self, (x, y): At) -> Result<Way, String> {
        let left = x > 0 && self.is_line((x - 1, y));
        match (left, self.is_line((x + 1, y))) {
            (true, false) => Ok(Way::Left),
            (false, true) => Ok(Way::Right),
            _ => Err(format!("the corner at {x},{y} may be read in two ways, or none")),
        }
    }

    /// What stands between `at` and the source's border: nothing, or a label and one more cell of the line.
    fn label_in_line(&mut self, at: At, way: Way, style: Style) -> Result<String, String> {
        let (x, y) = at;
        let columns = match way {
            Way::Left => self.column.right + 1..x + 1,
            Way::Right => x..self.column.left,
            _ => return Err(format!("a label in an upright line at {at:?}")),
        };
        if columns.is_empty() {
            return Ok(String::new());
        }
        let tail = if way == Way::Left { columns.start } else { columns.end - 1 };
        let exits = self.page.at((tail, y)) == self.page.script.exit;
        let joins = self.style(self.page.at((tail, y)), way).is_some_and(|found| style.and(found).is_some());
        if !exits && !joins {
            return Err(format!("the line doesn't reach its source at {tail},{y}"));
        }
        for x in columns.clone() {
            self.take((x, y), Use::Whole)?;
        }
        let columns = if way == Way::Left { columns.start + 1..columns.end } else { columns.start..columns.end - 1 };
        let text = self.page.text(y, columns);
        match self.page.script.padded && !text.is_empty() {
            false => bare(&text),
            true => bare(
                text.strip_prefix(' ')
                    .and_then(|t| t.strip_suffix(' '))
                    .ok_or_else(|| format!("{text:?} touches its line"))?,
            ),
        }
    }

    fn box_at(&self, y: usize) -> Result<String, String> {
        self.column.at(y).map(|b| b.name.clone()).ok_or_else(|| format!("row {y}: a line ends beside no box"))
    }

    fn take(&mut self, at: At, used: Use) -> Result<(), String> {
        let owners = self.owners.entry(at).or_default();
        if owners.iter().any(|other| *other == Use::Whole || used == Use::Whole || *other == used) {
            return Err(format!("two things use the cell {at:?}"));
        }
        owners.push(used);
        Ok(())
    }

    /// Every sign on the page belongs to a box or to what was traced, each crossing to two lines.
    fn nothing_is_left(&self) -> Result<(), String> {
        for (y, row) in self.page.cells.iter().enumerate() {
            for x in (0..row.len()).filter(|&x| row[x] != " ") {
                let boxed = self.column.at(y).is_some() && self.column.left <= x && x <= self.column.right;
                match self.owners.get(&(x, y)).map(Vec::as_slice) {
                    None if boxed => {}
                    Some([Use::Whole]) | Some([_, _]) if !boxed => {}
                    _ => return Err(format!("{:?} at {x},{y} belongs to no line", row[x])),
                }
            }
        }
        Ok(())
    }
}

/// A label without blanks at its ends, or within it two in a row.
fn bare(text: &str) -> Result<String, String> {
    match text.trim_matches(' ') == text && !text.contains("  ") {
        true => Ok(text.to_owned()),
        false => Err(format!("a gap beside the label {text:?}")),
    }
}

/// Which of the styles solid, dotted, dashed a line may have, after what was seen of it.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
struct Style([bool; 3]);

impl Style {
    fn and(self, other: Style) -> Option<Style> {
        let both = Style(std::array::from_fn(|i| self.0[i] && other.0[i]));
        (both != Style([false; 3])).then_some(both)
    }
}
