//! The texts of required Lua files that came with the program: they go before those that are found while it runs.

use std::cell::RefCell;
use std::collections::{BTreeMap, BTreeSet};
use std::rc::Rc;
use std::sync::Arc;

use super::engine::Engine;
use crate::model::{ModuleId, Program};

/// By module name.
pub type Texts = Rc<RefCell<BTreeMap<Arc<str>, Arc<str>>>>;

impl Engine {
    /// Where the text of a `require`d Lua module comes from, if it isn't part of the program.
    pub fn library(&mut self, find: impl Fn(&str) -> Result<String, String> + 'static) {
        let texts = Rc::clone(&self.modules);
        self.store.lua.library(Box::new(move |name| {
            let known = texts.borrow().get(name).map(ToString::to_string);
            known.map_or_else(|| find(name), Ok)
        }));
    }

    /// Reads a required Lua module anew when it is required next.
    pub fn forget(&mut self, module: &str) {
        self.store.lua.forget(module);
    }

    /// What has another text now is read anew when it is required next, and so is what took something from it.
    pub(super) fn take_over_modules(&mut self, old: &Program, new: &Program) {
        let (before, after) = (texts(old), texts(new));
        let changed: BTreeSet<&Arc<str>> =
            before.keys().chain(after.keys()).filter(|&name| before.get(name) != after.get(name)).collect();
        if changed.is_empty() {
            return;
        }
        let concerned = |program: &Program| -> Vec<Arc<str>> {
            let is_changed = |module: &ModuleId| changed.contains(&program[*module].name);
            let all = (0..program.modules.len() as u32).map(ModuleId);
            let concerned = all.filter(|it| is_changed(it) || program[*it].requires.iter().any(is_changed));
            concerned.map(|module| program[module].name.clone()).collect()
        };
        for name in concerned(old).into_iter().chain(concerned(new)) {
            self.forget(&name);
        }
        self.modules.replace(after);
    }
}

fn texts(program: &Program) -> BTreeMap<Arc<str>, Arc<str>> {
    let modules = (0..program.modules.len() as u32).map(ModuleId);
    modules.map(|module| (program[module].name.clone(), program.module_text(module).clone())).collect()
}
