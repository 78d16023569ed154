//! Lua's patterns, matched step by step, so that a match that takes too long can be stopped. Knows bytes, and nothing of Lua's values.

/// The most captures a pattern can have.
const CAPTURES: usize = 32;
/// How deeply one match may need another.
const DEPTH: u32 = 200;
/// Steps between two looks at whether to stop; a step is a few nanoseconds.
const STEPS: usize = 10_000;
const ESCAPE: u8 = b'%';

/// Why a match was given up.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Complaint {
    EndsWithEscape,
    MissingBracket,
    MissingBalance,
    MissingFrontierSet,
    TooComplex,
    TooManyCaptures,
    NothingToClose,
    Unfinished,
    /// There is no such capture, counted from 1.
    NoCapture(usize),
    Stopped,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Length {
    Bytes(usize),
    Position,
    Unfinished,
}

/// What a capture caught.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Caught {
    /// From, to.
    Text(usize, usize),
    /// A place in the subject, counted from 1.
    Position(usize),
}

/// A match of `pattern`, its anchor left out, in `subject`.
pub(super) struct Matcher<'a> {
    pub subject: &'a [u8],
    pattern: &'a [u8],
    stop: &'a dyn Fn() -> bool,
    steps: usize,
    depth: u32,
    level: usize,
    captures: [(usize, Length); CAPTURES],
}

type Matched = Result<Option<usize>, Complaint>;

impl<'a> Matcher<'a> {
    /// `stop` is asked now and then whether to give up.
    pub fn new(subject: &'a [u8], pattern: &'a [u8], stop: &'a dyn Fn() -> bool) -> Self {
        Self { subject, pattern, stop, steps: 0, depth: 0, level: 0, captures: [(0, Length::Unfinished); CAPTURES] }
    }

    /// The end of the match that begins at `start`.
    pub fn match_at(&mut self, start: usize) -> Matched {
        self.level = 0;
        self.depth = 0;
        self.find(start, 0)
    }

    /// How many values a match has: its captures, or the whole.
    pub fn values(&self) -> usize {
        self.level.max(1)
    }

    /// Capture `index`, counted from 0, of a match from `start` to `end`; the whole where there are no captures.
    pub fn capture(&self, index: usize, start: usize, end: usize) -> Result<Caught, Complaint> {
        if index >= self.level {
            return if index == 0 { Ok(Caught::Text(start, end)) } else { Err(Complaint::NoCapture(index + 1)) };
        }
        match self.captures[index] {
            (_, Length::Unfinished) => Err(Complaint::Unfinished),
            (from, Length::Position) => Ok(Caught::Position(from + 1)),
            (from, Length::Bytes(length)) => Ok(Caught::Text(from, from + length)),
        }
    }

    /// Whether captures were made at all.
    pub fn has_captures(&self) -> bool {
        self.level > 0
    }

    /// Where `text` is first found from `start` on, taken literally.
    pub fn find_plain(&mut self, text: &[u8], start: usize) -> Matched {
        for at in start..=self.subject.len() {
            self.step(1 + text.len() / 16)?;
            if self.subject[at..].starts_with(text) {
                return Ok(Some(at));
            }
        }
        Ok(None)
    }

    fn step(&mut self, cost: usize) -> Result<(), Complaint> {
        self.steps += cost;
        if self.steps < STEPS {
            return Ok(());
        }
        self.steps = 0;
        if (self.stop)() { Err(Complaint::Stopped) } else { Ok(()) }
    }

    /// The byte of the pattern, nought at its end.
    fn at(&self, p: usize) -> u8 {
        self.pattern.get(p).copied().unwrap_or(0)
    }

    fn subject_at(&self, s: usize) -> u8 {
        self.subject.get(s).copied().unwrap_or(0)
    }

    fn find(&mut self, s: usize, p: usize) -> Matched {
        if self.depth == DEPTH {
            return Err(Complaint::TooComplex);
        }
        self.depth += 1;
        let found = self.find_items(s, p)?;
        self.depth -= 1;
        Ok(found)
    }

