//! A bridge that does what a bridge must not do, when it is told to: what lrp makes of that is what tests look at. Writes
//! each stop into a file, so that a test sees it after everything else has gone.

use std::fs::OpenOptions;
use std::io::Write;
use std::path::PathBuf;
use std::process::{abort, exit};
use std::thread;
use std::time::Duration;

use lrp_bridge::{About, Bridge, Description, Form, Level, News, Port, Problem, Robot, Scope, Want, bridge};
use serde_json::{Value, json};

struct Unruly {
    robot: Robot,
    diary: Option<PathBuf>,
    /// Whether it writes down what it is told of the program.
    watches: bool,
}

bridge!(Unruly);

impl Bridge for Unruly {
    fn about() -> About {
        if std::env::var_os("LRP_UNRULY").is_some_and(|what| what == "silent") {
            hang();
        }
        About {
            kind: "unruly".into(),
            version: "0".into(),
            summary: "misbehaves when told to".into(),
            wants: vec![Want::Variables, Want::States, Want::Log],
            ..About::default()
        }
    }

    fn offer(_: &Value) -> Result<Description, Vec<Problem>> {
        let beat = Port::new("beat", json!({ "count": 0 }), "one more, ten times a second");
        let misdeed = Port::new("misdo", json!({ "what": "" }), "the misdeed");
        let other = |count| Port::new(format!("other{count}"), Value::Null, "");
        let inputs = std::iter::once(beat).chain((0..1000).step_by(111).map(other)).collect();
        Ok(Description { inputs, outputs: vec![misdeed], scope: Scope::Closed, ..Description::default() })
    }

    fn connect(robot: Robot, form: Form) -> Unruly {
        let diary = form.config.get("diary").and_then(Value::as_str).map(|name| form.folder.join(name));
        let unruly = Unruly { robot, diary, watches: form.config.get("watches").is_some() };
        unruly.note("connect");
        if let Some(first) = form.config.get("first").and_then(Value::as_str) {
            misbehave(first, &unruly.robot);
        }
        let beating = unruly.robot.clone();
        thread::spawn(move || {
            for count in 1.. {
                beating.input("beat", json!({ "count": count }));
                thread::sleep(Duration::from_millis(100));
            }
        });
        unruly.robot.up();
        unruly
    }

    fn configure(&mut self, form: Form) {
        self.note(&format!("configure {}", form.config["first"]));
    }

    fn send(&mut self, _: &str, message: Value) {
        if message["what"] == "drive" {
            return self.note("drive");
        }
        misbehave(message["what"].as_str().unwrap_or_default(), &self.robot);
    }

    fn stop(&mut self) {
        self.note("stop");
    }

    fn hear(&mut self, news: News) {
        if self.watches {
            self.note(&match news {
                News::Variables(all) => {
                    let all: Vec<String> = all.iter().map(|it| format!("{}={}", it.path, it.value)).collect();
                    format!("variables {}", all.join(" "))
                }
                News::States { t, machines } => {
                    let all: Vec<String> =
                        machines.iter().map(|it| format!("{}/{}@{}", it.machine, it.state, it.since)).collect();
                    format!("states {t} {}", all.join(" "))
                }
                News::Log { level, message, state } => format!("log {level:?} {message} {state:?}"),
                News::Answer { id, error } => format!("answer {id} {}", error.unwrap_or_default()),
            });
        }
    }
}

impl Unruly {
    fn note(&self, what: &str) {
        let Some(diary) = &self.diary else { return };
        if let Ok(mut file) = OpenOptions::new().append(true).create(true).open(diary) {
            let _ = writeln!(file, "{what}");
        }
    }
}

fn misbehave(how: &str, robot: &Robot) {
    match how {
        "segv" => {
            // SAFETY: there is none; that is what is asked for.
            unsafe { std::ptr::null_mut::<u8>().wrapping_add(8).write_volatile(1) }
        }
        "abort" => abort(),
        "panic" => panic!("as asked"),
        "exit" => exit(3),
        "hang" => hang(),
        "print" => println!("a line on standard output"),
        "complain" => (0..100_000).for_each(|line| eprintln!("complaint {line}")),
        "set" => {
            robot.set(1, "goal", json!(7));
            robot.set(2, "gaol", json!(7));
        }
        "clock" => robot.time(1000.0),
        "lose" => robot.lost("the cable is out"),
        "log" => (0..100_000).for_each(|line| robot.log(Level::Info, format!("line {line}"))),
        // About 100 MB in all, as fast as it is taken.
        "flood" => {
            let robot = robot.clone();
            thread::spawn(move || {
                let text = "x".repeat(100_000);
                for count in 0..1000 {
                    robot.input("beat", json!({ "count": count, "text": text }));
                    robot.input(&format!("other{count}"), text.clone());
                }
            });
        }
        _ => {}
    }
}

fn hang() {
    loop {
        thread::park();
    }
}
