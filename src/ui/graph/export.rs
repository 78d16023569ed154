//! A machine and the machines nested in it as Graphviz dot and as a Mermaid state diagram. Knows nothing of cells.

use super::{Edge, EdgeKind, Graph, NodeKind};

/// A machine with those nested in its states.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Nested {
    pub name: String,
    pub graph: Graph,
    /// The index of the node each machine is nested in.
    pub children: Vec<(usize, Nested)>,
}

/// Graphviz dot. A state with nested machines is a cluster that holds them and a node for itself.
pub fn dot(machine: &Nested) -> String {
    let mut out = Lines::default();
    out.line(format!("digraph {} {{", quoted(&machine.name)));
    out.indented(|out| {
        out.line("node [shape=box, style=rounded]".into());
        dot_machine(machine, "n", out);
    });
    out.line("}".into());
    out.text
}

fn dot_machine(machine: &Nested, id: &str, out: &mut Lines) {
    for (i, node) in machine.graph.nodes.iter().enumerate() {
        let shape = match node.kind {
            NodeKind::State => "",
            NodeKind::Any => ", shape=plaintext",
        };
        let line = format!("{id}_{i} [label={}{shape}]", quoted(&node.name));
        let inside: Vec<&Nested> = machine.children.iter().filter(|(at, _)| *at == i).map(|(_, child)| child).collect();
        if inside.is_empty() {
            out.line(line);
            continue;
        }
        out.line(format!("subgraph cluster_{id}_{i} {{"));
        out.indented(|out| {
            out.line("label=\"\"".into());
            out.line(line);
            for (k, child) in inside.into_iter().enumerate() {
                out.line(format!("subgraph cluster_{id}_{i}_{k} {{"));
                out.indented(|out| {
                    out.line(format!("label={}", quoted(&child.name)));
                    dot_machine(child, &format!("{id}_{i}_{k}"), out);
                });
                out.line("}".into());
            }
        });
        out.line("}".into());
    }
    for edge in edges(&machine.graph) {
        let (style, color) = dot_style(edge.kind);
        out.line(format!(
            "{id}_{} -> {id}_{} [label={}, color={color}, style={style}]",
            edge.from,
            edge.to,
            quoted(&edge.label)
        ));
    }
}

fn dot_style(kind: EdgeKind) -> (&'static str, &'static str) {
    match kind {
        EdgeKind::On => ("solid", "blue"),
        EdgeKind::Eps => ("dotted", "darkgreen"),
        EdgeKind::Ontime => ("dashed", "orange"),
        EdgeKind::Wildcard => ("solid", "purple"),
        EdgeKind::Exit => ("bold", "blue"),
    }
}

/// A Mermaid state diagram. A state with nested machines is a composite state; several are its concurrent regions.
pub fn mermaid(machine: &Nested) -> String {
    let mut out = Lines::default();
    out.line("stateDiagram-v2".into());
    out.indented(|out| mermaid_machine(machine, "n", out));
    out.text
}

fn mermaid_machine(machine: &Nested, id: &str, out: &mut Lines) {
    for (i, node) in machine.graph.nodes.iter().enumerate() {
        out.line(format!("state {} as {id}_{i}", mermaid_quoted(&node.name)));
        let inside = machine.children.iter().filter(|(at, _)| *at == i).enumerate();
        for (k, (_, child)) in inside.clone() {
            if k == 0 {
                out.line(format!("state {id}_{i} {{"));
            } else {
                out.indented(|out| out.line("--".into()));
            }
            out.indented(|out| mermaid_machine(child, &format!("{id}_{i}_{k}"), out));
        }
        if inside.count() > 0 {
            out.line("}".into());
        }
    }
    for edge in edges(&machine.graph) {
        let label = mermaid_text(&edge.label);
        let label = if label.is_empty() { label } else { format!(" : {label}") };
        out.line(format!("{id}_{} --> {id}_{}{label}", edge.from, edge.to));
    }
}

/// The edges that have both their ends in the graph.
fn edges(graph: &Graph) -> impl Iterator<Item = &Edge> {
    graph.edges.iter().filter(|edge| edge.from.max(edge.to) < graph.nodes.len())
}

fn quoted(text: &str) -> String {
    let escaped = text.replace('\\', "\\\\").replace('"', "\\\"").replace(['\n', '\r'], " ");
    format!("\"{escaped}\"")
}

fn mermaid_quoted(text: &str) -> String {
    format!("\"{}\"", mermaid_text(text))
}

/// Mermaid has no escapes but character codes, written with `#` and `;`.
fn mermaid_text(text: &str) -> String {
    let mut out = String::new();
    for c in text.chars() {
        match c {
            '\n' | '\r' => out.push(' '),
            '"' | '#' | ';' | ':' | '%' | '<' | '>' | '{' | '}' => out.push_str(&format!("#{};", u32::from(c))),
            _ => out.push(c),
        }
    }
    out
}

/// Text in indented lines.
#[derive(Default)]
struct Lines {
    text: String,
    depth: usize,
}

impl Lines {
    fn line(&mut self, line: String) {
        self.text.push_str(&"  ".repeat(self.depth));
        self.text.push_str(&line);
        self.text.push('\n');
    }

    fn indented(&mut self, write: impl FnOnce(&mut Lines)) {
        self.depth += 1;
        write(self);
        self.depth -= 1;
    }
}
