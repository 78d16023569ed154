//! What a guard reads: the variables and the robots' inputs that its code names. Knows no values.

use super::ids::*;
use super::names::Names;
use super::program::*;
use super::ways::guard_block;

/// A variable or an input, or a field of one.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Reading {
    /// As the code has it: `robot.light.data`.
    pub text: String,
    pub root: Root,
    /// From the root on: `data`.
    pub fields: Vec<String>,
}

#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Root {
    Variable(VarId),
    Input { bridge: String, input: String },
}

/// In the order written, each once.
pub fn readings(program: &Program, transition: TransitionId) -> Vec<Reading> {
    if let Trigger::AfterVar(var) = program[transition].trigger {
        return vec![Reading { text: program[var].name.to_string(), root: Root::Variable(var), fields: Vec::new() }];
    }
    let Some(block) = guard_block(program, transition).map(|id| &program[id]) else { return Vec::new() };
    let mut found: Vec<Reading> = Vec::new();
    for word in block.code.split(|c: char| !(c.is_ascii_alphanumeric() || c == '_' || c == '.')) {
        let reading = reading(program, block, word);
        found.extend(reading.filter(|reading| !found.contains(reading)));
    }
    found
}

fn reading(program: &Program, block: &Block, word: &str) -> Option<Reading> {
    let (first, rest) = word.split_once('.').map_or((word, ""), |(first, rest)| (first, rest));
    if !block.facts.reads.iter().any(|read| read.name == first) {
        return None;
    }
    let mut fields = rest.split('.').filter(|field| !field.is_empty()).map(str::to_string);
    let root = match Names::of(program).var(block.machine, first) {
        Some(var) => Root::Variable(var),
        None if program.bridges.iter().any(|bridge| *bridge.name == *first) => {
            Root::Input { bridge: first.to_string(), input: fields.next()? }
        }
        None => return None,
    };
    Some(Reading { text: word.to_string(), root, fields: fields.collect() })
}
