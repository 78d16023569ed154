//! Parameters: those of other nodes, and the program's variables as parameters of our node.

mod others;
mod own;
mod values;

pub use others::{CALLS, call, calls, got, listed, set, was_set};
pub use own::Parameters;

/// A node's service about its parameters: `GetParameters` is `/node/get_parameters`.
fn service(node: &str, kind: &str) -> String {
    format!("{node}/{}", snake(kind))
}

/// `GetParameters` is `get_parameters`.
fn snake(name: &str) -> String {
    let mut snake = String::new();
    for char in name.chars() {
        if char.is_ascii_uppercase() && !snake.is_empty() {
            snake.push('_');
        }
        snake.push(char.to_ascii_lowercase());
    }
    snake
}
