//! Conditions that are none, or do more than look.

use std::fmt::{self, Display, Formatter};

use crate::lua::Gives;
use crate::model::blocks::{Role, place};
use crate::model::program::*;
use crate::syntax::{Code, Diagnostic};

/// Conditions that give something else than true or false in any case.
pub fn not_boolean(program: &Program) -> Vec<Diagnostic> {
    let wrong = |(guard, block): (Guard, &Block)| {
        let gives = block.facts.gives;
        let boolean = matches!(gives, Gives::Something | Gives::True | Gives::False | Gives::Bits);
        // An assignment has its own finding.
        let assigns = gives == Gives::Nothing && !block.writes.is_empty();
        (!boolean && !assigns).then(|| {
            let message = format!("{guard} gives {}, not true or false; it doesn't occur", gives.name());
            Diagnostic::error(Code::NotBoolean, block.span, message).help("compare with something: `x > 0`, `x ~= nil`")
        })
    };
    conditions(program).filter_map(wrong).collect()
}

/// Conditions and timeouts that assign a variable of the program.
pub fn event_assigns(program: &Program) -> Vec<Diagnostic> {
    let timeouts = program.transitions.iter().filter_map(|transition| match transition.trigger {
        Trigger::AfterBlock(block) => Some((Guard::Timeout, &program[block])),
        _ => None,
    });
    conditions(program).chain(timeouts).filter_map(|(guard, block)| assigns(program, guard, block)).collect()
}

fn assigns(program: &Program, guard: Guard, block: &Block) -> Option<Diagnostic> {
    let var = &program[*block.writes.first()?].name;
    let line = block.facts.writes.iter().find(|name| *name.name == **var)?.line;
    let span = place(program.source(block.span), block.span, line, Some((var, Role::Free)));
    let message = format!("{guard} assigns `{var}`");
    Some(match block.facts.gives {
        Gives::Nothing => Diagnostic::error(Code::EventAssigns, span, format!("{message} and gives nothing"))
            .help("in Lua `=` assigns and `==` compares"),
        _ => Diagnostic::warning(Code::EventAssigns, span, message).help(
            "assign in an action: a guard may be asked several times in a step, or not at all when an earlier one holds",
        ),
    })
}

/// Smalltalk that Lua takes for something else: its `&` and `|` are for bits.
pub fn smalltalk(program: &Program) -> Vec<Diagnostic> {
    let left = conditions(program).filter(|(_, block)| block.facts.gives == Gives::Bits);
    let found = left.map(|(guard, block)| {
        let message = format!("this looks like Smalltalk; {guard} gives a number: `&` and `|` are for bits in Lua");
        Diagnostic::error(Code::Smalltalk, block.span, message).help("in Lua they are written `and` and `or`")
    });
    found.collect()
}

/// What a block decides; displayed as a sentence begins with it.
#[derive(Clone, Copy)]
enum Guard<'p> {
    Event(&'p str),
    Trigger,
    Timeout,
}

impl Display for Guard<'_> {
    fn fmt(&self, f: &mut Formatter<'_>) -> fmt::Result {
        match self {
            Guard::Event(name) => write!(f, "event `{name}`"),
            Guard::Trigger => f.write_str("this trigger"),
            Guard::Timeout => f.write_str("this timeout"),
        }
    }
}

/// The blocks of events and triggers.
fn conditions(program: &Program) -> impl Iterator<Item = (Guard<'_>, &Block)> {
    let events = program.events.iter().map(|event| (Guard::Event(&event.name), &program[event.block]));
    let triggers = program.transitions.iter().filter_map(|transition| match transition.trigger {
        Trigger::Block(block) => Some((Guard::Trigger, &program[block])),
        _ => None,
    });
    events.chain(triggers)
}
