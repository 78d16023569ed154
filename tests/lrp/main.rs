//! All integration tests of the package, in one binary.

mod frames;
mod graph;
mod program;
mod story;
mod syntax;
mod tracer;
mod lua;
mod editor;
mod loader;
mod quiet;
mod settling;
mod signals;
mod terminal;
mod watch;
