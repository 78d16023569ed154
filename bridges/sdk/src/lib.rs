//! To write a bridge for lrp in Rust. A bridge connects a program to one kind of robot; it runs in a process of its own
//! and talks to lrp in JSON lines (docs/bridges.md has the protocol), so that nothing it does can hold up the program.
//!
//! Implement [`Bridge`], say [`bridge!`]`(MyBridge);` in a library of the crate types `cdylib` and `rlib` whose file is
//! called `liblrp_bridge_KIND.so`, and put that where lrp looks for bridges. Or call [`run`] in a program that is called
//! `lrp-bridge-KIND`.
//!
//! ```
//! use lrp_bridge::{About, Bridge, Description, Form, Peer, Port, Problem, Robot};
//! use serde_json::{Value, json};
//!
//! struct Echo(Robot);
//!
//! impl Bridge for Echo {
//!     fn about() -> About {
//!         About { kind: "echo".into(), summary: "says what it hears".into(), ..About::default() }
//!     }
//!
//!     fn offer(_config: &Value) -> Result<Description, Vec<Problem>> {
//!         let port = |name| Port::new(name, json!({ "data": "" }), "a text");
//!         Ok(Description { inputs: vec![port("heard")], outputs: vec![port("say")], ..Description::default() })
//!     }
//!
//!     fn connect(robot: Robot, _form: Form) -> Echo {
//!         robot.up();
//!         Echo(robot)
//!     }
//!
//!     fn configure(&mut self, _form: Form) {}
//!
//!     fn send(&mut self, _output: &str, message: Value) {
//!         self.0.input("heard", message);
//!     }
//!
//!     fn stop(&mut self) {}
//! }
//!
//! let mut lrp = Peer::of::<Echo>();
//! lrp.configure(json!({}));
//! lrp.until_up();
//! lrp.send("say", json!({ "data": "hello" }));
//! assert_eq!(lrp.input("heard"), json!({ "data": "hello" }));
//! ```

mod message;
mod offer;
mod orders;
mod peer;
mod read;
mod robot;
mod run;
pub mod value;

use serde_json::Value;

pub use message::{Active, Call, Event, Form, Health, Item, Level, Order, Output, Variable};
pub use offer::{About, Argument, Description, Device, Found, Function, Port, Problem, Scope, Setting, Want};
pub use orders::{End, Orders};
pub use peer::Peer;
pub use robot::Robot;
pub use run::{run, run_on};

/// The protocol's version. A bridge and an lrp of different ones don't talk to each other.
pub const PROTOCOL: u32 = 1;

/// One kind of robot. All functions are called on one thread, in the order lrp asked; each must return within
/// milliseconds, so what waits for a robot belongs on a thread of the bridge's own. A bridge that doesn't return for some
/// seconds counts as hung and is started anew.
pub trait Bridge: Sized {
    fn about() -> About;

    /// What would be offered under a configuration, and what is wrong with it. Connects to nothing. What can only be
    /// known from the robot is said later, by [`Robot::offer`].
    fn offer(config: &Value) -> Result<Description, Vec<Problem>>;

    /// Begins to connect; that it worked is said by [`Robot::up`]. The configuration was accepted by `offer`. After
    /// connecting, and after each reconnect, the robot is to be brought to a halt first.
    fn connect(robot: Robot, form: Form) -> Self;

    /// The form was edited, and `offer` accepted it: what differs is to be changed, without reconnecting the rest.
    fn configure(&mut self, form: Form);

    /// Hands a message over to the robot, or drops it where that can't be reached: nothing is sent late.
    fn send(&mut self, output: &str, message: Value);

    /// Begins something that may take its time; [`Robot::reply`] ends it. A device's function is called
    /// `device.function`.
    fn call(&mut self, call: Call) {
        let _ = call;
    }

    /// A call is no longer wanted.
    fn cancel(&mut self, id: u64) {
        let _ = id;
    }

    /// All that a step sends has been handed over.
    fn flush(&mut self) {}

    /// Brings the robot to a halt at once, and cancels what moves it. Called also where lrp is gone, before the end.
    fn stop(&mut self);

    /// What it wants to be told, by [`About::wants`], and answers to [`Robot::set`].
    fn hear(&mut self, news: News) {
        let _ = news;
    }
}

/// What a bridge is told beside outputs and calls.
#[derive(Clone, Debug, PartialEq)]
pub enum News {
    /// Those that changed; the first time all.
    Variables(Vec<Variable>),
    /// All machines that run. `t`: program time, ms.
    States { t: f64, machines: Vec<Active> },
    /// What the program logs; `state`: whose block it was.
    Log { level: Level, message: String, state: Option<String> },
    /// What became of a variable that was to be set; no error: done.
    Answer { id: u64, error: Option<String> },
}

/// Makes a library a bridge: exports what lrp looks for in it.
#[macro_export]
macro_rules! bridge {
    ($bridge:ty) => {
        /// Looked at before anything is called.
        #[unsafe(no_mangle)]
        pub static LRP_BRIDGE_PROTOCOL: u32 = $crate::PROTOCOL;

        /// Speaks for the bridge until lrp is gone; gives the exit code.
        #[unsafe(no_mangle)]
        pub extern "C" fn lrp_bridge_main(input: i32, output: i32) -> i32 {
            $crate::run_on::<$bridge>(input, output)
        }
    };
}
