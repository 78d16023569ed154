//! Variables: made, looked at, compared, set from outside. Knows nothing of blocks.

use serde_json::Value;

use super::fingerprint::Fingerprint;
use super::{Cell, Lua, Slot};

impl Lua {
    /// A new variable, nil.
    pub fn cell(&mut self) -> Cell {
        let slot = self.unlimited(|lua| lua.stack.make_cell());
        self.note_slot(slot, Slot::Variable { seen: Fingerprint::NIL, name: None });
        Cell(slot)
    }

    /// Gives a variable up; its number may be used again. Blocks that use it keep it until they are freed.
    pub fn free_cell(&mut self, cell: Cell) {
        self.note_slot(cell.0, Slot::Empty);
        self.stack.release(cell.0);
    }

    /// A variable's value, for display.
    ///
    /// Integers and floats as such, nan and infinities as strings; functions, threads and userdata as `{"lua":"function"}`; a table with the keys 1..n as
    /// an array, others as an object, keys sorted; to four levels and about 1 KB, `"cut"` says how many entries were left out.
    pub fn get(&self, cell: Cell) -> Value {
        self.stack.value(cell.0)
    }

    /// Gives a variable a value.
    pub fn set(&mut self, cell: Cell, value: &Value) {
        self.unlimited(|lua| lua.stack.set(cell.0, value));
    }

    /// Makes a variable nil.
    pub fn clear(&mut self, cell: Cell) {
        self.stack.set(cell.0, &Value::Null);
    }

    /// Whether a variable has changed since this was last called for it; at first, since it was nil. A table's order
    /// doesn't count, nor what is more than four levels deep.
    #[inline]
    pub fn changed(&mut self, cell: Cell) -> bool {
        let now = self.stack.fingerprint(cell.0);
        match &mut self.slots[cell.0 as usize] {
            Slot::Variable { seen, .. } => std::mem::replace(seen, now) != now,
            _ => false,
        }
    }

    /// A variable's value, if it is a number.
    #[inline]
    pub fn number_in(&self, cell: Cell) -> Option<f64> {
        self.stack.number(cell.0)
    }
}
