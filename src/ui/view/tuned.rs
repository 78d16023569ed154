//! Values that a person set by hand: those that initial values replaced since, as an edit or a restart cost them; and
//! those that the text doesn't know of.

use serde_json::Value;

use super::{Edit, Outcome, Path, View};
use crate::model::initial::initial;
use crate::ui::format;

impl View {
    /// What can be set again: variables that have a value, which is another one, and whose lost value can be written down.
    pub fn lost(&self) -> impl Iterator<Item = (&Path, String)> {
        let now = |path| self.variables.get(path).and_then(|variable| variable.value.as_ref());
        let lost = self.tuned.iter().filter(move |&(path, value)| now(path).is_some_and(|now| now != value));
        lost.filter_map(|(path, value)| Some((path, format::source(value)?)))
    }

    /// What was set by hand and isn't what the text begins with.
    pub fn unwritten(&self) -> impl Iterator<Item = (&Path, &Value)> {
        self.by_hand.iter().filter(|(path, value)| self.is_unwritten(path, value))
    }

    pub fn is_unwritten(&self, path: &str, value: &Value) -> bool {
        let begins = self.program.as_ref().and_then(|program| initial(program, program.var(path)?));
        begins.as_ref() != Some(value)
    }

    /// A person asked for its initial value: that is no loss.
    pub(super) fn reset(&mut self, var: &str) {
        self.by_hand.remove(var);
        self.tuned.remove(var);
        if let Some(variable) = self.variables.get_mut(var) {
            variable.by = "init".into();
        }
    }

    /// The text gives them another initial value: what was set by hand before doesn't count any more.
    pub(super) fn given_by(&mut self, outcome: &Outcome) {
        self.by_hand.retain(|path, _| !outcome.gives(path));
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
            "command" => {
                self.tuned.remove(var);
                self.by_hand.insert(var.clone(), value.clone());
            }
            "init" => self.initialised(var, value),
            _ => _ = self.by_hand.remove(var),
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
