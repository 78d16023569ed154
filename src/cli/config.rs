//! `lrp config`: where the configuration file is, and what is wrong with it.

use std::path::Path;
use std::process::ExitCode;

use super::output::finish;
use crate::runtime::record::Finding;
use crate::ui::config::{Place, load};

pub fn check(said: Option<&Path>) -> ExitCode {
    let place = Place::here(said);
    let Some(path) = place.path() else {
        return finish("no configuration file is wanted: everything is as by default\n", ExitCode::SUCCESS);
    };
    if matches!(place, Place::Usual(_)) && !path.exists() {
        let text = format!(
            "{} isn't there: everything is as by default; docs/config.md tells what it may say\n",
            path.display()
        );
        return finish(&text, ExitCode::SUCCESS);
    }
    let findings = load(&place).findings;
    if findings.is_empty() {
        return finish(&format!("{}: no problems found\n", path.display()), ExitCode::SUCCESS);
    }
    finish(&findings.iter().map(line).collect::<String>(), ExitCode::FAILURE)
}

/// `config.toml:3:1: ...`, where editors look for it.
fn line(finding: &Finding) -> String {
    let place = match finding.line {
        0 => String::new(),
        line => format!("{}:{line}:{}: ", finding.file, finding.column),
    };
    let help = finding.help.iter().map(|help| format!("    help: {help}\n"));
    format!("{place}{}: {}\n{}", finding.severity, finding.message, help.collect::<String>())
}
