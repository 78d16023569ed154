//! A stand-in for any robot: takes everything, says nothing by itself. For tests, where records tell what it was told.

use std::path::Path;
use std::sync::Arc;

use serde_json::Value;

use super::{Bridge, Concern, Problems, Stopper};
use crate::model;
use crate::model::description::{Description, Scope};
use crate::runtime::Time;
use crate::runtime::record::{BridgeState, Health};

pub struct Fake {
    bridge: model::Bridge,
}

impl Fake {
    pub fn new(bridge: &model::Bridge) -> Fake {
        Fake { bridge: bridge.clone() }
    }
}

impl Bridge for Fake {
    fn description(&self) -> Description {
        let unknown =
            || Description { kind: self.bridge.kind.to_string(), scope: Scope::Open, ..Description::default() };
        super::description(&self.bridge).unwrap_or_else(unknown)
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

    fn send(&mut self, _: &str, _: &Value) {}

    fn stop(&mut self) {}

    fn stopper(&self) -> Stopper {
        Arc::new(|| {})
    }

    fn file_changed(&mut self, _: &Path) -> Result<Concern, Problems> {
        Ok(Concern::None)
    }

    fn put_at_start(&mut self) {}
}
