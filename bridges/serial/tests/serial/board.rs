//! A simulated ATmega328 with a firmware of ours, where the peers for that are installed.

use std::fs::{read_to_string, write};
use std::io::{BufRead, BufReader};
use std::os::unix::fs::symlink;
use std::path::{Path, PathBuf};
use std::process::{Child, Command, Stdio};

use lrp_peers::{file, program};
use tempfile::TempDir;

/// A board ends by itself after so long, whatever becomes of the test.
const SECONDS: &str = "60";

const FIRMWARES: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/tests/firmware");

/// What it takes to make boards, and where they are plugged in.
pub struct Bench {
    folder: TempDir,
}

/// Plugged in and running; dropped, it is unplugged.
pub struct Board {
    simulator: Child,
    path: PathBuf,
}

impl Bench {
    /// With a firmware of ours.
    pub fn with(firmware: &'static str) -> Option<Bench> {
        let source = read_to_string(format!("{FIRMWARES}/{firmware}.c")).expect("a firmware");
        Bench::build(&source, &["-x", "c", "-std=c11"])
    }

    /// With the sketch of docs/serial.md.
    pub fn with_sketch() -> Option<Bench> {
        let page = read_to_string(concat!(env!("CARGO_MANIFEST_DIR"), "/../../docs/serial.md")).expect("the page");
        let sketch = page.split("```").find_map(|part| part.strip_prefix("cpp\n")).expect("a sketch");
        Bench::build(&format!("#include \"arduino.h\"\n{sketch}"), &["-x", "c++", "-Wno-unused-function"])
    }

    fn build(source: &str, language: &[&str]) -> Option<Bench> {
        let (cross, c) = (program("avr-gcc")?, program("cc")?);
        file("/usr/include/simavr/sim_avr.h")?;
        let bench = Bench { folder: TempDir::new().expect("a folder") };
        write(bench.made("source"), source).expect("a source");
        let target = ["-Wall", "-Wextra", "-Werror", "-Os", "-mmcu=atmega328p", "-I", FIRMWARES];
        let mut compile = Command::new(cross);
        compile.args(language).args(target).arg(bench.made("source")).arg("-o").arg(bench.made("firmware"));
        run(compile.arg("-lm"));
        let libraries = ["-lsimavrparts", "-lsimavr", "-lelf", "-lpthread", "-lutil"];
        let board = format!("{FIRMWARES}/board.c");
        let out = bench.made("board");
        run(Command::new(c).args(["-O2", "-Wall", "-I/usr/include/simavr", &board, "-o"]).arg(out).args(libraries));
        Some(bench)
    }

    fn made(&self, name: &str) -> PathBuf {
        self.folder.path().join(name)
    }

    pub fn path(&self) -> PathBuf {
        self.made("ttyBOARD")
    }

    pub fn plug(&self) -> Board {
        let mut command = Command::new(self.made("board"));
        command.arg(self.made("firmware")).arg(SECONDS).stdout(Stdio::piped()).stderr(Stdio::null());
        let mut simulator = command.spawn().expect("a board");
        let words = BufReader::new(simulator.stdout.take().expect("its words"));
        let terminal =
            words.lines().map_while(Result::ok).find_map(|line| line.strip_prefix("terminal ").map(str::to_string));
        symlink(terminal.expect("a terminal"), self.path()).expect("a free socket");
        Board { simulator, path: self.path() }
    }
}

impl Board {
    /// As opening the port of a real one does.
    pub fn press_reset(&self) {
        run(Command::new("kill").arg("-USR1").arg(self.simulator.id().to_string()));
    }

    /// Turns the level at pin 8 over.
    pub fn press_bumper(&self) {
        run(Command::new("kill").arg("-USR2").arg(self.simulator.id().to_string()));
    }

    pub fn path(&self) -> &Path {
        &self.path
    }
}

impl Drop for Board {
    fn drop(&mut self) {
        let _ = std::fs::remove_file(&self.path);
        let _ = self.simulator.kill();
        let _ = self.simulator.wait();
    }
}

fn run(command: &mut Command) {
    let output = command.output().unwrap_or_else(|error| panic!("{command:?}: {error}"));
    assert!(output.status.success(), "{command:?}: {}", String::from_utf8_lossy(&output.stderr));
}
