//! The rows of `[keys]`, put over the defaults. A row that can't stand has its default keys.

use std::ops::Range;

use toml::de::{DeTable, DeValue};

use super::{Reader, did_you_mean, in_order};
use crate::ui::action::{Action, Entry, Reach, TABLE};
use crate::ui::key::Key;

/// A row of the file that can be read.
struct Wish {
    /// Of the table of actions.
    row: usize,
    keys: Vec<Key>,
    name: Range<usize>,
}

impl Reader {
    pub(super) fn keys(&mut self, rows: &DeTable) {
        let mut wishes = Vec::new();
        for (name, value) in in_order(rows) {
            let id = &**name.get_ref();
            let Some(row) = TABLE.iter().position(|entry| entry.id == id) else {
                let ids: Vec<&str> = TABLE.iter().map(|entry| entry.id).collect();
                self.finding(name.span(), format!("`{id}` is no action"), did_you_mean(id, &ids));
                continue;
            };
            if let Some(keys) = self.read_keys(&TABLE[row], value.get_ref(), value.span()) {
                wishes.push(Wish { row, keys, name: name.span() });
            }
        }
        while let Some((victim, message, help)) = first_clash(&wishes) {
            let wish = wishes.remove(victim);
            let entry = &TABLE[wish.row];
            self.finding(wish.name, format!("{message}; `{}` keeps {}", entry.id, entry.keys.join(", ")), help);
        }
        for wish in wishes {
            self.config.keys.set(wish.row, wish.keys);
        }
    }

    /// None where the default stays.
    fn read_keys(&mut self, entry: &Entry, value: &DeValue, at: Range<usize>) -> Option<Vec<Key>> {
        let list = match value {
            DeValue::String(text) => vec![(Some(&**text), at.clone())],
            DeValue::Array(items) => items.iter().map(|item| (item.get_ref().as_str(), item.span())).collect(),
            _ => vec![(None, at.clone())],
        };
        if list.is_empty() && entry.action == Action::Runstop {
            let message = format!("`{}` can be moved, but never be without a key", entry.id);
            self.finding(at, message, format!("give it another, or leave it at {}", entry.keys.join(", ")));
            return None;
        }
        let mut keys = Vec::new();
        for (text, at) in list {
            let Some(text) = text else {
                self.finding(at, format!("`{}` takes a key or a list of keys", entry.id), EXAMPLE);
                return None;
            };
            match text.parse().and_then(|key| typable(entry, key)) {
                Ok(key) => keys.push(key),
                Err(message) => {
                    self.finding(at, format!("{message}; `{}` keeps {}", entry.id, entry.keys.join(", ")), EXAMPLE);
                    return None;
                }
            }
        }
        Some(keys)
    }
}

const EXAMPLE: &str = "keys are written as \"s\", \"S\", \"Space\", \"PgUp\", \"F5\", \"Ctrl-X\", \"Alt-Left\"";

/// What works also while a value is typed can't be one that types.
fn typable(entry: &Entry, key: Key) -> Result<Key, String> {
    match entry.reach {
        Reach::Always if !key.is_command() => {
            Err(format!("{key} is needed for typing, where this works too: take one with Ctrl or Alt, or F1 to F12"))
        }
        _ => Ok(key),
    }
}

/// Which wish can't stand, why, and what to do.
fn first_clash(wishes: &[Wish]) -> Option<(usize, String, String)> {
    wishes.iter().enumerate().rev().find_map(|(victim, wish)| {
        let entry = &TABLE[wish.row];
        let others = TABLE.iter().enumerate().filter(|&(row, other)| row != wish.row && entry.clashes_with(other));
        others.into_iter().find_map(|(row, other)| {
            let keys = wishes.iter().find(|wish| wish.row == row).map(|wish| wish.keys.clone());
            let key = *keys.unwrap_or_else(|| other.default_keys()).iter().find(|key| wish.keys.contains(key))?;
            let message = format!("{key} is the key of `{}` as well", other.id);
            Some((victim, message, format!("take another, or give `{}` another", other.id)))
        })
    })
}
