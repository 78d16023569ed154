//! lrp's bridge to Lego Mindstorms EV3 bricks, over the network. The bridge's thread reads calls and puts them on a desk; the
//! brick's thread takes them from there, and alone talks to the brick.

pub mod command;
mod desk;
pub mod discovery;
mod driver;
pub mod frame;
mod inputs;
pub mod link;
pub mod motor;
mod moves;
mod offer;
pub mod orders;
pub mod poll;
pub mod sensor;
pub mod settings;
mod visit;

use std::sync::Arc;
use std::thread::Builder;

use lrp_bridge::{About, Bridge, Call, Description, Form, Problem, Robot};
use serde_json::Value;

use crate::desk::{Desk, Job};
use crate::driver::Driver;
use crate::settings::Settings;

lrp_bridge::bridge!(Ev3);

pub struct Ev3 {
    robot: Robot,
    desk: Arc<Desk>,
    settings: Settings,
}

impl Bridge for Ev3 {
    fn about() -> About {
        About {
            kind: "ev3".to_string(),
            version: env!("CARGO_PKG_VERSION").to_string(),
            summary: "Lego Mindstorms EV3 bricks, over the network".to_string(),
            settings: settings::described(),
            wants: Vec::new(),
        }
    }

    fn offer(config: &Value) -> Result<Description, Vec<Problem>> {
        Settings::read(config).map(|_| offer::description())
    }

    fn connect(robot: Robot, form: Form) -> Ev3 {
        let settings = accepted(&form);
        let desk = Arc::new(Desk::new(settings.clone()));
        let driver = Driver::new(Arc::clone(&desk), robot.clone());
        if let Err(error) = Builder::new().name("brick".into()).spawn(|| driver.run()) {
            robot.lost(format!("no thread for the brick: {error}"));
        }
        Ev3 { robot, desk, settings }
    }

    fn configure(&mut self, form: Form) {
        self.settings = accepted(&form);
        self.desk.settle(self.settings.clone());
    }

    fn send(&mut self, _output: &str, _message: Value) {}

    fn call(&mut self, call: Call) {
        let deed = orders::read(&call.call, &call.arguments, &self.settings);
        let put = deed.and_then(|deed| self.desk.put(Job { id: call.id, deed }).map_err(str::to_string));
        if let Err(problem) = put {
            self.robot.reply(call.id, Err(problem));
        }
    }

    fn cancel(&mut self, id: u64) {
        if self.desk.cancel(id) {
            self.robot.reply(id, Err("cancelled".to_string()));
        }
    }

    fn stop(&mut self) {
        for undone in self.desk.halt() {
            self.robot.reply(undone.id, Err("stopped".to_string()));
        }
    }
}

impl Drop for Ev3 {
    fn drop(&mut self) {
        self.desk.close();
    }
}

/// The settings of a form that `offer` has accepted.
fn accepted(form: &Form) -> Settings {
    Settings::read(&form.config).expect("a configuration that was accepted")
}
