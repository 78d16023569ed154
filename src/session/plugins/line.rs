//! The engine's way to a bridge and back, whichever process speaks for it at the moment. Nothing here waits.

use std::sync::atomic::{AtomicU64, Ordering};
use std::sync::{Arc, Mutex, MutexGuard};

use lrp_bridge::{Item, Order, Orders};

use super::incoming::{Incoming, Said};

#[derive(Default)]
pub struct Line {
    pub incoming: Incoming,
    /// Of the process that is connected; none: what is sent is lost.
    orders: Mutex<Option<Arc<Orders>>>,
    /// Outputs and calls that were lost.
    dropped: AtomicU64,
}

impl Line {
    /// What one step sends; nothing is sent late.
    pub fn send(&self, items: Vec<Item>) {
        let dropped = match &*self.orders() {
            Some(orders) => orders.put(Order::Send { items }),
            None => items,
        };
        self.dropped.fetch_add(dropped.len() as u64, Ordering::Relaxed);
        self.fail_calls(dropped, "the robot isn't there");
    }

    /// Brings the robot to a halt, ahead of all that waits to be sent. From any thread.
    pub fn stop(&self) {
        self.put(Order::Stop);
    }

    /// An order that only means something to a bridge that is connected.
    pub fn put(&self, order: Order) {
        let dropped = self.orders().as_ref().map(|orders| orders.put(order)).unwrap_or_default();
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
        *self.orders() = orders;
    }

    fn orders(&self) -> MutexGuard<'_, Option<Arc<Orders>>> {
        self.orders.lock().unwrap_or_else(|poisoned| poisoned.into_inner())
    }
}
