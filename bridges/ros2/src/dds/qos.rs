//! Quality of service: ROS's profiles by name, in detail, or whatever the other side has.

use lrp_bridge::Problem;
use rustdds::policy::{Deadline, Durability, History, Lifespan, Liveliness, Reliability, ResourceLimits};
use rustdds::qos::QosPolicyId;
use rustdds::{Duration, QosPolicies, QosPolicyBuilder};
use serde_json::Value;

/// How long writing may wait for readers that are behind.
const LONGEST_WRITE: Duration = Duration::from_millis(50);

/// The longest history; and so many messages may wait for a reader that is behind or dead before writing to all waits.
const MOST: i32 = 1000;

#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Qos {
    pub reliable: bool,
    /// Those who come later get the last messages too.
    pub transient_local: bool,
    pub depth: u32,
    /// Milliseconds.
    pub deadline: Option<u32>,
    pub lifespan: Option<u32>,
    pub lease: Option<u32>,
}

/// What the program's form asks for.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Wish {
    Exactly(Qos),
    /// Whatever the other side has; so many messages.
    Match {
        depth: u32,
    },
}

impl Qos {
    pub const DEFAULT: Qos =
        Qos { reliable: true, transient_local: false, depth: 10, deadline: None, lifespan: None, lease: None };
    pub const SENSOR_DATA: Qos = Qos { reliable: false, depth: 5, ..Qos::DEFAULT };
    pub const TRANSIENT_LOCAL: Qos = Qos { transient_local: true, depth: 1, ..Qos::DEFAULT };
    pub const PARAMETERS: Qos = Qos { depth: 1000, ..Qos::DEFAULT };
    pub const ROSOUT: Qos = Qos { transient_local: true, depth: 100, lifespan: Some(10_000), ..Qos::DEFAULT };
    pub const CLOCK: Qos = Qos { reliable: false, depth: 1, ..Qos::DEFAULT };

    /// What a reader keeps is no more than its depth.
    pub fn for_reader(&self) -> QosPolicies {
        self.policies(self.depth())
    }

    /// A reader that doesn't answer must not hold up what others get, so a writer's depth is only for those who come later.
    pub fn for_writer(&self) -> QosPolicies {
        self.policies(MOST)
    }

    fn depth(&self) -> i32 {
        i32::try_from(self.depth).unwrap_or(MOST).clamp(1, MOST)
    }

    fn policies(&self, kept: i32) -> QosPolicies {
        let limits = ResourceLimits { max_samples: kept, max_instances: 1, max_samples_per_instance: kept };
        let mut policies = QosPolicyBuilder::new()
            .history(History::KeepLast { depth: self.depth() })
            .resource_limits(limits)
            .durability(if self.transient_local { Durability::TransientLocal } else { Durability::Volatile })
            .reliability(match self.reliable {
                true => Reliability::Reliable { max_blocking_time: LONGEST_WRITE },
                false => Reliability::BestEffort,
            });
        if let Some(deadline) = self.deadline {
            policies = policies.deadline(Deadline(millis(deadline)));
        }
        if let Some(lifespan) = self.lifespan {
            policies = policies.lifespan(Lifespan { duration: millis(lifespan) });
        }
        if let Some(lease) = self.lease {
            policies = policies.liveliness(Liveliness::Automatic { lease_duration: millis(lease) });
        }
        policies.build()
    }

    /// A reader that gets all that these writers offer.
    pub fn to_read<'a>(depth: u32, offered: impl IntoIterator<Item = &'a QosPolicies>) -> Qos {
        let mut qos = Qos { transient_local: true, depth, ..Qos::DEFAULT };
        let mut any = false;
        for offered in offered {
            any = true;
            qos.reliable &= is_reliable(offered, true);
            qos.transient_local &= is_transient_local(offered);
        }
        Qos { transient_local: any && qos.transient_local, ..qos }
    }

    /// A writer that satisfies all these readers.
    pub fn to_write<'a>(depth: u32, requested: impl IntoIterator<Item = &'a QosPolicies>) -> Qos {
        let mut qos = Qos { depth, ..Qos::DEFAULT };
        for requested in requested {
            qos.transient_local |= is_transient_local(requested);
        }
        qos
    }

    /// A profile of ROS by its name.
    pub fn named(name: &str) -> Option<Wish> {
        Some(match name {
            "default" => Wish::Exactly(Qos::DEFAULT),
            "sensor_data" | "sensor data" => Wish::Exactly(Qos::SENSOR_DATA),
            "transient_local" | "transient local" | "latched" => Wish::Exactly(Qos::TRANSIENT_LOCAL),
            "services" => Wish::Exactly(Qos::DEFAULT),
            "parameters" => Wish::Exactly(Qos::PARAMETERS),
            "match" => Wish::Match { depth: Qos::DEFAULT.depth },
            _ => return None,
        })
    }
}

