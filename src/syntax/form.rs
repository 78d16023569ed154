//! A form as it is read from left to right: takes names and blocks off it, and keeps the first thing that is wrong. Knows no particular form.

use std::sync::Arc;

use super::ast::{Block, Name};
use super::diagnostic::{Code, Diagnostic};
use super::keyword::Keyword;
use super::names::{check_lua_name, check_name, shortened};
use super::pieces::PieceKind;
use super::reader::{Close, Group, Node};
use super::source::{FileId, Span};

/// The text that nodes are ranges of.
#[derive(Clone, Copy)]
pub struct Text<'a> {
    pub text: &'a str,
    pub file: FileId,
}

impl<'a> Text<'a> {
    pub fn of(self, node: &Node) -> &'a str {
        &self.text[node.range()]
    }

    pub fn span(self, start: usize, end: usize) -> Span {
        Span::new(self.file, start, end)
    }

    /// A node as a message names it.
    pub fn describe(self, node: &Node) -> String {
        match node {
            Node::Leaf(piece) => match piece.kind {
                PieceKind::Block | PieceKind::UnclosedBlock => "a block".to_string(),
                PieceKind::Text | PieceKind::UnclosedText => "a string".to_string(),
                _ => format!("`{}`", shortened(self.of(node))),
            },
            Node::Group(group) => match group.nodes.first() {
                Some(first) if first.is(PieceKind::Word) => {
                    format!("`({}`", shortened(self.of(first)))
                }
                _ => "`(`".to_string(),
            },
        }
    }

    /// Where to point for a node: a group by its first word.
    pub fn point(self, node: &Node) -> Span {
        match node {
            Node::Leaf(_) => node.span(self.file),
            Node::Group(group) => self.head(group),
        }
    }

    /// A group's bracket and first word.
    pub fn head(self, group: &Group) -> Span {
        let first = group.nodes.first().filter(|node| node.is(PieceKind::Word));
        first.map_or(group.open_span(self.file), |word| self.span(group.start as usize, word.range().end))
    }

    fn name(self, node: &Node) -> Name {
        Name { text: Arc::from(self.of(node)), span: node.span(self.file) }
    }
}

pub struct Form<'a> {
    pub text: Text<'a>,
    pub group: &'a Group,
    pub keyword: Keyword,
    /// What has not been taken yet.
    pub rest: &'a [Node],
    /// The first thing found wrong.
    pub fault: Option<Diagnostic>,
}

impl<'a> Form<'a> {
    pub fn new(text: Text<'a>, group: &'a Group, keyword: Keyword) -> Self {
        Form { text, group, keyword, rest: &group.nodes[1..], fault: None }
    }

    pub fn span(&self) -> Span {
        self.text.span(self.group.start as usize, self.group.end as usize)
    }

    pub fn fail<T>(&mut self, diagnostic: Diagnostic) -> Option<T> {
        self.fault.get_or_insert(diagnostic);
        None
    }

