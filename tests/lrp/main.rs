//! All integration tests of the package, in one binary.

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
mod checks;
mod edits;
mod isolation;
mod layers;
mod lines;
mod picture;
mod plot;
mod runs;
mod stage;
mod walk;
