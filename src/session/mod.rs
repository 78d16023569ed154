//! Where the program meets the operating system: files, signals, threads. Knows nothing of the screen.

pub mod loader;
pub mod signals;
pub mod watch;
