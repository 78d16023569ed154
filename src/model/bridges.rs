//! The robots of a program: its bridge forms, and what the command line puts in their place. Knows no kind of robot.

use std::collections::HashMap;

use super::program::Bridge;
use super::resolve::{Resolver, Robot};
use crate::lua::Checker;
use crate::syntax::ast::{self, Form};
use crate::syntax::{FileId, Span};

impl Resolver<'_> {
    /// Of bridges of one name, that of the file that comes first counts.
    pub(super) fn bridges(&mut self, order: &[FileId], robots: &[Robot], checker: &mut Checker) {
        let mut chosen: HashMap<&str, &str> = robots.iter().map(|robot| (&*robot.name, &*robot.kind)).collect();
        let files = self.files;
        for form in order.iter().flat_map(|file| &files[file.0 as usize].tree.forms) {
            let Form::Bridge(bridge) = form else { continue };
            if let Some(twin) = self.program.bridges.iter().find(|known| known.name == bridge.name.text) {
                let first = twin.span;
                if first.file == bridge.span.file {
                    self.duplicate("bridge", &bridge.name, first);
                }
                continue;
            }
            let other = chosen.remove(&*bridge.name.text).filter(|kind| *kind != &*bridge.kind.text);
            let (kind, config) = match other {
                Some(kind) => (kind.into(), serde_json::json!({})),
                None => (bridge.kind.text.clone(), self.config(bridge, checker)),
            };
            self.program.bridges.push(Bridge { name: bridge.name.text.clone(), kind, config, span: bridge.span });
        }
        for robot in robots.iter().filter(|robot| chosen.contains_key(&*robot.name)) {
            let (name, kind) = (robot.name.as_str().into(), robot.kind.as_str().into());
            self.program.bridges.push(Bridge { name, kind, config: serde_json::json!({}), span: Span::default() });
        }
    }

    fn config(&mut self, bridge: &ast::Bridge, checker: &mut Checker) -> serde_json::Value {
        let Some(block) = &bridge.config else { return serde_json::json!({}) };
        checker.config(&block.text).unwrap_or_else(|mut error| {
            // The bracket that Lua sees at the end is not in the text.
            if !block.text.contains('}') {
                error.message = error.message.replace("near '}'", "near ']'");
                error.token = error.token.filter(|token| token != "}");
            }
            let source = &self.program.sources[block.span.file.0 as usize];
            self.diagnostics.push(super::blocks::syntax_diagnostic(source, block.span, &error));
            serde_json::json!({})
        })
    }
}
