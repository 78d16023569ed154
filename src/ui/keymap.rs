//! Which keys do what: those of the table of actions, or a person's own.

use std::fmt::Write;

use super::action::{Action, Entry, Group, Reach, TABLE};
use super::key::Key;
use super::layout::Pane;

#[derive(Clone, Debug, PartialEq)]
pub struct Keymap {
    /// Of each row of the table.
    keys: Vec<Vec<Key>>,
}

impl Default for Keymap {
    fn default() -> Keymap {
        Keymap { keys: TABLE.iter().map(Entry::default_keys).collect() }
    }
}

impl Keymap {
    /// Every row of the table with its keys.
    pub fn rows(&self) -> impl Iterator<Item = (&'static Entry, &[Key])> + Clone {
        TABLE.iter().zip(self.keys.iter().map(Vec::as_slice))
    }

    /// Gives a row of the table other keys.
    pub fn set(&mut self, row: usize, keys: Vec<Key>) {
        if let Some(place) = self.keys.get_mut(row) {
            *place = keys;
        }
    }

    pub fn keys(&self, entry: &Entry) -> &[Key] {
        self.rows().find(|(row, _)| row.id == entry.id).map_or(&[], |(_, keys)| keys)
    }

    /// What a key does while a pane has the focus: the pane's own meaning before the general one.
    pub fn action(&self, key: Key, pane: Pane) -> Option<Action> {
        let mut fitting = self.rows().filter(|(entry, keys)| entry.works_in(pane) && keys.contains(&key));
        let own = fitting.clone().find(|(entry, _)| matches!(entry.reach, Reach::Panes(_)));
        own.or_else(|| fitting.next()).map(|(entry, _)| entry.action)
    }

    /// What a key does everywhere, also while a value is typed.
    pub fn action_always(&self, key: Key) -> Option<Action> {
        let mut always = self.rows().filter(|(entry, _)| entry.reach == Reach::Always);
        always.find(|(_, keys)| keys.contains(&key)).map(|(entry, _)| entry.action)
    }

    /// The key to name in a sentence.
    pub fn name(&self, action: Action) -> String {
        let mut keys = self.rows().filter(|(entry, _)| entry.action == action).flat_map(|(_, keys)| keys);
        keys.next().map_or_else(|| "(no key)".into(), Key::to_string)
    }

    /// The key of the row of this name.
    pub fn named(&self, id: &str) -> String {
        let row = self.rows().find(|(entry, _)| entry.id == id);
        row.and_then(|(_, keys)| keys.first()).map_or_else(|| "(no key)".into(), Key::to_string)
    }

    /// The key that does it also while a value is typed.
    pub fn name_always(&self, action: Action) -> String {
        let mut rows = self.rows().filter(|(entry, _)| entry.action == action && entry.reach == Reach::Always);
        rows.find_map(|(_, keys)| keys.first()).map_or_else(|| self.name(action), Key::to_string)
    }

    /// `Space`, `e, Enter`
    pub fn names(&self, entry: &Entry) -> String {
        self.keys(entry).iter().map(Key::to_string).collect::<Vec<_>>().join(", ")
    }

    /// What the footer offers while a pane has the focus, without what is always there (STOP and help): the pause, what
    /// there is only now and then, what belongs to the pane, the rest. Each with its first key.
    pub fn offered(&self, pane: Pane) -> Vec<(&'static Entry, Key)> {
        let labelled = self.rows().filter(|(entry, _)| !entry.label.is_empty() && entry.works_in(pane));
        let keyed = labelled.filter_map(|(entry, keys)| Some((entry, *keys.first()?)));
        // What the pane has another use for isn't offered under that key.
        let mut shown: Vec<_> = keyed.filter(|&(entry, key)| self.action(key, pane) == Some(entry.action)).collect();
        shown.retain(|(entry, _)| !matches!(entry.action, Action::Runstop | Action::Help));
        shown.sort_by_key(|(entry, _)| match (entry.action, entry.reach) {
            (Action::Pause, _) => 0,
            (Action::ApplyHeld | Action::DropHeld | Action::HeldEdit | Action::GiveBack, _) => 1,
            (Action::Step, _) => 2,
            (_, Reach::Panes(_)) => 3,
            _ => 4,
        });
        shown
    }

    /// The page docs/keys.md.
    pub fn page(&self) -> String {
        let mut page = String::from(
            "# Keys\n\nMade from the table in `src/ui/action.rs`; a test keeps it so.\n\
             Upper case means with Shift. `?` shows the same on the screen, `:` finds an action by its name.\n\
             These are the defaults; [config.md](config.md) tells how to have others.\n",
        );
        for group in Group::ALL {
            let head = "| key | what it does | where | name |\n|---|---|---|---|\n";
            let _ = write!(page, "\n## {}\n\n{head}", group.title());
            for entry in group.entries() {
                let keys: Vec<String> = self.keys(entry).iter().map(|key| format!("`{key}`")).collect();
                let (keys, place) = (keys.join(" "), entry.reach.place());
                let _ = writeln!(page, "| {keys} | {} | {place} | {} |", entry.help, entry.id);
            }
        }
        page
    }
}
