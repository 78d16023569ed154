//! All integration tests of the package, in one binary.

mod editor;
mod frames;
mod graph;
mod loader;
mod lua;
mod program;
mod quiet;
mod settling;
mod signals;
mod story;
mod syntax;
mod terminal;
mod tracer;
mod watch;
mod checks;
mod edits;
mod isolation;
mod layers;
mod lines;
mod picture;
mod runs;
mod stage;
mod walk;
