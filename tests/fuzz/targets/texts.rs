//! Any text goes through the reader, the parser and the renderer.
#![no_main]

#[path = "../../lrp/syntax/any_text.rs"]
mod any_text;
#[path = "../../lrp/syntax/spans.rs"]
mod spans;

use libfuzzer_sys::fuzz_target;

fuzz_target!(|text: &str| any_text::check(text));
