//! `lrp new NAME`: a first program that runs in the simulator, made to be edited.

use std::fs::OpenOptions;
use std::io::{ErrorKind, Write};
use std::process::ExitCode;

use super::output::{fail, finish};

const TEMPLATE: &str = include_str!("new.lrp");

pub fn create(name: &str) -> ExitCode {
    let file = if name.ends_with(".lrp") { name.to_string() } else { format!("{name}.lrp") };
    let created = OpenOptions::new()
        .write(true)
        .create_new(true)
        .open(&file)
        .and_then(|mut out| out.write_all(TEMPLATE.as_bytes()));
    match created {
        Ok(()) => {
            let text = format!(
                "{file} is made. Run it with `lrp {}` and edit it in another window: every save counts at once.\n",
                quoted(&file)
            );
            finish(&text, ExitCode::SUCCESS)
        }
        Err(error) if error.kind() == ErrorKind::AlreadyExists => {
            fail(format_args!("{file} exists already; choose another name"))
        }
        Err(error) => fail(format_args!("{file} can't be made: {error}")),
    }
}

/// As a shell would want it.
fn quoted(file: &str) -> String {
    let is_plain = file.chars().all(|c| c.is_alphanumeric() || "._-/".contains(c));
    if is_plain { file.to_string() } else { format!("'{}'", file.replace('\'', r"'\''")) }
}
