//! The command line: what can be asked for, and who does it. Only what was asked for goes to standard output.

mod args;
mod check;
mod graph;
mod new;

use std::process::ExitCode;

use clap::Parser;

use args::{Args, Task};

pub fn main() -> ExitCode {
    let args = Args::parse();
    match args.task() {
        Task::Live(run) => crate::ui::live::run(run.setup(), run.trace),
        Task::Run(run) => crate::session::headless::run(run.setup(), run.trace),
        Task::Check { files, format } => check::check(&files, format),
        Task::Graph(graph) => graph::print(&graph),
        Task::New { name } => new::create(&name),
        Task::Test { paths } => crate::session::test_runner::run(&paths),
        Task::Bridges { kind } => check::bridges(kind.as_deref()),
    }
}
