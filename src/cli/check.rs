//! `lrp check`: what is wrong with programs.

use std::io::{IsTerminal, stdout};
use std::path::{Path, PathBuf};
use std::process::ExitCode;

use super::args::Format;
use super::output::{complain, finish};
use crate::runtime::record::Finding;
use crate::session::compile::{Compiler, Rejected};
use crate::session::live::folder;
use crate::session::plugins::Plugins;
use crate::session::robots::{Problems, Robots, Workshop};
use crate::session::{findings, loader};
use crate::syntax::render::{Style, render};
use crate::syntax::{Diagnostic, Source};

pub fn check(files: &[PathBuf], format: Format, plugins: &Plugins) -> ExitCode {
    let mut failed = false;
    let mut listed: Vec<Finding> = Vec::new();
    let mut text = String::new();
    for file in files {
        match diagnose(file, plugins) {
            Err(why) => {
                failed = true;
                match format {
                    Format::Text => complain(why),
                    Format::Json => listed.push(unreadable(file, &why)),
                }
            }
            Ok((sources, diagnostics)) => {
                failed |= diagnostics.iter().any(Diagnostic::is_error);
                match format {
                    Format::Text => text += &shown(&diagnostics, &sources),
                    Format::Json => listed.extend(findings::errors_first(&diagnostics, &sources)),
                }
            }
        }
    }
    if let Format::Json = format {
        text = format!("{}\n", serde_json::json!(listed));
    }
    finish(&text, ExitCode::from(u8::from(failed)))
}

/// For tools: a file without a text has no place in it.
fn unreadable(file: &Path, why: &loader::Unreadable) -> Finding {
    Finding {
        severity: "error".to_string(),
        code: "file-unreadable".to_string(),
        message: why.to_string(),
        help: None,
        file: file.display().to_string().into(),
        line: 0,
        column: 0,
    }
}

fn shown(diagnostics: &[Diagnostic], sources: &[Source]) -> String {
    if diagnostics.is_empty() {
        return format!("{}: no problems found\n", sources[0].name);
    }
    let coloured = stdout().is_terminal() && std::env::var_os("NO_COLOR").is_none();
    let style = if coloured { Style::Colour } else { Style::Plain };
    render(diagnostics, sources, style)
}

/// Everything found in a program, in its texts, in its worlds.
pub fn diagnose(file: &Path, plugins: &Plugins) -> Result<(Vec<Source>, Vec<Diagnostic>), loader::Unreadable> {
    let source = loader::read(file)?;
    match Compiler::new(Vec::new()).with_plugins(plugins.clone()).compile(source) {
        Err(Rejected { sources, diagnostics }) => Ok((sources, diagnostics)),
        Ok(mut program) => {
            let (folder, plugins) = (folder(file), plugins.clone());
            let workshop = Workshop { folder, seed: 1, robots: Robots::AsProgrammed, plugins };
            for bridge in program.bridges.clone() {
                if let Err(Problems { sources, diagnostics }) = workshop.check(&bridge, program.sources.len() as u16) {
                    program.sources.extend(sources);
                    program.findings.extend(diagnostics);
                }
            }
            Ok((program.sources, program.findings))
        }
    }
}
