//! All integration tests, in one binary: each module tests a layer from outside.

mod syntax;
