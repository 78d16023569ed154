//! A direct command being written: opcodes, their parameters, and room for what the brick answers. Knows no opcode.

/// Operations that the brick does one after the other, and how many bytes it answers.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Command {
    ops: Vec<u8>,
    globals: u16,
}

/// Where a number stands in the brick's answer.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct At(u16);

impl Command {
    /// An opcode, or the subcode after it.
    pub fn op(&mut self, code: u8) -> &mut Command {
        self.ops.push(code);
        self
    }

    /// A constant, in as few bytes as it needs. The lowest of each size stand for "no value" on the brick, so they take
    /// the next size.
    pub fn number(&mut self, number: i32) -> &mut Command {
        match number {
            -32..=31 => self.ops.push(number as u8 & 0x3f),
            -127..=127 => self.ops.extend([0x81, number as u8]),
            -32767..=32767 => {
                self.ops.push(0x82);
                self.ops.extend((number as i16).to_le_bytes());
            }
            _ => {
                self.ops.push(0x83);
                self.ops.extend(number.to_le_bytes());
            }
        }
        self
    }

    pub fn numbers(&mut self, numbers: &[i32]) -> &mut Command {
        numbers.iter().fold(self, |command, &number| command.number(number))
    }

    /// A text, which ends at its first zero byte.
    pub fn text(&mut self, text: &str) -> &mut Command {
        self.ops.push(0x84);
        self.ops.extend(text.bytes().take_while(|&byte| byte != 0));
        self.ops.push(0);
        self
    }

    /// Has the brick answer a byte.
    pub fn byte(&mut self) -> At {
        self.room(1)
    }

    /// Has the brick answer four bytes.
    pub fn word(&mut self) -> At {
        self.room(4)
    }

    /// Room at a multiple of its size: the brick's processor wants it so.
    fn room(&mut self, size: u16) -> At {
        let at = self.globals.next_multiple_of(size);
        self.globals = at + size;
        match at {
            0..=31 => self.ops.push(0x60 | at as u8),
            32..=255 => self.ops.extend([0xe1, at as u8]),
            _ => {
                self.ops.push(0xe2);
                self.ops.extend(at.to_le_bytes());
            }
        }
        At(at)
    }

    /// Another command's operations after these. Neither may answer anything.
    pub fn then(&mut self, other: &Command) {
        debug_assert!(self.globals == 0 && other.globals == 0);
        self.ops.extend(&other.ops);
    }

    pub fn ops(&self) -> &[u8] {
        &self.ops
    }

    /// Bytes that the brick answers.
    pub fn globals(&self) -> u16 {
        self.globals
    }
}

/// What the brick answered to a command.
#[derive(Clone, Copy, Debug)]
pub struct Answer<'a>(pub &'a [u8]);

impl Answer<'_> {
    pub fn byte(self, At(at): At) -> Option<u8> {
        self.0.get(usize::from(at)).copied()
    }

    /// A number of one byte; none: no value.
    pub fn small(self, at: At) -> Option<i8> {
        self.byte(at).map(|byte| byte as i8).filter(|&number| number != i8::MIN)
    }

    /// A number of four bytes; none: no value.
    pub fn integer(self, at: At) -> Option<i32> {
        self.word(at).map(i32::from_le_bytes).filter(|&number| number != i32::MIN)
    }

    /// A number with decimals; none: no value.
    pub fn real(self, at: At) -> Option<f32> {
        self.word(at).map(f32::from_le_bytes).filter(|number| number.is_finite())
    }

    fn word(self, At(at): At) -> Option<[u8; 4]> {
        let at = usize::from(at);
        self.0.get(at..at + 4)?.try_into().ok()
    }
}
