//! The program's services: which are offered as calls, once their types are known.

use std::collections::BTreeMap;
use std::sync::Arc;
use std::time::Instant;

use lrp_bridge::Level;
use serde_json::Value;

use crate::client::{Clients, Request, Then};
use crate::config::Callable;
use crate::names::Role;
use crate::node::Node;
use crate::types::Struct;

#[derive(Default)]
pub struct Services {
    services: BTreeMap<String, Service>,
}

struct Service {
    wanted: Callable,
    /// The type's name, and that of its request.
    open: Option<(String, Arc<Struct>)>,
}

impl Services {
    pub fn configure(&mut self, node: &mut Node, clients: &mut Clients, wanted: &BTreeMap<String, Callable>) {
        let is_gone = |(name, service): &(&String, &Service)| wanted.get(*name) != Some(&service.wanted);
        let gone: Vec<String> = self.services.iter().filter(is_gone).map(|(name, _)| name.clone()).collect();
        for name in gone {
            self.services.remove(&name);
        }
        for (name, callable) in wanted {
            let new = || Service { wanted: callable.clone(), open: None };
            self.services.entry(name.clone()).or_insert_with(new);
        }
        self.follow(node, clients);
    }

    /// Opens those whose types are known by now. Whether there are any.
    pub fn follow(&mut self, node: &mut Node, clients: &mut Clients) -> bool {
        let mut news = false;
        for (name, service) in self.services.iter_mut().filter(|(_, service)| service.open.is_none()) {
            let Some(type_name) = service.type_name(node) else { continue };
            // What isn't known is asked for, and this is tried again.
            let found = ["_Request", "_Response"].map(|part| node.find(&format!("{type_name}{part}")));
            let [Ok(request), Ok(_)] = found else { continue };
            match clients.prepare(node, &service.wanted.name, &type_name) {
                Ok(()) => {
                    service.open = Some((type_name, request));
                    news = true;
                }
                Err(why) => node.complain(Level::Error, format!("service `{name}`: {why}")),
            }
        }
        news
    }

    /// The types of the requests.
    pub fn types(&self) -> impl Iterator<Item = (&String, &Arc<Struct>)> {
        self.services.iter().filter_map(|(name, service)| Some((name, &service.open.as_ref()?.1)))
    }

    /// Begins a call. None: no service is called so.
    pub fn call(
        &self,
        node: &mut Node,
        clients: &mut Clients,
        name: &str,
        call: u64,
        request: &Value,
    ) -> Option<Result<(), String>> {
        let service = self.services.get(name)?;
        let Some((type_name, _)) = &service.open else {
            return Some(Err(format!("nobody offers {}, so its type isn't known yet", service.wanted.name)));
        };
        Some(clients.ask(
            node,
            Request {
                service: &service.wanted.name,
                type_name,
                message: request,
                then: Then::Reply { call },
                until: service.wanted.timeout.map(|timeout| Instant::now() + timeout),
            },
        ))
    }
}

impl Service {
    fn type_name(&self, node: &Node) -> Option<String> {
        let found = || {
            let types = node.graph.types(&self.wanted.name, Role::Request);
            Some(types.first()?.strip_suffix("_Request")?.to_string())
        };
        self.wanted.type_name.clone().or_else(found)
    }
}
