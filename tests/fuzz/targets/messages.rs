//! Any bytes from the network, as any of ROS's common types: they are read or refused.
#![no_main]

use std::sync::{Arc, LazyLock};

use libfuzzer_sys::fuzz_target;
use lrp_bridge_ros2::cdr::{Order, read, write};
use lrp_bridge_ros2::types::{Registry, Struct, bundled};

static TYPES: LazyLock<Vec<Arc<Struct>>> = LazyLock::new(|| {
    let mut registry = Registry::new(Vec::new());
    // Those of services and actions are in parts, which the rest is made of as well.
    bundled::all().filter_map(|(name, _)| registry.find(name).ok()).collect()
});

fuzz_target!(|input: (u16, bool, &[u8])| {
    let (number, is_big, bytes) = input;
    let kind = &TYPES[usize::from(number) % TYPES.len()];
    let order = if is_big { Order::Big } else { Order::Little };
    if let Ok(message) = read(kind, bytes, order) {
        let again = write(kind, &message, order).expect("what was read can be written");
        assert_eq!(read(kind, &again, order).as_ref(), Ok(&message));
    }
});
