//! Messages as they travel (CDR, version 1) to JSON and back, walking over a type that is known at run time only.

mod read;
mod write;

pub use read::{Malformed, read};
pub use write::{Mismatch, write};

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Order {
    Little,
    Big,
}
