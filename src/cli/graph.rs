//! `lrp graph`: the drawing of a machine on standard output.

use std::io::{self, Write};
use std::process::ExitCode;

use super::args::{GraphArgs, GraphFormat};
use super::output::{fail, finish};
use crate::model::{MachineId, Program};
use crate::session::compile::{Compiler, Rejected};
use crate::session::loader;
use crate::syntax::nearest::nearest;
use crate::syntax::render::{Style, render};
use crate::ui::graph::{Glyphs, Options, Rows, dot, draw, mermaid};
use crate::ui::machine_graph;

pub fn print(args: &GraphArgs) -> ExitCode {
    match drawing(args) {
        Ok(text) => finish(&format!("{}\n", text.trim_end()), ExitCode::SUCCESS),
        Err(Failure::Said(why)) => fail(why),
        Err(Failure::Diagnosed(text)) => {
            // Diagnostics go where errors go: the drawing was asked for.
            let _ = io::stderr().write_all(text.as_bytes());
            ExitCode::FAILURE
        }
    }
}

/// Why there is no drawing.
enum Failure {
    Said(String),
    Diagnosed(String),
}

fn drawing(args: &GraphArgs) -> Result<String, Failure> {
    let source = loader::read(&args.file).map_err(|why| Failure::Said(why.to_string()))?;
    let program = Compiler::new(Vec::new()).compile(source).map_err(|Rejected { sources, diagnostics }| {
        Failure::Diagnosed(render(&diagnostics, &sources, Style::Plain))
    })?;
    let machine = chosen(&program, args.machine.as_deref()).map_err(Failure::Said)?;
    Ok(match args.format {
        GraphFormat::Text => text(&program, machine, args),
        GraphFormat::Dot => dot(&machine_graph::nested(&program, machine)),
        GraphFormat::Mermaid => mermaid(&machine_graph::nested(&program, machine)),
    })
}

fn chosen(program: &Program, path: Option<&str>) -> Result<MachineId, String> {
    let Some(path) = path else {
        return program.tops.first().copied().ok_or_else(|| "this program has no machine".to_string());
    };
    program.machine(path).or_else(|| by_last_name(program, path)).ok_or_else(|| {
        let known: Vec<&str> = program.machines.iter().map(|machine| &*machine.path).collect();
        let near = nearest(path, known.iter().copied());
        let help =
            near.map_or_else(|| format!("there is: {}", known.join(", ")), |near| format!("did you mean `{near}`?"));
        format!("there is no machine `{path}`; {help}")
    })
}

/// The machine of this name, where only one has it.
fn by_last_name(program: &Program, name: &str) -> Option<MachineId> {
    let mut named =
        (0..program.machines.len() as u32).map(MachineId).filter(|&machine| *program[machine].name == *name);
    named.next().filter(|_| named.next().is_none())
}

fn text(program: &Program, machine: MachineId, args: &GraphArgs) -> String {
    let graph = machine_graph::graph(program, machine);
    let glyphs = if args.ascii { Glyphs::Ascii } else { Glyphs::Unicode };
    let printed = |rows| {
        let drawing = draw(&graph, &Options { glyphs, max_width: args.width, rows, ..Options::default() });
        drawing.text() + &drawing.legend(args.width.unwrap_or(u16::MAX))
    };
    let full = printed(Rows::Two);
    let fits = args.height.is_none_or(|height| full.lines().count() <= usize::from(height));
    if fits { full } else { printed(Rows::One) }
}
