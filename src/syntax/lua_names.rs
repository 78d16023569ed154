//! Which names in a piece of Lua are free: no locals, fields, table keys or labels. Reads tokens with as much grammar as
//! scopes take, and never refuses a text.

use super::lua_tokens::{Token, TokenKind, tokens};

/// A token, comments left out.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Word {
    pub token: Token,
    /// A name that is found outside the piece of Lua, if at all.
    pub is_free: bool,
}

/// The tokens of a piece of Lua, comments left out, with the free names marked.
pub fn words(code: &str) -> Vec<Word> {
    let is_comment = |token: &Token| matches!(token.kind, TokenKind::Comment | TokenKind::UnclosedComment);
    let tokens: Vec<Token> = tokens(code).filter(|token| !is_comment(token)).collect();
    let text = |index: usize| tokens.get(index).map_or("", |token| &code[token.range.clone()]);
    let mut scopes = Scopes::default();
    let mut words = Vec::with_capacity(tokens.len());
    for (index, token) in tokens.iter().enumerate() {
        let is_free = scopes.next(token.kind, text(index), text(index + 1));
        words.push(Word { token: token.clone(), is_free });
    }
    words
}

/// What is open at a place, innermost last; the outermost is the piece of Lua itself.
struct Scopes<'c> {
    open: Vec<Open<'c>>,
    /// The token before, and whether an expression could end with it.
    last: &'c str,
    complete: bool,
    in_label: bool,
    /// Between `function` and its parameters; with the name that a method has for its object.
    head: Option<Head>,
}

#[derive(Clone, Copy, PartialEq)]
enum Head {
    Function,
    Method,
}

struct Open<'c> {
    bracket: Bracket,
    locals: Vec<&'c str>,
    statement: Statement<'c>,
}

#[derive(Clone, Copy, PartialEq)]
enum Bracket {
    /// `do`, `then`, `function`, ..
    Block,
    Curly,
    Other,
}

