//! Large programs made up by rule: nested machines with variables, events, states and blocks such as people write, the
//! same each time for the same size and seed; and the same program after an edit. Knows nothing of what is done with them.

use std::fmt::Write;

#[derive(Clone, Copy)]
pub struct Size {
    /// Of all depths together, in families of five: three of them, one inside the other, run; two wait in other states.
    pub machines: usize,
    /// Of each machine: at least [`FEWEST`].
    pub states: usize,
    pub seed: u64,
}

/// Each machine goes to and fro between its first two states; others contain machines that never run.
pub const FEWEST: usize = 8;

/// In what a program differs from the one first made of its size. The actions of states that are ever active stay, so no
/// edit makes anything start again.
#[derive(Clone, Copy, PartialEq)]
pub enum Edit {
    Nothing,
    /// A number in each of so many blocks, spread over the program: another one for each version from 1 on.
    Blocks {
        count: usize,
        version: u64,
    },
    AddedState,
    RenamedState,
    /// The top-level machines in the opposite order.
    Order,
    /// Blanks and comments between the forms.
    Layout,
}

/// For each machine of a family the one it is written in, and in which state of that.
const NESTING: [Option<(usize, usize)>; 5] = [None, Some((0, 0)), Some((1, 0)), Some((0, 5)), Some((3, 2))];
const EVENTS: usize = 4;

pub fn program(size: Size, edit: Edit) -> String {
    let total = Writer::new(size, Edit::Nothing, 0).program().written;
    Writer::new(size, edit, total).program().text
}

struct Writer {
    size: Size,
    edit: Edit,
    text: String,
    dice: u64,
    /// Blocks written so far that an edit may change, and how many there will be.
    written: usize,
    total: usize,
}

/// Where something is written.
#[derive(Clone, Copy)]
struct At {
    machine: usize,
    indent: usize,
}

impl Writer {
    fn new(size: Size, edit: Edit, total: usize) -> Writer {
        assert!(size.states >= FEWEST && size.machines.is_multiple_of(NESTING.len()));
        Writer { size, edit, text: String::new(), dice: 0, written: 0, total }
    }

    fn program(mut self) -> Self {
        let mut families: Vec<usize> = (0..self.size.machines).step_by(NESTING.len()).collect();
        for global in ["light := [200]", "limit := [0.8]", "pressed := [false]"] {
            self.line(0, &format!("(var {global})"));
        }
        if self.edit == Edit::Order {
            families.reverse();
        }
        for &family in &families {
            // Each family has dice of its own: it stays the same wherever it is written.
            self.dice = self.size.seed.wrapping_mul(0x9e37_79b9_7f4a_7c15) ^ (family as u64 + 1);
            self.machine(At { machine: family, indent: 0 });
        }
        families.sort_unstable();
        for family in families {
            self.line(0, &format!("(spawn m{family} s0)"));
        }
        self
    }

    fn machine(&mut self, at: At) {
        let At { machine, indent } = at;
        self.line(indent, &format!("(machine m{machine}"));
        let inside = At { indent: indent + 2, ..at };
        let start = self.roll(500);
        self.line(inside.indent, &format!("(var speed{machine} := [0.{start}])"));
        self.line(inside.indent, &format!("(var count{machine} := [0])"));
        self.line(inside.indent, &format!("(var pose{machine} := [{{ x = {start}, y = 0 }}])"));
        for event in 0..EVENTS {
            let condition = self.condition(machine);
            self.line(inside.indent, &format!("(event e{event} [{condition}])"));
        }
        for state in 0..self.size.states {
            self.state(inside, state);
        }
        if self.edit == Edit::AddedState && machine == 3 {
            self.line(inside.indent, "(state another (running [count3 = count3 + 1]))");
        }
        self.line(indent, ")");
    }

    fn state(&mut self, at: At, state: usize) {
        let inside = At { indent: at.indent + 2, ..at };
        let name = self.name(at.machine, state);
        self.line(at.indent, &format!("(state {name}"));
        if state < 2 {
            let count = at.machine;
            self.line(inside.indent, &format!("(running [count{count} = count{count} + 1])"));
        } else {
            self.actions(inside);
        }
        if let Some(nested) = self.nested(at.machine, state) {
            self.line(inside.indent, &format!("(onentry (spawn m{nested} s0))"));
            self.machine(At { machine: nested, ..inside });
        }
        self.line(at.indent, ")");
        self.transitions(at, state);
    }

