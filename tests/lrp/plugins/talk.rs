//! What programs and bridges say to each other.

use lrp::runtime::record::{Health, What};
use lrp::runtime::{Command, Record};
use serde_json::json;

use super::{Run, examples, plugins};

fn run(text: &str) -> Run {
    Run::start(text, ".".into(), plugins(vec![examples()]))
}

fn kinds(records: &[Record]) -> Vec<String> {
    let kind = |record: &Record| match &record.what {
        What::Input { name, value, .. } => Some(format!("input {name} {value}")),
        What::Output { name, value, .. } => Some(format!("output {name} {value}")),
        What::Call { name, id, arguments, .. } => Some(format!("call {name} #{id} {arguments}")),
        What::Cancel { id, .. } => Some(format!("cancel #{id}")),
        What::Reply { name, id, done: false, value, .. } => Some(format!("feedback {name} #{id} {value}")),
        What::Reply { name, id, error: Some(error), .. } => Some(format!("failed {name} #{id} {error}")),
        What::Reply { name, id, value, .. } => Some(format!("reply {name} #{id} {value}")),
        _ => None,
    };
    records.iter().filter_map(kind).collect()
}

#[test]
fn what_is_said_is_heard_a_step_later() {
    let mut run = run("(bridge robot echo)
        (var heard := [\"nothing\"])
        (machine m
          (state s (onentry [robot.say{ text = \"hello\" }]))
          (state t (onentry [heard = robot.heard.text]))
          (on [robot.heard and robot.heard.text ~= \"\"] s -> t))
        (spawn m s)");
    run.step_until("what was said", |run| run.value("heard") == Some(json!("hello")));
    let told = kinds(&run.records);
    assert!(told.contains(&r#"output say {"loud":false,"text":"hello"}"#.to_string()), "{told:?}");
    assert!(told.contains(&r#"input heard {"loud":false,"text":"hello"}"#.to_string()), "{told:?}");
}

#[test]
fn what_was_said_before_the_program_began_is_there_at_once() {
    let folder = plugins(vec![examples()]);
    let text = "(bridge robot echo) (var first := [robot.heard.text .. \"!\"]) (machine m (state s)) (spawn m s)";
    let mut run = Run::prepare(text, ".".into(), folder);
    run.until("it to be there", |run| run.driver.is_ready());
    // It says so when it is halted, which it is first thing.
    std::thread::park_timeout(std::time::Duration::from_millis(200));
    run.save(text);
    assert_eq!(run.value("first"), Some(json!("!")));
}

#[test]
fn a_call_is_a_value_that_is_done_later() {
    let mut run = run("(bridge robot echo)
        (var call := [])
        (machine m
          (state s (onentry [call = robot.repeat_it({ 1, \"two\" })]))
          (state t)
          (on [call.done and call.ok] s -> t))
        (spawn m s)");
    run.step_until("its end", |run| run.driver.engine().active() == ["m/t"]);
    assert_eq!(run.value("call").map(|call| call["value"].clone()), Some(json!([1, "two"])));
    assert_eq!(run.value("call").map(|call| call["feedback"].clone()), Some(json!("listening")));
    let told = kinds(&run.records);
    assert!(told.contains(&r#"call repeat_it #1 [[1,"two"]]"#.to_string()), "{told:?}");
    assert!(told.contains(&r#"reply repeat_it #1 [1,"two"]"#.to_string()), "{told:?}");
}

#[test]
fn a_device_is_a_value_with_functions() {
    let mut run = run("(bridge robot echo)
        (var horn := [robot.horn])
        (var call := [])
        (machine m
          (state s (onentry [call = horn:honk(2)]))
          (state t (onentry [robot.say{ text = call.value }]))
          (state u (onentry [log.info(horn:heard())]))
          (on [call.done] s -> t)
          (on [horn:heard() == \"honk honk\"] t -> u))
        (spawn m s)");
    run.step_until("both", |run| run.driver.engine().active() == ["m/u"]);
    assert_eq!(run.value("horn"), Some(json!({ "lua": "robot.horn" })));
    assert!(run.logs().contains(&"honk honk".to_string()));
}

#[test]
fn a_call_that_is_cancelled_fails() {
    let mut run = run("(bridge robot echo [pause = 300])
        (var call := [])
        (machine m
          (state s (onentry [call = robot.repeat_it(1)]))
          (state t (onentry [call:cancel()]))
          (on [call.feedback ~= nil] s -> t))
        (spawn m s)");
    run.step_until("its end", |run| run.value("call").is_some_and(|call| call["done"] == json!(true)));
    assert_eq!(run.value("call").map(|call| call["error"].clone()), Some(json!("cancelled")));
}

#[test]
fn what_it_does_not_offer_is_found_before_it_runs() {
    let mut run = run("(bridge robot echo)
        (machine m (state s (running
          [robot.sya{}; robot.say{ txt = 1 }; robot.horn:hoot(); robot.heard.tetx = 1; robot.repeat_it(1, 2)])))
        (spawn m s)");
    run.step();
    let messages: Vec<String> = run
        .records
        .iter()
        .filter_map(|record| if let What::Error(fault) = &record.what { Some(fault.message.clone()) } else { None })
        .collect();
    for says in [
        "`robot` has no input or output `sya`",
        "`robot.say` has no field `txt`",
        "`robot.horn` has no function `hoot`",
    ] {
        assert!(messages.iter().any(|message| message.contains(says)), "{says}: {messages:#?}");
    }
}

#[test]
fn an_edited_form_does_not_reconnect() {
    let program = |form: &str| {
        format!(
            "(bridge robot echo {form})
             (var call := [])
             (machine m (state s (onentry [call = robot.repeat_it(7)]))) (spawn m s)"
        )
    };
    let mut run = run(&program(""));
    run.step_until("a call", |run| run.value("call").is_some_and(|call| call["done"] == json!(true)));
    run.save(&program("[pause = 5]"));
    run.command(Command::Restart);
    run.step_until("another", |run| kinds(&run.records).contains(&"reply repeat_it #2 7".to_string()));
    assert_eq!(run.health(), [(Health::Connecting, None), (Health::Up, None)]);
}

#[test]
fn a_form_that_is_wrong_says_where() {
    let mut run = run("(bridge robot echo)");
    run.save("(bridge robot echo\n  [pause = 1, puase = 2])");
    let program = run.driver.engine().program();
    let finding = program.findings.first().expect("a finding");
    assert_eq!(finding.message, "an echo has no setting `puase`");
    assert_eq!(
        program.source(finding.span).text.get(finding.span.start as usize..finding.span.end as usize),
        Some("puase")
    );
}
