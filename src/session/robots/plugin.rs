//! A plugin as a robot of the program: the engine's side of a bridge that lives in a process of its own.

use std::collections::BTreeMap;
use std::path::{Path, PathBuf};
use std::sync::Arc;
use std::thread::JoinHandle;
use std::time::{Duration, Instant};

use lrp_bridge::{Form, Item, Level, Order, Scope, Want};
use serde_json::{Value, json};

use super::{Bridge, Fit, Halt, Offered, Problems, Stopper, problem};
use crate::model::{self, Description};
use crate::runtime::Time;
use crate::runtime::record::{BridgeState, Health};
use crate::session::plugins::{Answer, Keeper, Plugins, Said};
use crate::syntax::{Code, Diagnostic, Span};

/// Settings that every bridge has: lrp itself goes by them, the plugin isn't told.
const OWN: &[&str] = &["stale", "stop_on_pause"];
/// Losses are told no more often than that.
const TELL_LOSSES: Duration = Duration::from_secs(5);

pub struct Connected {
    bridge: model::Bridge,
    folder: PathBuf,
    keeper: Keeper,
    wants: Vec<Want>,
    description: Description,
    state: Health,
    message: Option<String>,
    /// Calls that are not over, by id.
    calls: BTreeMap<u64, Arc<str>>,
    /// Outputs and calls that were lost, and when that was last told.
    lost: (u64, Option<Instant>),
}

impl Connected {
    pub fn new(bridge: &model::Bridge, folder: &Path, plugins: &Plugins) -> Result<Connected, Problems> {
        let form = form(bridge, folder);
        let keeper = Keeper::start(plugins.clone(), bridge.kind.to_string(), form)
            .map_err(|error| problem(bridge.span, format!("`{}` can't be started: {error}", bridge.kind)))?;
        let known = known(bridge, plugins);
        // What it offers is told by itself in a moment; until then nothing counts as misspelt.
        let open = || Description { scope: Scope::Open, ..Description::default() };
        let (wants, description) = known.map_or_else(|| (Vec::new(), open()), |it| (it.about.wants, it.description));
        Ok(Connected {
            bridge: bridge.clone(),
            folder: folder.to_path_buf(),
            keeper,
            wants,
            description,
            state: Health::Connecting,
            message: None,
            calls: BTreeMap::new(),
            lost: (0, None),
        })
    }

    /// None: nobody asked for it.
    fn take(&mut self, mut said: Said) -> Option<Said> {
        match &mut said {
            Said::State { state, message } => (self.state, self.message) = (*state, message.clone()),
            Said::Offer(description) => self.description = description.clone(),
            Said::Reply { id, name, done: true, .. } => *name = self.calls.remove(id)?,
            Said::Reply { id, name, done: false, .. } => *name = Arc::clone(self.calls.get(id)?),
            _ => {}
        }
        Some(said)
    }

    fn tell_losses(&mut self, all: &mut Vec<Said>) {
        let (lost, told) = &mut self.lost;
        *lost += self.keeper.line().take_dropped();
        if *lost > 0 && told.is_none_or(|told| told.elapsed() >= TELL_LOSSES) {
            let message = format!("{lost} outputs and calls were dropped, as the robot isn't there to take them");
            all.push(Said::Log { level: Level::Warn, message, from: None });
            self.lost = (0, Some(Instant::now()));
        }
    }
}

impl Bridge for Connected {
    fn description(&self) -> Description {
        self.description.clone()
    }

    fn state(&self) -> BridgeState {
        let (bridge, kind) = (self.bridge.name.clone(), self.bridge.kind.clone());
        BridgeState { bridge, kind, state: self.state, message: self.message.clone(), world: None }
    }

    fn stale(&self) -> Option<Time> {
        self.bridge.config.get("stale").and_then(Value::as_f64).map(Time::from_ms)
    }

    fn advance(&mut self, _: Time) {}

    fn sample(&mut self) -> Vec<(Arc<str>, Value)> {
        let mut inputs = self.keeper.line().incoming.take_inputs();
        if self.description.scope == Scope::Closed {
            // What isn't offered can't be read; to tell blocks of it would only take time.
            inputs.retain(|(name, _)| self.description.input(name).is_some());
        }
        inputs.into_iter().map(|(name, value)| (name.into(), value)).collect()
    }

