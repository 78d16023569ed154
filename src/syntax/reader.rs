//! From a text to its brackets: groups within groups, with repairs where brackets don't match. Knows the forms' keywords and where they may stand, but not how they are written.

use super::block::MAX_DEPTH;
use super::findings::Findings;
use super::keyword::{Keyword, Place};
use super::pieces::{Piece, PieceKind, pieces};
use super::repair::{Repair, report};
use super::source::{FileId, Span};

#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Node {
    Leaf(Piece),
    Group(Group),
}

/// Round brackets and what is in them; at top level, the whole text.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Group {
    pub start: u32,
    /// Behind the closing bracket, or behind the last node where that is missing.
    pub end: u32,
    pub close: Close,
    /// The word it begins with, if that is a form's.
    pub keyword: Option<Keyword>,
    pub nodes: Vec<Node>,
    pub(super) indent: u32,
    pub(super) begins_line: bool,
    /// The column of the first group in it that begins a line.
    pub(super) child_column: Option<u32>,
    /// Whether something in it, but in no group inside it, could not be read and has been reported.
    pub hurt: bool,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Close {
    Bracket,
    Missing,
}

impl Node {
    pub fn range(&self) -> std::ops::Range<usize> {
        match self {
            Node::Leaf(piece) => piece.range(),
            Node::Group(group) => group.start as usize..group.end as usize,
        }
    }

    pub fn span(&self, file: FileId) -> Span {
        Span::new(file, self.range().start, self.range().end)
    }

    pub fn is(&self, kind: PieceKind) -> bool {
        matches!(self, Node::Leaf(piece) if piece.kind == kind)
    }
}

impl Group {
    fn new(open: Piece, keyword: Option<Keyword>) -> Self {
        Group {
            start: open.start,
            end: open.end,
            close: Close::Missing,
            keyword,
            nodes: Vec::new(),
            indent: open.indent,
            begins_line: open.begins_line,
            child_column: None,
            hurt: false,
        }
    }

    fn whole_text(text: &str) -> Self {
        let start = Piece { kind: PieceKind::Space, start: 0, end: text.len() as u32, indent: 0, begins_line: true };
        Group { close: Close::Bracket, ..Group::new(start, None) }
    }

    /// What this is to the forms in it, if it is a form.
    pub(super) fn place(&self) -> Option<Place> {
        self.keyword.map(Keyword::inside)
    }

    pub fn open_span(&self, file: FileId) -> Span {
        Span::new(file, self.start as usize, self.start as usize + 1)
    }
}

/// Reads the brackets of a text. What doesn't match is repaired and added to the findings.
pub fn read(text: &str, file: FileId, findings: &mut Findings) -> Group {
    let pieces = pieces(text, file, findings);
    let by_brackets = Builder::build(text, &pieces, Trust::Brackets);
    if by_brackets.complaints == 0 {
        return by_brackets.root;
    }
    let by_layout = Builder::build(text, &pieces, Trust::Layout);
    let best = if by_layout.complaints <= by_brackets.complaints { by_layout } else { by_brackets };

    report(best.repairs, text, file, findings);
    best.root
}

/// What to believe where brackets and indentation disagree.
#[derive(Clone, Copy, PartialEq, Eq)]
enum Trust {
    Brackets,
    Layout,
}

pub(super) struct Builder<'a> {
    text: &'a str,
    pub(super) root: Group,
    /// The groups that are open, innermost last.
    pub(super) stack: Vec<Group>,
    /// Brackets open beyond the limit, whose contents are passed over.
    beyond: usize,
    pub(super) repairs: Vec<Repair>,
    /// How many brackets would have to be added, removed or moved for all forms to be where they belong.
    pub(super) complaints: usize,
}

impl<'a> Builder<'a> {
    fn build(text: &'a str, pieces: &[Piece], trust: Trust) -> Self {
        let root = Group::whole_text(text);
        let mut builder = Builder { text, root, stack: Vec::new(), beyond: 0, repairs: Vec::new(), complaints: 0 };
        for (i, &piece) in pieces.iter().enumerate() {
            match piece.kind {
                PieceKind::Open if builder.stack.len() >= MAX_DEPTH || builder.beyond > 0 => builder.open_beyond(piece),
                PieceKind::Close if builder.beyond > 0 => builder.beyond -= 1,
                PieceKind::Open => builder.open(piece, keyword_after(text, &pieces[i + 1..]), trust),
                PieceKind::Close => builder.close(piece, trust),
                PieceKind::Junk if builder.beyond == 0 => builder.junk(),
                _ if piece.is_trivia() || builder.beyond > 0 => {}
                _ => builder.leaf(piece),
            }
        }
        let whole = pieces.last().is_none_or(|piece| piece.kind != PieceKind::Unread);
        builder.finish(whole && builder.beyond == 0);
        builder
    }

