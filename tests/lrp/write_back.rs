//! A tuned value written back: which literal changes in a text, and how the file is replaced.

use std::fs::{self, Permissions};
use std::os::unix::fs::{MetadataExt, PermissionsExt, symlink};
use std::path::Path;
use std::time::Duration;

use lrp::model::initial::{Unwritable, initial, with_initial, with_initials};
use lrp::model::literal::written;
use lrp::session::compile::Compiler;
use lrp::session::write_back::{NotWritten, Rewrite};
use lrp::syntax::Source;
use proptest::prelude::*;
use serde_json::{Value, json};

use crate::shelf::Shelf;
use crate::stage::{Event, Stage};
use crate::story::program;

/// What becomes of the initialiser of a variable, as it stands between its brackets.
fn rewritten(code: &str, value: Value) -> Result<String, Unwritable> {
    let text = format!("(var other := [1])\r\n(var x := [{code}]) ; and so on\n(machine m (state s))\n(spawn m s)\n");
    let program = program(&text);
    let var = program.var("x").expect("a variable");
    let new = with_initial(&program, &text, var, &value)?;
    let start = text.find("x := [").expect("the variable") + "x := [".len();
    let (before, after) = (&text[..start], &text[start + code.len()..]);
    let inside = new.strip_prefix(before).and_then(|new| new.strip_suffix(after));
    let inside = inside.unwrap_or_else(|| panic!("more than the literal changed: {new}")).to_owned();
    let again = crate::story::program(&new);
    assert_eq!(initial(&again, again.var("x").expect("the variable")), Some(value));
    Ok(inside)
}

fn becomes(code: &str, value: Value, inside: &str) {
    assert_eq!(rewritten(code, value), Ok(inside.into()), "{code}");
}