    /// Matches items one after the other, until one needs a choice.
    fn find_items(&mut self, mut s: usize, mut p: usize) -> Matched {
        while p < self.pattern.len() {
            self.step(1)?;
            let next = match (self.at(p), self.at(p + 1)) {
                (b'(', b')') => return self.open(s, p + 2, Length::Position),
                (b'(', _) => return self.open(s, p + 1, Length::Unfinished),
                (b')', _) => return self.close(s, p + 1),
                (b'$', _) if p + 1 == self.pattern.len() => {
                    return Ok((s == self.subject.len()).then_some(s));
                }
                (ESCAPE, b'b') => self.balance(s, p + 2)?.map(|s| (s, p + 4)),
                (ESCAPE, b'f') => self.frontier(s, p + 2)?.map(|p| (s, p)),
                (ESCAPE, digit) if digit.is_ascii_digit() => self.again(s, digit)?.map(|s| (s, p + 2)),
                _ => {
                    let end = self.class_end(p)?;
                    match (self.at(end), self.one(s, p, end)?) {
                        (b'?', true) => match self.find(s + 1, end + 1)? {
                            None => Some((s, end + 1)),
                            found => return Ok(found),
                        },
                        (b'+', true) => return self.most(s + 1, p, end),
                        (b'*', true) => return self.most(s, p, end),
                        (b'-', true) => return self.fewest(s, p, end),
                        (b'?' | b'*' | b'-', false) => Some((s, end + 1)),
                        (_, true) => Some((s + 1, end)),
                        (_, false) => None,
                    }
                }
            };
            match next {
                Some(next) => (s, p) = next,
                None => return Ok(None),
            }
        }
        Ok(Some(s))
    }

    fn most(&mut self, s: usize, p: usize, end: usize) -> Matched {
        let mut count = 0;
        while self.one(s + count, p, end)? {
            count += 1;
        }
        for count in (0..=count).rev() {
            if let Some(found) = self.find(s + count, end + 1)? {
                return Ok(Some(found));
            }
        }
        Ok(None)
    }

    fn fewest(&mut self, mut s: usize, p: usize, end: usize) -> Matched {
        loop {
            if let Some(found) = self.find(s, end + 1)? {
                return Ok(Some(found));
            }
            if !self.one(s, p, end)? {
                return Ok(None);
            }
            s += 1;
        }
    }

    fn open(&mut self, s: usize, p: usize, length: Length) -> Matched {
        if self.level >= CAPTURES {
            return Err(Complaint::TooManyCaptures);
        }
        self.captures[self.level] = (s, length);
        self.level += 1;
        let found = self.find(s, p)?;
        if found.is_none() {
            self.level -= 1;
        }
        Ok(found)
    }

    fn close(&mut self, s: usize, p: usize) -> Matched {
        let open = self.captures[..self.level].iter().rposition(|(_, length)| *length == Length::Unfinished);
        let open = open.ok_or(Complaint::NothingToClose)?;
        self.captures[open].1 = Length::Bytes(s - self.captures[open].0);
        let found = self.find(s, p)?;
        if found.is_none() {
            self.captures[open].1 = Length::Unfinished;
        }
        Ok(found)
    }

    /// `%bxy`
    fn balance(&mut self, s: usize, p: usize) -> Matched {
        if p + 1 >= self.pattern.len() {
            return Err(Complaint::MissingBalance);
        }
        let (begin, end) = (self.at(p), self.at(p + 1));
        if self.subject_at(s) != begin {
            return Ok(None);
        }
        let mut open = 1;
        for at in s + 1..self.subject.len() {
            self.step(1)?;
            let byte = self.subject[at];
            if byte == end {
                open -= 1;
                if open == 0 {
                    return Ok(Some(at + 1));
                }
            } else if byte == begin {
                open += 1;
            }
        }
        Ok(None)
    }

    /// `%f[set]`: where the pattern goes on.
    fn frontier(&mut self, s: usize, p: usize) -> Matched {
        if self.at(p) != b'[' {
            return Err(Complaint::MissingFrontierSet);
        }
        let end = self.class_end(p)?;
        let before = if s == 0 { 0 } else { self.subject[s - 1] };
        let here = self.in_set(self.subject_at(s), p, end - 1)?;
        Ok((!self.in_set(before, p, end - 1)? && here).then_some(end))
    }

