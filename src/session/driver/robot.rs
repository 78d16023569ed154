//! A robot of the program that runs: its form, the bridge to it, and what is heard from there.

use std::sync::Arc;

use crate::model;
use crate::runtime::record::{BridgeState, Level, Log};
use crate::runtime::{Engine, Input, Reply, What};
use crate::session::plugins::Said;
use crate::session::robots::{Bridge, Fit};

pub struct Robot {
    /// It has come up, and knows nothing of the program yet.
    pub uninformed: bool,
    pub form: model::Bridge,
    /// None: it couldn't be made; what is sent to it is lost.
    pub bridge: Option<Box<dyn Bridge>>,
}

impl Robot {
    /// Whether it goes on under a form that was edited.
    pub fn goes_on_as(&mut self, form: &model::Bridge) -> bool {
        match &mut self.bridge {
            None => false,
            Some(_) if same_form(&self.form, form) => true,
            Some(bridge) => self.form.name == form.name && bridge.configure(form) == Fit::Kept,
        }
    }

    pub fn halting_on_pause(&mut self) -> Option<&mut Box<dyn Bridge>> {
        self.bridge.as_mut().filter(|bridge| bridge.stops_on_pause())
    }
}

/// What a robot said beside messages; replies wait for the next step.
pub fn hear(engine: &mut Engine, replies: &mut Vec<Reply>, form: &model::Bridge, bridge: &dyn Bridge, said: Said) {
    match said {
        Said::State { state, message } => {
            engine.say(What::Bridge(BridgeState { state, message, ..bridge.state() }));
        }
        Said::Offer(description) => {
            engine.describe(&form.name, &description, bridge.stale());
            engine.say(What::Offer { bridge: form.name.clone(), description: Box::new(description) });
        }
        Said::Problems(problems) => {
            for problem in problems {
                let help = problem.help.map_or(String::new(), |help| format!("; {help}"));
                engine.say(log(form, Level::Error, format!("{}{help}", problem.message), None));
            }
        }
        Said::Reply { id, name, done, value, error } => {
            replies.push(Reply { bridge: form.name.clone(), name, id, done, value, error });
        }
        Said::Log { level, message, from } => engine.say(log(form, level, message, from.as_deref())),
        Said::Found(found) => engine.say(What::Found { bridge: form.name.clone(), found }),
        Said::Set { .. } => {}
    }
}

/// Written by a robot, or by a part of it.
fn log(form: &model::Bridge, level: Level, message: String, from: Option<&str>) -> What {
    let state = match from {
        Some(from) => format!("{}:{from}", form.name).into(),
        None => form.name.clone(),
    };
    What::Log(Log { level, message, state, file: Arc::default(), line: 0 })
}

/// What a robot has said since it was last asked.
pub fn messages(name: &Arc<str>, bridge: &mut dyn Bridge) -> Vec<Input> {
    let said = bridge.sample().into_iter();
    said.map(|(input, value)| Input { bridge: Arc::clone(name), name: input, value }).collect()
}

fn same_form(a: &model::Bridge, b: &model::Bridge) -> bool {
    a.name == b.name && a.kind == b.kind && a.config == b.config
}
