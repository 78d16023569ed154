//! Finds the free names of a compiled text in Lua's own bytecode, so scoping is exactly Lua's. Knows the format of Lua 5.4 and nothing of blocks.

use std::rc::Rc;

use super::instruction::*;
use super::registers::{self, FieldUse, Gives};

/// A free name, where it is used, and how.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(super) struct Use {
    pub name: String,
    pub line: u32,
    pub kind: Kind,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Kind {
    Read,
    Write,
}

/// Signature, version, format, check bytes, three sizes, an integer, a number, the count of upvalues.
pub(super) const HEADER: usize = 4 + 1 + 1 + 6 + 3 + 8 + 8 + 1;
/// In place of a line's difference: the line is in the other list.
const ABSOLUTE: i8 = -0x80;

/// What a compiled text says of itself; uses by line.
#[derive(Debug, Default)]
pub(super) struct Read {
    pub uses: Vec<Use>,
    pub fields: Vec<FieldUse>,
    pub gives: Gives,
}

/// Reads a function as `lua_dump` writes it, unstripped; nothing if the bytes aren't such.
pub(super) fn read(dump: &[u8]) -> Option<Read> {
    let mut reader = Reader { bytes: dump.get(HEADER..)? };
    let mut read = Read::default();
    reader.function(None, &mut read)?;
    read.uses.sort_by_key(|found| found.line);
    read.fields.sort_by_key(|found| found.line);
    Some(read)
}

struct Reader<'a> {
    bytes: &'a [u8],
}

/// Which of a function's upvalues are the environment.
type Environments = Rc<[bool]>;

impl<'a> Reader<'a> {
    fn take(&mut self, count: usize) -> Option<&'a [u8]> {
        let (taken, rest) = self.bytes.split_at_checked(count)?;
        self.bytes = rest;
        Some(taken)
    }

    fn byte(&mut self) -> Option<u8> {
        Some(self.take(1)?[0])
    }

    fn size(&mut self) -> Option<usize> {
        let mut size = 0_usize;
        loop {
            let byte = self.byte()?;
            size = size.checked_mul(128)? | usize::from(byte & 0x7F);
            if byte & 0x80 != 0 {
                return Some(size);
            }
        }
    }

    fn string(&mut self) -> Option<&'a [u8]> {
        match self.size()? {
            0 => Some(b""),
            size => self.take(size - 1),
        }
    }

    /// A function and those in it; `outer` is that of the function around it. Gives the registers of that one which this
    /// one shares.
    fn function(&mut self, outer: Option<&Environments>, read: &mut Read) -> Option<Vec<usize>> {
        self.string()?;
        let first_line = self.size()?;
        self.size()?;
        self.take(3)?;
        let count = self.size()?;
        let (words, _) = self.take(count.checked_mul(4)?)?.as_chunks::<4>();
        let code: Vec<_> = words.iter().map(|word| Instruction(u32::from_ne_bytes(*word))).collect();
        let constants = self.constants()?;
        let (environments, taken) = self.upvalues(outer)?;
        let mut shared = Vec::new();
        for _ in 0..self.size()? {
            shared.extend(self.function(Some(&environments), read)?);
        }
        let lines = self.lines(first_line)?;
        self.skip_names()?;
        let function = Function { code, constants, environments, lines, shared };
        read.uses.extend(function.uses());
        let (fields, gives) = registers::follow(&function);
        read.fields.extend(fields);
        // The text's own function comes last.
        read.gives = gives;
        Some(taken)
    }

    fn constants(&mut self) -> Option<Vec<Constant<'a>>> {
        let count = self.size()?;
        let mut constants = Vec::new();
        for _ in 0..count {
            constants.push(match self.byte()? {
                0 | 1 | 17 => Constant::Other,
                3 => Constant::Number(i64::from_ne_bytes(self.take(8)?.try_into().ok()?) as f64),
                19 => Constant::Number(f64::from_ne_bytes(self.take(8)?.try_into().ok()?)),
                4 | 20 => Constant::Text(self.string()?),
                _ => return None,
            });
        }
        Some(constants)
    }

    /// Which upvalues are the environment, and which registers of the function around it are among them. The text's only
    /// upvalue is its environment; an inner function's is, if it takes that of the function around it.
    fn upvalues(&mut self, outer: Option<&Environments>) -> Option<(Environments, Vec<usize>)> {
        let count = self.size()?;
        let mut environments = Vec::new();
        let mut taken = Vec::new();
        for _ in 0..count {
            let (in_stack, index) = (self.byte()? != 0, usize::from(self.byte()?));
            self.byte()?;
            environments.push(match outer {
                None => true,
                Some(outer) => !in_stack && outer.get(index).copied().unwrap_or(false),
            });
            taken.extend(Some(index).filter(|_| in_stack));
        }
        Some((environments.into(), taken))
    }

    /// The line of each instruction.
    fn lines(&mut self, first: usize) -> Option<Vec<u32>> {
        let count = self.size()?;
        let differences = self.take(count)?;
        let mut absolute = Vec::new();
        for _ in 0..self.size()? {
            absolute.push((self.size()?, self.size()?));
        }
        let (mut line, mut absolute) = (first as i64, absolute.into_iter());
        let mut lines = Vec::with_capacity(count);
        for &difference in differences {
            line = match difference as i8 {
                ABSOLUTE => absolute.next()?.1 as i64,
                difference => line + i64::from(difference),
            };
            lines.push(line as u32);
        }
        Some(lines)
    }

    fn skip_names(&mut self) -> Option<()> {
        for _ in 0..self.size()? {
            self.string()?;
            self.size()?;
            self.size()?;
        }
        for _ in 0..self.size()? {
            self.string()?;
        }
        Some(())
    }
}

