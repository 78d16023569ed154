//! The engine's way to a bridge and back, whichever process speaks for it at the moment. Nothing here waits, unless that is
//! what it is asked for.

use std::sync::atomic::{AtomicU64, Ordering};
use std::sync::{Arc, Condvar, Mutex, MutexGuard};
use std::time::Instant;

use lrp_bridge::{Item, Order, Orders};

use super::incoming::{Incoming, Said};
use crate::session::robots::Halt;

#[derive(Default)]
pub struct Line {
    pub incoming: Incoming,
    way: Mutex<Way>,
    answered: Condvar,
    /// Outputs and calls that were lost.
    dropped: AtomicU64,
}

#[derive(Default)]
struct Way {
    /// Of the process that is connected; none: what is sent is lost.
    orders: Option<Arc<Orders>>,
    /// Stops that it hasn't answered yet.
    stops: u32,
    /// The robot is to stay where it is, whatever is sent.
    held: bool,
}

impl Line {
    /// What one step sends; nothing is sent late.
    pub fn send(&self, items: Vec<Item>) {
        let way = self.way();
        if way.held {
            drop(way);
            return self.fail_calls(items, "the robot was stopped");
        }
        let dropped = match &way.orders {
            Some(orders) => orders.put(Order::Send { items }),
            None => items,
        };
        drop(way);
        self.dropped.fetch_add(dropped.len() as u64, Ordering::Relaxed);
        self.fail_calls(dropped, "the robot isn't there");
    }

    /// An order that only means something to a bridge that is connected.
    pub fn put(&self, order: Order) {
        let mut way = self.way();
        let is_stop = order == Order::Stop;
        let Some(orders) = &way.orders else { return };
        let dropped = orders.put(order);
        way.stops += u32::from(is_stop);
        drop(way);
        self.fail_calls(dropped, "the robot was stopped");
    }

    fn fail_calls(&self, items: Vec<Item>, why: &str) {
        for item in items {
            if let Item::Call(call) = item {
                self.incoming.say(Said::failed(call.id, why));
            }
        }
    }

    /// How many outputs and calls were lost since this was last asked.
    pub fn take_dropped(&self) -> u64 {
        self.dropped.swap(0, Ordering::Relaxed)
    }

    pub(super) fn connect(&self, orders: Option<Arc<Orders>>) {
        let mut way = self.way();
        (way.orders, way.stops) = (orders, 0);
        self.answered.notify_all();
    }

    /// The bridge says that it has stopped its robot.
    pub(super) fn stopped(&self) {
        let mut way = self.way();
        way.stops = way.stops.saturating_sub(1);
        self.answered.notify_all();
    }

    fn way(&self) -> MutexGuard<'_, Way> {
        self.way.lock().unwrap_or_else(|poisoned| poisoned.into_inner())
    }
}

impl Halt for Line {
    /// Ahead of all that waits to be sent.
    fn halt(&self) {
        self.put(Order::Stop);
    }

    fn hold(&self) {
        self.way().held = true;
        self.halt();
    }

    fn wait(&self, until: Instant) {
        let left = until.saturating_duration_since(Instant::now());
        // Whether it answered or not: there is no more to be done.
        let _ = self.answered.wait_timeout_while(self.way(), left, |way| way.stops > 0);
    }

    fn release(&self) {
        self.way().held = false;
    }
}
