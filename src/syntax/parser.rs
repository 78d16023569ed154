//! From a text to its tree: reads the brackets, then each form where it stands. A broken form is left out and reported; the rest is kept.
//! Never fails, and knows nothing of what names mean.

use super::ast::{Entry, Form as TopForm, Machine, MachineItem, State, StateItem, Tree};
use super::diagnostic::{Code, Diagnostic};
use super::findings::Findings;
use super::form::{Form, Text};
use super::keyword::{Keyword, Place};
use super::leaves::{action, breakpoint, bridge, event, export, import, one_action, spawn, var};
use super::misplaced::{bad_first_node, misplaced, outside, unknown};
use super::pieces::{PieceKind, control_characters};
use super::reader::{Close, Group, Node, read};
use super::source::{FileId, Source, Span};
use super::transition::transition;

/// Bytes; a longer text is not read.
pub const MAX_BYTES: usize = 8 << 20;

#[derive(Clone, Debug, PartialEq)]
pub struct Parsed {
    /// What could be understood; complete if there are no errors among the diagnostics.
    pub tree: Tree,
    /// In the order of the text; not more than 50.
    pub diagnostics: Vec<Diagnostic>,
}

/// Parses any text whatever, in time proportional to its length. `file` is put into the spans.
pub fn parse(source: &Source, file: FileId) -> Parsed {
    let text = &*source.text;
    if text.len() > MAX_BYTES {
        let message =
            format!("the text is too large: {} MB, where {} MB is the most", text.len() >> 20, MAX_BYTES >> 20);
        let error =
            Diagnostic::error(Code::TooLarge, Span::new(file, 0, 0), message).help("check that this is the right file");
        return Parsed { tree: Tree::default(), diagnostics: vec![error] };
    }
    if let Some(error) = control_characters(text, file) {
        return Parsed { tree: Tree::default(), diagnostics: vec![error] };
    }
    let mut findings = Findings::default();
    let root = read(text, file, &mut findings);
    let mut parser = Parser { text: Text { text, file }, findings };
    let forms = parser.items(&root, &root.nodes, Place::Top, Parser::top_form);
    Parsed { tree: Tree { forms }, diagnostics: parser.findings.sorted() }
}

struct Parser<'a> {
    text: Text<'a>,
    findings: Findings,
}

/// Whether a form's keyword was written so, or is what was probably meant.
#[derive(Clone, Copy, PartialEq, Eq)]
enum Reading {
    Sure,
    Guess,
}

