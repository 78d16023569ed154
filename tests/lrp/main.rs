//! All integration tests of the package, in one binary.

mod behaviors;
mod docs;
mod editor;
mod frames;
mod graph;
mod keys;
mod loader;
mod lua;
mod quiet;
mod settling;
mod signals;
mod story;
mod syntax;
mod terminal;
mod tracer;
mod view;
mod watch;