    fn actions(&mut self, at: At) {
        for (form, percent) in [("onentry", 60), ("running", 80), ("onexit", 30)] {
            if self.roll(100) < percent {
                let action = self.action(at.machine);
                self.line(at.indent, &format!("({form} [{action}])"));
            }
        }
    }

    fn transitions(&mut self, at: At, state: usize) {
        let from = self.name(at.machine, state);
        if state < 2 {
            let (to, ms) = (1 - state, 200 + self.roll(300));
            return self.line(at.indent, &format!("(ontime {ms} {from} -> s{to} beat{state})"));
        }
        let to = self.target(at.machine);
        let event = self.roll(EVENTS as u64);
        self.line(at.indent, &format!("(on e{event} {from} -> {to} t{state})"));
        let to = self.target(at.machine);
        match self.roll(3) {
            0 => {
                let condition = self.condition(at.machine);
                self.line(at.indent, &format!("(on [{condition}] {from} -> {to})"));
            }
            1 => {
                let ms = self.roll(5000);
                self.line(at.indent, &format!("(ontime {ms} {from} -> {to})"));
            }
            _ => {}
        }
    }

    /// The machine of the family that is written in a state of another.
    fn nested(&self, machine: usize, state: usize) -> Option<usize> {
        let member = machine % NESTING.len();
        let nested = NESTING.iter().position(|&place| place == Some((member, state)))?;
        Some(machine - member + nested)
    }

    fn name(&self, machine: usize, state: usize) -> String {
        let renamed = self.edit == Edit::RenamedState && machine == 3 && state == 6;
        if renamed { "renamed".to_string() } else { format!("s{state}") }
    }

    fn target(&mut self, machine: usize) -> String {
        let state = self.roll(self.size.states as u64) as usize;
        self.name(machine, state)
    }

    fn condition(&mut self, machine: usize) -> String {
        let (shape, number) = (self.roll(4), self.number());
        match shape {
            0 => format!("light > {number} + 1000 * limit"),
            1 => format!("speed{machine} > {number} and not pressed"),
            2 => format!("math.abs(speed{machine} - pose{machine}.y) > {number}.5"),
            _ => format!("(count{machine} + {number}) % 7 == 9 and speed{machine} < limit"),
        }
    }

    fn action(&mut self, machine: usize) -> String {
        let (shape, n) = (self.roll(6), self.number());
        let m = machine;
        match shape {
            0 => format!("count{m} = count{m} + {n}"),
            1 => format!("pose{m}.x, pose{m}.y = pose{m}.y, pose{m}.x + {n} * speed{m}"),
            2 => format!("if count{m} > {n} then speed{m} = speed{m} - 0.1 else speed{m} = speed{m} + 0.1 end"),
            3 => format!("log.info(string.format(\"%d of {n}, %g m/s\", count{m}, speed{m}))"),
            4 => format!("light = math.floor(math.min(light + {n}, 255))"),
            _ => format!(
                "local off = pose{m}.x - {n}   -- from the middle of the line\n\
                 \x20     local turn = 0.4 * off + 0.1 * pose{m}.y\n\
                 \x20     if math.abs(turn) > limit then\n\
                 \x20       turn = turn > 0 and limit or -limit\n\
                 \x20     end\n\
                 \x20     speed{m} = math.max(0.05, limit - math.abs(turn))"
            ),
        }
    }

    /// A number that makes a block different from most others, and from itself before it was edited.
    fn number(&mut self) -> u64 {
        let number = 1_000 + self.roll(9_000);
        self.written += 1;
        let Edit::Blocks { count, version } = self.edit else { return number };
        let edited_among = |written: usize| written * count / self.total;
        let is_edited = edited_among(self.written) > edited_among(self.written - 1);
        if is_edited { number + 10_000 * version } else { number }
    }

    /// From 0 up to a limit.
    fn roll(&mut self, limit: u64) -> u64 {
        // The step of `splitmix64`.
        self.dice = self.dice.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let mixed = (self.dice ^ (self.dice >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        let mixed = (mixed ^ (mixed >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        (mixed ^ (mixed >> 31)) % limit
    }

    fn line(&mut self, indent: usize, form: &str) {
        let (indent, comment) = match self.edit {
            Edit::Layout => (indent * 2, "   ; as before"),
            _ => (indent, ""),
        };
        // Nothing may follow a comment in its line but the next line.
        writeln!(self.text, "{:indent$}{form}{comment}", "").expect("a String takes text");
    }
}
