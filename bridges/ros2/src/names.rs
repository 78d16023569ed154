//! Names: of ROS as a program writes them, made absolute and remapped; and how DDS calls the same things.

use std::collections::BTreeMap;

/// Where relative names begin, and what is called otherwise.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Names {
    /// `/` or `/robot`.
    pub namespace: String,
    pub node: String,
    /// Absolute names and what they stand for.
    remaps: BTreeMap<String, String>,
}

/// What a topic of DDS is to ROS.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Role {
    Topic,
    Request,
    Reply,
}

impl Names {
    pub fn new(namespace: &str, node: &str, remaps: impl IntoIterator<Item = (String, String)>) -> Names {
        let namespace = format!("/{}", namespace.trim_matches('/'));
        let mut names = Names { namespace, node: node.to_string(), remaps: BTreeMap::new() };
        names.remaps = remaps.into_iter().map(|(from, to)| (names.absolute(&from), names.absolute(&to))).collect();
        names
    }

    /// What a name in the program stands for: `/x` itself, `x` in the namespace, `~/x` below the node.
    pub fn resolve(&self, name: &str) -> String {
        let name = self.absolute(name);
        self.remaps.get(&name).cloned().unwrap_or(name)
    }

    /// `/robot/lrp`
    pub fn full_node(&self) -> String {
        join(&self.namespace, &self.node)
    }

    fn absolute(&self, name: &str) -> String {
        if name.starts_with('/') {
            name.to_string()
        } else if let Some(below) = name.strip_prefix("~/") {
            join(&self.full_node(), below)
        } else {
            join(&self.namespace, name)
        }
    }
}

pub fn join(namespace: &str, name: &str) -> String {
    format!("{}/{name}", namespace.trim_end_matches('/'))
}

/// Why a name can't be one.
pub fn wrong(name: &str) -> Option<String> {
    let body = name.strip_prefix("~/").or(name.strip_prefix('/')).unwrap_or(name);
    let fits = |part: &str| {
        part.starts_with(|char: char| char.is_ascii_alphabetic() || char == '_')
            && part.chars().all(|char| char.is_ascii_alphanumeric() || char == '_')
    };
    let wrong = body.split('/').find(|part| !fits(part))?;
    Some(match wrong {
        "" => format!("`{name}` has an empty part"),
        _ => format!("in `{name}`, `{wrong}` is not made of letters, digits and _"),
    })
}

/// What DDS calls a name of ROS.
pub fn to_dds(name: &str, role: Role) -> String {
    match role {
        Role::Topic => format!("rt{name}"),
        Role::Request => format!("rq{name}Request"),
        Role::Reply => format!("rr{name}Reply"),
    }
}

pub fn from_dds(topic: &str) -> Option<(String, Role)> {
    let (prefix, name) = topic.split_at_checked(2)?;
    let (name, role) = match prefix {
        "rt" => (name, Role::Topic),
        "rq" => (name.strip_suffix("Request")?, Role::Request),
        "rr" => (name.strip_suffix("Reply")?, Role::Reply),
        _ => return None,
    };
    name.starts_with('/').then(|| (name.to_string(), role))
}

/// `std_msgs/msg/String` is `std_msgs::msg::dds_::String_` there.
pub fn type_to_dds(name: &str) -> String {
    match name.rsplit_once('/') {
        Some((package, short)) => format!("{}::dds_::{short}_", package.replace('/', "::")),
        None => name.to_string(),
    }
}

pub fn type_from_dds(name: &str) -> Option<String> {
    let (package, short) = name.rsplit_once("::dds_::")?;
    Some(format!("{}/{}", package.replace("::", "/"), short.strip_suffix('_')?))
}

/// A type as a program may write it: `geometry_msgs/Twist` is enough.
pub fn full_type(name: &str, family: &str) -> Result<String, String> {
    match name.split('/').collect::<Vec<_>>()[..] {
        [package, given, short] if given == family => Ok(format!("{package}/{family}/{short}")),
        [package, short] => Ok(format!("{package}/{family}/{short}")),
        _ => Err(format!("`{name}` is no type of this kind: those are written as `package/{family}/Name`")),
    }
}