/// The statement that declares something, as far as it was read.
#[derive(PartialEq)]
enum Statement<'c> {
    Plain,
    /// Seen only behind the statement.
    Local(Vec<&'c str>),
    LocalValue(Vec<&'c str>),
    For(Vec<&'c str>),
    /// Seen only in the loop's body.
    LoopValue(Vec<&'c str>),
    Parameters,
    /// Sees what is local to the body.
    Until,
}

impl Default for Scopes<'_> {
    fn default() -> Self {
        Scopes { open: vec![Open::new(Bracket::Block)], last: "", complete: false, in_label: false, head: None }
    }
}

impl<'c> Scopes<'c> {
    /// Whether the next token is a free name.
    fn next(&mut self, kind: TokenKind, text: &'c str, following: &str) -> bool {
        if self.complete && !continues(kind, text) {
            self.end_statement();
        }
        let is_free = match kind {
            TokenKind::Name => self.name(text, following),
            TokenKind::Keyword => self.keyword(text),
            TokenKind::Symbol => self.symbol(text),
            _ => false,
        };
        self.complete = match kind {
            TokenKind::Keyword => matches!(text, "nil" | "true" | "false" | "end"),
            TokenKind::Symbol => matches!(text, ")" | "]" | "}" | "..."),
            _ => true,
        };
        self.last = text;
        is_free
    }

    fn top(&mut self) -> &mut Open<'c> {
        if self.open.is_empty() {
            self.open.push(Open::new(Bracket::Block));
        }
        let last = self.open.len() - 1;
        &mut self.open[last]
    }

    /// What was declared with a value is seen from here on.
    fn end_statement(&mut self) {
        let top = self.top();
        match std::mem::replace(&mut top.statement, Statement::Plain) {
            Statement::LocalValue(names) => top.locals.extend(names),
            Statement::Until => self.close(),
            unfinished => top.statement = unfinished,
        }
    }

    fn name(&mut self, text: &'c str, following: &str) -> bool {
        if self.last == "goto" || self.in_label || matches!(self.last, "." | ":") {
            return false;
        }
        let (last, in_head) = (self.last, self.head.is_some());
        let top = self.top();
        if top.bracket == Bracket::Curly && matches!(last, "{" | "," | ";") && following == "=" {
            return false;
        }
        match &mut top.statement {
            Statement::Local(names) if matches!(last, "local" | ",") => names.push(text),
            Statement::Local(_) if last == "<" => {}
            Statement::Local(_) if last == "function" && in_head => {
                top.locals.push(text);
                top.statement = Statement::Plain;
            }
            Statement::For(names) => names.push(text),
            Statement::Parameters => top.locals.push(text),
            _ => {
                self.declare();
                return !self.open.iter().any(|open| open.locals.contains(&text));
            }
        }
        false
    }

    /// Locals without a value.
    fn declare(&mut self) {
        let top = self.top();
        if let Statement::Local(names) = &mut top.statement {
            top.locals.append(names);
            top.statement = Statement::Plain;
        }
    }

    fn keyword(&mut self, text: &str) -> bool {
        if text != "function" || self.last != "local" {
            self.declare();
        }
        match text {
            "local" => self.top().statement = Statement::Local(Vec::new()),
            "for" => self.top().statement = Statement::For(Vec::new()),
            "function" => self.head = Some(Head::Function),
            "in" => self.end_loop_names(),
            "do" => {
                let locals = match std::mem::replace(&mut self.top().statement, Statement::Plain) {
                    Statement::LoopValue(names) => names,
                    _ => Vec::new(),
                };
                self.open.push(Open { locals, ..Open::new(Bracket::Block) });
            }
            "then" | "repeat" => self.open.push(Open::new(Bracket::Block)),
            "else" => {
                self.close();
                self.open.push(Open::new(Bracket::Block));
            }
            "elseif" | "end" => self.close(),
            "until" => self.top().statement = Statement::Until,
            _ => {}
        }
        false
    }

    fn end_loop_names(&mut self) {
        let top = self.top();
        if let Statement::For(names) = &mut top.statement {
            top.statement = Statement::LoopValue(std::mem::take(names));
        }
    }

    fn symbol(&mut self, text: &str) -> bool {
        if text == "=" {
            self.end_loop_names();
        }
        let top = self.top();
        match (text, &mut top.statement) {
            ("=", Statement::Local(names)) => top.statement = Statement::LocalValue(std::mem::take(names)),
            ("," | "<" | ">", Statement::Local(_)) => {}
            (_, Statement::Local(_)) => self.declare(),
            (")", Statement::Parameters) => {
                top.statement = Statement::Plain;
                return false;
            }
            _ => {}
        }
        match text {
            "(" => match self.head.take() {
                Some(head) => self.open.push(Open::function(head)),
                None => self.open.push(Open::new(Bracket::Other)),
            },
            "[" => self.open.push(Open::new(Bracket::Other)),
            "{" => self.open.push(Open::new(Bracket::Curly)),
            ")" | "]" | "}" if self.top().bracket != Bracket::Block => drop(self.open.pop()),
            ":" if self.head.is_some() => self.head = Some(Head::Method),
            "::" => self.in_label = !self.in_label,
            _ => {}
        }
        false
    }

    /// The innermost block ends, and with it brackets that were left open in it.
    fn close(&mut self) {
        while self.open.pop().is_some_and(|open| open.bracket != Bracket::Block) {}
    }
}

impl<'c> Open<'c> {
    fn new(bracket: Bracket) -> Self {
        Open { bracket, locals: Vec::new(), statement: Statement::Plain }
    }

    fn function(head: Head) -> Self {
        let locals = if head == Head::Method { vec!["self"] } else { Vec::new() };
        Open { bracket: Bracket::Block, locals, statement: Statement::Parameters }
    }
}

/// Whether an expression that could be over goes on with this token.
fn continues(kind: TokenKind, text: &str) -> bool {
    match kind {
        TokenKind::String => true,
        TokenKind::Keyword => matches!(text, "and" | "or"),
        TokenKind::Symbol => !matches!(text, ")" | "]" | "}" | ";" | "::" | "=" | "..."),
        _ => false,
    }
}
