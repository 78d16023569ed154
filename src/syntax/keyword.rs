//! The words that begin a form, how each form is written, and where it may stand. Knows nothing of texts and trees.

use std::fmt;

/// What a form can stand in.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Place {
    Top,
    Machine,
    State,
    OnEntry,
    /// Where a list of names can stand, before a transition's arrow, or a `break`, at its end.
    Transition,
    /// Inside a form that holds no other.
    Nowhere,
}

impl fmt::Display for Place {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Place::Top => "at top level",
            Place::Machine => "in a machine",
            Place::State => "in a state",
            Place::OnEntry => "in an `onentry`",
            Place::Transition => "in a transition",
            Place::Nowhere => "inside this form",
        })
    }
}

macro_rules! keywords {
    ($($variant:ident $name:literal, $places:expr, $shape:literal, $inside:ident;)*) => {
        #[derive(Clone, Copy, Debug, PartialEq, Eq)]
        pub enum Keyword { $($variant,)* }

        impl Keyword {
            pub const ALL: &[Keyword] = &[$(Keyword::$variant,)*];

            pub fn name(self) -> &'static str {
                match self { $(Keyword::$variant => $name,)* }
            }

            pub fn of(word: &str) -> Option<Keyword> {
                match word { $($name => Some(Keyword::$variant),)* _ => None }
            }

            /// Where a form that begins with this word may stand.
            pub fn places(self) -> &'static [Place] {
                use Place::*;
                match self { $(Keyword::$variant => &$places,)* }
            }

            /// How the form is written, for help lines.
            pub fn shape(self) -> &'static str {
                match self { $(Keyword::$variant => $shape,)* }
            }

            /// What the inside of the form is to the forms in it.
            pub fn inside(self) -> Place {
                match self { $(Keyword::$variant => Place::$inside,)* }
            }
        }
    };
}

keywords! {
    Bridge "bridge", [Top], "(bridge NAME KIND [config])", Nowhere;
    Import "import", [Top], "(import \"file.lrp\")", Nowhere;
    Export "export", [Top], "(export MACHINE)", Nowhere;
    Var "var", [Top, Machine], "(var NAME := [value])", Nowhere;
    Machine "machine", [Top, State], "(machine NAME ...)", Machine;
    State "state", [Machine], "(state NAME ...)", State;
    Event "event", [Machine], "(event NAME [condition])", Nowhere;
    On "on", [Machine], "(on EVENT SOURCE -> TARGET)", Transition;
    Eps "eps", [Machine], "(eps SOURCE -> TARGET)", Transition;
    Ontime "ontime", [Machine], "(ontime MILLISECONDS SOURCE -> TARGET)", Transition;
    Exit "exit", [Machine], "(exit EVENT SOURCE -> TARGET)", Transition;
    Spawn "spawn", [Top, OnEntry], "(spawn MACHINE STATE)", Nowhere;
    Onentry "onentry", [State], "(onentry [action]) or (onentry (spawn MACHINE STATE))", OnEntry;
    Running "running", [State], "(running [action])", Nowhere;
    Onexit "onexit", [State], "(onexit [action])", Nowhere;
    Break "break", [State, Transition], "(break)", Nowhere;
    Onpause "onpause", [Top], "(onpause [action])", Nowhere;
    Onresume "onresume", [Top], "(onresume [action])", Nowhere;
}

impl Keyword {
    pub fn may_stand(self, place: Place) -> bool {
        self.places().contains(&place)
    }

    /// "a state", "an event": as a sentence names the form.
    pub fn with_article(self) -> &'static str {
        match self {
            Keyword::Machine => "a machine",
            Keyword::State => "a state",
            Keyword::Event => "an event",
            Keyword::Var => "a variable",
            Keyword::Spawn => "a `spawn`",
            Keyword::Bridge => "a `bridge`",
            Keyword::On | Keyword::Eps | Keyword::Ontime | Keyword::Exit => "a transition",
            Keyword::Import => "an `import`",
            Keyword::Export => "an `export`",
            Keyword::Onentry => "an `onentry`",
            Keyword::Running => "a `running`",
            Keyword::Onexit => "an `onexit`",
            Keyword::Break => "a `break`",
            Keyword::Onpause => "an `onpause`",
            Keyword::Onresume => "an `onresume`",
        }
    }
}
