//! The command line from the outside: what goes where, and the exit code.

use std::fs;
use std::path::Path;
use std::process::{Command, Stdio};
use std::thread;
use std::time::{Duration, Instant};

use serde_json::Value;

use crate::binary::{AMPLE, Running, Said, command, lrp};

fn root() -> &'static Path {
    Path::new(env!("CARGO_MANIFEST_DIR"))
}

fn ok(said: &Said) {
    assert_eq!((said.code, &*said.err), (Some(0), ""), "{said:?}");
}

#[test]
fn help_is_what_was_asked_for() {
    let said = lrp(root(), &["--help"]);
    ok(&said);
    let kept = root().join("tests/corpus/command_line/help.txt");
    if std::env::var_os("UPDATE").is_some() {
        fs::write(&kept, &said.out).unwrap();
    }
    assert!(fs::read_to_string(&kept).unwrap_or_default() == said.out, "not as in {}:\n{}", kept.display(), said.out);
    for name in ["live", "run", "check", "test", "graph", "new", "tour", "bridges"] {
        let said = lrp(root(), &[name, "--help"]);
        ok(&said);
        let undescribed =
            |line: &&str| line.trim_start().starts_with(['-', '<', '[']) && line.split_whitespace().count() < 3;
        let bare: Vec<&str> = said.out.lines().filter(undescribed).filter(|line| line.len() < 24).collect();
        assert!(bare.is_empty(), "lrp {name} --help explains everything but {bare:?}");
    }
}

#[test]
fn wrong_usage_is_2_with_the_likely_fix() {
    for (args, says) in [
        (&[][..], "Usage: lrp"),
        (&["run"], "<FILE>"),
        (&["runn", "x.lrp"], "there is no command `runn`; did you mean `run`?"),
        (&["run", "--rate", "fast", "x.lrp"], "a rate is a number of steps a second"),
        (&["run", "--rate", "-1", "x.lrp"], "a rate is a number of steps a second"),
        (&["run", "--for", "5", "x.lrp"], "such as 500ms, 5s or 2m"),
        (&["run", "--for", "-5s", "x.lrp"], "such as 500ms, 5s or 2m"),
        (&["run", "--bridge", "sim", "x.lrp"], "write NAME=KIND, such as robot=sim"),
        (&["run", "--virtul", "x.lrp"], "--virtual"),
        (&["run", "--on-edit", "kep", "x.lrp"], "keep"),
        (&["run", "--hold", "x.lrp"], "`lrp run` can't hold saves: it has no key to apply or drop them"),
        (&["check"], "<FILE>"),
        (&["graph", "--format", "png", "x.lrp"], "dot"),
    ] {
        let said = lrp(root(), args);
        assert_eq!((said.code, &*said.out), (Some(2), ""), "{args:?}: {said:?}");
        assert!(said.err.contains(says), "{args:?}: {}", said.err);
    }
}

#[test]
fn without_a_terminal_there_is_no_screen() {
    let said = lrp(root(), &["behaviors/line_follower.lrp"]);
    assert_eq!((said.code, &*said.out), (Some(1), ""));
    assert_eq!(said.err, "lrp: there is no terminal for the screen; `lrp run` works without one\n");
    let folder = tempfile::tempdir().unwrap();
    let said = lrp(folder.path(), &["tour"]);
    assert_eq!((said.code, &*said.out), (Some(1), ""));
    assert_eq!(fs::read_dir(folder.path()).unwrap().count(), 0, "nothing was made for nobody");
}

fn trace(args: &[&str]) -> String {
    let mut all = vec!["run", "--virtual", "--trace", "-"];
    all.extend(args);
    let said = lrp(root(), &all);
    ok(&said);
    said.out
}