    pub fn next(&mut self) -> Option<&'a Node> {
        let (first, rest) = self.rest.split_first()?;
        self.rest = rest;
        Some(first)
    }

    pub fn next_if(&mut self, kind: PieceKind) -> Option<&'a Node> {
        self.rest.first().filter(|node| node.is(kind))?;
        self.next()
    }

    pub fn name(&mut self, what: &str) -> Option<Name> {
        let node = self.word(what)?;
        self.checked(node)
    }

    pub fn lua_name(&mut self, what: &str) -> Option<Name> {
        let node = self.word(what)?;
        self.lua_checked(node)
    }

    pub fn checked(&mut self, node: &Node) -> Option<Name> {
        match check_name(self.text.of(node), node.span(self.text.file)) {
            Ok(()) => Some(self.text.name(node)),
            Err(diagnostic) => self.fail(diagnostic),
        }
    }

    pub fn lua_checked(&mut self, node: &Node) -> Option<Name> {
        match check_lua_name(self.text.of(node), node.span(self.text.file)) {
            Ok(()) => Some(self.text.name(node)),
            Err(diagnostic) => self.fail(diagnostic),
        }
    }

    /// The name of a form that holds others. Takes with it what is stuck to it or stands in its place.
    pub fn title(&mut self, what: &str) -> Option<Name> {
        let stuck = self.stuck_together();
        let in_its_place = matches!(self.rest.first(), Some(Node::Leaf(_)));
        let after = &self.rest[stuck.len().max(usize::from(in_its_place))..];
        let name = match stuck {
            [first, _, ..] if first.is(PieceKind::Word) => {
                let last = &stuck[stuck.len() - 1];
                let span = first.span(self.text.file).to(last.span(self.text.file));
                match check_name(&self.text.text[span.range()], span) {
                    Ok(()) => None,
                    Err(diagnostic) => self.fail(diagnostic),
                }
            }
            _ => self.name(what),
        };
        if name.is_none() {
            self.rest = after;
        }
        name
    }

    /// The leaves up to the first white space, block or group.
    fn stuck_together(&self) -> &'a [Node] {
        let mut end = self.rest.first().map_or(0, |node| node.range().start);
        let stuck = self.rest.iter().take_while(|node| {
            let in_a_name =
                matches!(node, Node::Leaf(piece) if !matches!(piece.kind, PieceKind::Block | PieceKind::UnclosedBlock));
            let follows = in_a_name && node.range().start == end;
            end = node.range().end;
            follows
        });
        &self.rest[..stuck.count()]
    }

    pub fn block(&mut self, what: &str) -> Option<Block> {
        match self.rest.first() {
            Some(node) if node.is(PieceKind::Block) || node.is(PieceKind::UnclosedBlock) => {
                self.rest = &self.rest[1..];
                Some(self.block_of(node))
            }
            Some(node) => {
                let diagnostic = self.bare_code(node, what);
                self.fail(diagnostic)
            }
            None => {
                let diagnostic = self.missing(what);
                self.fail(diagnostic)
            }
        }
    }

    /// The inside of a block. That of one which is not closed is left empty, so that nobody tries to make sense of it.
    pub fn block_of(&self, node: &Node) -> Block {
        let range = node.range();
        let end = if node.is(PieceKind::Block) { range.end - 1 } else { range.start + 1 };
        let inside = range.start + 1..end;
        Block { text: Arc::from(&self.text.text[inside.clone()]), span: self.text.span(inside.start, inside.end) }
    }

    /// Stands for a block that is missing, so that at least the name is known.
    pub fn empty_block(&self) -> Block {
        let end = self.group.end as usize - usize::from(self.group.close == Close::Bracket);
        Block { text: Arc::from(""), span: self.text.span(end, end) }
    }

    /// Nothing more may come.
    pub fn finish(&mut self) {
        if let Some(node) = self.rest.first() {
            let diagnostic =
                self.error(self.text.point(node), format!("{} is too much here", self.text.describe(node)));
            self.fail::<()>(diagnostic);
        }
    }

    fn word(&mut self, what: &str) -> Option<&'a Node> {
        match self.rest.first() {
            Some(node) if node.is(PieceKind::Word) => self.next(),
            Some(node) => {
                let diagnostic = self.unexpected(node, what);
                self.fail(diagnostic)
            }
            None => {
                let diagnostic = self.missing(what);
                self.fail(diagnostic)
            }
        }
    }

    pub fn error(&self, span: Span, message: impl Into<String>) -> Diagnostic {
        Diagnostic::error(Code::BadForm, span, message).help(format!("it is written {}", self.shape()))
    }

    fn shape(&self) -> String {
        self.keyword.shape().split(" or ").map(|shape| format!("`{shape}`")).collect::<Vec<_>>().join(" or ")
    }

    /// The form ends where `what` should come.
    pub fn missing(&self, what: &str) -> Diagnostic {
        let end = self.group.end as usize;
        let span = match self.group.close {
            Close::Bracket => self.text.span(end - 1, end),
            Close::Missing => self.text.span(end, end),
        };
        self.error(span, format!("`{}` lacks {what}", self.keyword.name()))
    }

    /// Something else stands where `what` should.
    pub fn unexpected(&self, node: &Node, what: &str) -> Diagnostic {
        let found = self.text.describe(node);
        let mut error = self.error(self.text.point(node), format!("{found} stands where {what} is expected"));
        if node.is(PieceKind::Other) {
            error.code = Code::StrayCharacter;
        }
        if node.is(PieceKind::Text) {
            return error.help("names are written without quotes");
        }
        error
    }

    /// Code, as it seems, without the brackets around it.
    fn bare_code(&self, node: &Node, what: &str) -> Diagnostic {
        let last = self.rest.last().unwrap_or(node);
        let span = node.span(self.text.file).to(last.span(self.text.file));
        let written = &self.text.text[span.range()];
        let is_code = |node: &Node| match node {
            Node::Leaf(piece) => {
                !matches!(piece.kind, PieceKind::Block | PieceKind::UnclosedBlock | PieceKind::UnclosedText)
            }
            Node::Group(group) => group.keyword.is_none(),
        };
        let begins = node.is(PieceKind::Word) || node.is(PieceKind::Text) || matches!(node, Node::Group(_));
        if !begins || written.contains(['\n', '\r']) || !self.rest.iter().all(is_code) {
            return self.unexpected(node, what);
        }
        if self.keyword == Keyword::Onentry && self.text.of(node) == Keyword::Spawn.name() {
            return self
                .error(span, "a `spawn` has brackets of its own")
                .help(format!("write `({})`", shortened(written)));
        }
        let message = format!("{what} belongs in square brackets: it is a block of Lua");
        self.error(span, message).help(format!("write `[{}]`", shortened(&self.in_lua(written))))
    }

    /// A line of Smalltalk as it is written in Lua, as far as assignments and comparisons go.
    fn in_lua(&self, code: &str) -> String {
        if code.contains(":=") {
            return code.replace(":=", "=");
        }
        let compared = self.keyword == Keyword::Event && !code.contains(['~', '<', '>']) && !code.contains("==");
        if compared { code.replace('=', "==") } else { code.to_string() }
    }
}
