//! The documents against the program: every example in them is compiled and run, every record they show is read. Knows
//! how examples are marked, and nothing of what they are about.
//!
//! A fence ```` ```lrp ```` is a program without mistakes; ```` ```lrp broken ```` must be reported; ```` ```lrp faulty ````
//! must go wrong while it runs; ```` ```lrp file NAME ```` is a file that programs after it on the page may import. A fence
//! ```` ```trace ```` after it tells lines of its run, in order, others left out, and what is done to it: `300 input ..`,
//! `300 command ..`, `300 save OLD => NEW`;
//! ```` ```json ```` in docs/trace.md is a record a line.

mod page;
mod run;

use std::collections::BTreeSet;

use lrp::runtime::{Record, What};

use page::{Example, Kind};

#[test]
fn every_example_does_what_the_page_says() {
    let examples = page::examples();
    assert!(examples.len() >= 10, "only {} examples were found", examples.len());
    let wrong: Vec<String> = examples.iter().filter_map(|example| judge(example).err()).collect();
    assert!(wrong.is_empty(), "{}", wrong.join("\n\n"));
}

fn judge(example: &Example) -> Result<(), String> {
    let run = run::run(example).map_err(|why| format!("{}: {why}", example.place))?;
    let (errors, faults, remarks) = (run.errors.join("\n"), run.faults.join("\n"), run.remarks.join("\n"));
    match example.kind {
        Kind::Sound if !remarks.is_empty() => return Err(format!("{}: {remarks}", example.place)),
        Kind::Sound if !errors.is_empty() || !faults.is_empty() => {
            return Err(format!("{}: {errors}\n{faults}", example.place));
        }
        Kind::Broken if errors.is_empty() => return Err(format!("{}: this should be reported", example.place)),
        Kind::Faulty if faults.is_empty() => return Err(format!("{}: this should go wrong", example.place)),
        _ => {}
    }
    let mut seen = run.lines.iter();
    for expected in &example.trace {
        if !seen.any(|line| line == expected) {
            return Err(format!("{}: no `{expected}` here in\n{}", example.place, run.lines.join("\n")));
        }
    }
    Ok(())
}

#[test]
fn a_wrong_claim_is_found() {
    let program = "(machine m (state a) (state b) (ontime 500 a -> b))\n(spawn m a)";
    let example = |kind, claims: &[&str]| Example {
        place: "here".to_string(),
        kind,
        text: program.to_string(),
        files: Vec::new(),
        fed: Vec::new(),
        trace: claims.iter().map(ToString::to_string).collect(),
    };
    assert!(judge(&example(Kind::Sound, &["0 enter m/a", "500 enter m/b"])).is_ok());
    for (kind, claims) in [
        (Kind::Sound, ["500 enter m/b", "0 enter m/a"]),
        (Kind::Sound, ["0 enter m/a", "600 enter m/b"]),
        (Kind::Broken, ["0 enter m/a", "500 enter m/b"]),
        (Kind::Faulty, ["0 enter m/a", "500 enter m/b"]),
    ] {
        assert!(judge(&example(kind, &claims)).is_err(), "{kind:?} {claims:?}");
    }
}

/// Without a wildcard, so that a new variant doesn't compile until it is here, and then isn't tested green until it is
/// in docs/trace.md.
fn kind(what: &What) -> &'static str {
    match what {
        What::Load(_) => "load",
        What::Reject { .. } => "reject",
        What::Held(_) => "held",
        What::Breakpoints { .. } => "breakpoints",
        What::Command { .. } => "command",
        What::Spawn { .. } => "spawn",
        What::Enter { .. } => "enter",
        What::Exit { .. } => "exit",
        What::Transition(_) => "transition",
        What::Guards { .. } => "guards",
        What::Discard { .. } => "discard",
        What::Set { .. } => "set",
        What::Input { .. } => "input",
        What::Output { .. } => "output",
        What::Call { .. } => "call",
        What::Cancel { .. } => "cancel",
        What::Reply { .. } => "reply",
        What::Log(_) => "log",
        What::Error(_) => "error",
        What::Mended(_) => "mended",
        What::Pause { .. } => "pause",
        What::Resume => "resume",
        What::Force { .. } => "force",
        What::Restart { .. } => "restart",
        What::Stop { .. } => "stop",
        What::Skip { .. } => "skip",
        What::Status { .. } => "status",
        What::Offer { .. } => "offer",
        What::Found { .. } => "found",
        What::Bridge(_) => "bridge",
    }
}

#[test]
fn the_trace_page_shows_every_kind_of_record_as_it_is() {
    let trace = page::pages().into_iter().find(|page| page.ends_with("docs/trace.md")).expect("docs/trace.md is there");
    let text = std::fs::read_to_string(&trace).expect("it can be read");
    let mut shown = BTreeSet::new();
    for fence in page::fences(&trace).into_iter().filter(|fence| fence.info == "json") {
        for line in fence.text.lines() {
            let record: Record =
                serde_json::from_str(line).unwrap_or_else(|why| panic!("{}: {why}: {line}", fence.place));
            assert_eq!(serde_json::to_string(&record).expect("a record is data"), line, "{}", fence.place);
            shown.insert(kind(&record.what));
        }
    }
    for kind in What::KINDS {
        assert!(text.contains(&format!("### {kind}\n")) && shown.contains(kind), "docs/trace.md lacks `{kind}`");
    }
    assert_eq!(shown.len(), What::KINDS.len());
}
