//! Live Robot Programming for the terminal. Each layer may use those before it, and knows nothing of those after it.

pub mod syntax;

pub mod lua;

pub mod model;

pub mod runtime;

pub mod session;

pub mod ui;

pub mod cli;
