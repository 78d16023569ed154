//! Records as an engine would send them, told step by step, for the tests of the screen.

use std::sync::Arc;

use lrp::model::Program;
use lrp::runtime::record::*;
use lrp::runtime::time::Time;
use lrp::session::compile::Compiler;
use lrp::syntax::Source;
use lrp::ui::view::View;
use serde_json::{Value, json};

pub const LINE_FOLLOWER: &str = include_str!("line_follower.lrp");

/// A program named `line_follower.lrp`.
pub fn program(text: &str) -> Arc<Program> {
    let compiled = Compiler::new(Vec::new()).compile(Source::new("line_follower.lrp", text));
    Arc::new(compiled.unwrap_or_else(|rejected| panic!("{:?}", rejected.diagnostics)))
}

/// Milliseconds of a step.
const PERIOD: f64 = 100.0;

pub struct Story {
    pub records: Vec<Record>,
    step: u64,
}

impl Story {
    pub fn new() -> Story {
        Story { records: Vec::new(), step: 0 }
    }

    /// The picture that a screen has of it.
    pub fn view(&self) -> View {
        let mut view = View::new(10.0);
        self.records.iter().for_each(|record| view.apply(record));
        view
    }

    /// The line follower from its start until it has searched the line for a while.
    pub fn searching() -> Story {
        let mut story = Story::new();
        story.sim();
        story.load(&program(LINE_FOLLOWER), &[]);
        let globals = [
            ("lightlim", json!(128)),
            ("maxlook", json!(100)),
            ("forward", json!(0.2)),
            ("search", json!(0.8)),
            ("back", json!(-0.2)),
        ];
        for (name, value) in globals {
            story.set(name, value, "init");
        }
        story.spawn("follower", None).set("follower/nobump", json!(true), "init").enter("follower/looking");
        story.look();
        story.sense(0.0, 0.6, 90.0, 96);
        story.at(4).take("follower", "follower/looking", "follower/moving", Some("tmoving"), "intheline", 1);
        for step in 5..60 {
            let t = f64::from(step) / 10.0;
            story.at(u64::from(step as u32)).sense(3.44 + t * 0.01, 1.2 + t * 0.07, 90.0 + t, 96);
        }
        story.at(60).take("follower", "follower/moving", "follower/looking", Some("tlooking"), "outofline", 0);
        story.look();
        let sweep = ["returnleft", "lookright", "returnright", "lookleft"];
        let (mut time, mut step, mut from) = (100, 60, "lookleft");
        for i in 0..10 {
            let to = sweep[i % 4];
            step += time / 100;
            story.at(step as u64);
            if from == "returnright" {
                time *= 2;
                story.set("follower/looking/lookalgo/time", json!(time), "follower/looking/lookalgo/returnright");
            }
            story.sweep(from, to, i as u32 % 4);
            from = to;
        }
        story.at(step as u64).log(Level::Warn, "third sweep", "follower/looking", 24);
        story.at(step as u64 + 2).sense(3.5, 1.62, 95.0, 142);
        story.output(
            "move",
            json!({"linear": {"x": 0.0, "y": 0.0, "z": 0.0}, "angular": {"x": 0.0, "y": 0.0, "z": -0.8}}),
        );
        story.tell(What::Status { rate: 10.0, late: 0.2 });
        story
    }

    /// At the start of a later step.
    pub fn at(&mut self, step: u64) -> &mut Story {
        self.step = step;
        self
    }

    pub fn tell(&mut self, what: What) -> &mut Story {
        let t = Time::from_ms(self.step as f64 * PERIOD);
        self.records.push(Record { step: self.step, t, what });
        self
    }

    pub fn load(&mut self, program: &Arc<Program>, changes: &[(Op, Element, &str)]) -> &mut Story {
        let changes =
            changes.iter().map(|&(op, kind, path)| Change { op, kind, path: path.into(), to: None }).collect();
        let files = vec![File { name: "line_follower.lrp".into(), text: program.sources[0].text.clone() }];
        self.tell(What::Load(Load {
            changes,
            restarted: false,
            reason: None,
            again: Vec::new(),
            discarded: Vec::new(),
            because: Vec::new(),
            findings: Vec::new(),
            files,
            program: Some(program.clone()),
        }))
    }

    /// An edit that restarts the program, or starts machines again.
    pub fn edit(
        &mut self,
        program: &Arc<Program>,
        changes: Vec<Change>,
        because: Option<&str>,
        again: &[&str],
    ) -> &mut Story {
        let files = vec![File { name: "line_follower.lrp".into(), text: program.sources[0].text.clone() }];
        self.tell(What::Load(Load {
            changes,
            restarted: because.is_some(),
            reason: because.map(Into::into),
            again: again.iter().map(|&machine| machine.into()).collect(),
            discarded: Vec::new(),
            because: Vec::new(),
            findings: Vec::new(),
            files,
            program: Some(program.clone()),
        }));
        match because {
            Some(reason) => self.tell(What::Restart { reason: reason.into() }),
            None => self,
        }
    }

