//! The machines of a program as they run: commands and inputs go in, records come out.
//! Never looks at the clock, the disk, the terminal or a socket.

mod because;
mod blocks;
mod breakpoints;
mod changes;
pub mod command;
mod conditions;
pub mod engine;
mod faults;
pub mod findings;
mod force;
mod machine;
mod message;
mod met;
mod modules;
mod note;
mod obey;
mod patch;
mod picture;
mod plan;
mod reach;
pub mod record;
mod reuse;
mod robot;
mod store;
pub mod time;
mod why;

pub use command::{BreakAt, Breaking, Command, Explain, OnEdit, OnError, Saves};
pub use engine::{Engine, Input, Options, Reply};
pub use obey::Refused;
pub use record::{Record, What};
pub use time::Time;
