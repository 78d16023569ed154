//! `lrp graph`: the drawing of a machine on standard output.

use std::io::{self, IsTerminal, Write};
use std::process::ExitCode;

use super::args::{GraphArgs, GraphForm, GraphFormat};
use super::ink;
use super::output::{fail, finish};
use crate::model::{MachineId, Program};
use crate::session::compile::{Compiler, Rejected};
use crate::session::loader;
use crate::syntax::nearest::nearest;
use crate::syntax::render::{Style, render};
use crate::ui::glyphs::Charset;
use crate::ui::graph::{Drawing, Form, Glyphs, Graph, Options, Rows, dot, draw, mermaid};
use crate::ui::machine_graph;
use crate::ui::settings::Surroundings;
use crate::ui::theme::{Palette, Theme};

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
        GraphFormat::Text => text(&program, machine, args).map_err(Failure::Said)?,
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

/// The drawing with the legend of what it shortens.
fn text(program: &Program, machine: MachineId, args: &GraphArgs) -> Result<String, String> {
    let graph = machine_graph::graph(program, machine);
    let (graph, forms) = match (&args.around, args.form) {
        (Some(state), _) => {
            let (part, middle) = around(&graph, state)?;
            (part, vec![Form::Around(middle)])
        }
        (None, Some(GraphForm::Boxes)) => (graph, vec![Form::Boxes]),
        (None, Some(GraphForm::Table)) => (graph, vec![Form::Table]),
        (None, None) => (graph, vec![Form::Boxes, Form::Table]),
    };
    let here = Surroundings::here();
    let is_seen = io::stdout().is_terminal();
    let ascii = args.ascii || (is_seen && here.charset() == Charset::Ascii);
    let glyphs = if ascii { Glyphs::Ascii } else { Glyphs::Unicode };
    let drawn = |(form, rows)| {
        let (max_width, max_height) = (args.width, args.height);
        let drawing = draw(&graph, &Options { form, glyphs, max_width, max_height, rows, ..Options::default() });
        let legend = drawing.legend(args.width.unwrap_or(u16::MAX));
        (drawing, legend)
    };
    let fits = |(drawing, legend): &(Drawing, String)| {
        let rows = usize::from(drawing.height) + legend.lines().count();
        args.height.is_none_or(|height| rows <= usize::from(height))
    };
    let ways: Vec<_> = forms.into_iter().flat_map(|form| [(form, Rows::Two), (form, Rows::One)]).collect();
    let mut drawings = ways.iter().copied().map(drawn);
    let (drawing, legend) = drawings.find(fits).unwrap_or_else(|| drawn(ways[1]));
    let palette = if is_seen { here.palette() } else { Palette::Mono };
    Ok(ink::inked(&drawing, &graph, &Theme::of(palette)) + &legend)
}

/// What is around a state, by its name, and which node of that it is.
fn around(graph: &Graph, state: &str) -> Result<(Graph, usize), String> {
    let names = || graph.nodes.iter().map(|node| node.name.as_str());
    let Some(node) = names().position(|name| name == state) else {
        let help = nearest(state, names()).map(|near| format!("; did you mean `{near}`?")).unwrap_or_default();
        return Err(format!("this machine has no state `{state}`{help}"));
    };
    let (part, nodes) = graph.around(node);
    let middle = nodes.iter().position(|&known| known == node).unwrap_or(0);
    Ok((part, middle))
}