/// What an instruction may refer to by number.
#[derive(Clone, Copy)]
pub(super) enum Constant<'a> {
    Text(&'a [u8]),
    Number(f64),
    Other,
}

pub(super) struct Function<'a> {
    pub code: Vec<Instruction>,
    pub constants: Vec<Constant<'a>>,
    environments: Environments,
    lines: Vec<u32>,
    /// Registers that functions in it read and write as well.
    pub shared: Vec<usize>,
}

impl Function<'_> {
    pub fn line(&self, at: usize) -> u32 {
        self.lines.get(at).copied().unwrap_or(0)
    }

    pub fn text(&self, constant: usize) -> Option<String> {
        match self.constants.get(constant)? {
            Constant::Text(text) => Some(String::from_utf8_lossy(text).into_owned()),
            _ => None,
        }
    }

    fn uses(&self) -> impl Iterator<Item = Use> + '_ {
        (0..self.code.len()).filter_map(|at| {
            let (constant, kind) = self.use_at(at)?;
            Some(Use { name: self.text(constant)?, line: self.line(at), kind })
        })
    }

    /// The constant that names what the instruction uses of the environment.
    fn use_at(&self, at: usize) -> Option<(usize, Kind)> {
        let instruction = self.code[at];
        match instruction.opcode() {
            GETTABUP if self.is_environment(instruction.b()) => Some((instruction.c(), Kind::Read)),
            SETTABUP if self.is_environment(instruction.a()) => Some((instruction.b(), Kind::Write)),
            GETUPVAL if self.is_environment(instruction.b()) => self.long_use(at),
            _ => None,
        }
    }

    pub fn is_environment(&self, upvalue: usize) -> bool {
        self.environments.get(upvalue).copied().unwrap_or(false)
    }

    /// Where a name is long, or one of more than 255 constants, environment and name are put in registers first.
    fn long_use(&self, at: usize) -> Option<(usize, Kind)> {
        let table = self.code[at].a();
        let load = *self.code.get(at + 1)?;
        let (constant, next) = match load.opcode() {
            LOADK => (load.bx(), at + 2),
            LOADKX => (self.code.get(at + 2)?.ax(), at + 3),
            _ => return None,
        };
        let key = load.a();
        let used = self.code[next..].iter().find_map(|user| match user.opcode() {
            GETTABLE if user.b() == table && user.c() == key => Some(Kind::Read),
            SETTABLE if user.a() == table && user.b() == key => Some(Kind::Write),
            _ => None,
        });
        Some((constant, used?))
    }
}
