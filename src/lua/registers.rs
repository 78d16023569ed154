//! What registers hold while a function's instructions are read one after another: how fields of free names are used, and
//! what the function gives in any case. Where ways meet nothing is known, so what is said is certain.

use std::collections::HashSet;

use super::bytecode::{Constant, Function};
use super::instruction::*;

/// A field of a free name, or a field of its field and so on.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct FieldUse {
    /// `robot` of `robot.light.data`
    pub name: String,
    /// `light`, `data`
    pub fields: Vec<String>,
    /// 1-based in the block's text.
    pub line: u32,
    pub kind: FieldKind,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum FieldKind {
    Read,
    Write,
    /// `robot:age()`
    Method,
    /// `robot.move{ linear = 1 }`: a field of the table that a function is called with.
    Given,
}

/// What a block gives, whatever happens.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub enum Gives {
    /// That depends.
    #[default]
    Something,
    /// It has no value, as statements without `return`.
    Nothing,
    Nil,
    True,
    False,
    Number(f64),
    Text,
    Table,
    Function,
    /// A number made of bits, by `&` or `|`.
    Bits,
}

impl Gives {
    /// Its type, as Lua calls it.
    pub fn name(self) -> &'static str {
        match self {
            Gives::Something => "something",
            Gives::Nothing => "nothing",
            Gives::Nil => "nil",
            Gives::True | Gives::False => "boolean",
            Gives::Number(_) | Gives::Bits => "number",
            Gives::Text => "string",
            Gives::Table => "table",
            Gives::Function => "function",
        }
    }
}

pub(super) fn follow(function: &Function) -> (Vec<FieldUse>, Gives) {
    let mut walk = Walk { function, held: Vec::new(), tables: Vec::new(), fields: Vec::new(), gives: None };
    let targets = targets(function);
    let mut straight = true;
    for at in 0..function.code.len() {
        if targets.contains(&at) {
            walk.held.clear();
            straight = false;
        }
        straight &= !function.code[at].is_test() && function.code[at].jump().is_none();
        walk.step(at, straight);
    }
    (walk.fields, walk.gives.unwrap_or_default())
}

fn targets(function: &Function) -> HashSet<usize> {
    let jumps = function.code.iter().enumerate();
    jumps.filter_map(|(at, word)| usize::try_from(at as i64 + 1 + word.jump()?).ok()).collect()
}

#[derive(Clone)]
enum Held {
    Free {
        name: String,
        fields: Vec<String>,
    },
    /// Made here, by its number.
    Table(usize),
    Constant(Gives),
}

/// A table's fields that were given by name: each with its line and, if that is a table made here, its value.
#[derive(Default)]
struct Table(Vec<(String, u32, Option<usize>)>);

struct Walk<'a, 'b> {
    function: &'a Function<'b>,
    held: Vec<Option<Held>>,
    tables: Vec<Table>,
    fields: Vec<FieldUse>,
    /// What it gives at the first return that is always reached.
    gives: Option<Gives>,
}

impl Walk<'_, '_> {
    fn step(&mut self, at: usize, straight: bool) {
        let word = self.function.code[at];
        match word.opcode() {
            SETFIELD => self.set_field(at, word),
            CALL | TAILCALL if word.b() == 2 => self.call(word),
            RETURN..=RETURN1 if straight && self.gives.is_none() => self.give(word),
            _ => {}
        }
        if word.writes_nothing() {
            return;
        }
        let held = self.result(at, word);
        // What lies above is a function's arguments, a loop's variables or nothing any more.
        self.held.truncate(word.a());
        if !self.function.shared.contains(&word.a()) {
            self.held.resize(word.a(), None);
            self.held.push(held);
        }
    }

    fn held(&self, register: usize) -> Option<&Held> {
        self.held.get(register)?.as_ref()
    }

    fn result(&mut self, at: usize, word: Instruction) -> Option<Held> {
        let number = |number| Some(Held::Constant(Gives::Number(number)));
        match word.opcode() {
            MOVE => self.held(word.b()).cloned(),
            LOADI | LOADF => number(word.sbx() as f64),
            LOADK => match *self.function.constants.get(word.bx())? {
                Constant::Number(value) => number(value),
                Constant::Text(_) => Some(Held::Constant(Gives::Text)),
                Constant::Other => None,
            },
            LOADFALSE => Some(Held::Constant(Gives::False)),
            LOADTRUE => Some(Held::Constant(Gives::True)),
            LOADNIL => Some(Held::Constant(Gives::Nil)),
            CLOSURE => Some(Held::Constant(Gives::Function)),
            BAND | BOR | BANDK | BORK => Some(Held::Constant(Gives::Bits)),
            NEWTABLE => {
                self.tables.push(Table::default());
                Some(Held::Table(self.tables.len() - 1))
            }
            GETTABUP if self.function.is_environment(word.b()) => {
                Some(Held::Free { name: self.function.text(word.c())?, fields: Vec::new() })
            }
            GETFIELD => self.field(at, word.b(), word.c(), FieldKind::Read),
            SELF if word.k() => {
                self.field(at, word.b(), word.c(), FieldKind::Method);
                None
            }
            _ => None,
        }
    }

    /// Takes note of a field of what a register holds.
    fn field(&mut self, at: usize, table: usize, key: usize, kind: FieldKind) -> Option<Held> {
        let Held::Free { name, mut fields } = self.held(table)?.clone() else { return None };
        fields.push(self.function.text(key)?);
        self.fields.push(FieldUse { name: name.clone(), fields: fields.clone(), line: self.function.line(at), kind });
        Some(Held::Free { name, fields })
    }

    fn set_field(&mut self, at: usize, word: Instruction) {
        match self.held(word.a()) {
            Some(Held::Free { .. }) => drop(self.field(at, word.a(), word.b(), FieldKind::Write)),
            Some(&Held::Table(table)) => {
                let value = match self.held(word.c()) {
                    Some(&Held::Table(inner)) if !word.k() => Some(inner),
                    _ => None,
                };
                let line = self.function.line(at);
                self.tables[table].0.extend(self.function.text(word.b()).map(|key| (key, line, value)));
            }
            _ => {}
        }
    }

    /// A call with one argument: what is called is in the register before it.
    fn call(&mut self, word: Instruction) {
        if let (Some(Held::Free { name, fields }), Some(&Held::Table(table))) =
            (self.held(word.a()).cloned(), self.held(word.a() + 1))
        {
            self.given(&name, &fields, table);
        }
    }

    fn given(&mut self, name: &str, path: &[String], table: usize) {
        for (key, line, inner) in std::mem::take(&mut self.tables[table].0) {
            let fields: Vec<String> = path.iter().cloned().chain([key]).collect();
            let found = FieldUse { name: name.to_string(), fields: fields.clone(), line, kind: FieldKind::Given };
            self.fields.push(found);
            if let Some(inner) = inner {
                self.given(name, &fields, inner);
            }
        }
    }

    fn give(&mut self, word: Instruction) {
        let count = match word.opcode() {
            RETURN0 => 0,
            RETURN1 => 1,
            // None where that depends on a call.
            _ => word.b().wrapping_sub(1),
        };
        self.gives = Some(match (count, self.held(word.a())) {
            (0, _) => Gives::Nothing,
            (1, Some(Held::Constant(gives))) => *gives,
            (1, Some(Held::Table(_))) => Gives::Table,
            _ => Gives::Something,
        });
    }
}
