//! Orders between the thread that reads them and the bridge's own. A stop overtakes what waits to be sent, and undoes it.

use std::collections::VecDeque;
use std::sync::{Condvar, Mutex, MutexGuard};

use crate::message::Order;

#[derive(Default)]
pub(crate) struct Inbox {
    queue: Mutex<Queue>,
    filled: Condvar,
}

#[derive(Default)]
struct Queue {
    orders: VecDeque<Order>,
    end: Option<End>,
}

/// Why a bridge ends.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum End {
    /// lrp closed the conversation, or is gone.
    Closed,
    /// Some thread of the bridge panicked.
    Panicked,
}

impl Inbox {
    pub fn put(&self, order: Order) {
        let mut queue = self.queue();
        if order == Order::Stop {
            queue.orders.retain(|order| !matches!(order, Order::Send { .. }));
            let connects = queue.orders.iter().rposition(|order| matches!(order, Order::Configure(_)));
            queue.orders.insert(connects.map_or(0, |at| at + 1), order);
        } else {
            queue.orders.push_back(order);
        }
        drop(queue);
        self.filled.notify_one();
    }

    pub fn end(&self, end: End) {
        self.queue().end.get_or_insert(end);
        self.filled.notify_one();
    }

    /// Waits for the next order.
    pub fn take(&self) -> Result<Order, End> {
        let mut queue = self.queue();
        loop {
            if let Some(end) = queue.end {
                return Err(end);
            }
            if let Some(order) = queue.orders.pop_front() {
                return Ok(order);
            }
            queue = self.filled.wait(queue).unwrap_or_else(|poisoned| poisoned.into_inner());
        }
    }

    fn queue(&self) -> MutexGuard<'_, Queue> {
        self.queue.lock().unwrap_or_else(|poisoned| poisoned.into_inner())
    }
}
