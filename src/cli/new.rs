//! `lrp new NAME`: says what was made, and what to do with it.

use std::process::ExitCode;

use super::output::{fail, finish};
use crate::session::first_program;

pub fn create(name: &str) -> ExitCode {
    match first_program::create(name) {
        Ok(file) => {
            let file = file.display().to_string();
            let run = quoted(&file);
            let text = format!(
                "{file} is made: a robot in the simulator that turns away from walls.\n\n\
                 \x20   lrp {run}\n\n\
                 runs it. Edit it in another window, or press o: every save counts at once. `lrp tour` shows what else there is.\n"
            );
            finish(&text, ExitCode::SUCCESS)
        }
        Err(why) => fail(why),
    }
}

/// As a shell would want it.
fn quoted(file: &str) -> String {
    let is_plain = file.chars().all(|c| c.is_alphanumeric() || "._-/".contains(c));
    if is_plain { file.to_string() } else { format!("'{}'", file.replace('\'', r"'\''")) }
}