    /// `%1`: what a capture caught, again.
    fn again(&mut self, s: usize, digit: u8) -> Matched {
        let number = usize::from(digit - b'0');
        let known = number.checked_sub(1).filter(|index| *index < self.level);
        let (from, length) = known.map(|index| self.captures[index]).ok_or(Complaint::NoCapture(number))?;
        match length {
            Length::Unfinished => Err(Complaint::NoCapture(number)),
            Length::Position => Ok(None),
            Length::Bytes(length) => {
                self.step(length / 16)?;
                let same = self.subject[s..].starts_with(&self.subject[from..from + length]);
                Ok(same.then_some(s + length))
            }
        }
    }

    /// Where the item that begins at `p` ends, its suffix left out.
    fn class_end(&mut self, mut p: usize) -> Result<usize, Complaint> {
        let begin = self.at(p);
        p += 1;
        match begin {
            ESCAPE if p == self.pattern.len() => Err(Complaint::EndsWithEscape),
            ESCAPE => Ok(p + 1),
            b'[' => self.set_end(p),
            _ => Ok(p),
        }
    }

    fn set_end(&mut self, mut p: usize) -> Result<usize, Complaint> {
        if self.at(p) == b'^' {
            p += 1;
        }
        loop {
            self.step(1)?;
            if p >= self.pattern.len() {
                return Err(Complaint::MissingBracket);
            }
            let byte = self.at(p);
            p += 1;
            if byte == ESCAPE && p < self.pattern.len() {
                p += 1;
            }
            if self.at(p) == b']' {
                return Ok(p + 1);
            }
        }
    }

    /// Whether the item from `p` to `end` matches the byte at `s`.
    fn one(&mut self, s: usize, p: usize, end: usize) -> Result<bool, Complaint> {
        self.step(1)?;
        let Some(&byte) = self.subject.get(s) else {
            return Ok(false);
        };
        match self.at(p) {
            b'.' => Ok(true),
            ESCAPE => Ok(in_class(byte, self.at(p + 1))),
            b'[' => self.in_set(byte, p, end - 1),
            other => Ok(other == byte),
        }
    }

    /// Whether a byte is in the set from the bracket at `p` to that at `end`.
    fn in_set(&mut self, byte: u8, mut p: usize, end: usize) -> Result<bool, Complaint> {
        let inverted = self.at(p + 1) == b'^';
        if inverted {
            p += 1;
        }
        p += 1;
        while p < end {
            self.step(1)?;
            let found = if self.at(p) == ESCAPE {
                p += 1;
                in_class(byte, self.at(p))
            } else if self.at(p + 1) == b'-' && p + 2 < end {
                p += 2;
                self.at(p - 2) <= byte && byte <= self.at(p)
            } else {
                self.at(p) == byte
            };
            if found {
                return Ok(!inverted);
            }
            p += 1;
        }
        Ok(inverted)
    }
}

/// Whether a pattern means more than its bytes.
pub(super) fn has_specials(pattern: &[u8]) -> bool {
    pattern.iter().any(|byte| b"^$*+?.([%-".contains(byte))
}

/// `%a` and the like; a capital letter means the opposite.
fn in_class(byte: u8, class: u8) -> bool {
    let within = match class.to_ascii_lowercase() {
        b'a' => byte.is_ascii_alphabetic(),
        b'c' => byte.is_ascii_control(),
        b'd' => byte.is_ascii_digit(),
        b'g' => byte.is_ascii_graphic(),
        b'l' => byte.is_ascii_lowercase(),
        b'p' => byte.is_ascii_punctuation(),
        b's' => byte.is_ascii_whitespace() || byte == 0x0B,
        b'u' => byte.is_ascii_uppercase(),
        b'w' => byte.is_ascii_alphanumeric(),
        b'x' => byte.is_ascii_hexdigit(),
        b'z' => byte == 0,
        _ => return class == byte,
    };
    within != class.is_ascii_uppercase()
}
