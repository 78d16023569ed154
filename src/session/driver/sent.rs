//! What a step or a command has for robots, on its way from the engine's records to them.

use std::sync::Arc;

use lrp_bridge::Item;

use super::robot::Robot;

/// Something for a robot: its name, and what.
pub type Sent = (Arc<str>, Item);

#[derive(Clone, Copy)]
pub enum Delivery {
    Now,
    Held,
}

impl Delivery {
    /// Where it is put.
    pub fn of<'a>(self, now: &'a mut Vec<Sent>, held: &'a mut Vec<Sent>) -> &'a mut Vec<Sent> {
        match self {
            Delivery::Now => now,
            Delivery::Held => held,
        }
    }
}

/// What is sent together leaves together, in order.
pub fn send(robots: &mut [Robot], all: Vec<Sent>) {
    if all.is_empty() {
        return;
    }
    for robot in robots {
        let own: Vec<Item> =
            all.iter().filter(|(name, _)| *name == robot.form.name).map(|(_, item)| item.clone()).collect();
        if let (Some(bridge), false) = (&mut robot.bridge, own.is_empty()) {
            bridge.send(own);
        }
    }
}

/// A call that hasn't left yet never does.
pub fn cancel(robots: &mut [Robot], unsent: &mut [&mut Vec<Sent>], robot: &str, id: u64) {
    let is_it = |(name, item): &Sent| **name == *robot && matches!(item, Item::Call(call) if call.id == id);
    for sent in unsent {
        sent.retain(|sent| !is_it(sent));
    }
    let robot = robots.iter_mut().find(|known| &*known.form.name == robot);
    if let Some(bridge) = robot.and_then(|robot| robot.bridge.as_mut()) {
        bridge.cancel(id);
    }
}
