//! A bridge for robots on a serial port, which speak in lines of text or in Firmata. Data flows from the port
//! (`visit`) through a codec, which knows bytes and messages only, to lrp; what is sent goes through the codec to the
//! wire, on the bridge's own thread.

pub mod codec;
mod complaints;
pub mod firmata;
pub mod lines;
mod port;
mod read;
pub mod settings;
mod shared;
mod visit;
mod wire;

use std::sync::Arc;
use std::thread::{Builder, JoinHandle};

use lrp_bridge::{About, Bridge, Call, Description, Form, Problem, Robot};
use serde_json::Value;

use crate::settings::Settings;
use crate::shared::Shared;

pub struct Serial {
    shared: Arc<Shared>,
    visits: Option<JoinHandle<()>>,
}

lrp_bridge::bridge!(Serial);

impl Bridge for Serial {
    fn about() -> About {
        About {
            kind: "serial".into(),
            version: env!("CARGO_PKG_VERSION").into(),
            summary: "robots on a serial port, as an Arduino: lines of text, or Firmata".into(),
            settings: settings::described(),
            ..About::default()
        }
    }

    fn offer(config: &Value) -> Result<Description, Vec<Problem>> {
        Ok(Settings::read(config)?.protocol.codec().offer())
    }

    fn connect(robot: Robot, form: Form) -> Serial {
        // `offer` accepted it, so there are settings.
        let settings = Settings::read(&form.config).unwrap_or_default();
        let shared = Arc::new(Shared::new(settings, robot));
        let visited = Arc::clone(&shared);
        let visits = Builder::new().name("port".into()).spawn(move || visit::all(&visited));
        if let Err(error) = &visits {
            shared.robot.lost(format!("the port's thread can't be started: {error}"));
        }
        Serial { shared, visits: visits.ok() }
    }

    fn configure(&mut self, form: Form) {
        if let Ok(settings) = Settings::read(&form.config) {
            self.shared.configure(settings);
        }
    }

    fn send(&mut self, output: &str, message: Value) {
        self.shared.send(output, &message);
    }

    fn call(&mut self, call: Call) {
        self.shared.call(&call);
    }

    fn cancel(&mut self, id: u64) {
        self.shared.cancel(id);
    }

    fn flush(&mut self) {
        self.shared.flush();
    }

    fn stop(&mut self) {
        self.shared.stop();
    }
}

/// What was handed over last, as a stop, still goes out.
impl Drop for Serial {
    fn drop(&mut self) {
        self.shared.end();
        if let Some(visits) = self.visits.take() {
            let _ = visits.join();
        }
    }
}
