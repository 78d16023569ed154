//! The command line: what can be asked for, and who does it. Only what was asked for goes to standard output.

mod args;
mod bridges;
mod check;
mod config;
mod explain;
mod graph;
mod ink;
mod new;
mod output;
mod tour;
mod welcome;

use std::process::ExitCode;

use clap::error::{ContextKind, ContextValue, ErrorKind};
use clap::{CommandFactory, Parser};

use crate::session::plugins::Plugins;
use crate::syntax::nearest::nearest;
use crate::ui::live;
use args::{Args, Task};

pub fn main() -> ExitCode {
    if std::env::args_os().len() == 1 {
        return welcome::welcome();
    }
    let args = match Args::try_parse() {
        Ok(args) => args,
        Err(error) => return wrong(&error),
    };
    match args.task() {
        Task::Live(live) => live::run(live.setup(), live.settings(), live.run.trace, None),
        Task::Run(run) => crate::session::headless::run(run.setup(), run.trace),
        Task::Check { explain: Some(code), .. } => explain::explain(&code),
        Task::Check { files, format, bridge_path, .. } => check::check(&files, format, &Plugins::here(&bridge_path)),
        Task::Graph(graph) => graph::print(&graph),
        Task::New { name } => new::create(&name),
        Task::Tour { folder } => tour::take(folder),
        Task::Test { paths } => crate::session::test_runner::run(&paths),
        Task::Config { file } => config::check(file.as_deref()),
        Task::Bridges { kind, bridge_path } => bridges::list(kind.as_deref(), &Plugins::here(&bridge_path)),
        Task::BridgeHost { library } => crate::session::plugins::host(&library),
    }
}

/// Help that was asked for, or what is wrong with the arguments. A misspelt command looks like a file with too much after it.
fn wrong(error: &clap::Error) -> ExitCode {
    let first = std::env::args().nth(1).unwrap_or_default();
    let commands = Args::command();
    match nearest(&first, commands.get_subcommands().map(clap::Command::get_name)) {
        Some(near) if error.kind() == ErrorKind::ArgumentConflict => {
            output::complain(format_args!("there is no command `{first}`; did you mean `{near}`?"));
        }
        _ if error.kind() == ErrorKind::UnknownArgument && first == "run" && is_about(error, "--hold") => {
            output::complain("`lrp run` can't hold saves: it has no key to apply or drop them; `lrp --hold FILE` has");
        }
        _ => {
            // Where nobody listens there is nothing to say.
            let _ = error.print();
        }
    }
    ExitCode::from(error.exit_code() as u8)
}

fn is_about(error: &clap::Error, argument: &str) -> bool {
    matches!(error.get(ContextKind::InvalidArg), Some(ContextValue::String(wrong)) if wrong == argument)
}
