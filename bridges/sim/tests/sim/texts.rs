//! World texts: what they mean, and what is said about broken ones.

use lrp_sim::{Fault, World};
use proptest::prelude::*;

const DOC: &str = include_str!("../../../../docs/sim.md");
const BASICS: &str = "size 4 2\nstart 1 1 heading 0\n";

fn faults(text: &str) -> Vec<Fault> {
    World::parse(text).expect_err("the text should have faults")
}

/// The faults of a text as one line each.
fn said(text: &str) -> Vec<String> {
    faults(text).iter().map(Fault::to_string).collect()
}

/// The faults of statements in a world that is well otherwise; their first line is line 3.
fn said_of(statements: &str) -> Vec<String> {
    said(&format!("{BASICS}{statements}"))
}

#[test]
fn the_documented_example_is_a_world() {
    let example = DOC.split("```world\n").nth(1).unwrap().split("```").next().unwrap();
    let world = World::parse(example).unwrap();
    assert_eq!((world.size().width, world.size().height), (4.0, 2.0));
    assert_eq!(world.walls().len(), 4 + 1 + 4);
    let end = world.lines()[0].points.last().unwrap();
    assert_eq!((end.x, end.y), (3.5, 0.9));
}

#[test]
fn every_statement_is_documented_as_its_help_has_it() {
    for word in
        ["size", "start", "ground", "line", "from", "straight", "left", "right", "to", "wall", "box", "light", "range"]
    {
        let help = faults(&format!("{word} ?"))[0].help.clone().unwrap_or_default();
        let usage = help.trim_start_matches("write ").to_owned();
        assert!(usage.starts_with(&format!("`{word} ")), "{word}: {help}");
        assert!(DOC.contains(&format!("| {usage} |")), "{usage} is not in docs/sim.md");
    }
}

#[test]
fn names_of_numbers_may_be_left_out_or_reordered() {
    let lines = ["line width 0.1 brightness 30", "line 0.1 30", "line brightness 30 width 0.1"].map(|line| {
        World::parse(&format!("{BASICS}{line}\nfrom 1 1 heading 90\nleft 90 radius 0.4")).unwrap().lines()[0].clone()
    });
    assert_eq!(lines[0], lines[1]);
    assert_eq!(lines[0], lines[2]);
    let brighter = World::parse(&format!("{BASICS}line brightness 99\nfrom 1 1\nstraight 1")).unwrap();
    assert_eq!((brighter.lines()[0].width, brighter.lines()[0].brightness), (0.06, 99.0));
}

#[test]
fn a_line_is_drawn_like_a_turtle() {
    let world = World::parse("size 4 4\nstart 1 1\nline\nfrom 1 1 heading 0\nstraight 1\nleft 90 radius 0.5\nright 90 radius 0.5\nstraight 0.5").unwrap();
    let end = world.lines()[0].points.last().unwrap();
    assert!((end.x - 3.5).abs() < 1e-9 && (end.y - 2.0).abs() < 1e-9, "{end:?}");
    assert!((world.line_length() - (1.5 + 0.5 * std::f64::consts::PI)).abs() < 0.001);
}

#[test]
fn order_indentation_comments_and_line_ends_don_t_matter() {
    let tidy = World::parse("size 4 2\nstart 1 1 heading 0\nwall 2 0 2 1\n").unwrap();
    let wild = World::parse("\u{feff}# a world\r\n\twall 2 0   2 1 # here\r  start 1 1\r\n\r\nsize 4 2").unwrap();
    assert_eq!(tidy, wild);
}

#[test]
fn an_empty_text_is_explained() {
    for text in ["", "\n\n", "# nothing yet\n"] {
        let fault = &faults(text)[0];
        assert_eq!((fault.line, fault.column, fault.message.as_str()), (1, 1, "the world is empty"));
        assert!(fault.help.as_ref().unwrap().contains("size"));
    }
}

#[test]
fn what_every_world_needs_is_asked_for() {
    let size = "1:1: the world has no size (add a line `size WIDTH HEIGHT`, in metres)";
    let start = "1:1: the robot has no place to start (add a line `start X Y heading DEGREES`)";
    assert_eq!(said("wall 0 0 1 1"), [size, start]);
    assert_eq!(said("size 4 2"), [start]);
}

#[test]
fn a_misspelt_word_gets_a_suggestion() {
    assert_eq!(said_of("wal 1 1 2 2"), ["3:1: unknown word `wal` (did you mean `wall`?)"]);
    assert_eq!(said_of("  Straigt 1"), ["3:3: unknown word `Straigt` (did you mean `straight`?)"]);
    assert_eq!(said_of("line\nform 1 1\nstraight 1"), ["4:1: unknown word `form` (did you mean `from`?)"]);
    assert_eq!(said_of("lin\nstraight 1"), ["3:1: unknown word `lin` (did you mean `line`?)"]);
    assert_eq!(
        said_of("line\nfrom 1 1\nleft 90 radus 0.4"),
        ["5:9: `radus` is no number, and `radius` needs one (did you mean `radius`?)"]
    );
    assert!(said_of("elephant")[0].contains("a line begins with one of: size, ground"));
}