    fn open_beyond(&mut self, piece: Piece) {
        self.beyond += 1;
        if self.beyond == 1 {
            self.stack.iter_mut().for_each(|group| group.hurt = true);
            if !self.repairs.iter().any(|repair| matches!(repair, Repair::TooDeep { .. })) {
                self.complaints += 1;
                self.repairs.push(Repair::TooDeep { at: piece.start });
            }
        }
    }

    fn open(&mut self, piece: Piece, keyword: Option<Keyword>, trust: Trust) {
        if trust == Trust::Layout {
            self.make_room(piece, keyword);
        }
        if keyword.is_some_and(|keyword| !self.accepts(keyword)) {
            self.complaints += 1;
        }
        if piece.begins_line {
            self.top().child_column.get_or_insert(piece.indent);
        }
        self.stack.push(Group::new(piece, keyword));
    }

    fn close(&mut self, piece: Piece, trust: Trust) {
        if trust == Trust::Layout {
            self.line_up(piece);
        }
        match self.stack.pop() {
            Some(group) => self.add(Group { end: piece.end, close: Close::Bracket, ..group }),
            None => {
                self.complaints += 1;
                self.repairs.push(Repair::Remove { at: piece.start });
            }
        }
    }

    fn leaf(&mut self, piece: Piece) {
        let top = self.top();
        top.hurt |= matches!(piece.kind, PieceKind::UnclosedBlock | PieceKind::UnclosedText);
        top.end = top.end.max(piece.end);
        top.nodes.push(Node::Leaf(piece));
    }

    fn junk(&mut self) {
        if let Some(group) = self.stack.last_mut() {
            group.hurt = true;
        }
    }

    pub(super) fn top(&mut self) -> &mut Group {
        self.stack.last_mut().unwrap_or(&mut self.root)
    }

    fn add(&mut self, group: Group) {
        let top = self.top();
        top.end = top.end.max(group.end);
        top.nodes.push(Node::Group(group));
    }

    /// Whether a form may stand in the innermost open group; lists of names and unknown forms take anything.
    pub(super) fn accepts(&self, keyword: Keyword) -> bool {
        match self.stack.last() {
            None => keyword.may_stand(Place::Top),
            Some(group) => match group.place() {
                None => true,
                // `(state b)` may well be a list of two states.
                Some(Place::Transition) => true,
                Some(place) => keyword.may_stand(place),
            },
        }
    }

    /// Closes the innermost `count` groups, which lack their brackets.
    pub(super) fn close_unclosed(&mut self, count: usize) {
        let mut opened = Vec::new();
        let mut add_at = 0;
        for _ in 0..count {
            let Some(group) = self.stack.pop() else { break };
            add_at = add_at.max(group.end);
            // An unclosed block or string took the bracket with it.
            let swallowed = |node: &Node| node.is(PieceKind::UnclosedBlock) || node.is(PieceKind::UnclosedText);
            if !group.nodes.iter().any(swallowed) {
                opened.push(group.start..self.head_end(&group));
            }
            self.add(group);
        }
        if !opened.is_empty() {
            self.complaints += opened.len();
            self.repairs.push(Repair::Close { opened, add_at });
        }
    }

    /// Behind the words a group begins with: as much as is needed to name it.
    fn head_end(&self, group: &Group) -> u32 {
        let words = group.nodes.iter().take(2).take_while(|node| node.is(PieceKind::Word)).map(Node::range);
        words
            .last()
            .filter(|range| !self.text[group.start as usize..range.end].contains(['\n', '\r']))
            .map_or(group.start + 1, |range| range.end as u32)
    }

    fn finish(&mut self, report: bool) {
        let count = self.stack.len();
        let before = self.repairs.len();
        self.close_unclosed(count);
        if !report {
            self.repairs.truncate(before);
        }
    }
}

fn keyword_after(text: &str, pieces: &[Piece]) -> Option<Keyword> {
    let first = pieces.iter().find(|piece| !piece.is_trivia())?;
    (first.kind == PieceKind::Word).then(|| Keyword::of(&text[first.range()]))?
}
