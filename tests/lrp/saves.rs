//! Saves as no careful person makes them: whole programs swapped, halves of forms, empty files, a thousand at once. Nothing
//! is lost but what they remove.

use std::time::Duration;

use lrp::runtime::{Command, OnEdit, What};
use serde_json::json;

use crate::stage::{Event, Stage, lines};

/// Runs on through whatever is done to the rest.
const KEPT: &str = "(var tuned := [1])
(machine kept
  (var n := [0])
  (state waiting (running [n = n + 1]))
  (state done)
  (ontime 1000 waiting -> done)
  (ontime 100000 done -> waiting))
(spawn kept waiting)\n";

fn playing(text: &str, mode: OnEdit) -> Stage {
    let mut stage = Stage::new(1, Duration::from_secs(5), Vec::new());
    stage.command(Command::OnEdit { mode });
    save(&mut stage, text);
    stage.command(Command::Set { var: "tuned".into(), value: "42".into() });
    for _ in 0..5 {
        stage.tick();
    }
    stage
}

fn save(stage: &mut Stage, text: &str) {
    stage.event(Event::Save(text.into()));
}

/// Half a second after the start, and a second after it, whatever was saved in between.
fn goes_on(stage: &mut Stage) {
    let engine = stage.engine();
    assert!(engine.active().contains(&"kept/waiting".to_string()), "{:?}", engine.active());
    assert_eq!(engine.entered("kept").map(|entered| entered.ms()), Some(0.0));
    assert_eq!((engine.value("kept/n"), engine.value("tuned")), (Some(json!(6)), Some(json!(42))));
    assert_eq!(engine.visits("kept/waiting"), Some(1));
    for _ in 0..5 {
        stage.tick();
    }
    assert!(stage.engine().active().contains(&"kept/done".to_string()), "its timeout went on");
    assert_eq!(stage.engine().value("kept/n"), Some(json!(10)));
}

fn count(stage: &Stage, is: impl Fn(&What) -> bool) -> usize {
    stage.records.iter().filter(|record| is(&record.what)).count()
}

fn rejects(stage: &Stage) -> usize {
    count(stage, |what| matches!(what, What::Reject { .. }))
}

fn loads(stage: &Stage) -> usize {
    count(stage, |what| matches!(what, What::Load(_)))
}

fn restarts(stage: &Stage) -> usize {
    count(stage, |what| matches!(what, What::Restart { .. }))
}

#[test]
fn two_programs_swapped_leave_alone_what_they_share() {
    let with = |name: &str, n: u32| {
        format!(
            "{KEPT}(machine {name} (var v := [{n}]) (state s (running [v = v + 1]) (onexit [tuned = 0])))\n(spawn {name} s)"
        )
    };
    let (one, other) = (with("one", 10), with("other", 20));
    let mut stage = playing(&one, OnEdit::Keep);
    for _ in 0..200 {
        save(&mut stage, &other);
        assert_eq!(stage.engine().active(), ["kept/waiting", "other/s"]);
        assert_eq!(stage.engine().value("other/v"), Some(json!(21)));
        save(&mut stage, &one);
        assert_eq!(stage.engine().value("other/v"), None);
    }
    goes_on(&mut stage);
    assert_eq!((restarts(&stage), loads(&stage)), (0, 401));
}

#[test]
fn two_programs_without_anything_in_common_begin_anew_each_time() {
    // Not alike, or the one would be the other renamed.
    let programs = [("a", 1), ("b", 2)].map(|(name, n)| {
        let states = format!("(state s (running [v = v + 1])) (state t (onentry [g_{name} = 7])) (ontime 100 s -> t)");
        let text = format!("(var g_{name} := [{n}])\n(machine {name} (var v := [{n}]) {states})\n(spawn {name} s)");
        (name, n, text)
    });
    for mode in [OnEdit::Restart, OnEdit::Keep] {
        let mut stage = Stage::new(1, Duration::from_secs(5), Vec::new());
        stage.command(Command::OnEdit { mode });
        for (name, n, text) in programs.iter().cycle().take(200) {
            save(&mut stage, text);
            let engine = stage.engine();
            assert_eq!(engine.active(), [format!("{name}/s")]);
            assert_eq!(engine.entered(name), Some(engine.now()));
            assert_eq!(engine.visits(&format!("{name}/s")), Some(1));
            assert_eq!(engine.values(), [(format!("g_{name}"), json!(n)), (format!("{name}/v"), json!(n + 1))]);
            stage.tick();
        }
        assert_eq!(restarts(&stage), if mode == OnEdit::Restart { 199 } else { 0 });
        assert_eq!(stage.engine().faults().count(), 0);
    }
}

#[test]
fn half_a_form_every_other_time() {
    let mut stage = playing(KEPT, OnEdit::Restart);
    for n in 0..200 {
        let whole = format!("{KEPT}(machine more (state s{n}))\n");
        let half: String = whole.chars().take(whole.len() - 2 - n % 25).collect();
        save(&mut stage, &half);
        assert_eq!(rejects(&stage), n + 1, "{half}");
        save(&mut stage, &whole);
        assert_eq!(stage.view.errors(), 0);
        assert!(stage.engine().program().state(&format!("more/s{n}")).is_some());
    }
    goes_on(&mut stage);
    assert_eq!((restarts(&stage), loads(&stage)), (0, 201));
}

#[test]
fn an_empty_text_in_between() {
    let mut stage = playing(KEPT, OnEdit::Restart);
    for text in ["", "\n\n", "; gone\n", KEPT].repeat(50) {
        save(&mut stage, text);
        assert_eq!(stage.engine().active(), ["kept/waiting"]);
    }
    goes_on(&mut stage);
    assert_eq!((rejects(&stage), restarts(&stage), loads(&stage)), (150, 0, 51));
}

#[test]
fn a_thousand_saves_between_two_steps() {
    for mode in [OnEdit::Restart, OnEdit::Keep] {
        let mut stage = playing(KEPT, mode);
        for n in 0..1000 {
            save(
                &mut stage,
                &format!("{KEPT}(var v := [{n}])\n(machine more (var w := [v]) (state s (running [w = {n}])))\n"),
            );
        }
        assert_eq!(stage.engine().value("v"), Some(json!(999)));
        goes_on(&mut stage);
        assert_eq!((restarts(&stage), loads(&stage)), (0, 1001), "{}", lines(&stage.records[..20]));
    }
}
