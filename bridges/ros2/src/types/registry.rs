//! Finds types by name: in the `share` folders of an installed ROS, among the bundled ones, and among those that nodes
//! have described.

use std::collections::{BTreeSet, HashMap};
use std::path::PathBuf;
use std::sync::Arc;

use serde_json::Value;

use super::{Count, Definition, Field, Kind, Scalar, Struct, bundled, description, parse};

/// A type nested deeper contains itself, or is not meant seriously.
const DEEPEST: usize = 32;

/// Bytes of the smallest message of a type. What is greater is not meant seriously.
const GREATEST: usize = 4 << 20;

/// So many letters of two names may differ for one to be a slip for the other.
const LIKE: usize = 2;

const UUID: &str = "unique_identifier_msgs/msg/UUID";
const TIME: &str = "builtin_interfaces/msg/Time";

pub struct Registry {
    /// Folders that contain a folder for each package: those of the form, and those of the environment.
    own: Vec<PathBuf>,
    shares: Vec<PathBuf>,
    definitions: HashMap<String, Definition>,
    known: HashMap<String, Arc<Struct>>,
}

impl Registry {
    /// Types found in these folders, each with a folder for each package, go before bundled ones.
    pub fn new(shares: Vec<PathBuf>) -> Registry {
        Registry { own: Vec::new(), shares, definitions: HashMap::new(), known: HashMap::new() }
    }

    /// With the folders of the ROS that is installed, if one is.
    pub fn of_environment() -> Registry {
        let prefixes = std::env::var_os("AMENT_PREFIX_PATH").unwrap_or_default();
        Registry::new(std::env::split_paths(&prefixes).map(|prefix| prefix.join("share")).collect())
    }

    /// Looks in these folders first, from now on.
    pub fn look_in(&mut self, own: Vec<PathBuf>) {
        if self.own != own {
            self.own = own;
            self.definitions.clear();
            self.known.clear();
        }
    }

    fn folders(&self) -> impl Iterator<Item = &PathBuf> {
        self.own.iter().chain(&self.shares)
    }

    /// A type as `geometry_msgs/msg/Twist`, with all that it is made of.
    pub fn find(&mut self, name: &str) -> Result<Arc<Struct>, String> {
        self.resolve(name, 0)
    }

    /// Takes over what somebody described. What was known before stays.
    pub fn learn(&mut self, definitions: impl IntoIterator<Item = (String, Definition)>) {
        for (name, definition) in definitions {
            self.definitions.entry(name).or_insert(definition);
        }
    }

    fn resolve(&mut self, name: &str, depth: usize) -> Result<Arc<Struct>, String> {
        if let Some(known) = self.known.get(name) {
            return Ok(known.clone());
        }
        if depth > DEEPEST {
            return Err(format!("{name} contains itself"));
        }
        let Definition { fields, constants } = self.definition(name)?;
        let mut resolved = Struct { name: name.to_string(), constants, ..Struct::default() };
        for Field { name: field, kind, count, default } in fields {
            let kind = match kind {
                Kind::Nested(inner) => Kind::Nested(self.resolve(&inner, depth + 1)?),
                Kind::Scalar(scalar) => Kind::Scalar(scalar),
                Kind::Text { wide, bound } => Kind::Text { wide, bound },
            };
            let least = match count {
                Count::One => kind.least(),
                Count::Exactly(count) => kind.least().saturating_mul(count as usize),
                Count::AtMost(_) | Count::Any => 4,
            };
            resolved.least = resolved.least.saturating_add(least);
            resolved.fields.push(Field { name: field, kind, count, default });
        }
        // A type without fields travels as one byte.
        resolved.least = resolved.least.max(1);
        if resolved.least > GREATEST {
            return Err(format!("each {name} has more than {} MB", GREATEST >> 20));
        }
        let resolved = Arc::new(resolved);
        self.known.insert(name.to_string(), resolved.clone());
        Ok(resolved)
    }

    fn definition(&mut self, name: &str) -> Result<Definition, String> {
        if !self.definitions.contains_key(name) {
            self.load(name)?;
        }
        self.definitions.get(name).cloned().ok_or_else(|| unknown(name))
    }

    /// Reads the file that defines a type, and takes over all that it defines.
    fn load(&mut self, name: &str) -> Result<(), String> {
        let [package, family, short] = name.split('/').collect::<Vec<_>>()[..] else {
            return Err(format!("`{name}` is no type: those are written as `geometry_msgs/msg/Twist`"));
        };
        let whole = whole_of(family, short);
        let full = format!("{package}/{family}/{whole}");
        let file = format!("{full}.{family}");
        let installed = self.installed(&file);
        let text = match (&installed, bundled::definition(&full)) {
            (Some(text), _) => text.as_str(),
            (None, Some(text)) => text,
            (None, None) => return self.load_description(&full).ok_or_else(|| unknown(name))?,
        };
        let parts = parse::parts(text, package).map_err(|mistake| format!("{file}, {mistake}"))?;
        let parts = named(&full, family, parts).ok_or_else(|| format!("{file}: not the parts of a .{family}"))?;
        self.learn(parts);
        Ok(())
    }

