//! The program with its screen, as a user at a terminal has it: what is seen, what keys do, how it ends.

mod mouse;

use std::fs;
use std::path::Path;
use std::time::{Duration, Instant};

use portable_pty::CommandBuilder;
use serde_json::Value;

use crate::terminal::pty::{Pty, Running};
use crate::terminal::tells_of_mouse;

struct User {
    pty: Pty,
    running: Running,
    folder: tempfile::TempDir,
    modes: String,
}

impl User {
    /// `lrp line_follower.lrp` in 80x24, its first steps on the screen.
    fn new() -> User {
        User::with(&[])
    }

    fn with(set: &[(&str, &str)]) -> User {
        User::start(set, &[])
    }

    fn start(set: &[(&str, &str)], arguments: &[&str]) -> User {
        let folder = tempfile::tempdir().unwrap();
        let behaviors = Path::new(env!("CARGO_MANIFEST_DIR")).join("behaviors");
        fs::create_dir(folder.path().join("worlds")).unwrap();
        for file in ["line_follower.lrp", "worlds/curve.world"] {
            fs::copy(behaviors.join(file), folder.path().join(file)).unwrap();
        }
        let pty = Pty::new();
        let modes = format!("{:?}", pty.modes());
        let mut command = CommandBuilder::new(env!("CARGO_BIN_EXE_lrp"));
        command.args(["line_follower.lrp", "--trace", "trace"]);
        command.args(arguments);
        command.cwd(folder.path());
        ["NO_COLOR", "TMUX"].iter().for_each(|name| command.env_remove(name));
        command.env("TERM", "xterm-256color");
        command.env("LC_ALL", "C.UTF-8");
        set.iter().for_each(|(name, value)| command.env(name, value));
        let running = pty.run(command);
        let user = User { pty, running, folder, modes };
        user.sees(&["line_follower.lrp", "RUN", "10 Hz", "robot up", "moving", "lookalgo", "lightlim", "128", "STOP"]);
        user
    }

    fn shows(&self, what: &str, wanted: impl Fn(&str) -> bool) {
        self.pty
            .wait_for(what, |screen| screen.alternate_screen() && screen.hide_cursor() && wanted(&screen.contents()));
    }

    fn sees(&self, words: &[&str]) {
        self.shows(&words.join(", "), |text| words.iter().all(|word| text.contains(word)));
    }

    fn types(&mut self, keys: &str, words: &[&str]) {
        self.pty.type_in(keys);
        self.sees(words);
    }

    fn trace(&self) -> Vec<Value> {
        let text = fs::read_to_string(self.folder.path().join("trace")).unwrap();
        // The last line may be on its way.
        let whole = text.rfind('\n').map_or("", |end| &text[..end]);
        whole.lines().map(|line| serde_json::from_str(line).unwrap()).collect()
    }

    fn traced(&self, what: &str, wanted: impl Fn(&Value) -> bool) {
        let begun = Instant::now();
        while !self.trace().iter().any(&wanted) {
            assert!(begun.elapsed() < crate::binary::AMPLE, "not in the trace: {what}");
            std::thread::sleep(Duration::from_millis(10));
        }
    }

    fn signal(&self, signal: i32) {
        // SAFETY: a signal to a child.
        assert_eq!(unsafe { libc::kill(self.running.id, signal) }, 0);
    }

    /// It ends; the terminal is as it was, and the robot was stopped.
    fn ends(self, code: u32) {
        assert_eq!(self.running.wait().exit_code(), code);
        self.pty.wait_for("the shell's screen", |screen| {
            !screen.alternate_screen() && !screen.hide_cursor() && !tells_of_mouse(screen)
        });
        assert_eq!(format!("{:?}", self.pty.modes()), self.modes);
        self.robot_was_stopped();
    }

    fn robot_was_stopped(&self) {
        assert_eq!(self.trace().last().unwrap()["kind"], "stop");
    }
}

#[test]
fn q_leaves_everything_as_it_was() {
    let mut user = User::new();
    assert!(user.pty.is_raw());
    user.pty.type_in("q");
    user.ends(0);
}

#[test]
fn ctrl_c_and_signals_stop_the_robot_too() {
    let mut user = User::new();
    user.pty.type_in("\x03");
    user.ends(130);
    for (signal, code) in [(libc::SIGTERM, 0), (libc::SIGHUP, 0), (libc::SIGINT, 130)] {
        let user = User::new();
        user.signal(signal);
        user.ends(code);
    }
}

