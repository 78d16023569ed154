//! Live Robot Programming for the terminal. Each layer may use those before it, and knows nothing of those after it.

pub mod model;
pub mod runtime;
pub mod syntax;
pub mod ui;
