//! A bridge between a fake brick and a test that speaks as lrp does.

use std::time::{Duration, Instant};

use lrp_bridge::{Event, Order, Peer};
use lrp_bridge_ev3::Ev3;
use lrp_fake_ev3::Brick;
use serde_json::{Value, json};

/// How long something may take that is to happen at the brick.
const PATIENCE: Duration = Duration::from_secs(10);

pub struct Robot {
    pub brick: Brick,
    pub lrp: Peer,
}

impl Robot {
    /// Connected by its address; `config`: what else the form says.
    pub fn connected(config: Value) -> Robot {
        let mut robot = Robot::new(Brick::start(0), config);
        robot.lrp.until_up();
        robot
    }

    pub fn new(brick: Brick, mut config: Value) -> Robot {
        config["address"] = json!(brick.address.to_string());
        let mut lrp = Peer::of::<Ev3>();
        lrp.configure(config);
        Robot { brick, lrp }
    }

    /// Calls and waits for what becomes of it.
    pub fn call(&mut self, name: &str, arguments: Value) -> Result<Value, String> {
        let call = self.begin(name, arguments);
        self.lrp.reply(call)
    }

    pub fn begin(&mut self, name: &str, arguments: Value) -> u64 {
        self.lrp.call(name, arguments.as_array().expect("a list of arguments").clone())
    }

    pub fn stop(&mut self) {
        self.lrp.order(Order::Stop);
        self.lrp.until("`stopped`", |event| (*event == Event::Stopped).then_some(()));
    }

    pub fn speed(&self, motor: usize) -> f64 {
        self.brick.state().machine.motors[motor].speed
    }

    pub fn is_still(&self) -> bool {
        let mut state = self.brick.state();
        state.machine.pass();
        !state.machine.motors.iter().any(|motor| motor.is_turning())
    }

    /// The operations of all frames so far that aren't readings of everything.
    pub fn operations(&self) -> Vec<String> {
        let state = self.brick.state();
        let ops = state.frames.iter().map(|(_, frame)| hex(&frame[5..]));
        ops.filter(|ops| !ops.starts_with("9905")).collect()
    }
}

impl Drop for Robot {
    fn drop(&mut self) {
        self.brick.end();
    }
}

pub fn hex(bytes: &[u8]) -> String {
    bytes.iter().map(|byte| format!("{byte:02x}")).collect()
}

pub fn eventually(what: &str, holds: impl Fn() -> bool) {
    let end = Instant::now() + PATIENCE;
    while !holds() {
        assert!(Instant::now() < end, "{what}: not in time");
        std::thread::sleep(Duration::from_millis(2));
    }
}
