//! Orders on their way from one thread to another, on either side of the conversation. A stop overtakes what waits to be
//! sent, and undoes it; of what nobody takes in time the oldest is dropped, since old orders must not drive.

use std::collections::VecDeque;
use std::sync::{Condvar, Mutex, MutexGuard};

use crate::message::Order;

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
    /// Gives how many outputs and calls were dropped for it.
    pub fn put(&self, order: Order) -> usize {
        let mut queue = self.queue();
        let mut dropped = 0;
        match order {
            Order::Stop => {
                queue.orders.retain(|order| !matches!(order, Order::Send { .. }));
                queue.sends = 0;
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

    fn queue(&self) -> MutexGuard<'_, Queue> {
        self.queue.lock().unwrap_or_else(|poisoned| poisoned.into_inner())
    }
}

impl Queue {
    fn drop_oldest(&mut self) -> usize {
        let oldest = self.orders.iter().position(|order| matches!(order, Order::Send { .. }));
        match oldest.and_then(|at| self.orders.remove(at)) {
            Some(Order::Send { items }) => {
                self.sends -= 1;
                items.len()
            }
            _ => 0,
        }
    }
}