#[test]
fn only_the_literal_changes() {
    becomes("128", json!(148), "148");
    becomes("128", json!(0.2), "0.2");
    becomes(" 0.25 -- m/s\n", json!(0.3), " 0.3 -- m/s\n");
    becomes("return 5;", json!(-7), "return -7;");
    becomes("-0.2", json!(0.4), "0.4");
    becomes("- 3", json!(4), "4");
    becomes("0x10", json!(17), "17");
    becomes("100", json!(100.0), "100.0");
    becomes("true", json!(false), "false");
    becomes("nil", json!(3), "3");
    becomes("'left'", json!("it's"), r"'it\'s'");
    becomes(r#""left""#, json!("a\\b\n"), r#""a\\b\n""#);
    becomes("'a'", json!("\0\u{80}"), r"'\000\u{80}'");
    becomes("[[long]]", json!("short"), r#""short""#);
    becomes("return'left'", json!(5), "return 5");
    becomes("1", json!(1e300), "1e+300");
    becomes("1", json!(0.1 + 0.2), "0.30000000000000004");
}

#[test]
fn in_a_table_only_the_entries_that_differ_change() {
    becomes(
        "{ p = 0.5, -- proportional\n  i = 0 }",
        json!({"p": 0.6, "i": 0}),
        "{ p = 0.6, -- proportional\n  i = 0 }",
    );
    becomes("{1, 2; 3}", json!([1, 20, 30]), "{1, 20; 30}");
    becomes("{['a b'] = {x = 1}, [7] = 2}", json!({"a b": {"x": -1}, "7": 2}), "{['a b'] = {x = -1}, [7] = 2}");
    becomes("{a = 1}", json!({"a": [true, "x"]}), r#"{a = {true, "x"}}"#);
}

#[test]
fn what_is_no_literal_is_left_alone() {
    let not = |code: &str| Err(Unwritable::NotLiteral(code.into()));
    for code in ["other", "1 + 1", "math.pi", "-other", "{other}", "{f()}", "local a = 1 return a", "not true", "#'a'"]
    {
        assert_eq!(rewritten(code, json!(2)), not(code));
    }
    assert_eq!(rewritten("other + other + other + other + other", json!(2)), not("other + other + other + other …"));
}

#[test]
fn what_has_no_literal_is_not_written() {
    for value in [json!({"lua": "function"}), json!("inf"), json!([1, {"cut": 3}]), json!({"a": 1, "cut": 3})] {
        assert_eq!(rewritten("1", value), Err(Unwritable::NoText));
    }
    assert_eq!(rewritten("1", json!(i64::MIN)), Err(Unwritable::NoText));
    assert_eq!(rewritten("{1}", json!([1, 2])), Err(Unwritable::OtherEntries));
    assert_eq!(rewritten("{a = 1}", json!({"b": 1})), Err(Unwritable::OtherEntries));
    assert_eq!(rewritten("{a = 1}", json!(3)), Err(Unwritable::OtherEntries));
    assert_eq!(rewritten("0x80", json!(128)), Err(Unwritable::Same));
}

#[test]
fn strings_are_read_as_lua_reads_them() {
    let same = |code: &str, text: &str| assert_eq!(rewritten(code, json!(text)), Err(Unwritable::Same), "{code}");
    same(r#""a\tb\65\x41\u{41}\z   c""#, "a\tbAAAc");
    same("[==[\nx]]y]==]", "x]]y");
    same(r"'\'\\'", "'\\");
}

#[test]
fn a_text_that_reads_otherwise_is_refused() {
    let text = "(var x := [1])\n(machine m (state s))\n(spawn m s)\n";
    let program = program(text);
    let var = program.var("x").expect("a variable");
    for changed in [text.replace("[1]", "[2]"), text.replace("(var", " (var"), "(var x".into()] {
        assert_eq!(with_initial(&program, &changed, var, &json!(5)), Err(Unwritable::Changed));
    }
}

/// As records have values: an empty table is an object, and what is nil isn't in one.
fn any_value() -> impl Strategy<Value = Value> {
    let number = proptest::num::f64::NORMAL.prop_map(|number| json!(number));
    let leaf = prop_oneof![any::<bool>().prop_map(Value::from), any::<i64>().prop_map(Value::from), number, text()];
    leaf.prop_recursive(3, 12, 3, |inner| {
        let array = prop::collection::vec(inner.clone(), 1..3).prop_map(Value::from);
        let object = prop::collection::btree_map("[a-z ]{1,4}", inner, 0..3);
        prop_oneof![array, object.prop_map(|fields| Value::Object(fields.into_iter().collect()))]
    })
}

fn text() -> impl Strategy<Value = Value> {
    prop_oneof!["[ -~\n\r\t\0]{0,8}", "(?s).{0,8}"].prop_map(Value::from)
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(128))]

    #[test]
    fn whatever_is_written_back_is_what_lua_reads(old in any_value(), new in any_value()) {
        let Some(code) = written(&old, "") else { return Ok(()) };
        match rewritten(&code, new.clone()) {
            Ok(code) => {
                let mut stage = Stage::new(1, Duration::from_secs(1), Vec::new());
                stage.event(Event::Save(format!("(var x := [{code}])\n(machine m (state s))\n(spawn m s)\n")));
                prop_assert_eq!(stage.engine().value("x"), Some(new), "{}", code);
            }
            Err(Unwritable::Same) => prop_assert_eq!(old, new),
            Err(Unwritable::NoText) => prop_assert_eq!(written(&new, ""), None),
            Err(why) => prop_assert!(why == Unwritable::OtherEntries && (old.is_object() || old.is_array()), "{}", why),
        }
    }
}

#[test]
fn each_file_has_its_own_variables() {
    let arm = "(export arm)\n(var reach := [3])\n(machine arm (var speed := [1]) (state s))\n";
    let files = Shelf::of(vec![("arm.lrp".into(), arm.into())]);
    let main = "(import \"arm.lrp\")\n(var x := [100]) (var y := [2]) (var z := [x])\n(spawn arm s)\n";
    let compiled = Compiler::new(Vec::new()).with_files(files).compile(Source::new("main.lrp", main));
    let program = compiled.unwrap_or_else(|rejected| panic!("{:?}", rejected.diagnostics));
    let var = |path: &str| program.var(path).expect("a variable");
    let values = [("x", json!(5)), ("arm/speed", json!(2.5)), ("z", json!(1)), ("y", json!(1000)), ("reach", json!(3))];
    let (texts, refused) = with_initials(&program, &values.map(|(path, value)| (var(path), value)));
    let texts: Vec<(&str, String)> =
        texts.into_iter().map(|(file, text)| (&*program.sources[usize::from(file.0)].name, text)).collect();
    let main = main.replace("100", "5").replace("[2]", "[1000]");
    assert_eq!(texts, [("main.lrp", main), ("arm.lrp", arm.replace("[1]", "[2.5]"))]);
    let why = [(var("reach"), Unwritable::Same), (var("z"), Unwritable::NotLiteral("x".into()))];
    assert_eq!(refused, why);
}

fn rewrite(path: &Path, from: &str) -> Rewrite {
    Rewrite { file: path.display().to_string().into(), from: from.into(), to: "new and longer".into() }
}

fn names(folder: &Path) -> Vec<String> {
    let mut names: Vec<String> =
        fs::read_dir(folder).unwrap().map(|entry| entry.unwrap().file_name().into_string().unwrap()).collect();
    names.sort();
    names
}

#[test]
fn a_file_is_replaced_with_its_permissions() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("a.lrp");
    fs::write(&path, "old").unwrap();
    fs::set_permissions(&path, Permissions::from_mode(0o640)).unwrap();
    let before = fs::metadata(&path).unwrap().ino();
    rewrite(&path, "old").write().unwrap();
    assert_eq!(fs::read_to_string(&path).unwrap(), "new and longer");
    let after = fs::metadata(&path).unwrap();
    assert_eq!(after.mode() & 0o777, 0o640);
    assert_ne!(after.ino(), before, "by a rename");
    assert_eq!(names(folder.path()), ["a.lrp"], "nothing is left beside it");
}

#[test]
fn a_file_that_has_changed_is_left_alone() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("a.lrp");
    fs::write(&path, "edited").unwrap();
    assert!(matches!(rewrite(&path, "old").write(), Err(NotWritten::Changed { .. })));
    assert_eq!(fs::read_to_string(&path).unwrap(), "edited");
    fs::remove_file(&path).unwrap();
    let error = rewrite(&path, "old").write().unwrap_err().to_string();
    assert!(error.contains("a.lrp") && error.contains("No such file"), "{error}");
    assert_eq!(names(folder.path()), [""; 0]);
}

#[test]
fn a_link_stays_one() {
    let folder = tempfile::tempdir().unwrap();
    fs::create_dir(folder.path().join("real")).unwrap();
    let (real, link) = (folder.path().join("real/a.lrp"), folder.path().join("link.lrp"));
    fs::write(&real, "old").unwrap();
    symlink("real/a.lrp", &link).unwrap();
    rewrite(&link, "old").write().unwrap();
    assert!(fs::symlink_metadata(&link).unwrap().is_symlink());
    assert_eq!(fs::read_to_string(&real).unwrap(), "new and longer");
    assert_eq!(names(&folder.path().join("real")), ["a.lrp"]);
}

#[test]
fn a_file_with_two_names_keeps_both() {
    let folder = tempfile::tempdir().unwrap();
    let (one, other) = (folder.path().join("a.lrp"), folder.path().join("b.lrp"));
    fs::write(&one, "old but much longer than the new one").unwrap();
    fs::hard_link(&one, &other).unwrap();
    rewrite(&one, "old but much longer than the new one").write().unwrap();
    assert_eq!(fs::read_to_string(&other).unwrap(), "new and longer");
    assert_eq!(names(folder.path()), ["a.lrp", "b.lrp"]);
}
