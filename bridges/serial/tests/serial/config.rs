//! What is wrong with a form's configuration is told with its key and what would be right.

use lrp_bridge::{Bridge, Problem};
use lrp_bridge_serial::Serial;
use serde_json::{Value, json};

fn problems(config: Value) -> Vec<(String, String, String)> {
    let parts = |Problem { key, message, help }| (key.unwrap_or_default(), message, help.unwrap_or_default());
    Serial::offer(&config).err().unwrap_or_default().into_iter().map(parts).collect()
}

#[track_caller]
fn wrong(config: Value, key: &str, message: &str) {
    let all = problems(config);
    let found = all.iter().any(|(at, said, help)| at == key && said == message && !help.is_empty());
    assert!(found && all.len() == 1, "{all:#?}");
}

#[test]
fn what_is_right() {
    for config in [
        json!({}),
        json!([]),
        json!({ "port": "ttyACM0", "inputs": ["light", "bumper"], "outputs": {}, "calls": [], "stop": ["S", "T"] }),
        json!({ "fields": "csv", "inputs": { "a": 0 }, "columns": ["", "a.data"], "eol": "\r\n", "ready": 500 }),
        json!({ "codec": "firmata", "pins": { "a": "analog A0", "b": "pullup 7 inverted" }, "sampling": 50 }),
    ] {
        assert_eq!(problems(config.clone()), [], "{config}");
    }
}

#[test]
fn settings() {
    wrong(json!({ "prot": "x" }), "prot", "`lines` has no setting `prot`");
    wrong(json!({ "codec": "firmata", "inputs": {} }), "inputs", "`firmata` has no setting `inputs`");
    wrong(json!({ "codec": "morse" }), "codec", "there is no codec `morse`");
    wrong(json!({ "baud": "fast" }), "baud", "`baud` is a number from 50 to 4000000 baud");
    wrong(json!({ "port": 3 }), "port", "`port` is a text");
    wrong(json!({ "ready": true }), "ready", "`ready` is a line, or a time of up to 60000 ms");
    wrong(json!({ "eol": ";" }), "eol", "`eol` is one of \"\\n\", \"\\r\\n\" and \"\\r\"");
    wrong(json!({ "stop": "a\nb" }), "stop", "`stop` is a line, or a list of lines");
}

#[test]
fn fields() {
    wrong(json!({ "fields": "xml" }), "fields", "there are no fields `xml`");
    wrong(json!({ "inputs": { "a-b": 0 } }), "inputs.a-b", "`a-b` is no name that a block can use");
    wrong(json!({ "inputs": 3 }), "inputs", "`inputs` is a table by name");
    wrong(json!({ "fields": "csv", "inputs": { "a": 0 } }), "fields", "which column is which has to be said");
    wrong(
        json!({ "fields": "kv", "inputs": { "a": 0 }, "columns": ["a"] }),
        "columns",
        "only \"csv\" and \"nmea\" have columns",
    );
    let config = json!({ "fields": "csv", "inputs": { "a": 0 }, "columns": ["a", "b"] });
    wrong(config, "columns", "no input has a field `b`");
    wrong(json!({ "inputs": { "a": 0 }, "rename": { "x": "b" } }), "rename.x", "no input has a field `b`");
}

#[test]
fn templates() {
    let output = |line: &str| json!({ "outputs": { "go": line }, "stop": "S" });
    wrong(output("G {x"), "outputs.go", "`G {x`: a `{` has no `}`; a brace itself is `{{`");
    wrong(output("G }"), "outputs.go", "`G }`: a `}` has no `{`; a brace itself is `}}`");
    wrong(output("{x:.99}"), "outputs.go", "`{x:.99}`: `.99` is no form; there are .2, b, s, json");
    wrong(output("{a} {a.b}"), "outputs.go", "`{a} {a.b}`: `a` can't also have `a.b`");
    wrong(output("{\"x\": 1}"), "outputs.go", "`{\"x\": 1}`: ` 1` is no form; there are .2, b, s, json");
    wrong(output("a\nb"), "outputs.go", "`a\nb`: it is one line; several are a list");
    let call = |call: Value| json!({ "calls": { "c": call } });
    wrong(call(json!("T {a.b}")), "calls.c", "`{a.b}` can't be an argument");
    wrong(call(json!({ "send": "T", "replay": "x" })), "calls.c.replay", "a call has no setting `replay`");
    wrong(call(json!({ "reply": "x" })), "calls.c", "`calls.c` is a line, or a list of lines");
    let touching = "`{a}{b}` has two fields without anything between them";
    wrong(call(json!({ "send": "T", "reply": "{a}{b}" })), "calls.c.reply", touching);
    wrong(call(json!({ "send": "T", "error": "x" })), "calls.c", "an `error` is waited for only beside a `reply`");
}

#[test]
fn pins() {
    let pins = |pins: Value| json!({ "codec": "firmata", "pins": pins });
    wrong(pins(json!({ "a": "analogue A0" })), "pins.a", "`pins.a`: there is no mode `analogue`");
    wrong(pins(json!({ "a": "pwm" })), "pins.a", "`pins.a`: `pwm` is no mode and pin");
    wrong(pins(json!({ "a": "pwm x" })), "pins.a", "`pins.a`: `x` is no pin");
    wrong(pins(json!({ "a": "pwm 5 inverted" })), "pins.a", "`pins.a`: pwm can't be inverted");
    wrong(pins(json!({ "a": "pwm 5", "b": "output 5" })), "pins.b", "`b` and `a` are the same pin");
    let stop = json!({ "codec": "firmata", "pins": { "a": "servo 9" }, "stop": { "a": 900 } });
    wrong(stop, "stop.a", "`stop.a` is a number from 0 to 180");
    wrong(json!({ "codec": "firmata", "stop": { "a": 1 } }), "stop.a", "no pin `a` can be set");
}
