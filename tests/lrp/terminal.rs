//! The terminal is as it was, however the program ends; and while it runs, keys and frames go where they should.

mod program;
pub mod pty;

use std::env;
use std::fs;
use std::path::PathBuf;
use std::process::{Command, Stdio};

use crossterm::event::KeyCode;
use portable_pty::CommandBuilder;
use pty::{Pty, Running};

const PROGRAM: [&str; 3] = ["terminal::a_screen_needs_a_terminal", "--exact", "--nocapture"];

/// Also what the other tests start, to have a program with a screen.
#[test]
fn a_screen_needs_a_terminal() {
    if let Some(journal) = env::var_os(program::JOURNAL) {
        return program::play(&PathBuf::from(journal));
    }
    let folder = tempfile::tempdir().unwrap();
    let journal = folder.path().join("journal");
    let ended = Command::new(env::current_exe().unwrap())
        .args(PROGRAM)
        .env(program::JOURNAL, &journal)
        .stdin(Stdio::null())
        .stdout(Stdio::piped())
        .output()
        .unwrap();
    assert!(ended.status.success());
    assert!(!ended.stdout.contains(&0x1b), "nothing meant for a terminal");
    let said = fs::read_to_string(journal).unwrap();
    assert_eq!(said, "there is no terminal for the screen; `lrp run` works without one\n");
}

/// Whether the terminal sends clicks to the program.
pub fn tells_of_mouse(screen: &vt100::Screen) -> bool {
    screen.mouse_protocol_mode() != vt100::MouseProtocolMode::None
}

struct Stage {
    pty: Pty,
    running: Running,
    folder: tempfile::TempDir,
}

impl Stage {
    /// The program, with its first frame drawn, behind these words.
    fn new(before: &[&str]) -> Stage {
        let pty = Pty::new();
        let folder = tempfile::tempdir().unwrap();
        let mut words: Vec<_> = before.iter().map(Into::into).collect();
        words.push(env::current_exe().unwrap().into_os_string());
        words.extend(PROGRAM.map(Into::into));
        let mut command = CommandBuilder::from_argv(words);
        command.env(program::JOURNAL, folder.path().join("journal"));
        command.env("RUST_BACKTRACE", "0");
        let running = pty.run(command);
        let stage = Stage { pty, running, folder };
        stage.sees("<ready>");
        stage
    }

    fn sees(&self, frame: &str) {
        self.pty.wait_for(frame, |screen| {
            screen.alternate_screen()
                && screen.hide_cursor()
                && tells_of_mouse(screen)
                && screen.contents().contains(frame)
        });
    }

    fn sees_restored(&self, text: &str) {
        self.pty.wait_for(text, |screen| {
            !screen.alternate_screen()
                && !screen.hide_cursor()
                && !tells_of_mouse(screen)
                && screen.contents().contains(text)
        });
    }

    fn signal(&self, signal: i32) {
        // SAFETY: no memory is involved; the process is our child and not waited for yet.
        assert_eq!(unsafe { libc::kill(self.running.id, signal) }, 0);
    }

    fn journal(&self) -> String {
        fs::read_to_string(self.folder.path().join("journal")).unwrap_or_default()
    }
}

#[test]
fn quitting_restores_the_terminal() {
    let before = Pty::new().modes();
    let mut stage = Stage::new(&[]);
    assert!(stage.pty.is_raw());
    stage.pty.type_in("q");
    stage.sees_restored("1 passed");
    assert!(stage.running.wait().success());
    assert_eq!(stage.pty.modes(), before);
}

#[test]
fn a_panic_restores_the_terminal_stops_the_robot_and_explains_itself() {
    let before = Pty::new().modes();
    let mut stage = Stage::new(&[]);
    stage.pty.type_in("p");
    stage.sees_restored("lrp made a mistake it can't recover from");
    stage.sees_restored("on purpose");
    assert!(!stage.running.wait().success());
    assert_eq!(stage.pty.modes(), before);
    assert_eq!(stage.journal(), "robot stopped\n");
}

