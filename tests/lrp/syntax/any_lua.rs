//! Random pieces of Lua, drawn from a row of numbers: scopes in scopes, with few names, so that they hide each other.

use crate::plot::Choices;

pub fn piece(choices: &mut Choices) -> String {
    let mut writer = Writer { choices, text: String::new(), varargs: false, loops: 0 };
    writer.block(4);
    writer.text
}

struct Writer<'a, 'n> {
    choices: &'a mut Choices<'n>,
    text: String,
    /// Whether `...` means something here.
    varargs: bool,
    /// How many loops of this function are around.
    loops: usize,
}

impl Writer<'_, '_> {
    fn say(&mut self, text: &str) {
        if !self.text.ends_with(['\n', '.', ':']) && !matches!(text, "." | ":") {
            self.text.push(' ');
        }
        self.text.push_str(text);
    }

    fn one_of(&mut self, texts: &[&str]) {
        let text = self.choices.of(texts).expect("there are some");
        self.say(text);
    }

    fn name(&mut self) {
        self.one_of(&["a", "b", "c", "self"]);
    }

    fn list(&mut self, most: usize, item: impl Fn(&mut Self)) {
        item(self);
        for _ in 0..self.choices.below(most) {
            self.say(",");
            item(self);
        }
    }

    fn block(&mut self, depth: usize) {
        for _ in 0..self.choices.below(4) {
            self.statement(depth.saturating_sub(1));
            self.one_of(&["\n", " ; ", " -- a\n", " --[[ b ]] "]);
        }
        if self.choices.below(4) == 0 {
            self.say("return");
            self.list(2, |it| it.expression(depth.saturating_sub(1)));
        }
    }

    fn end(&mut self, depth: usize) {
        self.block(depth);
        self.say("end");
    }

    fn body_of_loop(&mut self, depth: usize) {
        self.loops += 1;
        self.block(depth);
        self.loops -= 1;
    }

    fn function(&mut self, depth: usize) {
        let around = (self.varargs, std::mem::take(&mut self.loops));
        self.varargs = false;
        self.say("(");
        match self.choices.below(4) {
            0 => {}
            1 => {
                self.say("...");
                self.varargs = true;
            }
            2 => self.list(2, Self::name),
            _ => {
                self.list(2, Self::name);
                self.say(", ...");
                self.varargs = true;
            }
        }
        self.say(")");
        self.end(depth);
        (self.varargs, self.loops) = around;
    }

    fn statement(&mut self, depth: usize) {
        let simple = depth == 0;
        match self.choices.below(if simple { 5 } else { 14 }) {
            0 => self.local(depth),
            1 => {
                self.list(2, |it| it.place(depth));
                self.say("=");
                self.list(2, |it| it.expression(depth));
            }
            2 => self.call(depth),
            3 => self.say("do goto a ::a:: end"),
            4 if self.loops > 0 => self.say("break"),
            4 | 5 => {
                self.say("do");
                self.end(depth);
            }
            6 => {
                self.say("while");
                self.expression(depth);
                self.say("do");
                self.body_of_loop(depth);
                self.say("end");
            }
            7 => {
                self.say("repeat");
                self.loops += 1;
                self.local(depth);
                self.loops -= 1;
                self.say("until");
                self.expression(depth);
            }
            8 => self.choice(depth),
            9 => self.count(depth),
            10 => {
                self.say("for");
                self.list(2, Self::name);
                self.say("in");
                self.list(2, |it| it.expression(depth));
                self.say("do");
                self.body_of_loop(depth);
                self.say("end");
            }
            11 => {
                self.say("local function");
                self.name();
                self.function(depth);
            }
            12 => {
                self.say("function");
                self.name();
                self.one_of(&["", ".a", ".b:c", ":a"]);
                self.function(depth);
            }
            _ => {
                self.say("repeat");
                self.body_of_loop(depth);
                self.say("until");
                self.expression(depth);
            }
        }
    }

    fn local(&mut self, depth: usize) {
        self.say("local");
        self.list(3, |it| {
            it.name();
            if it.choices.below(6) == 0 {
                it.say("<const>");
            }
        });
        if self.choices.below(3) > 0 {
            self.say("=");
            self.list(2, |it| it.expression(depth));
        }
    }

    fn choice(&mut self, depth: usize) {
        self.say("if");
        self.expression(depth);
        self.say("then");
        self.block(depth);
        if self.choices.below(2) == 0 {
            self.say("elseif");
            self.expression(depth);
            self.say("then");
            self.block(depth);
        }
        if self.choices.below(2) == 0 {
            self.say("else");
            self.block(depth);
        }
        self.say("end");
    }

    fn count(&mut self, depth: usize) {
        self.say("for");
        self.name();
        self.say("=");
        self.expression(depth);
        self.say(",");
        self.expression(depth);
        self.say("do");
        self.body_of_loop(depth);
        self.say("end");
    }

    /// What can be assigned.
    fn place(&mut self, depth: usize) {
        self.name();
        match self.choices.below(3) {
            0 => self.say(".a"),
            1 => {
                self.say("[");
                self.expression(depth.saturating_sub(1));
                self.say("]");
            }
            _ => {}
        }
    }

    fn call(&mut self, depth: usize) {
        self.place(depth);
        match self.choices.below(5) {
            0 => self.say("'a b'"),
            1 => self.say("[==[ a ]] ]==]"),
            2 => self.table(depth),
            3 => {
                self.say(":");
                self.say("b");
                self.say("()");
            }
            _ => {
                self.say("(");
                self.list(2, |it| it.expression(depth.saturating_sub(1)));
                self.say(")");
            }
        }
    }

    fn table(&mut self, depth: usize) {
        self.say("{");
        for _ in 0..self.choices.below(4) {
            match self.choices.below(3) {
                0 => {
                    self.name();
                    self.say("=");
                }
                1 => {
                    self.say("[");
                    self.expression(depth.saturating_sub(1));
                    self.say("] =");
                }
                _ => {}
            }
            self.expression(depth.saturating_sub(1));
            self.one_of(&[",", ";"]);
        }
        self.say("}");
    }

    fn expression(&mut self, depth: usize) {
        let below = depth.saturating_sub(1);
        match self.choices.below(if depth == 0 { 6 } else { 13 }) {
            0..=2 => self.name(),
            3 => self.one_of(&["nil", "1", "'a'", "[[b]]", "true"]),
            4 if self.varargs => self.say("..."),
            4 | 5 => self.place(below),
            6 => {
                self.say("function");
                self.function(below);
            }
            7 => self.table(below),
            8 => self.call(below),
            9 => {
                self.say("(");
                self.expression(below);
                self.say(")");
                self.one_of(&["", ".a", ":b()"]);
            }
            10 => {
                self.one_of(&["not", "-", "#", "~"]);
                self.expression(below);
            }
            _ => {
                self.expression(below);
                self.one_of(&["+", "..", "and", "or", "==", "<", ">", "//"]);
                self.expression(below);
            }
        }
    }
}
