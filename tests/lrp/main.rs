//! All integration tests of the package, in one binary.

mod loader;
mod settling;
mod signals;
mod watch;
