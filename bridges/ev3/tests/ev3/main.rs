//! Tests of the bridge from the outside: a fake brick on one side, lrp's words on the other.

mod faults;
mod forms;
mod frames;
mod peer;
mod program;
mod search;
