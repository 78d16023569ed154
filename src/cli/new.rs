//! `lrp new NAME`: a first program that runs in the simulator, made to be edited.

use std::fs::OpenOptions;
use std::io::{ErrorKind, Write};
use std::process::ExitCode;

const TEMPLATE: &str = include_str!("new.lrp");

pub fn create(name: &str) -> ExitCode {
    let file = if name.ends_with(".lrp") { name.to_string() } else { format!("{name}.lrp") };
    let created = OpenOptions::new().write(true).create_new(true).open(&file).and_then(|mut out| out.write_all(TEMPLATE.as_bytes()));
    match created {
        Ok(()) => {
            println!("{file} is made. Run it with `lrp {file}` and edit it in another window: every save counts at once.");
            ExitCode::SUCCESS
        }
        Err(error) if error.kind() == ErrorKind::AlreadyExists => {
            eprintln!("lrp: {file} exists already; choose another name");
            ExitCode::FAILURE
        }
        Err(error) => {
            eprintln!("lrp: {file} can't be made: {error}");
            ExitCode::FAILURE
        }
    }
}
