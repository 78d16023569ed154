//! Any text as the definition of a type of ROS, which is then used.
#![no_main]

use libfuzzer_sys::fuzz_target;
use lrp_bridge_ros2::cdr::{Order, read, write};
use lrp_bridge_ros2::types::{Registry, parse};

fuzz_target!(|text: &str| {
    let Ok(definitions) = parse::parts(text, "p") else { return };
    let mut registry = Registry::new(Vec::new());
    let named = definitions.into_iter().enumerate().map(|(at, definition)| (format!("p/msg/T{at}"), definition));
    registry.learn(named);
    let Ok(kind) = registry.find("p/msg/T0") else { return };
    let message = kind.blank();
    // A default may be more than its own bounds allow.
    if let Ok(bytes) = write(&kind, &message, Order::Little) {
        read(&kind, &bytes, Order::Little).expect("what was written can be read");
    }
});
