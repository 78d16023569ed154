//! `lrp check` and `lrp bridges`: what is wrong with programs, and what robots there are.

use std::io::{IsTerminal, stdout};
use std::path::{Path, PathBuf};
use std::process::ExitCode;

use super::args::Format;
use crate::runtime::record::Finding;
use crate::session::compile::{Compiler, Rejected};
use crate::session::live::folder;
use crate::session::robots::{self, Problems, Robots, Workshop};
use crate::session::{findings, loader};
use crate::syntax::render::{Style, render};
use crate::syntax::{Diagnostic, Source};

pub fn check(files: &[PathBuf], format: Format) -> ExitCode {
    let mut failed = false;
    let mut listed: Vec<Finding> = Vec::new();
    for file in files {
        match diagnose(file) {
            Err(why) => {
                eprintln!("lrp: {why}");
                failed = true;
            }
            Ok((sources, diagnostics)) => {
                failed |= diagnostics.iter().any(Diagnostic::is_error);
                match format {
                    Format::Text => show(&diagnostics, &sources),
                    Format::Json => listed.extend(findings::errors_first(&diagnostics, &sources)),
                }
            }
        }
    }
    if let Format::Json = format {
        println!("{}", serde_json::json!(listed));
    }
    ExitCode::from(u8::from(failed))
}

fn show(diagnostics: &[Diagnostic], sources: &[Source]) {
    if diagnostics.is_empty() {
        println!("{}: no problems found", sources[0].name);
        return;
    }
    let coloured = stdout().is_terminal() && std::env::var_os("NO_COLOR").is_none();
    let style = if coloured { Style::Colour } else { Style::Plain };
    print!("{}", render(diagnostics, sources, style));
}

/// Everything found in a program, in its texts, in its worlds.
pub fn diagnose(file: &Path) -> Result<(Vec<Source>, Vec<Diagnostic>), loader::Unreadable> {
    let source = loader::read(file)?;
    match Compiler::new(Vec::new()).compile(source) {
        Err(Rejected { sources, diagnostics }) => Ok((sources, diagnostics)),
        Ok(mut program) => {
            let workshop = Workshop { folder: folder(file), seed: 1, robots: Robots::AsProgrammed };
            for bridge in program.bridges.clone() {
                if let Err(Problems { sources, diagnostics }) = workshop.make(&bridge, program.sources.len() as u16) {
                    program.sources.extend(sources);
                    program.findings.extend(diagnostics);
                }
            }
            Ok((program.sources, program.findings))
        }
    }
}

pub fn bridges(kind: Option<&str>) -> ExitCode {
    let Some(kind) = kind else {
        for kind in robots::KINDS {
            println!("{kind:10} built in    {}", robots::summary(kind));
        }
        return ExitCode::SUCCESS;
    };
    let Some(description) = robots::offer(kind) else {
        eprintln!("lrp: there is no bridge of kind `{kind}`; there is: {}", robots::KINDS.join(", "));
        return ExitCode::FAILURE;
    };
    println!("{kind}: {}", robots::summary(kind));
    for (title, ports) in [("inputs", &description.inputs), ("outputs", &description.outputs)] {
        println!("\n{title}");
        for port in ports {
            println!("  {:10} {}\n  {:10} {}", port.name, port.doc, "", port.message);
        }
    }
    ExitCode::SUCCESS
}