#[test]
fn a_panic_of_another_thread_leaves_the_screen_and_is_read_afterwards() {
    let mut stage = Stage::new(&[]);
    stage.pty.type_in("t");
    stage.sees("<it panicked: true>");
    assert!(stage.pty.is_raw());
    stage.pty.type_in("q");
    stage.sees_restored("elsewhere");
    assert!(stage.running.wait().success());
    assert_eq!(stage.journal(), "", "the robot needn't stop for this");
}

#[test]
fn a_signal_to_end_restores_the_terminal() {
    let before = Pty::new().modes();
    for (signal, name) in [(libc::SIGTERM, "Terminate\n"), (libc::SIGINT, "Interrupt\n")] {
        let stage = Stage::new(&[]);
        stage.signal(signal);
        stage.sees_restored("1 passed");
        assert!(stage.running.wait().success());
        assert_eq!(stage.pty.modes(), before);
        assert_eq!(stage.journal(), name);
    }
}

#[test]
fn a_terminal_that_is_gone_is_noticed_by_signal_input_and_output() {
    let Stage { pty, running, folder } = Stage::new(&[]);
    pty.unplug("x");
    // How it ends is no matter of ours: the test harness around it has lost its output, too.
    running.wait();
    let journal = fs::read_to_string(folder.path().join("journal")).unwrap();
    let mut lines: Vec<&str> = journal.lines().collect();
    lines.sort_unstable();
    assert_eq!(lines, ["gone", "hung up", "no output"]);
}

/// As an interactive shell does it: the job in a group of its own, in front until it stops.
const SHELL: [&str; 4] = ["/bin/sh", "-c", "set -m; \"$@\"; echo it stopped; read go; fg; echo it ended", "sh"];

#[test]
fn ctrl_z_gives_the_terminal_back_until_it_is_continued() {
    let before = Pty::new().modes();
    let mut stage = Stage::new(&SHELL);
    stage.pty.type_in("z");
    stage.sees_restored("it stopped");
    assert_eq!(stage.pty.modes(), before);
    stage.pty.type_in("\n");
    stage.sees("<continued>");
    stage.pty.wait_for("raw mode", |_| stage.pty.is_raw());
    stage.pty.type_in("q");
    stage.sees_restored("it ended");
    assert_eq!(stage.pty.modes(), before);
}

#[test]
fn where_no_shell_waits_ctrl_z_changes_nothing() {
    let mut stage = Stage::new(&[]);
    stage.pty.type_in("z");
    stage.sees("<continued>");
    stage.pty.type_in("k");
    stage.sees("<Char('k')>");
}

#[test]
fn a_stop_nobody_announced_is_recovered_from() {
    let mut stage = Stage::new(&[]);
    stage.signal(libc::SIGSTOP);
    stage.signal(libc::SIGCONT);
    stage.pty.type_in("k");
    stage.sees("<Char('k')>");
    // For a moment it isn't, while it is taken back.
    stage.pty.wait_for("raw mode", |_| stage.pty.is_raw());
}

#[test]
fn keys_and_sizes_arrive_in_order() {
    let mut stage = Stage::new(&[]);
    for (keys, frame) in
        [("\x1b[A", KeyCode::Up), ("\r", KeyCode::Enter), ("\x1b", KeyCode::Esc), ("\u{e9}", KeyCode::Char('\u{e9}'))]
    {
        stage.pty.type_in(keys);
        stage.sees(&format!("<{frame:?}>"));
    }
    stage.pty.resize(100, 30);
    stage.sees("<100x30>");
    stage.pty.type_in(&"a".repeat(3000));
    stage.pty.type_in("b");
    stage.sees("<Char('b')>");
}

#[test]
fn an_editor_in_front_gets_all_keys_and_can_not_hide() {
    let before = Pty::new().modes();
    let mut stage = Stage::new(&[]);
    stage.pty.type_in("e");
    stage.pty.wait_for("the screen left", |screen| {
        !screen.alternate_screen() && !screen.hide_cursor() && !tells_of_mouse(screen)
    });
    assert_eq!(stage.pty.modes(), before);
    stage.pty.type_in("quick\n");
    stage.sees_restored("read quick");
    stage.pty.type_in("zebra\n");
    stage.sees("<edited: Ok(())>");
    stage.pty.type_in("k");
    stage.sees("<Char('k')>");
    stage.pty.type_in("q");
    stage.sees_restored("read zebra");
}
