//! The machines of a program as they run: commands and inputs go in, records come out.
//! Never looks at the clock, the disk, the terminal or a socket.

pub mod command;
pub mod record;
pub mod time;

pub use command::Command;
pub use record::{Record, What};
pub use time::Time;
