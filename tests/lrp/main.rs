//! All integration tests of the package, in one binary.

mod behaviors;
mod checks;
mod docs;
mod editor;
mod edits;
mod frames;
mod graph;
mod keys;
mod layers;
mod lines;
mod loader;
mod lua;
mod picture;
mod plot;
mod quiet;
mod runs;
mod settling;
mod signals;
mod stage;
mod story;
mod syntax;
mod terminal;
mod tracer;
mod view;
mod walk;
mod watch;