    fn listen(&mut self) -> Vec<Said> {
        let (said, dropped) = self.keeper.line().incoming.take_said();
        let was = self.state;
        let mut all: Vec<Said> = said.into_iter().filter_map(|said| self.take(said)).collect();
        if was == Health::Up && self.state != Health::Up {
            // Calls don't outlive the connection.
            let ids: Vec<u64> = self.calls.keys().copied().collect();
            all.extend(ids.into_iter().filter_map(|id| self.take(Said::failed(id, "the robot was lost"))));
        }
        if dropped > 0 {
            let message = format!("{dropped} things that the bridge said were lost, as they came too fast");
            all.push(Said::Log { level: Level::Warn, message, from: None });
        }
        self.tell_losses(&mut all);
        all
    }

    fn send(&mut self, items: Vec<Item>) {
        for item in &items {
            if let Item::Call(call) = item {
                self.calls.insert(call.id, call.call.as_str().into());
            }
        }
        self.keeper.line().send(items);
    }

    fn cancel(&mut self, id: u64) {
        self.keeper.line().put(Order::Cancel { id });
    }

    fn stop(&mut self) {
        self.keeper.line().halt();
    }

    fn stopper(&self) -> Stopper {
        Arc::clone(self.keeper.line()) as Stopper
    }

    fn stops_on_pause(&self) -> bool {
        self.bridge.config.get("stop_on_pause") == Some(&Value::Bool(true))
    }

    fn configure(&mut self, form: &model::Bridge) -> Fit {
        if form.kind != self.bridge.kind || form.name != self.bridge.name {
            return Fit::Anew;
        }
        let sent = self::form(form, &self.folder);
        if sent.config != self::form(&self.bridge, &self.folder).config {
            self.keeper.configure(sent);
        }
        self.bridge = form.clone();
        Fit::Kept
    }

    fn time(&self) -> Option<Duration> {
        let ms = self.keeper.line().incoming.robots_time()?;
        Duration::try_from_secs_f64(ms / 1e3).ok()
    }

    fn is_heard_early(&self) -> bool {
        true
    }

    fn is_ready(&self) -> bool {
        self.state == Health::Up
    }

    fn wants(&self) -> &[Want] {
        &self.wants
    }

    fn tell(&mut self, order: Order) {
        self.keeper.line().put(order);
    }

    fn part(self: Box<Self>) -> Option<JoinHandle<()>> {
        self.keeper.end()
    }
}

fn form(bridge: &model::Bridge, folder: &Path) -> Form {
    Form { name: bridge.name.to_string(), config: config(bridge), folder: folder.to_path_buf() }
}

/// What the plugin is told of the form.
fn config(bridge: &model::Bridge) -> Value {
    let mut config = bridge.config.clone();
    match &mut config {
        Value::Object(keys) => keys.retain(|key, _| !OWN.contains(&key.as_str())),
        // Lua's empty table.
        other => *other = json!({}),
    }
    config
}

/// What a plugin said of a form when it was last asked.
pub fn known(bridge: &model::Bridge, plugins: &Plugins) -> Option<Answer> {
    plugins.known(&bridge.kind, &config(bridge)).and_then(Result::ok)
}

/// Asks it. `text`: the form as it is written, to find the place of what is wrong.
pub fn offered(bridge: &model::Bridge, text: &str, plugins: &Plugins) -> Offered {
    match plugins.ask(&bridge.kind, &config(bridge)) {
        // There is no such plugin: told when the robot is to be made.
        None => Offered::default(),
        Some(Err(why)) => {
            let message = format!("the bridge `{}` doesn't say what it offers: {why}", bridge.kind);
            Offered { description: None, findings: vec![Diagnostic::error(Code::BadBridge, bridge.span, message)] }
        }
        Some(Ok(answer)) => {
            let finding = |problem: &lrp_bridge::Problem| {
                let span = place(bridge.span, text, problem.key.as_deref());
                let finding = Diagnostic::error(Code::BadBridge, span, problem.message.clone());
                Diagnostic { help: problem.help.clone(), ..finding }
            };
            let findings: Vec<_> = answer.problems.iter().map(finding).collect();
            let description = findings.is_empty().then_some(answer.description);
            Offered { description, findings }
        }
    }
}

/// The last part of a key in the form's text, else the form as a whole.
fn place(form: Span, text: &str, key: Option<&str>) -> Span {
    let found = key.and_then(|key| {
        let part = key.rsplit('.').next()?;
        let is_word = |at: usize| {
            let word = |c: char| c.is_alphanumeric() || c == '_';
            !text[..at].ends_with(word) && !text[at + part.len()..].starts_with(word)
        };
        let at = text.match_indices(part).map(|(at, _)| at).find(|&at| is_word(at))?;
        Some(Span::new(form.file, form.start as usize + at, form.start as usize + at + part.len()))
    });
    found.unwrap_or(form)
}
