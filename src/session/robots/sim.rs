//! The simulator as a robot: the `lrp-sim` crate's robot and world behind a bridge's inputs and outputs.

use std::path::{Path, PathBuf};
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};

use lrp_bridge::value::as_number;
use lrp_bridge::{Item, Output, Port, Setting};
use lrp_sim::{Noise, Sim, Twist, World};
use serde_json::{Value, json};

use super::{Bridge, Concern, Problems, Stopper, problem};
use crate::model;
use crate::model::Description;
use crate::runtime::Time;
use crate::runtime::record::{BridgeState, Health, WorldText};
use crate::session::loader;
use crate::syntax::{Code, Diagnostic, FileId, Source, Span};

/// What the form may configure.
const KEYS: &[&str] = &["world", "names", "noise", "stale"];

pub fn settings() -> Vec<Setting> {
    vec![
        Setting::new("world", "a file with the world, from the program's folder; by default an empty floor")
            .example("\"worlds/curve.world\""),
        Setting::new("names", "other names for the inputs and outputs")
            .example("{ light = \"eye\", move = \"drive\" }"),
        Setting::new("noise", "standard deviations of what is measured, for light and range").example("{ light = 3 }"),
        Setting::new("stale", "ms after which an input reads as nil; by default never").example("500"),
    ]
}
const PORTS: &[&str] = &["light", "bumper", "range", "odom", "move"];

pub struct Simulated {
    bridge: model::Bridge,
    names: Names,
    world: Source,
    sim: Sim,
    halted: Arc<AtomicBool>,
    folder: PathBuf,
}

/// The program's names for the simulator's inputs and outputs.
pub struct Names {
    config: Value,
}

impl Names {
    pub fn of(config: &Value) -> Names {
        Names { config: config.get("names").cloned().unwrap_or_default() }
    }

    fn get<'a>(&'a self, port: &'a str) -> &'a str {
        self.config.get(port).and_then(Value::as_str).unwrap_or(port)
    }
}

pub fn description(names: &Names) -> Description {
    let port = |name: &str, message: Value, doc: &str| Port::new(names.get(name), message, doc);
    Description {
        inputs: vec![
            port("light", json!({ "data": 0 }), "brightness of the ground under the sensor, 0 (dark) to 255 (bright)"),
            port("bumper", json!({ "data": 0 }), "1 while the front touches something, else 0"),
            port("range", json!({ "data": 0.0 }), "metres to the nearest wall ahead"),
            port("odom", json!({ "x": 0.0, "y": 0.0, "theta": 0.0 }), "where the robot is: metres and radians"),
        ],
        outputs: vec![port(
            "move",
            json!({ "linear": { "x": 0.0, "y": 0.0, "z": 0.0 }, "angular": { "x": 0.0, "y": 0.0, "z": 0.0 } }),
            "linear.x in m/s, angular.z in rad/s; stops 0.5 s after the last one",
        )],
        ..Description::default()
    }
}

impl Simulated {
    pub fn new(bridge: &model::Bridge, folder: &Path, seed: u64, file: FileId) -> Result<Simulated, Problems> {
        check_config(bridge)?;
        let world = match world_file(bridge, folder) {
            None => Source::new("built-in.world", DEFAULT_WORLD),
            Some(file) => read_world(bridge, &file)?,
        };
        let parsed = World::parse(&world.text).map_err(|faults| broken_world(&world, file, &faults))?;
        Ok(Simulated {
            names: Names::of(&bridge.config),
            sim: Sim::new(parsed, noise(&bridge.config), seed),
            world,
            bridge: bridge.clone(),
            halted: Arc::default(),
            folder: folder.to_path_buf(),
        })
    }
}

/// An empty floor, for a program that names no world.
const DEFAULT_WORLD: &str = "size 4 3\nstart 2 1.5 heading 0\n";

fn noise(config: &Value) -> Noise {
    let deviation = |sensor: &str| config.pointer(&format!("/noise/{sensor}")).and_then(Value::as_f64).unwrap_or(0.0);
    Noise { light: deviation("light"), range: deviation("range") }
}

fn check_config(bridge: &model::Bridge) -> Result<(), Problems> {
    let Some(config) = bridge.config.as_object() else {
        return Err(problem(bridge.span, "the configuration of a bridge is written `[key = value, ..]`".to_string()));
    };
    for key in config.keys() {
        if !KEYS.contains(&key.as_str()) {
            return Err(unknown(bridge, "setting", key, KEYS));
        }
    }
    if config.get("world").is_some_and(|world| !world.is_string()) {
        return Err(problem(bridge.span, "`world` is the name of a file, in quotes".to_string()));
    }
    for key in config.get("names").and_then(Value::as_object).into_iter().flat_map(|names| names.keys()) {
        if !PORTS.contains(&key.as_str()) {
            return Err(unknown(bridge, "input or output", key, PORTS));
        }
    }
    for sensor in ["light", "range"] {
        let deviation = config.get("noise").and_then(|noise| noise.get(sensor));
        if deviation.is_some_and(|value| !value.as_f64().is_some_and(|deviation| deviation >= 0.0)) {
            return Err(problem(bridge.span, format!("`noise.{sensor}` is a standard deviation: a number from 0 on")));
        }
    }
    Ok(())
}

