//! The scanner for the end of a block against Lua's own compiler.
#![no_main]

#[path = "../../lrp/syntax/any_block.rs"]
mod any_block;

use std::cell::RefCell;

use libfuzzer_sys::fuzz_target;
use lrp::lua::Checker;

thread_local! {
    static CHECKER: RefCell<Checker> = RefCell::default();
}

fuzz_target!(|code: &str| CHECKER.with_borrow_mut(|checker| any_block::check(code, checker)));
