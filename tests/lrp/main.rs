//! All integration tests of the package, in one binary.

mod graph;
mod lua;
mod tracer;