impl<'a> Parser<'a> {
    /// The forms among these nodes that may stand in this place; everything else is reported.
    fn items<T>(
        &mut self,
        parent: &'a Group,
        nodes: &'a [Node],
        place: Place,
        item: fn(&mut Self, &mut Form<'a>) -> Option<T>,
    ) -> Vec<T> {
        let mut items = Vec::new();
        let mut rest = nodes;
        while let Some(node) = rest.first() {
            let leaves = rest.iter().take_while(|node| matches!(node, Node::Leaf(_))).count();
            match node {
                Node::Group(group) => items.extend(self.form(group, parent, place, item)),
                Node::Leaf(_) if parent.hurt => {}
                Node::Leaf(_) => self.findings.add(outside(self.text, &rest[..leaves], place)),
            }
            rest = &rest[leaves.max(1)..];
        }
        items
    }

    fn form<T>(
        &mut self,
        group: &'a Group,
        parent: &Group,
        place: Place,
        item: fn(&mut Self, &mut Form<'a>) -> Option<T>,
    ) -> Option<T> {
        let (keyword, reading) = self.keyword(group, place)?;
        if !keyword.may_stand(place) {
            if reading == Reading::Sure {
                self.findings.add(misplaced(self.text, keyword, group, parent, place));
            }
            return None;
        }
        let mut form = Form::new(self.text, group, keyword);
        let found = item(self, &mut form);
        if let Some(fault) = form.fault
            && reading == Reading::Sure
        {
            self.fault(group, keyword, fault);
        }
        found
    }

    fn keyword(&mut self, group: &Group, place: Place) -> Option<(Keyword, Reading)> {
        if let Some(keyword) = group.keyword {
            return Some((keyword, Reading::Sure));
        }
        let Some(first) = group.nodes.first().filter(|node| node.is(PieceKind::Word)) else {
            if !group.hurt {
                let diagnostic = bad_first_node(self.text, group, place);
                self.findings.add(diagnostic);
            }
            return None;
        };
        let (diagnostic, guess) = unknown(self.text, first, place);
        self.findings.add(diagnostic);
        guess.map(|keyword| (keyword, Reading::Guess))
    }

    /// What is wrong with a form, unless that follows from what is known already.
    fn fault(&mut self, group: &Group, keyword: Keyword, fault: Diagnostic) {
        let container = matches!(keyword, Keyword::Machine | Keyword::State);
        if group.hurt {
            return;
        }
        if group.close == Close::Bracket || container {
            return self.findings.add(fault);
        }
        // Of a form that is both cut off and not closed, say what it lacks.
        let unclosed = |found: &Diagnostic| found.code == Code::UnclosedBracket && found.span.start == group.start;
        if let Some(found) = self.findings.find(unclosed) {
            let also = std::mem::take(&mut found.also);
            *found = Diagnostic { also, ..fault };
        }
    }

    fn top_form(&mut self, form: &mut Form<'a>) -> Option<TopForm> {
        match form.keyword {
            Keyword::Bridge => bridge(form).map(TopForm::Bridge),
            Keyword::Import => import(form).map(TopForm::Import),
            Keyword::Export => export(form).map(TopForm::Export),
            Keyword::Var => var(form).map(TopForm::Var),
            Keyword::Machine => self.machine(form).map(TopForm::Machine),
            Keyword::Spawn => spawn(form).map(TopForm::Spawn),
            Keyword::Onpause => action(form).map(TopForm::OnPause),
            Keyword::Onresume => action(form).map(TopForm::OnResume),
            _ => None,
        }
    }

    fn machine(&mut self, form: &mut Form<'a>) -> Option<Machine> {
        let name = form.title("the machine's name");
        let items = self.items(form.group, form.rest, Place::Machine, Parser::machine_item);
        Some(Machine { span: form.span(), name: name?, items })
    }

    fn machine_item(&mut self, form: &mut Form<'a>) -> Option<MachineItem> {
        match form.keyword {
            Keyword::Var => var(form).map(MachineItem::Var),
            Keyword::Event => event(form).map(MachineItem::Event),
            Keyword::State => self.state(form).map(MachineItem::State),
            Keyword::On | Keyword::Eps | Keyword::Ontime | Keyword::Exit => {
                transition(form).map(MachineItem::Transition)
            }
            _ => None,
        }
    }

    fn state(&mut self, form: &mut Form<'a>) -> Option<State> {
        let name = form.title("the state's name");
        let items = self.items(form.group, form.rest, Place::State, Parser::state_item);
        Some(State { span: form.span(), name: name?, items })
    }

    fn state_item(&mut self, form: &mut Form<'a>) -> Option<StateItem> {
        match form.keyword {
            Keyword::Onentry => self.entry(form).map(StateItem::OnEntry),
            Keyword::Running => action(form).map(StateItem::Running),
            Keyword::Onexit => action(form).map(StateItem::OnExit),
            Keyword::Break => breakpoint(form).map(StateItem::Break),
            Keyword::Machine => self.machine(form).map(StateItem::Machine),
            _ => None,
        }
    }

    fn entry(&mut self, form: &mut Form<'a>) -> Option<Entry> {
        let Some(Node::Group(group)) = form.rest.first() else {
            let block = form.block("the action")?;
            one_action(form);
            return Some(Entry::Action(block));
        };
        form.next();
        let spawned = self.form(group, form.group, Place::OnEntry, |_, form| spawn(form));
        form.finish();
        spawned.map(Entry::Spawn)
    }
}
