//! All integration tests of the package, in one binary.

mod frames;
mod graph;
mod story;
mod view;
mod keys;
mod tracer;
mod lua;
mod editor;
mod loader;
mod quiet;
mod settling;
mod signals;
mod terminal;
mod watch;
