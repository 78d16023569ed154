//! Asks a kind of bridge what it is and what it would offer under a configuration, without connecting to any robot.

use std::path::Path;
use std::sync::mpsc::{Receiver, channel};
use std::time::{Duration, Instant};

use lrp_bridge::{About, Description, Event, Order, PROTOCOL, Problem};
use serde_json::Value;

use super::folders::Plugin;
use super::process::{Heard, Process};

/// How long a bridge may take for it.
const PATIENCE: Duration = Duration::from_secs(10);
const LAST_WORDS: Duration = Duration::from_millis(200);

#[derive(Clone, Debug, PartialEq)]
pub struct Answer {
    pub about: About,
    pub description: Description,
    pub problems: Vec<Problem>,
}

/// What the bridge says, or why it says nothing.
pub fn ask(plugin: &Plugin, host: &Path, config: &Value) -> Result<Answer, String> {
    let (sender, inbox) = channel();
    // When nobody waits for an answer any more, none is needed.
    let heard = move |heard| drop(sender.send(heard));
    let process = Process::start(plugin, host, heard).map_err(|error| format!("it can't be started: {error}"))?;
    let end = Instant::now() + PATIENCE;
    let about = hear(&inbox, end, |event| match event {
        Event::Hello { protocol, about } => Some((protocol, about)),
        _ => None,
    });
    let (protocol, about) = about?;
    if protocol != PROTOCOL {
        return Err(format!("it speaks version {protocol} of the protocol, this lrp version {PROTOCOL}"));
    }
    process.orders().put(Order::Describe { config: config.clone() });
    let (description, problems) = hear(&inbox, end, |event| match event {
        Event::Offer { description, problems } => Some((description, problems)),
        _ => None,
    })?;
    Ok(Answer { about, description, problems })
}

fn hear<T>(inbox: &Receiver<Heard>, end: Instant, wanted: impl Fn(Event) -> Option<T>) -> Result<T, String> {
    let mut complaint = None;
    loop {
        match inbox.recv_timeout(end.saturating_duration_since(Instant::now())) {
            Ok(Heard::Event(event, _)) => {
                if let Some(found) = wanted(event) {
                    return Ok(found);
                }
            }
            Ok(Heard::Complaint(line)) => complaint = Some(line),
            Ok(Heard::Mute) => {}
            Ok(Heard::Garbage(line)) => return Err(format!("it doesn't speak lrp's protocol: `{line}`")),
            Ok(Heard::TooLong) => return Err("it says a line without an end".to_string()),
            Ok(Heard::Closed) => {
                // What it complained of last may still be on its way.
                while let Ok(Heard::Complaint(line)) = inbox.recv_timeout(LAST_WORDS) {
                    complaint = Some(line);
                }
                return Err(complaint.unwrap_or_else(|| "it ended at once".to_string()));
            }
            Err(_) => return Err(format!("it doesn't answer within {} s", PATIENCE.as_secs())),
        }
    }
}
