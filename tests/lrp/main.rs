//! All integration tests of the package, in one binary.

mod bad_input;
mod behaviors;
mod binary;
mod command_line;
mod docs;
mod editor;
mod frames;
mod graph;
mod keys;
mod live;
mod loader;
mod lua;
mod pty;
mod quiet;
mod settling;
mod signals;
mod story;
mod syntax;
mod terminal;
mod tracer;
mod view;
mod watch;
