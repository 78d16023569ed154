//! All integration tests of the package, in one binary.

mod frames;
mod graph;
mod program;
mod story;
mod tracer;
mod lua;
mod editor;
mod loader;
mod quiet;
mod settling;
mod signals;
mod terminal;
mod watch;
mod checks;
mod edits;
mod layers;
mod lines;
mod picture;
mod plot;
mod runs;
mod stage;
mod walk;