fn unknown(bridge: &model::Bridge, what: &str, name: &str, known: &[&str]) -> Problems {
    let mut problems = problem(bridge.span, format!("the simulator has no {what} `{name}`"));
    let near = crate::syntax::nearest::nearest(name, known.iter().copied());
    let help = near.map_or_else(|| format!("it has: {}", known.join(", ")), |near| format!("did you mean `{near}`?"));
    problems.diagnostics[0].help = Some(help);
    problems
}

/// The file that a form names as its world.
pub fn world_file(bridge: &model::Bridge, folder: &Path) -> Option<PathBuf> {
    Some(folder.join(bridge.config.get("world")?.as_str()?))
}

fn read_world(bridge: &model::Bridge, file: &Path) -> Result<Source, Problems> {
    loader::read_file(file).map_err(|why| problem(bridge.span, format!("the world can't be read: {why}")))
}

fn broken_world(world: &Source, file: FileId, faults: &[lrp_sim::Fault]) -> Problems {
    let diagnostics = faults.iter().map(|fault| {
        let line = world.line_range(fault.line);
        let start = world.text[line.clone()]
            .char_indices()
            .nth(fault.column.saturating_sub(1))
            .map_or(line.end, |(at, _)| line.start + at);
        let length = world.text[start..line.end].find(char::is_whitespace).unwrap_or(line.end - start);
        let diagnostic =
            Diagnostic::error(Code::BadBridge, Span::new(file, start, start + length), fault.message.clone());
        Diagnostic { help: fault.help.clone(), ..diagnostic }
    });
    Problems { diagnostics: diagnostics.collect(), sources: vec![world.clone()] }
}

impl Bridge for Simulated {
    fn description(&self) -> Description {
        description(&self.names)
    }

    fn state(&self) -> BridgeState {
        BridgeState {
            bridge: self.bridge.name.clone(),
            kind: self.bridge.kind.clone(),
            state: Health::Up,
            message: None,
            world: Some(WorldText {
                name: self.world.name.clone(),
                text: self.world.text.clone(),
                pose: self.names.get("odom").into(),
            }),
        }
    }

    fn stale(&self) -> Option<Time> {
        self.bridge.config.get("stale").and_then(Value::as_f64).map(Time::from_ms)
    }

    fn advance(&mut self, now: Time) {
        if self.halted.swap(false, Ordering::SeqCst) {
            self.sim.halt();
        }
        self.sim.advance_to(now.0);
    }

    fn sample(&mut self) -> Vec<(Arc<str>, Value)> {
        let pose = self.sim.pose();
        let input = |port: &str, value: Value| (Arc::from(self.names.get(port)), value);
        vec![
            input("light", json!({ "data": self.sim.light() })),
            input("bumper", json!({ "data": u8::from(self.sim.bumper()) })),
            input("range", json!({ "data": legible(self.sim.range()) })),
            input("odom", json!({ "x": legible(pose.x), "y": legible(pose.y), "theta": legible(pose.theta) })),
        ]
    }

    fn send(&mut self, items: Vec<Item>) {
        for item in items {
            match item {
                Item::Output(Output { output, value }) if output == self.names.get("move") => self.drive(&value),
                Item::Output(_) | Item::Call(_) => {}
            }
        }
    }

    fn stop(&mut self) {
        self.sim.halt();
        // A halt asked for from another thread is done with: it must not undo what the robot is told later.
        self.halted.store(false, Ordering::SeqCst);
    }

    fn stopper(&self) -> Stopper {
        let halted = Arc::clone(&self.halted);
        Arc::new(move || halted.store(true, Ordering::SeqCst))
    }

    fn file_changed(&mut self, file: &Path) -> Result<Concern, Problems> {
        if world_file(&self.bridge, &self.folder).as_deref() != Some(file) {
            return Ok(Concern::None);
        }
        let world = read_world(&self.bridge, file)?;
        let parsed = World::parse(&world.text).map_err(|faults| broken_world(&world, FileId(0), &faults))?;
        self.sim.replace_world(parsed);
        self.world = world;
        Ok(Concern::TakenOver)
    }

    fn put_at_start(&mut self) {
        self.sim.put_at_start();
    }
}

impl Simulated {
    fn drive(&mut self, message: &Value) {
        let speed = |field: &str| message.pointer(field).and_then(as_number).unwrap_or(0.0);
        let twist = Twist { linear: speed("/linear/x"), angular: speed("/angular/z") };
        // Not a number: a real base would ignore it too, and its dead-man stops it.
        let _ = self.sim.drive(twist);
    }
}

/// A tenth of a millimetre is enough, and keeps records short.
fn legible(number: f64) -> f64 {
    (number * 1e4).round() / 1e4
}