#[test]
fn numbers_are_checked_where_they_stand() {
    assert_eq!(said_of("wall 1 1 2"), ["3:1: `wall` lacks its `y2` (write `wall X1 Y1 X2 Y2`)"]);
    assert_eq!(said_of("wall 1 1 2 1.5 7"), ["3:16: `7` is one too many for `wall` (write `wall X1 Y1 X2 Y2`)"]);
    assert_eq!(
        said_of("ground dark"),
        ["3:8: `dark` is no number, and `brightness` needs one (write `ground BRIGHTNESS`)"]
    );
    assert_eq!(said_of("ground nan"), ["3:8: `brightness` can't be nan (from 0 to 255)"]);
    assert_eq!(said_of("ground inf"), ["3:8: `brightness` can't be inf (from 0 to 255)"]);
    assert_eq!(
        said_of("line width"),
        ["3:6: a number must follow `width` (write `line width METRES brightness BRIGHTNESS`)"]
    );
    assert_eq!(
        said_of("line 0.1 width 0.1"),
        ["3:10: `width` is given twice (write `line width METRES brightness BRIGHTNESS`)"]
    );
    assert_eq!(said("size 10000 10000\nstart 1 1"), ["1:6: `width` can't be 10000 (from 0.2 to 100)"]);
}

#[test]
fn what_lies_off_the_floor_is_named() {
    assert_eq!(
        said_of("wall 1 1 5 3"),
        ["3:10: x = 5 is off the floor (x goes from 0 to 4)", "3:12: y = 3 is off the floor (y goes from 0 to 2)"]
    );
    assert!(said_of("box 3.5 1 1 0.5")[0].starts_with("3:1: the box reaches to 4.5 1.5, off the floor"));
    assert_eq!(
        said_of("line\nfrom 3 1\nstraight 2\nstraight 1"),
        ["5:1: the line leaves the floor here, at 5.00 1.00 (make the floor larger, or the line shorter)"]
    );
}

#[test]
fn pieces_without_a_line_are_explained() {
    assert!(said_of("straight 1")[0].starts_with("3:1: nothing to draw `straight` with (begin with `line"));
    assert!(said_of("line\nstraight 1\nleft 90 0.1")[0].contains("say where the line begins"));
    assert_eq!(said_of("line\nstraight 1\nleft 90 0.1").len(), 1);
    assert!(said_of("from 1 1")[0].contains("must stand after a `line`"));
    assert!(said_of("line\nfrom 1 1\nfrom 2 1\nstraight 1")[0].starts_with("5:1: this line has a `from` already"));
    assert!(said_of("line\nfrom 1 1")[0].starts_with("3:1: the line has no pieces"));
}

#[test]
fn a_start_in_a_wall_is_refused() {
    assert!(said("size 4 2\nstart 0.05 1")[0].starts_with("2:1: the robot would start in a wall"));
    assert!(said_of("box 0.5 0.5 1 1")[0].starts_with("2:1: the robot would start in a wall"));
}

#[test]
fn what_stands_once_stands_once() {
    assert_eq!(said_of("start 2 1"), ["3:1: `start` was given already, on line 2 (keep one of them)"]);
}

#[test]
fn all_faults_come_at_once_in_order() {
    let lines: Vec<usize> =
        faults("size 4 2\nwal 1\nstart 9 1\nground 300\nwall 1 1 1 1").iter().map(|fault| fault.line).collect();
    assert_eq!(lines, [2, 3, 4, 5]);
}

#[test]
fn too_much_of_anything_is_refused_politely() {
    assert!(said_of(&"wall 3 0 3 1\n".repeat(100_000))[0].contains("too long"));
    assert!(said_of(&"wall 3 0 3 1\n".repeat(2_000))[0].contains("too many walls"));
    assert!(said_of(&format!("line\nfrom 2 1\n{}", "left 360 0.5\n".repeat(2_000)))[0].contains("too many pieces"));
    assert_eq!(faults(&"oops\n".repeat(5_000)).len(), 50);
}

proptest! {
    #[test]
    fn no_text_is_too_odd(text in any::<String>()) {
        let _ = World::parse(&text);
    }

    #[test]
    fn no_statements_are_too_odd(
        lines in prop::collection::vec(
            ("(size|start|ground|line|from|straight|to|left|right|wall|box|light|range|#|)", prop::collection::vec(
                prop_oneof![(0..40_i32).prop_map(|n| (f64::from(n) / 10.0).to_string()), any::<f64>().prop_map(|n| n.to_string()), "[a-zß# ]{0,6}"], 0..5)),
            0..20),
        basics in prop_oneof![Just(""), Just(BASICS)],
    ) {
        let text: String = lines.iter().map(|(word, rest)| format!("{word} {}\n", rest.join(" "))).collect();
        match World::parse(&format!("{basics}{text}")) {
            Ok(world) => prop_assert!(world.line_length().is_finite() && world.walls().len() >= 4),
            Err(faults) => {
                prop_assert!(!faults.is_empty() && faults.iter().all(|fault| fault.line >= 1 && fault.column >= 1));
            }
        }
    }
}
