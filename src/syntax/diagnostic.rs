//! What is wrong with a program, as data. Rendering is done where it is shown.

use super::source::Span;

#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum Severity {
    Error,
    Warning,
    Hint,
}

#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Diagnostic {
    pub code: Code,
    pub severity: Severity,
    pub span: Span,
    /// One line: what is wrong, naming the thing.
    pub message: String,
    /// The likely fix, as a sentence.
    pub help: Option<String>,
    /// Other places that matter, each with what it is: "first declared here".
    pub also: Vec<(Span, String)>,
}

impl Diagnostic {
    pub fn error(code: Code, span: Span, message: impl Into<String>) -> Self {
        Self::new(Severity::Error, code, span, message)
    }

    pub fn warning(code: Code, span: Span, message: impl Into<String>) -> Self {
        Self::new(Severity::Warning, code, span, message)
    }

    pub fn hint(code: Code, span: Span, message: impl Into<String>) -> Self {
        Self::new(Severity::Hint, code, span, message)
    }

    fn new(severity: Severity, code: Code, span: Span, message: impl Into<String>) -> Self {
        Diagnostic { code, severity, span, message: message.into(), help: None, also: Vec::new() }
    }

    pub fn help(mut self, sentence: impl Into<String>) -> Self {
        self.help = Some(sentence.into());
        self
    }

    pub fn also(mut self, span: Span, what: impl Into<String>) -> Self {
        self.also.push((span, what.into()));
        self
    }

    pub fn is_error(&self) -> bool {
        self.severity == Severity::Error
    }
}

macro_rules! codes {
    ($($variant:ident $name:literal,)*) => {
        /// Every kind of finding, by the name that is printed: `error[unknown-state]`.
        #[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
        pub enum Code { $($variant,)* }

        impl Code {
            pub const ALL: &[Code] = &[$(Code::$variant,)*];

            pub fn name(self) -> &'static str {
                match self { $(Code::$variant => $name,)* }
            }

            pub fn named(name: &str) -> Option<Code> {
                match name {
                    $($name => Some(Code::$variant),)*
                    _ => None,
                }
            }
        }
    };
}

codes! {
    // The text can't be read.
    UnclosedBracket "unclosed-bracket",
    StrayBracket "stray-bracket",
    UnclosedBlock "unclosed-block",
    UnclosedString "unclosed-string",
    StrayCharacter "stray-character",
    NestedTooDeep "nested-too-deep",
    TooLarge "too-large",
    BadForm "bad-form",
    UnknownForm "unknown-form",
    MisplacedForm "misplaced-form",
    BadName "bad-name",
    BadTimeout "bad-timeout",
    // Lua in a block can't be compiled.
    LuaSyntax "lua-syntax",
    Smalltalk "smalltalk",
    // Names that mean nothing, or two things.
    UnknownState "unknown-state",
    UnknownEvent "unknown-event",
    UnknownMachine "unknown-machine",
    UnknownVariable "unknown-variable",
    Duplicate "duplicate",
    Redeclared "redeclared",
    ExitAtTop "exit-at-top",
    NoSpawn "no-spawn",
    EmptyProgram "empty-program",
    UnknownBridge "unknown-bridge",
    BadBridge "bad-bridge",
    UnknownField "unknown-field",
    // Other files.
    UnreadableImport "unreadable-import",
    TooManyFiles "too-many-files",
    ImportCycle "import-cycle",
    NothingExported "nothing-exported",
    UnknownModule "unknown-module",
    // Sound as it stands, and hardly what was meant.
    UnreachableState "unreachable-state",
    NeverSpawned "never-spawned",
    ShadowedTransition "shadowed-transition",
    NeverRests "never-rests",
    ReentersItself "reenters-itself",
    EventAssigns "event-assigns",
    UnusedEvent "unused-event",
    UnusedVariable "unused-variable",
    // Comments that allow a finding.
    UnknownCode "unknown-code",
    UnusedAllow "unused-allow",
    // While it runs.
    Runtime "runtime-error",
    NotBoolean "not-boolean",
    NotMilliseconds "not-milliseconds",
    AlreadyRunning "already-running",
    OverTime "over-time",
    OverMemory "over-memory",
}
