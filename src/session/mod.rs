//! The engine among threads, files and robots: paces it, feeds it with saves and commands, writes its records down.

pub mod behaviours;
pub mod compile;
pub mod driver;
pub mod edits;
pub mod engine_thread;
pub mod files;
pub mod findings;
pub mod first_program;
pub mod gather;
pub mod headless;
pub mod live;
pub mod loader;
pub mod modules;
pub mod pace;
pub mod plugins;
pub mod robots;
pub mod settled;
pub mod signals;
pub mod test_runner;
pub mod trace;
pub mod warden;
pub mod watch;
pub mod write_back;
