//! Orders on their way from one thread to another, on either side of the conversation. A stop overtakes what waits to be
//! sent, and undoes it; of what nobody takes in time the oldest is dropped, since old orders must not drive.

use std::collections::VecDeque;
use std::sync::{Condvar, Mutex, MutexGuard};
use std::time::Duration;

use crate::message::{Item, Order};

/// Steps whose outputs may wait.
const WAITING: usize = 256;

#[derive(Default)]
pub struct Orders {
    queue: Mutex<Queue>,
    filled: Condvar,
}

#[derive(Default)]
struct Queue {
    orders: VecDeque<Order>,
    /// Of those, outputs of a step.
    sends: usize,
    end: Option<End>,
}

/// Why there are no more orders.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum End {
    /// lrp closed the conversation, or is gone.
    Closed,
    /// Some thread of the bridge panicked.
    Panicked,
}

impl Orders {
    /// Gives what is dropped for it: outputs that never arrive, calls that are over before they began.
    pub fn put(&self, order: Order) -> Vec<Item> {
        let mut queue = self.queue();
        let mut dropped = Vec::new();
        match order {
            Order::Stop => {
                while queue.sends > 0 {
                    dropped.append(&mut queue.drop_oldest());
                }
                let connects = queue.orders.iter().rposition(|order| matches!(order, Order::Configure(_)));
                queue.orders.insert(connects.map_or(0, |at| at + 1), order);
            }
            Order::Send { .. } => {
                if queue.sends >= WAITING {
                    dropped = queue.drop_oldest();
                }
                queue.sends += 1;
                queue.orders.push_back(order);
            }
            order => queue.orders.push_back(order),
        }
        drop(queue);
        self.filled.notify_one();
        dropped
    }

    pub fn end(&self, end: End) {
        self.queue().end.get_or_insert(end);
        self.filled.notify_one();
    }

    /// Waits for the next order; after the end there is none, whatever was put before.
    pub fn take(&self) -> Result<Order, End> {
        let mut queue = self.queue();
        loop {
            if let Some(end) = queue.end {
                return Err(end);
            }
            if let Some(order) = queue.orders.pop_front() {
                queue.sends -= usize::from(matches!(order, Order::Send { .. }));
                return Ok(order);
            }
            queue = self.filled.wait(queue).unwrap_or_else(|poisoned| poisoned.into_inner());
        }
    }

    /// The same, but waits no longer than that for something to come; none: nothing did.
    pub(crate) fn take_within(&self, patience: Duration) -> Option<Result<Order, End>> {
        let waits = |queue: &mut Queue| queue.end.is_none() && queue.orders.is_empty();
        let waited = self.filled.wait_timeout_while(self.queue(), patience, waits);
        let came = !waited.unwrap_or_else(|poisoned| poisoned.into_inner()).1.timed_out();
        came.then(|| self.take())
    }

    fn queue(&self) -> MutexGuard<'_, Queue> {
        self.queue.lock().unwrap_or_else(|poisoned| poisoned.into_inner())
    }
}

impl Queue {
    /// Of what waits to be sent.
    fn drop_oldest(&mut self) -> Vec<Item> {
        let oldest = self.orders.iter().position(|order| matches!(order, Order::Send { .. }));
        self.sends = self.sends.saturating_sub(1);
        match oldest.and_then(|at| self.orders.remove(at)) {
            Some(Order::Send { items }) => items,
            _ => Vec::new(),
        }
    }
}
