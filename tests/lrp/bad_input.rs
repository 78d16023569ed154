//! What a hostile or careless world gives to the program: each time one clear message, the right exit code, in bounded
//! time, and whatever else runs goes on.

use std::fs;
use std::path::Path;
use std::time::Instant;

use crate::binary::{AMPLE, Said, lrp};

const NAME: &str = "bad.lrp";

fn given(bytes: impl AsRef<[u8]>) -> tempfile::TempDir {
    let folder = tempfile::tempdir().unwrap();
    fs::write(folder.path().join(NAME), bytes).unwrap();
    folder
}

fn sound(what: &str, said: &Said) {
    for text in [&said.out, &said.err] {
        assert!(!text.contains("panicked") && !text.contains("RUST_BACKTRACE"), "{what}: {text}");
    }
}

fn each(folder: &Path, name: &str) -> [(&'static str, Said); 3] {
    let run = lrp(folder, &["run", "--virtual", "--for", "2s", name]);
    [("run", run), ("check", lrp(folder, &["check", name])), ("graph", lrp(folder, &["graph", name]))]
}

/// No command accepts it; run says this, in one line.
fn refused(what: &str, bytes: impl AsRef<[u8]>, says: &str) {
    let folder = given(bytes);
    for (command, said) in each(folder.path(), NAME) {
        sound(what, &said);
        assert_eq!(said.code, Some(1), "{command} of {what}: {said:?}");
        let text = said.out.clone() + &said.err;
        let limit = if command == "run" { 1 } else { 14 };
        assert!(!text.is_empty() && text.lines().count() <= limit && text.len() < 1500, "{command} of {what}: {text}");
        if command == "run" {
            assert!(text.contains(says), "{what}: {text}");
        }
    }
}

#[test]
fn texts_that_are_none() {
    refused("an empty file", "", "there is no program in this file");
    refused("blanks", " \r\n\t\n", "there is no program in this file");
    refused("a comment", "; nothing yet\n", "there is no program in this file");
    refused("Latin-1", b"(var x := [\"\xE9\"])", "bad.lrp:1:13: not UTF-8 (byte 0xE9); save the file as UTF-8");
    refused("a NUL byte", b"(machine m (state s))\0(spawn m s)", "bad.lrp:1:22: error: a NUL byte stands here");
    refused("50 MB", vec![b';'; 50 << 20], "larger than 8 MiB; is this a program?");
}

#[test]
fn brackets_without_end() {
    let n = 10_000;
    let state = "(machine m (state s ";
    let too_deep = "nested more than 100 deep";
    refused("nested machines", format!("{}{}(spawn m s)", state.repeat(n), "))".repeat(n)), too_deep);
    refused("unclosed machines", state.repeat(n), too_deep);
    refused("brackets", format!("{}{}", "(".repeat(n), ")".repeat(n)), too_deep);
    refused("open brackets", "(".repeat(n), too_deep);
    refused(
        "an unclosed long string",
        format!("(var x := {}", "[".repeat(n)),
        "bad.lrp:1:11: error: this block is not closed",
    );
    refused("closing ones", ")".repeat(n), "close nothing");
    for (open, close) in [('(', ')'), ('{', '}')] {
        let (open, close) = (open.to_string().repeat(n), close.to_string().repeat(n));
        refused("Lua brackets", format!("(var x := [{open}1{close}])(machine m (state s))(spawn m s)"), too_deep);
    }
}

#[test]
fn files_that_are_none() {
    let folder = given("(machine m (state s)) (spawn m s)");
    for (name, says) in [
        ("bda.lrp", "lrp: bda.lrp: no such file; did you mean `bad.lrp`?\n"),
        ("other/bad.lrp", "lrp: other/bad.lrp: no such file; there is no folder `other`\n"),
        (".", "lrp: .: this is a folder; name a file in it\n"),
        ("bad.lrp/x", "lrp: bad.lrp/x: "),
    ] {
        for (command, said) in each(folder.path(), name) {
            assert_eq!((said.code, &*said.out), (Some(1), ""), "{command} {name}: {said:?}");
            assert!(said.err.starts_with(says) && said.err.lines().count() == 1, "{command} {name}: {}", said.err);
        }
    }
    let said = lrp(folder.path(), &["test", "none_test.lua"]);
    assert_eq!((said.code, &*said.err), (Some(1), "lrp: none_test.lua: no such file or folder\n"));
}

/// Beside it runs a counter, which must come to the end; the first message is this.
fn beside(what: &str, forms: &str, code: i32, says: &str) -> String {
    beside_within("250", what, forms, code, says)
}

/// `limit`: how long a block may run, ms.
fn beside_within(limit: &str, what: &str, forms: &str, code: i32, says: &str) -> String {
    let counter = "(machine counter (var n := [0]) (state s (running [n = n + 1]))) (spawn counter s)\n";
    let folder = given(format!("{counter}{forms}"));
    let begun = Instant::now();
    let said =
        lrp(folder.path(), &["run", "--virtual", "--for", "2s", "--block-limit", limit, "--trace", "trace", NAME]);
    sound(what, &said);
    assert!(begun.elapsed() < AMPLE, "{what}");
    assert_eq!((said.code, &*said.out), (Some(code), ""), "{what}: {}", cut(&said.err));
    assert!(said.err.lines().next().unwrap_or_default().contains(says), "{what}: {}", cut(&said.err));
    let trace = fs::read_to_string(folder.path().join("trace")).unwrap();
    assert!(trace.contains(r#""var":"counter/n","value":20,"#), "{what}: the rest goes on");
    said.err
}

fn cut(text: &str) -> String {
    text.chars().take(500).collect()
}

/// One message that begins with the place.
fn costs_itself_alone(what: &str, forms: &str, says: &str) {
    let err = beside(what, forms, 1, says);
    assert!(err.starts_with("bad.lrp:2:") && err.lines().count() == 1 && err.len() < 300, "{what}: {}", cut(&err));
}

#[test]
fn blocks_without_end() {
    let says = "error: stopped, as it ran for more than 250 ms";
    for (what, form) in [
        ("a guard", "(machine m (state s) (state t) (on [@] s -> t)) (spawn m s)"),
        ("an event", "(machine m (state s) (state t) (event e [@]) (on e s -> t)) (spawn m s)"),
        ("a timeout", "(machine m (state s) (state t) (ontime [@] s -> t)) (spawn m s)"),
        ("a variable", "(machine m (var x := [@]) (state s)) (spawn m s)"),
        ("a global", "(var x := [@])"),
        ("onentry", "(machine m (state s (onentry [@]))) (spawn m s)"),
        ("running", "(machine m (state s (running [@]))) (spawn m s)"),
        ("onexit", "(machine m (state s (onexit [@])) (state t) (ontime 300 s -> t)) (spawn m s)"),
    ] {
        costs_itself_alone(what, &form.replace('@', "while true do end"), says);
    }
    refused(
        "a bridge",
        "(bridge robot sim [while true do end]) (machine m (state s)) (spawn m s)",
        "bad.lrp:1:20: error: ",
    );
}

fn running(block: &str) -> String {
    format!("(machine m (state s (running [{block}]))) (spawn m s)")
}

#[test]
fn blocks_that_take_everything() {
    for (limit, what, block, says) in [
        ("20000", "10 GB", "local s = ('x'):rep(1e10)", "resulting string too large"),
        (
            "20000",
            "doubling",
            "local s = 'x' while true do s = s .. s end",
            "stopped, as more than 64 MiB of memory were in use",
        ),
        ("20000", "a recursion", "local function f(n) return 1 + f(n + 1) end f(1)", "stack overflow"),
        ("250", "a tail call", "local function f(n) return f(n + 1) end f(1)", "stopped, as it ran"),
        ("20000", "a recursion through C", "local function f() return ('x'):gsub('x', f) end f()", "stack overflow"),
        ("20000", "coroutines", "local function f() return coroutine.wrap(f)() end f()", "stack overflow"),
        ("250", "a pattern", "('a'):rep(40):find(('a*'):rep(40)..'b')", "stopped, as it ran"),
    ] {
        let err = beside_within(limit, what, &running(block), 1, says);
        assert!(err.lines().count() == 1 && err.len() < 300, "{what}: {}", cut(&err));
    }
}

/// To stop it all its calls must be gone through: it may take long, but it ends.
#[test]
fn a_recursion_is_stopped_where_it_is_deepest() {
    let err = beside_within(
        "1",
        "a recursion",
        &running("local function f(n) return 1 + f(n + 1) end f(1)"),
        1,
        "stopped, as it ran",
    );
    assert!(err.lines().count() <= 2, "{}", cut(&err));
}

#[test]
fn machines_that_spawn_themselves() {
    let itself = "(machine m (state s (onentry (spawn m s)))) (spawn m s)";
    let each_other =
        "(machine a (state s (onentry (spawn b s)))) (machine b (state s (onentry (spawn a s)))) (spawn a s)";
    for (what, forms) in [("itself", itself), ("each other", each_other)] {
        let err = beside(what, forms, 1, "is running already when it is spawned here");
        let goes_on = "is running already; it goes on undisturbed";
        assert!(err.lines().count() == 2 && err.contains(goes_on), "{what}: {}", cut(&err));
    }
}

#[test]
fn a_flood_of_words() {
    let err = beside_within(
        "20000",
        "100,000 lines a step",
        &running("for i = 1, 100000 do log.info('line ' .. i) end"),
        0,
        "info: line 1",
    );
    assert!(err.lines().count() < 50_000, "{} lines", err.lines().count());
    let err = beside("a long line", &running("log.info(('x'):rep(1000000))"), 0, "info: xxx");
    assert!(err.lines().all(|line| line.len() < 20_000), "{}", err.len());
    let err = beside(
        "codes for the terminal",
        &running(r"log.info('\27[2J\27]0;mine\7')"),
        0,
        r"info: \u{1b}[2J\u{1b}]0;mine\u{7}",
    );
    assert!(!err.contains('\u{1b}'));
}

#[test]
fn a_thousand_machines() {
    let machine =
        |i| format!("(machine m{i} (state a) (state b) (ontime 100 a -> b) (ontime 100 b -> a)) (spawn m{i} a)\n");
    let text: String = (0..1000).map(machine).collect();
    let folder = given(text);
    for (command, said) in each(folder.path(), NAME) {
        assert_eq!((said.code, &*said.err), (Some(0), ""), "{command}");
    }
}

#[test]
fn endless_names() {
    let n = "n".repeat(10_000);
    let text = "(machine m@ (var v@ := [0]) (state s@ (running [v@ = v@ + 1])) (state t@) (event e@ [v@ > 3]) (on e@ s@ -> t@ x@)) (spawn m@ s@)";
    let folder = given(text.replace('@', &n));
    for (command, said) in each(folder.path(), NAME) {
        assert_eq!((said.code, &*said.err), (Some(0), ""), "{command}");
    }
    let said = lrp(folder.path(), &["graph", "--width", "60", NAME]);
    assert!(said.code == Some(0) && said.out.lines().all(|line| line.chars().count() <= 60), "{}", cut(&said.out));
}

#[test]
fn bridges_that_cannot_be() {
    let bridge = |form: &str| format!("(bridge robot {form})\n");
    fs::metadata("/dev/zero").unwrap();
    for (form, says) in [
        ("sjm", "error: there is no bridge of kind `sjm`; did you mean `sim`?"),
        ("nao6000", "error: there is no bridge of kind `nao6000`; there is: "),
        ("sim [world = 'none.world']", "error: the world can't be read: none.world: no such file"),
        ("sim [world = '.']", "error: the world can't be read: .: this is a folder"),
        ("sim [world = '/dev/zero']", "error: the world can't be read: /dev/zero: this is a pipe or a device"),
        ("sim [world = 'bad.lrp']", "bad.lrp:1:1: error: unknown word"),
        ("sim [wordl = 'x']", "error: the simulator has no setting `wordl`; did you mean `world`?"),
    ] {
        beside(form, &bridge(form), 1, says);
    }
}

#[test]
fn tests_that_misbehave() {
    let folder = tempfile::tempdir().unwrap();
    for (name, text, says) in [
        ("syntax", "test('x', function(t) end", "syntax_test.lua:"),
        ("binary", "\u{1b}Lua", "binary_test.lua"),
        ("missing", "test('x', function(t) t:load('none.lrp') end)", "none.lrp: no such file"),
        ("error", "test('x', function(t) error('no') end)", "no"),
        ("recursion", "test('x', function(t) local function f() return 1 + f() end f() end)", "stack overflow"),
        ("memory", "test('x', function(t) local s = 'x' while true do s = s .. s end end)", "memory"),
    ] {
        let name = format!("{name}_test.lua");
        fs::write(folder.path().join(&name), text).unwrap();
        let said = lrp(folder.path(), &["test", &name]);
        sound(&name, &said);
        assert_eq!(said.code, Some(1), "{name}: {said:?}");
        assert!(said.out.contains(says) && said.out.len() < 3000, "{name}: {}", cut(&said.out));
    }
}
