//! The page that a tracer looks at: the printed text as cells, the characters that it may be drawn with, and the column of
//! boxes. Knows nothing of lines.

use unicode_segmentation::UnicodeSegmentation;
use unicode_width::UnicodeWidthStr;

/// The text as cells: a wide cluster is followed by empty ones.
pub struct Page {
    pub cells: Vec<Vec<String>>,
    pub script: Script,
}

/// The characters that the drawing uses.
pub struct Script {
    pub borders: [&'static str; 2],
    pub nested: &'static str,
    /// To the left, right, up and down.
    pub heads: [&'static str; 4],
    /// Solid, dotted and dashed.
    pub across: [&'static str; 3],
    pub down: [&'static str; 3],
    pub crossing: &'static str,
    pub exit: &'static str,
    /// Whether a blank stands on both sides of a label in a line.
    pub padded: bool,
}

const UNICODE: Script = Script {
    borders: ["▌", "▐"],
    nested: " ▸",
    heads: ["◄◁", "►▷", "▲△⇡", "▼▽⇣"],
    across: ["─", "┄", "╌"],
    down: ["│", "┆", "╎"],
    crossing: "┼",
    exit: "○",
    padded: false,
};

const ASCII: Script = Script {
    borders: ["[", "]"],
    nested: " >",
    heads: ["<", ">", "^", "v"],
    across: ["-", "~", "="],
    down: ["|", ":", "|"],
    crossing: "+",
    exit: "o",
    padded: true,
};

pub type At = (usize, usize);

impl Page {
    pub fn new(lines: &[&str]) -> Page {
        let script = if lines.iter().any(|line| line.contains('▌')) { UNICODE } else { ASCII };
        let cells = lines.iter().map(|line| {
            let clusters = line.graphemes(true);
            clusters
                .flat_map(|c| [c].into_iter().chain(std::iter::repeat_n("", c.width().max(1) - 1)).map(str::to_owned))
                .collect()
        });
        Page { cells: cells.collect(), script }
    }

    pub fn at(&self, (x, y): At) -> &str {
        self.cells.get(y).and_then(|row| row.get(x)).map_or(" ", String::as_str)
    }

    pub fn text(&self, y: usize, columns: std::ops::Range<usize>) -> String {
        columns.map(|x| self.at((x, y))).collect()
    }
}

impl Page {
    /// The columns of the two borders in a row that has any.
    fn borders(&self, y: usize) -> Result<Option<(usize, usize)>, String> {
        let columns = |border: &str| -> Vec<usize> {
            let row = self.cells[y].iter().enumerate();
            row.filter(|(_, cell)| *cell == border).map(|(x, _)| x).collect()
        };
        match self.script.borders.map(columns).each_ref().map(Vec::as_slice) {
            [[], []] => Ok(None),
            [&[left], &[right]] if left < right => Ok(Some((left, right))),
            _ => Err(format!("row {y}: a box without both its borders")),
        }
    }
}

pub struct Block {
    pub top: usize,
    pub bottom: usize,
    pub name: String,
    pub nested: bool,
}

/// The column of boxes: the columns of its borders, and the boxes from top to bottom.
pub struct Column {
    pub left: usize,
    pub right: usize,
    pub boxes: Vec<Block>,
}

impl Column {
    pub fn find(page: &Page) -> Result<Option<Column>, String> {
        let mut borders: Option<(usize, usize)> = None;
        let mut boxes: Vec<Block> = Vec::new();
        for y in 0..page.cells.len() {
            let Some((left, right)) = page.borders(y)? else {
                continue;
            };
            if *borders.get_or_insert((left, right)) != (left, right) {
                return Err(format!("row {y}: a border outside of the column"));
            }
            if page.at((left + 1, y)) != " " || page.at((right - 1, y)) != " " {
                return Err(format!("row {y}: something touches the border from inside"));
            }
            match boxes.last_mut() {
                Some(last) if last.bottom + 1 == y => last.bottom = y,
                _ => boxes.push(Block { top: y, bottom: y, name: String::new(), nested: false }),
            }
            let text = page.text(y, left + 1..right);
            let last = boxes.last_mut().expect("one was pushed");
            match (text.trim_matches(' '), last.name.is_empty()) {
                ("", _) => {}
                (_, false) => return Err(format!("row {y}: a second name in a box")),
                (name, true) => {
                    (last.name, last.nested) = super::named(name, &page.script);
                }
            }
        }
        for (i, b) in boxes.iter().enumerate() {
            if b.name.is_empty() || boxes[..i].iter().any(|other| other.name == b.name) {
                return Err(format!("row {}: a box with no name, or another's", b.top));
            }
        }
        Ok(borders.map(|(left, right)| Column { left, right, boxes }))
    }

    pub fn at(&self, y: usize) -> Option<&Block> {
        self.boxes.iter().find(|b| b.top <= y && y <= b.bottom)
    }

    /// Where a gap's arrows stand on either side of.
    pub fn middle(&self) -> usize {
        self.left + (self.right - self.left).div_ceil(2)
    }
}

/// How many columns a text takes.
pub fn columns(text: &str) -> usize {
    text.graphemes(true).map(UnicodeWidthStr::width).sum()
}
