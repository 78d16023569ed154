//! A stand-in for any robot: takes everything, says nothing by itself. For tests, where records tell what it was told.

use std::sync::Arc;

use lrp_bridge::{Item, Scope};
use serde_json::Value;

use super::{Bridge, Stopper};
use crate::model::{self, Description};
use crate::runtime::Time;
use crate::runtime::record::{BridgeState, Health};
use crate::session::plugins::Plugins;

pub struct Fake {
    bridge: model::Bridge,
    description: Description,
}

impl Fake {
    pub fn new(bridge: &model::Bridge, plugins: &Plugins) -> Fake {
        let unknown = || Description { scope: Scope::Open, ..Description::default() };
        let description = super::description(bridge, plugins).unwrap_or_else(unknown);
        Fake { bridge: bridge.clone(), description }
    }
}

impl Bridge for Fake {
    fn description(&self) -> Description {
        self.description.clone()
    }

    fn state(&self) -> BridgeState {
        let (bridge, kind) = (self.bridge.name.clone(), self.bridge.kind.clone());
        BridgeState { bridge, kind, state: Health::Up, message: Some("a stand-in".to_string()), world: None }
    }

    fn stale(&self) -> Option<Time> {
        self.bridge.config.get("stale").and_then(Value::as_f64).map(Time::from_ms)
    }

    fn advance(&mut self, _: Time) {}

    fn sample(&mut self) -> Vec<(Arc<str>, Value)> {
        Vec::new()
    }

    fn send(&mut self, _: Vec<Item>) {}

    fn stop(&mut self) {}

    fn stopper(&self) -> Stopper {
        Arc::new(|| {})
    }
}
