//! What a person chose of the layout: it stays, whatever becomes of the terminal's size.

use std::collections::{BTreeMap, BTreeSet};

use super::Pane;
use super::place::{Border, Divide, allowed};

#[derive(Clone, Debug, Default, PartialEq)]
pub struct Chosen {
    hidden: BTreeSet<Pane>,
    /// The part of the whole that the first side of a border has.
    shares: BTreeMap<Divide, f64>,
}

/// Where a border goes to from where it is.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Way {
    /// To the left, or up.
    Back,
    /// To the right, or down.
    On,
}

impl Way {
    pub fn back(self) -> Way {
        match self {
            Way::Back => Way::On,
            Way::On => Way::Back,
        }
    }
}

impl Chosen {
    pub fn hides(&self, pane: Pane) -> bool {
        self.hidden.contains(&pane)
    }

    pub fn hide(&mut self, pane: Pane) {
        self.hidden.insert(pane);
    }

    pub fn show(&mut self, pane: Pane) {
        self.hidden.remove(&pane);
    }

    pub fn share(&self, divide: Divide) -> Option<f64> {
        self.shares.get(&divide).copied()
    }

    /// So that the first side has this many cells, as nearly as can be.
    pub fn move_border(&mut self, border: &Border, first: i32) {
        let whole = border.length();
        let first = allowed(border.axis, first, whole);
        self.shares.insert(border.divide, f64::from(first) / f64::from(whole.max(1)));
    }
}
