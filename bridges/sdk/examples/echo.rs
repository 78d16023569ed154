//! A whole bridge, to begin with: it hears what the program says to it. Has one of everything: an input, an output, calls
//! that take their time, a device.

use std::thread;
use std::time::{Duration, Instant};

use lrp_bridge::{
    About, Argument, Bridge, Call, Description, Device, Form, Function, Port, Problem, Robot, Setting, bridge,
};
use serde_json::{Value, json};

struct Echo {
    robot: Robot,
    /// How long a call takes.
    pause: Duration,
    /// The latest calls that were cancelled; a call looks here before it ends.
    cancelled: std::sync::Arc<std::sync::Mutex<Vec<u64>>>,
}

bridge!(Echo);

impl Bridge for Echo {
    fn about() -> About {
        About {
            kind: "echo".into(),
            version: env!("CARGO_PKG_VERSION").into(),
            summary: "hears what is said to it".into(),
            settings: vec![Setting::new("pause", "how long a call takes, ms; 0 by default").example("50")],
            wants: Vec::new(),
        }
    }

    fn offer(config: &Value) -> Result<Description, Vec<Problem>> {
        let mut problems = Vec::new();
        for key in config.as_object().into_iter().flat_map(|keys| keys.keys()).filter(|key| *key != "pause") {
            problems.push(Problem::new(format!("an echo has no setting `{key}`")).at(key).help("it has: pause"));
        }
        if pause(config).is_none() {
            problems.push(Problem::new("`pause` is a number of milliseconds").at("pause"));
        }
        if !problems.is_empty() {
            return Err(problems);
        }
        let text = json!({ "text": "", "loud": false });
        let horn = Device {
            name: "horn".into(),
            doc: "makes a noise".into(),
            functions: vec![
                Function::new("honk", vec![Argument::new("times").or(1)], "so many times"),
                Function::reading("heard", "heard.text", "what was heard last"),
            ],
        };
        Ok(Description {
            inputs: vec![Port::new("heard", text.clone(), "what was said last")],
            outputs: vec![Port::new("say", text, "something to be heard")],
            calls: vec![Function::new("repeat_it", vec![Argument::new("what")], "gives back what it is given")],
            devices: vec![horn],
            ..Description::default()
        })
    }

    fn connect(robot: Robot, form: Form) -> Echo {
        robot.up();
        Echo { robot, pause: pause(&form.config).unwrap_or_default(), cancelled: Default::default() }
    }

    fn configure(&mut self, form: Form) {
        self.pause = pause(&form.config).unwrap_or_default();
    }

    fn send(&mut self, _output: &str, message: Value) {
        self.robot.input("heard", message);
    }

    fn call(&mut self, Call { call, id, mut arguments }: Call) {
        let result = match &*call {
            "repeat_it" => Ok(arguments.remove(0)),
            "horn.honk" => Ok(json!("honk ".repeat(arguments[0].as_u64().unwrap_or(0) as usize).trim_end())),
            other => Err(format!("an echo has no call `{other}`")),
        };
        // Whatever takes its time does so on a thread of its own.
        let (robot, cancelled, end) = (self.robot.clone(), self.cancelled.clone(), Instant::now() + self.pause);
        thread::spawn(move || {
            robot.feedback(id, json!("listening"));
            thread::sleep(end.saturating_duration_since(Instant::now()));
            let is_cancelled = cancelled.lock().is_ok_and(|cancelled| cancelled.contains(&id));
            robot.reply(id, if is_cancelled { Err("cancelled".into()) } else { result });
        });
    }

    fn cancel(&mut self, id: u64) {
        if let Ok(mut cancelled) = self.cancelled.lock() {
            cancelled.push(id);
        }
    }

    fn stop(&mut self) {
        self.robot.input("heard", json!({ "text": "", "loud": false }));
    }
}

fn pause(config: &Value) -> Option<Duration> {
    match config.get("pause") {
        None => Some(Duration::ZERO),
        Some(pause) => pause.as_u64().map(Duration::from_millis),
    }
}