    pub fn spawn(&mut self, machine: &str, by: Option<&str>) -> &mut Story {
        self.tell(What::Spawn { machine: machine.into(), by: by.map(Into::into) })
    }

    pub fn enter(&mut self, state: &str) -> &mut Story {
        self.tell(What::Enter { state: state.into() })
    }

    pub fn set(&mut self, var: &str, value: Value, by: &str) -> &mut Story {
        self.tell(What::Set { var: var.into(), value, by: by.into() })
    }

    pub fn log(&mut self, level: Level, message: &str, state: &str, line: usize) -> &mut Story {
        self.tell(What::Log(Log {
            level,
            message: message.into(),
            state: state.into(),
            file: "line_follower.lrp".into(),
            line,
        }))
    }

    pub fn fault(&mut self, message: &str, state: &str, line: usize, count: u64) -> &mut Story {
        self.tell(What::Error(Fault {
            code: "runtime-error".into(),
            message: message.into(),
            help: Some("ask `robot.range and robot.range.data` first".into()),
            file: "line_follower.lrp".into(),
            line,
            column: 27,
            state: state.into(),
            count,
        }))
    }

    /// A text that isn't taken over: message, file and line of each finding.
    pub fn reject(&mut self, findings: &[(&str, &str, usize)]) -> &mut Story {
        let finding = |&(message, file, line): &(&str, &str, usize)| Finding {
            severity: "error".into(),
            code: "unclosed-bracket".into(),
            message: message.into(),
            help: Some("add a `)` before line 16".into()),
            file: file.into(),
            line,
            column: 5,
        };
        self.tell(What::Reject { findings: findings.iter().map(finding).collect(), files: Vec::new() })
    }

    /// A save that can't be taken over, as the compiler finds it.
    pub fn refuse(&mut self, text: &str) -> &mut Story {
        use lrp::session::findings;
        let compiled = Compiler::new(Vec::new()).compile(Source::new("line_follower.lrp", text));
        let Err(rejected) = compiled else { panic!("it is sound:\n{text}") };
        let (findings, files) = findings::of_rejected(&rejected.diagnostics, &rejected.sources);
        self.tell(What::Reject { findings, files })
    }

    pub fn output(&mut self, name: &str, value: Value) -> &mut Story {
        self.tell(What::Output { bridge: "robot".into(), name: name.into(), value })
    }

    pub fn input(&mut self, name: &str, value: Value) -> &mut Story {
        self.tell(What::Input { bridge: "robot".into(), name: name.into(), value })
    }

    /// A transition of a machine without anything inside, as its records.
    pub fn take(
        &mut self,
        machine: &str,
        from: &str,
        to: &str,
        name: Option<&str>,
        trigger: &str,
        index: u32,
    ) -> &mut Story {
        self.tell(What::Transition(Taken {
            machine: machine.into(),
            from: from.rsplit('/').next().unwrap_or(from).into(),
            to: to.rsplit('/').next().unwrap_or(to).into(),
            name: name.map(Into::into),
            trigger: trigger.into(),
            via: None,
            index,
        }));
        if from == "follower/looking" {
            self.tell(What::Discard { machine: "follower/looking/lookalgo".into() });
        }
        self.tell(What::Exit { state: from.into() }).enter(to)
    }

    fn look(&mut self) -> &mut Story {
        let algo = "follower/looking/lookalgo";
        self.spawn(algo, Some("follower/looking")).set(&format!("{algo}/time"), json!(100), "init");
        self.enter(&format!("{algo}/lookleft"))
    }

    fn sweep(&mut self, from: &str, to: &str, index: u32) -> &mut Story {
        let algo = "follower/looking/lookalgo";
        let name = format!("t{to}");
        self.take(algo, &format!("{algo}/{from}"), &format!("{algo}/{to}"), Some(&name), "ontime", index)
    }

    fn sim(&mut self) -> &mut Story {
        self.tell(What::Bridge(BridgeState {
            bridge: "robot".into(),
            kind: "sim".into(),
            state: Health::Up,
            message: None,
            world: Some(WorldText {
                name: "curve".into(),
                text: include_str!("../../behaviors/worlds/curve.world").into(),
                pose: "pose".into(),
            }),
        }))
    }

    fn sense(&mut self, x: f64, y: f64, degrees: f64, light: i64) -> &mut Story {
        self.input("light", json!({ "data": light }));
        self.input("bumper", json!({ "data": 0 }));
        self.input("pose", json!({ "x": x, "y": y, "theta": degrees.to_radians() }))
    }
}