#[test]
fn a_terminal_that_is_gone_stops_the_robot() {
    let User { pty, running, folder, .. } = User::new();
    let gone = Instant::now();
    pty.unplug("?");
    assert_eq!(running.wait().exit_code(), 0);
    println!("the terminal gone, ended after {:.0} ms", gone.elapsed().as_secs_f64() * 1e3);
    let trace = fs::read_to_string(folder.path().join("trace")).unwrap();
    assert!(trace.lines().last().unwrap().contains(r#""kind":"stop""#));
}

#[test]
fn keys_drive_the_program() {
    let mut user = User::new();
    user.types(" ", &["PAUSED"]);
    let steps = || user.trace().iter().filter_map(|record| record["step"].as_u64()).max().unwrap();
    let before = steps();
    user.pty.type_in("s");
    user.traced("a step by hand", |record| record["step"].as_u64() == Some(before + 1));
    user.types(" ", &["RUN"]);
    user.types("?", &["stop the robot at once"]);
    user.pty.type_in("\x1b");
    user.shows("no help", |text| !text.contains("stop the robot at once"));
    user.pty.type_in("w");
    user.shows("the world", |text| {
        text.contains("curve") && text.chars().any(|c| ('\u{2801}'..='\u{28ff}').contains(&c))
    });
    user.types("!", &["STOPPED"]);
    user.traced("the stop", |record| record["kind"] == "stop" && record["reason"] == "runstop");
    user.types(" ", &["RUN"]);
    user.pty.type_in("q");
    user.ends(0);
}

#[test]
fn values_and_states_are_set() {
    let mut user = User::new();
    user.types(" ", &["PAUSED"]);
    // In the variables, from the top: nobump, pressed, lightlim, ..
    user.pty.type_in("3gjj");
    user.pty.type_in("e99\r");
    user.traced("a typed value", |record| {
        record["kind"] == "set" && record["var"] == "lightlim" && record["value"] == 99
    });
    user.pty.type_in("l");
    user.traced("a nudge", |record| {
        record["kind"] == "set" && record["var"] == "lightlim" && record["value"].as_f64() > Some(99.0)
    });
    // In the machines, the last state.
    user.pty.type_in("1Gt");
    user.traced("a state", |record| record["kind"] == "force" && record["state"] == "follower/finished");
    user.pty.type_in("\x12");
    user.traced("a restart", |record| record["kind"] == "restart");
    user.pty.type_in("q");
    user.ends(0);
}

#[test]
fn every_size_is_filled_and_none_breaks_it() {
    let mut user = User::new();
    for (cols, rows) in [(120, 40), (40, 24), (80, 12), (12, 3), (200, 50), (80, 24)] {
        user.pty.resize(cols, rows);
        let stop =
            |screen: &vt100::Screen| screen.contents().lines().next_back().is_some_and(|line| line.contains("STOP"));
        let roomy = cols >= 40;
        user.pty.wait_for(&format!("{cols}x{rows}"), |screen| {
            screen.size() == (rows, cols) && (!roomy || screen.contents().contains("machines") && stop(screen))
        });
    }
    user.sees(&["moving", "looking", "lightlim"]);
    user.pty.resize(120, 40);
    user.sees(&["source  line_follower.lrp", "(machine follower"]);
    // What was hidden and moved stays so at every size.
    user.pty.type_in("4x1]]");
    user.shows("no log", |text| !text.contains("─ log"));
    for (cols, rows) in [(80, 24), (40, 24), (120, 40)] {
        user.pty.resize(cols, rows);
        user.pty.wait_for(&format!("{cols}x{rows} without a log"), |screen| {
            let text = screen.contents();
            screen.size() == (rows, cols)
                && text.contains("machines")
                && text.contains("STOP")
                && !text.contains("─ log")
        });
    }
    user.pty.type_in("q");
    user.ends(0);
}

#[test]
fn ctrl_z_stops_the_robot_and_comes_back() {
    let mut user = User::new();
    user.pty.type_in("\x1a");
    user.pty.wait_for("the shell's screen", |screen| {
        !screen.alternate_screen() && !screen.hide_cursor() && !tells_of_mouse(screen)
    });
    user.signal(libc::SIGCONT);
    user.sees(&["STOPPED", "machines"]);
    user.traced("the stop", |record| record["kind"] == "stop");
    user.types(" ", &["RUN"]);
    user.pty.type_in("q");
    user.ends(0);
}

#[test]
fn a_stop_it_never_heard_of_is_recovered_from() {
    let mut user = User::new();
    user.signal(libc::SIGSTOP);
    user.pty.scribble("\x1b[2J\x1b[?1049l\x1b[?25h$ ");
    user.signal(libc::SIGCONT);
    user.sees(&["line_follower.lrp", "machines", "lightlim"]);
    user.pty.type_in("q");
    user.ends(0);
}

#[test]
fn edits_are_seen() {
    let mut user = User::new();
    let file = user.folder.path().join("line_follower.lrp");
    let text = fs::read_to_string(&file).unwrap();
    let before = user.trace().len();
    let saved = Instant::now();
    fs::write(&file, text.replace("lightlim := [128]", "lightlim := [131]")).unwrap();
    user.sees(&["131"]);
    println!("an edit seen on the screen after {:.0} ms", saved.elapsed().as_secs_f64() * 1e3);
    assert!(user.trace().len() > before);
    fs::write(&file, text.replacen("(machine follower", "(machine follower (", 1)).unwrap();
    user.traced("a broken edit", |record| record["kind"] == "reject" && record["findings"][0]["line"].is_u64());
    user.sees(&["RUN", "is not closed"]);
    fs::write(&file, text).unwrap();
    user.traced("a mended one", |record| {
        record["kind"] == "set" && record["var"] == "lightlim" && record["value"] == 128
    });
    user.pty.type_in("q");
    user.ends(0);
}

fn coloured(user: &User) -> bool {
    let any = std::cell::Cell::new(false);
    user.pty.wait_for("a screen", |screen| {
        let cells = (0..24).flat_map(|row| (0..80).filter_map(move |col| screen.cell(row, col)));
        let plain =
            |cell: &vt100::Cell| cell.fgcolor() == vt100::Color::Default && cell.bgcolor() == vt100::Color::Default;
        any.set(!cells.into_iter().all(plain));
        true
    });
    any.get()
}

#[test]
fn no_color_means_none() {
    let mut user = User::with(&[("NO_COLOR", "1")]);
    assert!(!coloured(&user));
    user.pty.type_in("q");
    user.ends(0);
    let user = User::new();
    assert!(coloured(&user));
}

#[test]
fn the_screen_keeps_standard_output_to_itself() {
    let pty = Pty::new();
    let mut command = CommandBuilder::new(env!("CARGO_BIN_EXE_lrp"));
    command.args(["behaviors/line_follower.lrp", "--trace", "-"]);
    command.cwd(env!("CARGO_MANIFEST_DIR"));
    assert_eq!(pty.run(command).wait().exit_code(), 1);
    pty.wait_for("why", |screen| screen.contents().contains("the screen needs standard output for itself"));
}

/// The trace's trouble is told on the screen, not over it.
#[test]
fn a_full_disk_is_told_on_the_screen() {
    let mut pty = Pty::new();
    let mut command = CommandBuilder::new(env!("CARGO_BIN_EXE_lrp"));
    command.args(["behaviors/line_follower.lrp", "--trace", "/dev/full"]);
    command.cwd(env!("CARGO_MANIFEST_DIR"));
    let running = pty.run(command);
    pty.wait_for("the trouble", |screen| {
        let last = screen.contents().lines().next_back().unwrap_or_default().to_string();
        last.contains("the trace /dev/full ends here") && screen.contents().contains("machines")
    });
    pty.type_in("q");
    assert_eq!(running.wait().exit_code(), 0);
}

#[test]
fn a_tuned_value_is_written_into_the_file_and_one_that_is_not_is_named_at_the_end() {
    let mut user = User::new();
    let file = user.folder.path().join("line_follower.lrp");
    let before = fs::read_to_string(&file).unwrap();
    user.types("3/lightlim\rj>", &["variables  /lightlim", "*lightlim", "138", "1 unwritten"]);
    user.types("w", &["written to line_follower.lrp: lightlim 138"]);
    user.sees(&["saved: ~variable lightlim"]);
    assert_eq!(fs::read_to_string(&file).unwrap(), before.replace("lightlim := [128]", "lightlim := [138]"));
    user.traced("the initial value", |record| {
        record["kind"] == "set" && record["var"] == "lightlim" && record["value"] == 138 && record["by"] == "init"
    });
    user.types(">", &["*lightlim", "148"]);
    user.pty.type_in("q");
    let told = "lightlim was set to 148 by hand; the file still has 138";
    user.pty.wait_for(told, |screen| !screen.alternate_screen() && screen.contents().replace('\n', "").contains(told));
    user.ends(0);
}

/// A script for an editor, which covers the screen, changes the file and ends.
#[test]
fn an_editor_changes_the_file_and_gives_the_screen_back() {
    let scripts = tempfile::tempdir().unwrap();
    let script = scripts.path().join("edit");
    let text = "#!/bin/sh\nfor file; do :; done\nsed -i 's/lightlim := \\[128\\]/lightlim := [77]/' \"$file\"\n\
                echo edited; read key\n";
    fs::write(&script, text).unwrap();
    let executable = std::os::unix::fs::PermissionsExt::from_mode(0o755);
    fs::set_permissions(&script, executable).unwrap();
    let editor = script.to_str().unwrap();
    let mut user = User::with(&[("EDITOR", editor), ("VISUAL", editor)]);
    user.types("o", &["the editor will cover this screen"]);
    user.pty.type_in("o");
    user.pty.wait_for("the editor", |screen| {
        !screen.alternate_screen() && !tells_of_mouse(screen) && screen.contents().contains("edited")
    });
    user.traced("the edit", |record| record["kind"] == "set" && record["var"] == "lightlim" && record["value"] == 77);
    user.pty.type_in("\n");
    user.sees(&["machines", "lightlim", "77", "STOP"]);
    user.pty.wait_for("the mouse again", tells_of_mouse);
    let file = fs::read_to_string(user.folder.path().join("line_follower.lrp")).unwrap();
    assert!(file.contains("lightlim := [77]"));
    user.pty.type_in("q");
    user.ends(0);
}
