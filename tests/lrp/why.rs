//! Why a state is not left, on the screen: what each guard came to, and the list of what was taken.

use std::fs;
use std::path::PathBuf;

use lrp::model::transition_names::TransitionNames;
use lrp::model::ways::ways_out;
use lrp::runtime::record::{Answer, Taken, Way};
use lrp::runtime::{Command, Explain, Record, What};
use serde_json::json;

use crate::frames::{SIZES, check, frame, press, screen};
use crate::lines::line;
use crate::runs;
use crate::stage::{Head, read_event};
use crate::story::{LINE_FOLLOWER, Story, program};

/// What the guards of a state came to, in order: each with the length of a timeout and a message.
fn guards(story: &mut Story, state: &str, found: &[(Answer, Option<f64>, Option<&str>)]) {
    let program = program(LINE_FOLLOWER);
    let ways = ways_out(&program, program.state(state).expect("it is there"));
    assert_eq!(ways.len(), found.len());
    let way = |(&id, &(guard, after, message)): (_, &(Answer, _, Option<&str>))| Way {
        transition: TransitionNames::of(&program).name(id),
        guard,
        after,
        message: message.map(Into::into),
    };
    let ways = ways.iter().zip(found).map(way).collect();
    story.tell(What::Guards { state: state.into(), ways });
}

const NO: (Answer, Option<f64>, Option<&str>) = (Answer::False, None, None);

fn searching() -> Story {
    let mut story = Story::searching();
    guards(&mut story, "follower/looking", &[NO, NO, NO]);
    guards(&mut story, "follower/looking/lookalgo/lookright", &[(Answer::False, Some(400.0), None)]);
    story
}

#[test]
fn what_a_state_waits_for() {
    for (width, height) in SIZES {
        let mut app = screen(width, height, &searching());
        press(&mut app, "Down Down y");
        check(&format!("why_not_{width}x{height}"), &app);
    }
}

#[test]
fn values_change_where_they_stand() {
    let mut story = searching();
    let mut app = screen(80, 24, &story);
    press(&mut app, "Down Down y");
    let rows = |text: &str| -> Vec<String> {
        let words = |line: &str| line.split_once('→').map(|(_, rest)| rest.trim_end().to_string());
        text.lines().take(14).map(|line| words(line).unwrap_or_default()).collect()
    };
    let before = frame(&app);
    let known = story.records.len();
    let message = "attempt to index a nil value (field 'bumper')";
    guards(&mut story, "follower/looking", &[(Answer::True, None, None), (Answer::Error, None, Some(message)), NO]);
    story.input("light", json!({ "data": 90 }));
    story.records[known..].iter().for_each(|record| app.record(record));
    let after = frame(&app);
    assert_eq!(rows(&before), rows(&after), "no way out moves");
    assert!(before.contains("false  → moving") && after.contains("true   → moving"), "{after}");
    assert!(
        before.contains("light.data 142, lightlim 128") && after.contains("light.data 90, lightlim 128"),
        "{after}"
    );
    assert!(after.contains("error  → bumpback") && after.contains("attempt to index a nil"), "{after}");
    check("why_error_80x24", &app);
}

#[test]
fn a_timeout_counts_down() {
    let mut story = searching();
    let keys = "Down Down Down Down Down Down y";
    let mut app = screen(80, 24, &story);
    press(&mut app, keys);
    assert!(frame(&app).contains("200 ms → returnright  ontime time"), "{}", frame(&app));
    let mut app = screen(80, 24, story.at(83).input("light", json!({ "data": 142 })));
    press(&mut app, keys);
    assert!(frame(&app).contains("100 ms → returnright"), "{}", frame(&app));
}

#[test]
fn of_a_machine_it_is_the_active_state() {
    let mut app = screen(80, 24, &searching());
    press(&mut app, "y");
    assert!(frame(&app).contains("why not, in looking"), "{}", frame(&app));
    press(&mut app, "y");
    assert!(!frame(&app).contains("why not"), "{}", frame(&app));
}

#[test]
fn from_everywhere_it_is_the_selected_state() {
    let mut app = screen(80, 24, &searching());
    press(&mut app, "Down Down 3 Down y");
    assert!(frame(&app).contains("why not"), "{}", frame(&app));
    press(&mut app, "Down i");
    press(&mut app, "i");
    assert!(frame(&app).contains("variable"), "{}", frame(&app));
    press(&mut app, "y");
    assert!(frame(&app).contains("why not"), "it takes the place of the variable\n{}", frame(&app));
}

