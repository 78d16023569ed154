//! docs/codes.md against the checks: every code has its section, each wrong example gives exactly that code, and each right
//! one nothing at all. Behaviours and the files a beginner starts from are free of findings.

use std::collections::BTreeSet;
use std::path::{Path, PathBuf};

use lrp::runtime::{Options, Time, What};
use lrp::session::compile::{Compiler, Rejected};
use lrp::session::driver::Driver;
use lrp::session::plugins::Plugins;
use lrp::session::robots::{Robots, Workshop};
use lrp::syntax::{Code, Source};

use crate::shelf::Shelf;

const PAGE: &str = include_str!("../../docs/codes.md");
/// Milliseconds of program time.
const RUN: u64 = 2000;

struct Section {
    code: &'static str,
    text: &'static str,
}

impl Section {
    /// What the examples may import.
    fn files(&self) -> Shelf {
        let fences = self.text.split("```lrp file ").skip(1);
        let files = fences.map(|fence| fence.split_once('\n').expect("a text"));
        let files = files.map(|(name, rest)| (name.into(), rest.split("```").next().unwrap_or_default().into()));
        Shelf::of(files.collect())
    }

    fn examples(&self, info: &str) -> Vec<&'static str> {
        let mut rest = self.text;
        let mut found = Vec::new();
        while let Some((_, after)) = rest.split_once(&format!("```{info}\n")) {
            let (example, after) = after.split_once("```").expect("the fence is closed");
            found.push(example);
            rest = after;
        }
        found
    }
}

fn sections() -> Vec<Section> {
    let sections = PAGE.split("\n## ").skip(1);
    sections
        .map(|section| section.split_once('\n').expect("a text"))
        .map(|(code, text)| Section { code, text })
        .collect()
}

/// The codes of what is found in a program, and of what goes wrong in its first seconds where nothing is.
fn codes(text: &str, files: &Shelf) -> BTreeSet<String> {
    let workshop =
        || Workshop { folder: PathBuf::new(), seed: 1, robots: Robots::AsProgrammed, plugins: Plugins::default() };
    let (program, diagnostics) =
        match Compiler::new(Vec::new()).with_files(files.clone()).compile(Source::new("example.lrp", text)) {
            Err(Rejected { diagnostics, .. }) => (None, diagnostics),
            Ok(program) => {
                let mut diagnostics = program.findings.clone();
                for bridge in &program.bridges {
                    diagnostics.extend(workshop().make(bridge, 1).err().into_iter().flat_map(|it| it.diagnostics));
                }
                (Some(program), diagnostics)
            }
        };
    let mut codes: BTreeSet<String> = diagnostics.iter().map(|it| it.code.name().to_string()).collect();
    if let Some(program) = program {
        let mut driver = Driver::new(Options::default(), workshop());
        let mut see = |record: lrp::runtime::Record| {
            if let What::Error(fault) = &record.what {
                codes.insert(fault.code.clone());
            }
        };
        driver.command(lrp::runtime::Command::Load(program.into()), &mut see).expect("it is taken");
        for now in (100..=RUN).step_by(100) {
            driver.step(Time(now * 1000), &mut see);
        }
    }
    codes
}

/// This many files, each of which imports the next one and hands on what that exports.
fn chain(length: usize) -> Shelf {
    let link = |n: usize| match n == length {
        true => "(export m)\n(machine m (state s))\n".to_string(),
        false => format!("(import \"{}.lrp\")\n(export m)\n", n + 1),
    };
    Shelf::of((1..=length).map(|n| (format!("{n}.lrp"), link(n))).collect())
}

#[test]
fn a_thousand_files_are_not_too_many() {
    assert_eq!(codes("(import \"1.lrp\")\n(spawn m s)\n", &chain(999)), BTreeSet::new());
}

#[test]
fn every_code_has_its_section() {
    let told: Vec<&str> = sections().iter().map(|section| section.code).collect();
    let known: Vec<&str> = Code::ALL.iter().map(|code| code.name()).collect();
    let missing: Vec<_> = known.iter().filter(|code| !told.contains(code)).collect();
    let unknown: Vec<_> = told.iter().filter(|code| !known.contains(code)).collect();
    assert!(missing.is_empty() && unknown.is_empty(), "missing: {missing:?}; no code: {unknown:?}");
    assert_eq!(told.len(), known.len());
    for section in sections() {
        assert!(section.text.contains("\nSeverity: "), "{}: how bad is it?", section.code);
    }
}

#[test]
fn examples_give_what_they_are_about() {
    let deep = format!("(machine m (state a (running [{}1{}])))", "(".repeat(150), ")".repeat(150));
    let large = ";".repeat(9 << 20);
    let mut wrong = Vec::new();
    for section in sections() {
        let mut examples = section.examples("lrp wrong");
        let right = section.examples("lrp");
        match section.code {
            "nested-too-deep" => examples.push(&deep),
            "too-large" => examples.push(&large),
            "too-many-files" => examples.push("(import \"1.lrp\")\n(spawn m s)\n"),
            code if examples.is_empty() || right.is_empty() => wrong.push(format!("{code} has no examples")),
            _ => {}
        }
        let files = match section.code {
            "too-many-files" => chain(1000),
            _ => section.files(),
        };
        let only = BTreeSet::from([section.code.to_string()]);
        let found = examples.into_iter().map(|text| codes(text, &files)).filter(|codes| *codes != only);
        wrong.extend(found.map(|codes| format!("{}, wrong: {codes:?}", section.code)));
        let found = right.into_iter().map(|text| codes(text, &files)).filter(|codes| !codes.is_empty());
        wrong.extend(found.map(|codes| format!("{}, right: {codes:?}", section.code)));
    }
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
}

#[test]
fn nothing_is_found_in_the_behaviours() {
    let root = Path::new(env!("CARGO_MANIFEST_DIR")).join("behaviors");
    let mut seen = 0;
    for file in std::fs::read_dir(root).expect("behaviours").flatten().map(|entry| entry.path()) {
        if file.extension().is_some_and(|it| it == "lrp") {
            let text = std::fs::read_to_string(&file).expect("a text");
            let program = Compiler::new(Vec::new()).compile(Source::new(file.to_string_lossy(), text));
            let program = program.unwrap_or_else(|_| panic!("{} compiles", file.display()));
            assert_eq!(program.findings, [], "{}", file.display());
            seen += 1;
        }
    }
    assert!(seen >= 6, "only {seen} behaviours");
}
