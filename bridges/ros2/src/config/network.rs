//! Which network is to be used, as the form says, and where it doesn't, as the environment does.

use std::net::{IpAddr, Ipv4Addr};

use serde_json::Value;

use super::Network;
use super::read::Reader;

/// Ports are 7400 and up, 250 for each domain.
const HIGHEST_DOMAIN: u16 = 232;

pub(super) fn network(reader: &mut Reader) -> Network {
    let domain = match reader.form.get("domain") {
        None | Some(Value::Null) => domain_of_environment().unwrap_or_else(|wrong| {
            reader.wrong(wrong, "export ROS_DOMAIN_ID=0, or `domain = 0` in the form", "domain");
            0
        }),
        Some(value) => {
            let domain = value.as_f64().filter(|domain| domain.fract() == 0.0 && *domain >= 0.0);
            match domain.filter(|domain| *domain <= HIGHEST_DOMAIN.into()) {
                Some(domain) => domain as u16,
                None => {
                    reader.wrong(format!("{value} is no domain"), "a number from 0 to 232", "domain");
                    0
                }
            }
        }
    };
    let localhost = reader.flag("localhost").unwrap_or_else(localhost_of_environment);
    let only = match reader.text("interface") {
        Some(interface) => {
            let addresses = addresses(&interface);
            if addresses.is_empty() {
                let what = format!("there is no network interface `{interface}` with an IPv4 address");
                reader.wrong(what, &format!("one of: {}", interfaces().join(", ")), "interface");
            }
            Some(addresses)
        }
        None => localhost.then(|| vec![IpAddr::V4(Ipv4Addr::LOCALHOST)]),
    };
    Network { domain, only }
}

fn domain_of_environment() -> Result<u16, String> {
    match std::env::var("ROS_DOMAIN_ID") {
        Ok(text) if !text.trim().is_empty() => {
            let domain = text.trim().parse().ok().filter(|domain| *domain <= HIGHEST_DOMAIN);
            domain.ok_or(format!("ROS_DOMAIN_ID is `{text}`, which is no domain"))
        }
        _ => Ok(0),
    }
}

fn localhost_of_environment() -> bool {
    let range = std::env::var("ROS_AUTOMATIC_DISCOVERY_RANGE").unwrap_or_default();
    let only = std::env::var("ROS_LOCALHOST_ONLY").unwrap_or_default();
    matches!(range.as_str(), "LOCALHOST" | "OFF") || only == "1"
}

/// Of an interface by its name, or by one of its addresses.
fn addresses(interface: &str) -> Vec<IpAddr> {
    let known = netdev::get_interfaces().into_iter().flat_map(|known| {
        let name = known.name;
        known.ipv4.into_iter().map(move |network| (name.clone(), IpAddr::V4(network.addr())))
    });
    let wanted = interface.parse().ok();
    known.filter(|(name, address)| name == interface || Some(*address) == wanted).map(|(_, address)| address).collect()
}

fn interfaces() -> Vec<String> {
    let usable = netdev::get_interfaces().into_iter().filter(|known| !known.ipv4.is_empty());
    let mut names: Vec<String> = usable.map(|known| known.name).collect();
    names.sort();
    names
}
