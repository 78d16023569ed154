//! One instruction of Lua 5.4's bytecode: its number and its fields. Knows nothing of what instructions do.

macro_rules! opcodes {
    ($($name:ident $number:literal,)*) => {$( pub(super) const $name: u32 = $number; )*};
}

opcodes! {
    MOVE 0,
    LOADI 1,
    LOADF 2,
    LOADK 3,
    LOADKX 4,
    LOADFALSE 5,
    LOADTRUE 7,
    LOADNIL 8,
    GETUPVAL 9,
    SETUPVAL 10,
    GETTABUP 11,
    GETTABLE 12,
    GETFIELD 14,
    SETTABUP 15,
    SETTABLE 16,
    SETI 17,
    SETFIELD 18,
    NEWTABLE 19,
    SELF 20,
    BANDK 29,
    BORK 30,
    BAND 41,
    BOR 42,
    MMBIN 46,
    MMBINI 47,
    MMBINK 48,
    CLOSE 54,
    TBC 55,
    JMP 56,
    EQ 57,
    TEST 66,
    TESTSET 67,
    CALL 68,
    TAILCALL 69,
    RETURN 70,
    RETURN0 71,
    RETURN1 72,
    FORLOOP 73,
    FORPREP 74,
    TFORPREP 75,
    TFORLOOP 77,
    SETLIST 78,
    CLOSURE 79,
    EXTRAARG 82,
}

/// The bias of a signed field of 17 bits, and of 25 bits.
const BIAS_BX: i64 = (1 << 16) - 1;
const BIAS_J: i64 = (1 << 24) - 1;

/// Its fields as Lua names them.
#[derive(Clone, Copy)]
pub(super) struct Instruction(pub u32);

impl Instruction {
    pub fn opcode(self) -> u32 {
        self.0 & 0x7F
    }
    pub fn a(self) -> usize {
        (self.0 >> 7 & 0xFF) as usize
    }
    pub fn k(self) -> bool {
        self.0 >> 15 & 1 == 1
    }
    pub fn b(self) -> usize {
        (self.0 >> 16 & 0xFF) as usize
    }
    pub fn c(self) -> usize {
        (self.0 >> 24) as usize
    }
    pub fn bx(self) -> usize {
        (self.0 >> 15) as usize
    }
    pub fn sbx(self) -> i64 {
        self.bx() as i64 - BIAS_BX
    }
    pub fn ax(self) -> usize {
        (self.0 >> 7) as usize
    }

    /// How far behind the next instruction it may go on, if it is a jump.
    pub fn jump(self) -> Option<i64> {
        match self.opcode() {
            JMP => Some(i64::from(self.0 >> 7) - BIAS_J),
            FORLOOP | TFORLOOP => Some(-(self.bx() as i64)),
            FORPREP => Some(self.bx() as i64 + 1),
            TFORPREP => Some(self.bx() as i64),
            _ => None,
        }
    }

    pub fn is_test(self) -> bool {
        (EQ..=TESTSET).contains(&self.opcode())
    }

    /// Whether it leaves all registers as they are.
    pub fn writes_nothing(self) -> bool {
        matches!(
            self.opcode(),
            SETUPVAL | SETTABUP | SETTABLE | SETI | SETFIELD | MMBIN | MMBINI | MMBINK | CLOSE | TBC | JMP | EQ
                ..=TEST | RETURN | RETURN0 | RETURN1 | SETLIST | EXTRAARG
        )
    }
}
