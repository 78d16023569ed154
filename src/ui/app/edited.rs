//! What a person has selected, folded and typed at, across an edit of the program.

use std::sync::Arc;

use super::{App, Overlay};
use crate::model::Program;
use crate::ui::tree;
use crate::ui::view::Renames;

impl App {
    /// What was renamed stays selected, folded, nudged and typed at.
    pub(super) fn rename(&mut self, renames: &Renames) {
        if renames.is_empty() {
            return;
        }
        self.selected = self.selected.as_ref().map(|path| renames.place(path));
        self.folded = self.folded.iter().map(|path| renames.place(path)).collect();
        self.value = self.value.as_ref().map(|path| renames.variable(path));
        self.reading.only = self.reading.only.as_ref().map(|path| renames.place(path));
        self.arrangement.rename(renames);
        if let Some((path, _)) = &mut self.nudged {
            *path = renames.variable(path);
        }
        if let Overlay::Typing(typing) = &mut self.overlay {
            typing.goal.rename(renames);
        }
        self.sent.iter_mut().for_each(|typing| typing.goal.rename(renames));
    }

    /// What is still there stays selected and folded; else what took its place is, or the first machine.
    pub(super) fn program_changed(&mut self, before: Option<Arc<Program>>) {
        let Some(now) = self.view.program.clone() else { return };
        let kept = self.selected.as_ref().and_then(|selected| match &before {
            _ if tree::element(&now, selected).is_some() => Some(selected.clone()),
            Some(before) => tree::survivor(before, &now, selected),
            None => None,
        });
        let first = || now.tops.first().map(|&machine| now[machine].path.clone());
        self.selected = kept.or_else(first);
        self.folded.retain(|path| tree::element(&now, path).is_some());
        self.reading.only.take_if(|path| now.machine(path).is_none());
        self.settle();
    }
}
