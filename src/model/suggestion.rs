//! What to say to a name that nothing has. Knows nothing of what it should have named.

use crate::syntax::nearest::nearest;

/// Names listed at most where none is near to the one that was meant.
const LISTED: usize = 8;

/// The nearest known name, or those there are.
pub fn suggestion(wanted: &str, known: &[&str]) -> String {
    match nearest(wanted, known.iter().copied()) {
        Some(near) => format!("did you mean `{near}`?"),
        None if known.is_empty() => "there is none here yet".to_string(),
        None => format!("there is: {}", listed(known)),
    }
}

/// Names in a row, the last ones only counted where there are many.
pub fn listed(names: &[&str]) -> String {
    match names.len().checked_sub(LISTED) {
        None | Some(0) => names.join(", "),
        Some(more) => format!("{}, and {more} more", names[..LISTED].join(", ")),
    }
}