const NAMES: &str = "default, sensor_data, transient_local, services, parameters, match";
const KEYS: &str = "profile, reliability, durability, depth, deadline, lifespan, lease";

impl Wish {
    /// A name, or a table like `{ reliability = "best_effort", depth = 1 }`.
    pub fn read(value: &Value, key: &str) -> Result<Wish, Problem> {
        let wrong = |what: String, help: &str| Problem::new(what).help(help.to_string()).at(key);
        match value {
            Value::String(name) => {
                Qos::named(name).ok_or_else(|| wrong(format!("no QoS profile is called `{name}`"), &one_of(NAMES)))
            }
            Value::Object(details) => {
                let mut wish = match details.get("profile") {
                    Some(name) => Wish::read(&Value::String(name.as_str().unwrap_or_default().to_string()), key)?,
                    None => Wish::Exactly(Qos::DEFAULT),
                };
                for (name, value) in details {
                    let said = wish.detail(name, value);
                    said.ok_or_else(|| wrong(format!("no QoS has `{name} = {value}`"), &one_of(KEYS)))?;
                }
                Ok(wish)
            }
            other => Err(wrong(format!("{other} is no QoS"), "a profile's name, or a table with its details")),
        }
    }

    fn detail(&mut self, name: &str, value: &Value) -> Option<()> {
        let number = || value.as_f64().filter(|number| (0.0..=1e9).contains(number)).map(|number| number as u32);
        let qos = match self {
            Wish::Exactly(qos) => qos,
            Wish::Match { depth } if name == "depth" => {
                *depth = number()?;
                return Some(());
            }
            Wish::Match { .. } => return (name == "profile").then_some(()),
        };
        match name {
            "profile" => {}
            "reliability" => {
                qos.reliable = match value.as_str()? {
                    "reliable" => true,
                    "best_effort" => false,
                    _ => return None,
                }
            }
            "durability" => {
                qos.transient_local = match value.as_str()? {
                    "transient_local" => true,
                    "volatile" => false,
                    _ => return None,
                }
            }
            "depth" => qos.depth = number()?.max(1),
            "deadline" => qos.deadline = Some(number()?),
            "lifespan" => qos.lifespan = Some(number()?),
            "lease" => qos.lease = Some(number()?),
            _ => return None,
        }
        Some(())
    }
}

fn one_of(names: &str) -> String {
    format!("one of: {names}")
}

fn millis(count: u32) -> Duration {
    Duration::from_millis(count.into())
}

fn is_transient_local(policies: &QosPolicies) -> bool {
    policies.durability().is_some_and(|durability| durability >= Durability::TransientLocal)
}

/// What isn't said is DDS's default, which differs for writers and readers.
fn is_reliable(policies: &QosPolicies, unsaid: bool) -> bool {
    match policies.reliability() {
        Some(Reliability::Reliable { .. }) => true,
        Some(Reliability::BestEffort) => false,
        None => unsaid,
    }
}

/// Why a writer and a reader don't match, in a user's words.
pub fn fault(offered: &QosPolicies, requested: &QosPolicies) -> String {
    match offered.compliance_failure_wrt(requested) {
        Some(QosPolicyId::Reliability) => "reliability (offered: best effort, wanted: reliable)".to_string(),
        Some(QosPolicyId::Durability) => "durability (offered: volatile, wanted: transient local)".to_string(),
        Some(QosPolicyId::Deadline) => "deadline (offered: later than wanted)".to_string(),
        Some(QosPolicyId::Liveliness) => "liveliness".to_string(),
        Some(other) => format!("{other:?}").to_lowercase(),
        None => "some policy".to_string(),
    }
}