#[test]
fn it_is_asked_for_only_while_it_is_seen() {
    let mut app = screen(80, 24, &searching());
    assert_eq!(app.explain(), Explain::Off);
    press(&mut app, "y");
    assert_eq!(app.explain(), Explain::On);
    press(&mut app, "w");
    assert_eq!(app.explain(), Explain::Off);
    assert_eq!(screen(200, 60, &searching()).explain(), Explain::On, "there it has a place of its own");
}

#[test]
fn what_is_no_longer_told_is_forgotten() {
    let mut story = searching();
    story.tell(What::Command { command: Command::Explain { mode: Explain::Off } });
    let mut app = screen(80, 24, &story);
    press(&mut app, "Down Down y");
    let seen = frame(&app);
    assert!(seen.contains("→ moving") && !seen.contains("false  →"), "{seen}");
}

#[test]
fn the_log_lists_transitions() {
    for (width, height, keys) in [(80, 24, "4 v"), (80, 24, "4 v z"), (120, 40, "4 v"), (40, 24, "4 v")] {
        let mut app = screen(width, height, &searching());
        press(&mut app, keys);
        let zoomed = if keys.ends_with('z') { "_alone" } else { "" };
        check(&format!("transitions{zoomed}_{width}x{height}"), &app);
    }
}

#[test]
fn the_log_of_one_machine() {
    let mut story = searching();
    story.at(82).log(lrp::runtime::record::Level::Info, "outer", "follower/looking", 14);
    let mut app = screen(80, 24, &story);
    press(&mut app, "Down Down Down 4 m");
    let seen = frame(&app);
    assert!(seen.contains("only lookalgo") && seen.contains("returnleft → lookright"), "{seen}");
    assert!(!seen.contains("moving → looking") && !seen.contains("outer"), "{seen}");
    press(&mut app, "v v v");
    assert!(frame(&app).contains("(m shows all machines)"), "{}", frame(&app));
    press(&mut app, "m v v");
    assert!(frame(&app).contains("outer") && !frame(&app).contains("only lookalgo"), "{}", frame(&app));
}

/// Each program of the corpus, played as its head says, and as it is when somebody asks from the start.
fn corpus() -> Vec<(PathBuf, Vec<Record>, Vec<Record>)> {
    let files = fs::read_dir(runs::corpus("run")).expect("the corpus").flatten().map(|it| it.path());
    let cases = files.filter(|path| path.extension().is_some_and(|it| it == "lrp"));
    let play = |path: PathBuf| {
        let text = fs::read_to_string(&path).expect("a case");
        let plain = Head::read(&text).play(&text, Vec::new());
        let asked = Head::read(&text).play(&text, vec![(0.0, read_event("explain on"))]);
        (path, plain, asked)
    };
    cases.map(play).collect()
}

fn is_answer(record: &Record) -> bool {
    matches!(record.what, What::Guards { .. } | What::Command { command: Command::Explain { .. } })
}

#[test]
fn asking_changes_nothing_and_is_answered_with_what_happens() {
    let mut taken = 0;
    for (path, plain, asked) in corpus() {
        let rest = |records: &[Record]| records.iter().filter(|it| !is_answer(it)).map(line).collect::<String>();
        assert_eq!(rest(&plain), rest(&asked), "{}", path.display());
        for (index, record) in asked.iter().enumerate() {
            let What::Guards { state, ways } = &record.what else { continue };
            let holds = |way: &&Way| way.guard == Answer::True;
            let Some(way) = ways.iter().find(holds) else { continue };
            let next = asked[index + 1..].iter().filter(|it| !is_answer(it));
            let mut next = next.take_while(|it| it.step <= record.step + 1).peekable();
            if next.clone().any(|it| matches!(it.what, What::Command { .. } | What::Load(_))) || next.peek().is_none() {
                continue;
            }
            let (machine, from) = state.rsplit_once('/').expect("a state is in a machine");
            let is_out = |it: &Taken| *it.machine == *machine && *it.from == *from || it.via.as_ref() == Some(state);
            let is_it = |it: &Record| matches!(&it.what, What::Transition(it) if is_out(it));
            assert!(next.any(is_it), "{}: {} at step {}", path.display(), way.transition, record.step);
            taken += 1;
        }
    }
    assert!(taken >= 3, "only {taken} were told beforehand");
}
