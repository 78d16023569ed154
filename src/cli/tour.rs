//! `lrp tour`: its folder, the screen on it, and what is said afterwards.

use std::path::{Path, PathBuf};
use std::process::ExitCode;

use super::args::LiveArgs;
use super::output::{fail, finish};
use crate::ui::config;
use crate::ui::live::{self, Guide};
use crate::ui::terminal::Screen;
use crate::ui::tour::{STEPS, Tour, folder};

pub fn take(folder: PathBuf) -> ExitCode {
    if let Err(why) = Screen::check() {
        return fail(why);
    }
    let file = match folder::open(&folder) {
        Ok(file) => file,
        Err(error) => {
            let name = folder.display();
            return fail(format_args!("{name} can't be made: {error}; name another folder: lrp tour FOLDER"));
        }
    };
    let guide = Guide { tour: folder::resume(&folder), folder: folder.clone() };
    let live = LiveArgs::of(file);
    let code = live::run(live.setup(), live.settings(), live.run.trace, Some(guide));
    let done = folder::resume(&folder).done();
    let said = match STEPS.len() - done {
        0 => format!("That was the tour. What it ran is yours, in {}.", folder.display()),
        left => format!("{done} of {} tasks are done. `{}` goes on with {left}.", STEPS.len(), again(&folder)),
    };
    finish(&format!("{said}\n{}", Tour::outlook(&config::usual().keys)), code)
}

fn again(folder: &Path) -> String {
    if folder == Path::new(folder::USUAL) { "lrp tour".into() } else { format!("lrp tour {}", folder.display()) }
}
