//! Types that nobody here knows: the nodes that offer something of such a type are asked what it is.

use std::time::{Duration, Instant};

use lrp_bridge::Level;
use serde_json::{Value, json};

use crate::client::{Clients, Request, Then};
use crate::node::Node;
use crate::types::description;
use crate::types::registry::unknown;

/// How often nodes are asked for a type that nobody has told yet, and when it is said that nobody does.
const ASK_AGAIN: Duration = Duration::from_secs(2);
const LATE: Duration = Duration::from_secs(3);

const DESCRIBE: &str = "type_description_interfaces/srv/GetTypeDescription";

/// Since when a type is wanted, and when a node was last asked for it.
pub struct Wanted {
    since: Instant,
    asked: Option<Instant>,
}

impl Wanted {
    pub fn new() -> Wanted {
        Wanted { since: Instant::now(), asked: None }
    }
}

/// Asks for those whose time has come, and says which nobody tells.
pub fn ask(node: &mut Node, clients: &mut Clients, now: Instant) {
    let mut offers = Vec::new();
    for (type_name, wanted) in &mut node.wanted {
        if wanted.asked.is_none_or(|asked| now > asked + ASK_AGAIN)
            && let Some((of, hash)) = node.graph.offering(type_name).next()
        {
            wanted.asked = Some(now);
            offers.push((type_name.clone(), of.to_string(), hash.to_string()));
        }
    }
    for (type_name, of, hash) in offers {
        let request = Request {
            service: &format!("{of}/get_type_description"),
            type_name: DESCRIBE,
            message: &json!({ "type_name": type_name, "type_hash": hash, "include_type_sources": false }),
            then: Then::Learn { type_name: type_name.clone() },
            until: Some(now + ASK_AGAIN),
        };
        if let Err(why) = clients.ask(node, request) {
            node.complain(Level::Warn, format!("can't ask {of} for {type_name}: {why}"));
        }
    }
    let late = node.wanted.iter().filter(|(_, wanted)| now > wanted.since + LATE);
    let late: Vec<String> = late.map(|(name, _)| name.clone()).collect();
    for name in late {
        node.complain_once(Level::Warn, unknown(&name));
    }
}

/// Takes over what a node has answered.
pub fn learn(node: &mut Node, answer: Result<Value, String>) -> Result<(), String> {
    let response = answer?;
    if response["successful"] != true {
        return Err(response["failure_reason"].as_str().unwrap_or_default().to_string());
    }
    node.types.learn(description::definitions(&response["type_description"])?);
    Ok(())
}