    /// What is defined in IDL has a description all the same.
    fn load_description(&mut self, full: &str) -> Option<Result<(), String>> {
        let described: Value = serde_json::from_str(&self.installed(&format!("{full}.json"))?).ok()?;
        let definitions = description::definitions(described.get("type_description_msg")?);
        Some(definitions.map(|definitions| self.learn(definitions)))
    }

    /// Of a type that isn't known, although its package is: what it may have meant to be. None: perhaps some node knows it.
    pub fn would_know(&self, name: &str) -> Option<String> {
        let (package, short) = name.rsplit_once('/')?;
        let short = whole_of(package.rsplit_once('/')?.1, short);
        let bundled = bundled::all().filter_map(|(name, _)| name.rsplit_once('/'));
        let mut known: BTreeSet<String> =
            bundled.filter(|(other, _)| *other == package).map(|(_, short)| short.to_string()).collect();
        for share in self.folders() {
            let files = std::fs::read_dir(share.join(package)).into_iter().flatten().flatten();
            let stem = |path: PathBuf| Some(path.file_stem()?.to_str()?.to_string());
            known.extend(files.filter_map(|file| stem(file.path())));
        }
        let likest = known.iter().min_by_key(|known| difference(known, short))?;
        (difference(likest, short) <= LIKE).then_some(())?;
        Some(format!("{package} has no {short}; {likest}?"))
    }

    fn installed(&self, file: &str) -> Option<String> {
        self.folders().find_map(|share| std::fs::read_to_string(share.join(file)).ok())
    }
}

/// What is said of a type that nobody knows.
pub fn unknown(name: &str) -> String {
    format!(
        "the type {name} is not known here: is its package installed (AMENT_PREFIX_PATH), or a node up that has it?"
    )
}

/// The service or action that a type like `AddTwoInts_Request` is a part of.
fn whole_of<'a>(family: &str, short: &'a str) -> &'a str {
    let parts: &[&str] = match family {
        "srv" => &["_Request", "_Response"],
        "action" => &[
            "_SendGoal_Request",
            "_SendGoal_Response",
            "_GetResult_Request",
            "_GetResult_Response",
            "_FeedbackMessage",
            "_Goal",
            "_Result",
            "_Feedback",
        ],
        _ => &[],
    };
    parts.iter().find_map(|part| short.strip_suffix(part)).unwrap_or(short)
}

/// The types that a text defines.
fn named(full: &str, family: &str, parts: Vec<Definition>) -> Option<Vec<(String, Definition)>> {
    let mut parts = parts.into_iter();
    let mut next = |suffix: &str| Some((format!("{full}{suffix}"), parts.next()?));
    let named = match family {
        "msg" => vec![next("")?],
        "srv" => vec![next("_Request")?, next("_Response")?],
        "action" => {
            let mut named = vec![next("_Goal")?, next("_Result")?, next("_Feedback")?];
            named.extend(around_an_action(full));
            named
        }
        _ => return None,
    };
    parts.next().is_none().then_some(named)
}

/// What travels when an action is used, made from its three parts.
fn around_an_action(full: &str) -> Vec<(String, Definition)> {
    let field = |name: &str, kind| Field { name: name.to_string(), kind, count: Count::One, default: None };
    let nested = |name: &str, of: String| field(name, Kind::Nested(of));
    let scalar = |name: &str, of| field(name, Kind::Scalar(of));
    let goal_id = || nested("goal_id", UUID.to_string());
    let made = |suffix: &str, fields| (format!("{full}{suffix}"), Definition { fields, constants: Vec::new() });
    vec![
        made("_SendGoal_Request", vec![goal_id(), nested("goal", format!("{full}_Goal"))]),
        made("_SendGoal_Response", vec![scalar("accepted", Scalar::Bool), nested("stamp", TIME.to_string())]),
        made("_GetResult_Request", vec![goal_id()]),
        made("_GetResult_Response", vec![scalar("status", Scalar::I8), nested("result", format!("{full}_Result"))]),
        made("_FeedbackMessage", vec![goal_id(), nested("feedback", format!("{full}_Feedback"))]),
    ]
}

/// How many letters are to be changed, added or left out.
fn difference(one: &str, other: &str) -> usize {
    let mut row: Vec<usize> = (0..=other.chars().count()).collect();
    for (at, char) in one.chars().enumerate() {
        let mut before = std::mem::replace(&mut row[0], at + 1);
        for (column, theirs) in other.chars().enumerate() {
            let changed = before + usize::from(char != theirs);
            before = row[column + 1];
            row[column + 1] = changed.min(before + 1).min(row[column] + 1);
        }
    }
    row.last().copied().unwrap_or_default()
}
