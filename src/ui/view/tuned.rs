//! Values that a person set by hand and that initial values replaced since: an edit or a restart cost them.

use serde_json::Value;

use super::{Edit, Path, View};
use crate::ui::format;

impl View {
    /// What can be set again: variables that have a value, which is another one, and whose lost value can be written down.
    pub fn lost(&self) -> impl Iterator<Item = (&Path, String)> {
        let now = |path| self.variables.get(path).and_then(|variable| variable.value.as_ref());
        let lost = self.tuned.iter().filter(move |&(path, value)| now(path).is_some_and(|now| now != value));
        lost.filter_map(|(path, value)| Some((path, format::source(value)?)))
    }

    /// The variables inside `outer`, or all, are about to be forgotten because of an edit or a restart.
    pub(super) fn remember_tuned(&mut self, concerned: impl Fn(&Path) -> bool) {
        let tuned = self.variables.iter().filter(|(path, variable)| variable.is_tuned() && concerned(path));
        let values = tuned.filter_map(|(path, variable)| Some((path.clone(), variable.value.clone()?)));
        let values: Vec<(Path, Value)> = values.filter(|(path, _)| !self.is_wanted(path)).collect();
        self.tuned.extend(values);
    }

    /// A variable is about to have a value.
    pub(super) fn watch_tuned(&mut self, var: &Path, value: &Value, by: &Path) {
        match &**by {
            "command" => _ = self.tuned.remove(var),
            "init" => self.initialised(var, value),
            _ => (),
        }
    }

    fn initialised(&mut self, var: &Path, value: &Value) {
        let at = |path: &Path| path == var;
        self.remember_tuned(at);
        if self.tuned.get(var) == Some(value) {
            self.tuned.remove(var);
        }
    }

    /// Whether the last edit gave the variable the initial value it has.
    fn is_wanted(&self, var: &str) -> bool {
        matches!(&self.edit, Some(Edit::Taken(outcome)) if outcome.gives(var))
    }
}
