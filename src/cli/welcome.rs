//! `lrp` alone: on a terminal a choice of what there is, elsewhere how to use it.

use std::io::{IsTerminal, stdin, stdout};
use std::path::{Path, PathBuf};
use std::process::ExitCode;

use super::args::LiveArgs;
use super::output::{complain, fail};
use super::tour;
use crate::ui::live;
use crate::ui::tour::folder;
use crate::ui::welcome::run::{Wanted, ask};

const USAGE: &str = "a program's file is missing

Usage: lrp FILE        the screen on a program
       lrp run FILE    without a screen
       lrp new NAME    a first program
       lrp tour        ten minutes that show what there is
       lrp --help      all commands and options";

pub fn welcome() -> ExitCode {
    if !stdin().is_terminal() || !stdout().is_terminal() {
        complain(USAGE);
        return ExitCode::from(2);
    }
    match ask(folder::begun(Path::new(folder::USUAL))) {
        Ok(Wanted::Program(file)) => {
            let live = LiveArgs::of(file);
            live::run(live.setup(), live.settings(), live.run.trace, None)
        }
        Ok(Wanted::Tour) => tour::take(PathBuf::from(folder::USUAL)),
        Ok(Wanted::Nothing(code)) => code,
        Err(why) => fail(why),
    }
}