#[test]
fn virtual_runs_are_equal_to_the_byte() {
    let run = || trace(&["behaviors/escapement.lrp", "--for", "60s"]);
    let first = run();
    assert!(first.starts_with(r#"{"lrp":1,"#));
    assert_eq!(first, run());
}

#[test]
fn every_line_of_a_trace_is_a_record() {
    let kinds = "load reject command spawn enter exit transition discard set input output call reply log error pause resume \
                 force restart stop skip status bridge";
    let text = trace(&["behaviors/line_follower.lrp", "--for", "30s"]);
    let mut lines = text.lines().map(|line| serde_json::from_str::<Value>(line).unwrap());
    let header = lines.next().unwrap();
    assert_eq!(header["lrp"], 1);
    assert_eq!(header["files"][0]["text"], fs::read_to_string(root().join("behaviors/line_follower.lrp")).unwrap());
    let mut last = Value::Null;
    for record in lines {
        let kind = record["kind"].as_str().unwrap();
        assert!(kinds.split_whitespace().any(|known| known == kind), "{record}");
        assert!(record["step"].is_u64() && record["t"].is_u64(), "{record}");
        assert!(record["t"].as_u64() >= last["t"].as_u64(), "{record} after {last}");
        last = record;
    }
    assert_eq!((&last["kind"], &last["t"]), (&"stop".into(), &30_000.into()));
}

#[test]
fn noise_is_the_seeds() {
    let folder = tempfile::tempdir().unwrap();
    let behaviors = root().join("behaviors");
    let text = fs::read_to_string(behaviors.join("line_follower.lrp")).unwrap();
    let world = format!("{:?}", behaviors.join("worlds/curve.world"));
    let noisy = text.replace("\"worlds/curve.world\"", &format!("{world}, noise = {{ light = 4, range = 0.01 }}"));
    assert_ne!(text, noisy);
    let file = folder.path().join("noisy.lrp");
    fs::write(&file, noisy).unwrap();
    let run = |seed| {
        let text = trace(&[file.to_str().unwrap(), "--for", "10s", "--seed", seed]);
        text.split_once('\n').unwrap().1.to_string()
    };
    assert_eq!(run("7"), run("7"));
    assert_ne!(run("7"), run("8"));
}

#[test]
fn signals_end_it_after_the_robot_is_stopped() {
    for (signal, code) in [(libc::SIGINT, 130), (libc::SIGTERM, 0), (libc::SIGHUP, 0)] {
        let running = Running::start(root(), &["behaviors/line_follower.lrp"]);
        running.wait_for_kind("output");
        running.signal(signal);
        let (ended, records, err) = running.end();
        assert_eq!((ended, &*err), (Some(code), ""));
        assert_eq!(records.last().unwrap()["kind"], "stop", "after signal {signal}");
    }
}

/// A block that can't be stopped doesn't keep the program from ending.
#[test]
fn a_stuck_block_is_not_waited_for() {
    let folder = tempfile::tempdir().unwrap();
    let text =
        r#"(machine m (state s (onentry [os.execute("touch stuck; exec sleep 20 >/dev/null 2>&1")]))) (spawn m s)"#;
    fs::write(folder.path().join("a.lrp"), text).unwrap();
    let running = Running::start(folder.path(), &["a.lrp", "--allow-system", "--block-limit", "50"]);
    let begun = Instant::now();
    while !folder.path().join("stuck").exists() {
        assert!(begun.elapsed() < AMPLE);
        thread::sleep(Duration::from_millis(10));
    }
    running.signal(libc::SIGTERM);
    let asked = Instant::now();
    assert_eq!(running.end().0, Some(0));
    assert!(asked.elapsed() < Duration::from_secs(10));
}

#[test]
fn errors_are_1() {
    let folder = tempfile::tempdir().unwrap();
    for (text, says) in [
        ("(machine m (state s (running [error('no')]))) (spawn m s)", "a.lrp:1:31: error: no\n"),
        ("(machine m (state s)) (spawn m t)", "a.lrp:1:"),
        ("(machine m", "a.lrp:1:1: error: "),
    ] {
        fs::write(folder.path().join("a.lrp"), text).unwrap();
        let said = lrp(folder.path(), &["run", "--virtual", "--for", "1s", "a.lrp"]);
        assert_eq!((said.code, &*said.out), (Some(1), ""), "{text}: {said:?}");
        assert!(said.err.starts_with(says) && said.err.lines().count() == 1, "{text}: {}", said.err);
    }
}

#[test]
fn run_says_what_is_likely_wrong() {
    let folder = tempfile::tempdir().unwrap();
    fs::write(folder.path().join("a.lrp"), "(machine m (state s))").unwrap();
    let said = lrp(folder.path(), &["run", "--virtual", "--for", "1s", "a.lrp"]);
    assert_eq!(said.code, Some(0));
    assert_eq!(
        said.err,
        "a.lrp:1:10: warning: nothing is spawned, so nothing will run; add `(spawn m s)` at the end of the file\n"
    );
}

#[test]
fn warnings_and_hints_are_no_failure() {
    let folder = tempfile::tempdir().unwrap();
    fs::write(folder.path().join("a.lrp"), "(var x := [1]) (machine m (state a) (state b)) (spawn m a)").unwrap();
    let said = lrp(folder.path(), &["check", "a.lrp"]);
    assert_eq!((said.code, &*said.err), (Some(0), ""), "{said:?}");
    assert!(said.out.contains("warning[unreachable-state]") && said.out.contains("hint[unused-variable]"), "{said:?}");
}

#[test]
fn codes_are_explained() {
    let said = lrp(root(), &["check", "--explain", "never-rests"]);
    assert_eq!((said.code, &*said.err), (Some(0), ""), "{said:?}");
    assert!(said.out.starts_with("never-rests\n\nTransitions that"), "{said:?}");
    assert!(said.out.contains("Wrong:\n\n    (machine m") && !said.out.contains("```"), "{said:?}");
    for args in [&["check", "--explain"][..], &["check", "--explain", "list"]] {
        let said = lrp(root(), args);
        assert_eq!((said.code, said.out.lines().count()), (Some(0), lrp::syntax::Code::ALL.len()), "{said:?}");
    }
    let said = lrp(root(), &["check", "--explain", "never-rest"]);
    assert_eq!(said.code, Some(1));
    assert_eq!(said.err, "lrp: no finding has the code `never-rest`; did you mean `never-rests`?\n");
}

#[test]
fn check_for_tools_lists_everything() {
    let folder = tempfile::tempdir().unwrap();
    fs::write(folder.path().join("a.lrp"), "(machine m (state s) (on nope s -> s)) (spawn m s)").unwrap();
    fs::write(folder.path().join("b.lrp"), "").unwrap();
    let said = lrp(folder.path(), &["check", "--format", "json", "a.lrp", "b.lrp", "c.lrp"]);
    assert_eq!((said.code, &*said.err), (Some(1), ""));
    let found: Value = serde_json::from_str(&said.out).unwrap();
    let brief: Vec<_> =
        found.as_array().unwrap().iter().map(|one| [&one["file"], &one["code"], &one["line"]]).collect();
    assert_eq!(
        serde_json::json!(brief),
        serde_json::json!([
            ["a.lrp", "unknown-event", 1],
            ["b.lrp", "file-unreadable", 0],
            ["c.lrp", "file-unreadable", 0]
        ])
    );
    let said = lrp(root(), &["check", "behaviors/line_follower.lrp", "behaviors/escapement.lrp"]);
    ok(&said);
    assert_eq!(said.out.lines().filter(|line| line.ends_with(": no problems found")).count(), 2);
}

#[test]
fn graphs_fit_where_they_are_asked_to() {
    let graph = |args: &[&str]| {
        let mut all = vec!["graph", "behaviors/line_follower.lrp"];
        all.extend(args);
        let said = lrp(root(), &all);
        ok(&said);
        said.out
    };
    let ascii = graph(&["--ascii"]);
    assert!(ascii.is_ascii() && ascii.contains("bumpback"));
    assert!(!graph(&[]).is_ascii());
    for width in [9, 22, 30] {
        let narrow = graph(&["--width", &width.to_string()]);
        assert!(narrow.lines().all(|line| line.chars().count() <= width), "{narrow}");
        // Where a text is shortened, a legend has it whole.
        assert!(width < 20 || narrow.contains("tlooking"), "{narrow}");
    }
    assert!(graph(&["--height", "14"]).lines().count() <= graph(&[]).lines().count());
    assert!(graph(&["--height", "8"]).lines().count() <= 8);
    assert!(graph(&["--form", "table"]).lines().count() < graph(&["--form", "boxes"]).lines().count());
    let around = graph(&["--around", "bumpturn"]);
    assert!(around.contains("3100ms") && around.contains("bumpback") && !around.contains("moving"), "{around}");
    let said = lrp(root(), &["graph", "behaviors/line_follower.lrp", "--around", "bumptrun"]);
    let why = "lrp: this machine has no state `bumptrun`; did you mean `bumpturn`?\n";
    assert_eq!((said.code, &*said.err), (Some(1), why));
    assert!(graph(&["follower/looking/lookalgo"]).contains("lookleft"));
    assert!(graph(&["--format", "dot"]).starts_with("digraph"));
    assert!(graph(&["--format", "mermaid"]).starts_with("stateDiagram"));
    let said = lrp(root(), &["graph", "behaviors/line_follower.lrp", "folower"]);
    assert_eq!((said.code, &*said.err), (Some(1), "lrp: there is no machine `folower`; did you mean `follower`?\n"));
}

#[test]
fn a_new_program_checks_clean_and_runs() {
    let folder = tempfile::tempdir().unwrap();
    ok(&lrp(folder.path(), &["new", "rover"]));
    let made = fs::read_to_string(folder.path().join("rover.lrp")).unwrap();
    let said = lrp(folder.path(), &["check", "rover.lrp"]);
    ok(&said);
    assert_eq!(said.out, "rover.lrp: no problems found\n");
    let said = lrp(folder.path(), &["run", "--virtual", "--for", "60s", "--trace", "-", "rover.lrp"]);
    ok(&said);
    assert!(said.out.contains(r#""to":"turning""#), "it meets a wall");
    let said = lrp(folder.path(), &["new", "rover.lrp"]);
    assert_eq!(
        (said.code, &*said.err),
        (Some(1), "lrp: rover.lrp exists already and stays as it is; choose another name, or run it: lrp rover.lrp\n")
    );
    assert_eq!(made, fs::read_to_string(folder.path().join("rover.lrp")).unwrap());
    let said = lrp(folder.path(), &["new", "no/such/rover"]);
    assert_eq!(
        (said.code, &*said.err),
        (Some(1), "lrp: no/such/rover.lrp can't be made: there is no folder no/such\n")
    );
    for nameless in ["", ".lrp", "/tmp/"] {
        let said = lrp(folder.path(), &["new", nameless]);
        assert_eq!((said.code, &*said.err), (Some(1), "lrp: a new behaviour needs a name, such as rover\n"));
    }
}

#[test]
fn bridges_are_listed() {
    let said = lrp(root(), &["bridges"]);
    ok(&said);
    assert!(said.out.starts_with("sim "));
    let said = lrp(root(), &["bridges", "sim"]);
    ok(&said);
    assert!(["light", "bumper", "range", "odom", "move"].iter().all(|port| said.out.contains(port)));
    let said = lrp(root(), &["bridges", "smi"]);
    assert_eq!((said.code, &*said.err), (Some(1), "lrp: there is no bridge of kind `smi`; did you mean `sim`?\n"));
}

#[test]
fn the_behaviours_pass_their_tests() {
    for kind in ["ev3", "ros2"] {
        let library = Path::new(env!("CARGO_BIN_EXE_lrp")).with_file_name(format!("deps/liblrp_bridge_{kind}.so"));
        assert!(library.exists(), "{} is missing: the tests are run by `cargo test --workspace`", library.display());
    }
    let said = lrp(&root().join("behaviors"), &["test"]);
    assert_eq!((said.code, &*said.err), (Some(0), ""), "{said:?}");
    let folder = tempfile::tempdir().unwrap();
    let said = lrp(folder.path(), &["test"]);
    assert_eq!((said.code, &*said.out), (Some(1), ""));
    assert_eq!(said.err, "lrp: no tests found: there is no `*_test.lua` in .\n");
}

/// Starts it behind a reader that closes the pipe after the first line.
fn head(args: &str) -> (Option<i32>, String) {
    let script = format!("set -o pipefail; \"$LRP\" {args} | head -n 1 >/dev/null");
    let mut bash = Command::new("bash");
    bash.args(["-c", &script]).env("LRP", env!("CARGO_BIN_EXE_lrp")).current_dir(root()).stdin(Stdio::null());
    let ended = bash.output().unwrap();
    (ended.status.code(), String::from_utf8(ended.stderr).unwrap())
}

#[test]
fn a_reader_that_has_seen_enough_is_no_fault() {
    let run = "run --virtual behaviors/line_follower.lrp --trace -";
    for args in [run, "graph behaviors/line_follower.lrp", "bridges sim", "check behaviors/line_follower.lrp", "--help"]
    {
        assert_eq!(head(args), (Some(0), String::new()), "{args}");
    }
}

#[test]
fn a_full_disk_is_told_once() {
    let full = || fs::OpenOptions::new().write(true).open("/dev/full").unwrap();
    let said = lrp(root(), &["run", "--virtual", "--for", "60s", "behaviors/escapement.lrp", "--trace", "/dev/full"]);
    assert_eq!(said.code, Some(0), "the run goes on");
    assert!(
        said.err.starts_with("lrp: the trace /dev/full ends here: ") && said.err.lines().count() == 1,
        "{}",
        said.err
    );
    let said =
        lrp(root(), &["run", "--virtual", "--for", "1s", "behaviors/escapement.lrp", "--trace", "no/such/trace"]);
    assert_eq!(said.code, Some(1));
    assert!(said.err.starts_with("lrp: the trace can't be written: "), "{}", said.err);
    for args in [&["graph", "behaviors/escapement.lrp"][..], &["bridges"], &["check", "behaviors/escapement.lrp"]] {
        let ended = command(root(), args).stdout(full()).stderr(Stdio::piped()).output().unwrap();
        assert_eq!(ended.status.code(), Some(1), "{args:?}");
        assert!(
            String::from_utf8_lossy(&ended.stderr).starts_with("lrp: standard output can't be written: "),
            "{args:?}"
        );
    }
}

/// Without limits on time, records are made only as fast as they are taken.
#[test]
fn a_slow_reader_costs_no_memory() {
    let mut child = command(root(), &["run", "--virtual", "behaviors/line_follower.lrp", "--trace", "-"]);
    let mut child = child.stdout(Stdio::piped()).spawn().unwrap();
    let statm = |id| fs::read_to_string(format!("/proc/{id}/statm")).unwrap();
    let resident = |id| statm(id).split_whitespace().nth(1).unwrap().parse::<u64>().unwrap() * 4096;
    // Nobody reads: once the pipe is full and the records wait, the processor rests.
    let mut before = 0;
    let cpu = |id| {
        let stat = fs::read_to_string(format!("/proc/{id}/stat")).unwrap();
        stat.rsplit_once(')').unwrap().1.split_whitespace().nth(11).unwrap().parse::<u64>().unwrap()
    };
    let begun = Instant::now();
    let rests = loop {
        thread::sleep(Duration::from_millis(300));
        let now = cpu(child.id());
        if now > 0 && now <= before + 3 || begun.elapsed() > AMPLE {
            break now <= before + 3;
        }
        before = now;
    };
    let memory = resident(child.id());
    child.kill().unwrap();
    child.wait().unwrap();
    assert!(rests && memory < 300 << 20, "rests: {rests}, {} MiB", memory >> 20);
}
