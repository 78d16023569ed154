//! The engine's way to a bridge and back, whichever process speaks for it at the moment. Nothing here waits.

use std::sync::atomic::{AtomicU64, Ordering};
use std::sync::{Arc, Mutex, MutexGuard};

use lrp_bridge::{Item, Order, Orders};

use super::incoming::Incoming;

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
        let count = items.len();
        let dropped = match &*self.orders() {
            Some(orders) => orders.put(Order::Send { items }),
            None => count,
        };
        self.dropped.fetch_add(dropped as u64, Ordering::Relaxed);
    }

    /// Brings the robot to a halt, ahead of all that waits to be sent. From any thread.
    pub fn stop(&self) {
        self.put(Order::Stop);
    }

    /// An order that only means something to a bridge that is connected.
    pub fn put(&self, order: Order) {
        if let Some(orders) = &*self.orders() {
            orders.put(order);
        }
    }

    pub fn is_connected(&self) -> bool {
        self.orders().is_some()
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
