//! Goals of actions: sent, accepted or rejected, followed by feedback, over with a result; and cancelled on the way.

use std::collections::BTreeMap;
use std::hash::{BuildHasher, RandomState};
use std::sync::Arc;
use std::time::{Duration, Instant};

use lrp_bridge::Level;
use serde_json::{Value, json};

use crate::client::{Clients, Request, Then};
use crate::config::Callable;
use crate::dds::ReaderId;
use crate::dds::qos::Qos;
use crate::names::Role;
use crate::node::{Node, decode};
use crate::types::Struct;

type GoalId = [u8; 16];

/// How long a server may take to come up and to accept or reject a goal.
const PATIENCE: Duration = Duration::from_secs(5);

/// How goals end, in `action_msgs/msg/GoalStatus`.
const SUCCEEDED: i64 = 4;
const CANCELED: i64 = 5;
const ABORTED: i64 = 6;

/// Cancelling was refused since the goal is over already.
const ALREADY_OVER: i64 = 3;

/// The types that travel. They contain the goal's, the result's and the feedback's own.
const PARTS: [&str; 5] =
    ["_SendGoal_Request", "_SendGoal_Response", "_GetResult_Request", "_GetResult_Response", "_FeedbackMessage"];

#[derive(Default)]
pub struct Actions {
    actions: BTreeMap<String, Action>,
    goals: BTreeMap<GoalId, Goal>,
}

struct Action {
    wanted: Callable,
    open: Option<Open>,
}

struct Open {
    type_name: String,
    goal: Arc<Struct>,
    feedback: Arc<Struct>,
    reader: ReaderId,
}

struct Goal {
    /// None: the call has its reply.
    call: Option<u64>,
    action: String,
    type_name: String,
    stage: Stage,
    /// When it must be accepted, and when it must be over.
    accept: Instant,
    until: Option<Instant>,
    /// Why it is to be cancelled, once it can be.
    cancel: Option<String>,
}

#[derive(Clone, Copy, Debug, PartialEq)]
enum Stage {
    Sent,
    Accepted,
}

/// What to tell the program of a call.
pub type Reply = (u64, Result<Value, String>);

impl Actions {
    pub fn configure(&mut self, node: &mut Node, clients: &mut Clients, wanted: &BTreeMap<String, Callable>) {
        let is_gone = |(name, action): &(&String, &Action)| wanted.get(*name) != Some(&action.wanted);
        let gone: Vec<String> = self.actions.iter().filter(is_gone).map(|(name, _)| name.clone()).collect();
        for name in gone {
            if let Some(Action { wanted, open: Some(open) }) = self.actions.remove(&name) {
                node.close_reader(open.reader);
                // Goals go on being followed: their calls are the program's.
                if !self.goals.values().any(|goal| goal.action == wanted.name) {
                    services(&wanted.name, &open.type_name).iter().for_each(|(name, _)| clients.close(node, name));
                }
            }
        }
        for (name, callable) in wanted {
            let new = || Action { wanted: callable.clone(), open: None };
            self.actions.entry(name.clone()).or_insert_with(new);
        }
        self.follow(node, clients);
    }

    /// Opens those whose types are known by now. Whether there are any.
    pub fn follow(&mut self, node: &mut Node, clients: &mut Clients) -> bool {
        let mut news = false;
        for (name, action) in &mut self.actions {
            if action.open.is_some() {
                continue;
            }
            let Some(type_name) = action.type_name(node) else { continue };
            // What isn't known is asked for, and this is tried again.
            let found = PARTS.map(|part| node.find(&format!("{type_name}{part}")));
            if found.iter().any(Result::is_err) {
                continue;
            }
            match open(node, clients, &action.wanted.name, &type_name) {
                Ok(opened) => {
                    action.open = Some(opened);
                    news = true;
                }
                Err(why) => node.complain(Level::Error, format!("action `{name}`: {why}")),
            }
        }
        news
    }

    /// The types of the goals.
    pub fn types(&self) -> impl Iterator<Item = (&String, &Arc<Struct>)> {
        self.actions.iter().filter_map(|(name, action)| Some((name, &action.open.as_ref()?.goal)))
    }

    /// Sends a goal. None: no action is called so.
    pub fn start(
        &mut self,
        node: &mut Node,
        clients: &mut Clients,
        name: &str,
        call: u64,
        goal: &Value,
    ) -> Option<Result<(), String>> {
        let action = self.actions.get(name)?;
        let Some(open) = &action.open else {
            return Some(Err(format!("nobody offers {}, so its type isn't known yet", action.wanted.name)));
        };
        let (id, now) = (new_id(call), Instant::now());
        let accept = now + action.wanted.timeout.unwrap_or(PATIENCE);
        let goal = json!({ "goal_id": { "uuid": id }, "goal": goal });
        let sent = clients.ask(
            node,
            Request {
                service: &format!("{}/_action/send_goal", action.wanted.name),
                type_name: &format!("{}_SendGoal", open.type_name),
                message: &goal,
                then: Then::Accept { goal: id },
                until: Some(accept),
            },
        );
        if sent.is_ok() {
            self.goals.insert(
                id,
                Goal {
                    call: Some(call),
                    action: action.wanted.name.clone(),
                    type_name: open.type_name.clone(),
                    stage: Stage::Sent,
                    accept,
                    until: action.wanted.timeout.map(|timeout| now + timeout),
                    cancel: None,
                },
            );
        }
        Some(sent)
    }

    /// Whether a reader is an action's; then its feedback has been passed on.
    pub fn receive(&mut self, node: &mut Node, reader: ReaderId) -> bool {
        let opened = self.actions.values().filter_map(|action| action.open.as_ref());
        let Some(open) = opened.into_iter().find(|open| open.reader == reader) else { return false };
        while let Some(sample) = node.take(reader) {
            let Ok(mut message) = decode(&open.feedback, sample.sample) else { continue };
            let call = goal_id(&message["goal_id"]).and_then(|id| self.goals.get(&id)?.call);
            if let Some(call) = call {
                node.robot.feedback(call, message["feedback"].take());
            }
        }
        true
    }

    /// A goal was accepted or rejected, or nobody answered.
    pub fn accepted(
        &mut self,
        node: &mut Node,
        clients: &mut Clients,
        id: GoalId,
        result: Result<Value, String>,
    ) -> Option<Reply> {
        let goal = self.goals.get_mut(&id)?;
        let refused = match result {
            Err(why) => why,
            Ok(response) if response["accepted"] != true => format!("{} rejected the goal", goal.action),
            Ok(_) => {
                goal.stage = Stage::Accepted;
                let asked = clients.ask(
                    node,
                    Request {
                        service: &format!("{}/_action/get_result", goal.action),
                        type_name: &format!("{}_GetResult", goal.type_name),
                        message: &json!({ "goal_id": { "uuid": id } }),
                        then: Then::Finish { goal: id },
                        until: None,
                    },
                );
                if goal.cancel.is_some() {
                    goal.ask_to_cancel(id, node, clients);
                }
                match asked {
                    Ok(()) => return None,
                    Err(why) => why,
                }
            }
        };
        self.goals.remove(&id).and_then(|goal| Some((goal.call?, Err(refused))))
    }

    /// A goal is over.
    pub fn finished(&mut self, id: GoalId, result: Result<Value, String>) -> Option<Reply> {
        let Goal { call, action, cancel, .. } = self.goals.remove(&id)?;
        let outcome = result.and_then(|mut response| {
            let result = response["result"].take();
            match (response["status"].as_i64(), cancel) {
                (Some(SUCCEEDED), _) => Ok(result),
                (Some(CANCELED), Some(why)) => Err(why),
                (Some(CANCELED), None) => Err(format!("the goal of {action} was cancelled by somebody else")),
                (Some(ABORTED), _) => Err(format!("{action} gave up: {result}")),
                (status, _) => Err(format!("{action} ended with status {}", status.unwrap_or_default())),
            }
        });
        Some((call?, outcome))
    }

    /// What came of asking to cancel.
    pub fn cancelled(&mut self, node: &mut Node, id: GoalId, result: Result<Value, String>) {
        let Some(goal) = self.goals.get(&id) else { return };
        let refused = match result {
            Ok(response) => match response["return_code"].as_i64() {
                Some(0 | ALREADY_OVER) => return,
                code => format!("code {}", code.unwrap_or_default()),
            },
            Err(why) => why,
        };
        node.complain(Level::Warn, format!("{} would not cancel: {refused}", goal.action));
    }

    /// The program has lost interest in a call. Whether it was a goal.
    pub fn cancel(&mut self, node: &mut Node, clients: &mut Clients, call: u64, why: &str) -> Option<Vec<Reply>> {
        let id = *self.goals.iter().find(|(_, goal)| goal.call == Some(call))?.0;
        Some(self.cancel_goal(node, clients, id, why).into_iter().collect())
    }

    pub fn cancel_all(&mut self, node: &mut Node, clients: &mut Clients, why: &str) -> Vec<Reply> {
        let ids: Vec<GoalId> = self.goals.keys().copied().collect();
        ids.into_iter().filter_map(|id| self.cancel_goal(node, clients, id, why)).collect()
    }

    fn cancel_goal(&mut self, node: &mut Node, clients: &mut Clients, id: GoalId, why: &str) -> Option<Reply> {
        let goal = self.goals.get_mut(&id)?;
        goal.until = None;
        if goal.cancel.replace(why.to_string()).is_some() {
            return None;
        }
        match goal.stage {
            // One that hasn't left yet doesn't.
            Stage::Sent if clients.withdraw(&Then::Accept { goal: id }) => {
                return self.goals.remove(&id).and_then(|goal| Some((goal.call?, Err(why.to_string()))));
            }
            Stage::Sent => {}
            Stage::Accepted => goal.ask_to_cancel(id, node, clients),
        }
        None
    }

    /// Those that aren't over.
    pub fn open(&self) -> Vec<OpenGoal> {
        self.goals.iter().map(|(id, goal)| OpenGoal { action: goal.action.clone(), id: *id }).collect()
    }

    /// Cancels what takes too long.
    pub fn tick(&mut self, node: &mut Node, clients: &mut Clients, now: Instant) -> Vec<Reply> {
        let is_late = |goal: &Goal| goal.until.is_some_and(|until| until <= now) && goal.stage == Stage::Accepted;
        let late: Vec<GoalId> = self.goals.iter().filter(|(_, goal)| is_late(goal)).map(|(id, _)| *id).collect();
        let cancelled = late.into_iter().filter_map(|id| self.cancel_goal(node, clients, id, "the goal took too long"));
        let mut replies: Vec<Reply> = cancelled.collect();
        let unanswered = |goal: &&mut Goal| goal.stage == Stage::Sent && goal.accept <= now;
        replies.extend(self.goals.values_mut().filter(unanswered).filter_map(Goal::give_up));
        replies
    }
}

impl Action {
    fn type_name(&self, node: &Node) -> Option<String> {
        let found = || {
            let types = node.graph.types(&format!("{}/_action/send_goal", self.wanted.name), Role::Request);
            Some(types.first()?.strip_suffix("_SendGoal_Request")?.to_string())
        };
        self.wanted.type_name.clone().or_else(found)
    }
}

impl Goal {
    fn ask_to_cancel(&self, id: GoalId, node: &mut Node, clients: &mut Clients) {
        OpenGoal { action: self.action.clone(), id }.ask_to_cancel(node, clients);
    }

    /// The call fails; a server that accepts it all the same is asked to cancel it.
    fn give_up(&mut self) -> Option<Reply> {
        let why = format!("{}/_action/send_goal took too long", self.action);
        self.cancel.get_or_insert_with(|| why.clone());
        Some((self.call.take()?, Err(why)))
    }
}

/// A goal that isn't over, as it can be told of to a later node.
pub struct OpenGoal {
    action: String,
    id: GoalId,
}

impl OpenGoal {
    pub fn ask_to_cancel(&self, node: &mut Node, clients: &mut Clients) {
        let asked = clients.ask(
            node,
            Request {
                service: &format!("{}/_action/cancel_goal", self.action),
                type_name: "action_msgs/srv/CancelGoal",
                message: &json!({ "goal_info": { "goal_id": { "uuid": self.id } } }),
                then: Then::Cancel { goal: self.id },
                until: Some(Instant::now() + PATIENCE),
            },
        );
        if let Err(why) = asked {
            node.complain(Level::Error, format!("can't cancel the goal of {}: {why}", self.action));
        }
    }
}

fn open(node: &mut Node, clients: &mut Clients, action: &str, type_name: &str) -> Result<Open, String> {
    let feedback = node.find(&format!("{type_name}_FeedbackMessage"))?;
    let goal = node.find(&format!("{type_name}_Goal"))?;
    for (service, type_name) in services(action, type_name) {
        clients.prepare(node, &service, &type_name)?;
    }
    let topic = format!("{action}/_action/feedback");
    let reader = node.reader(&topic, Role::Topic, &feedback.name, Qos::DEFAULT)?;
    Ok(Open { type_name: type_name.to_string(), goal, feedback, reader })
}

fn services(action: &str, type_name: &str) -> [(String, String); 3] {
    [
        (format!("{action}/_action/send_goal"), format!("{type_name}_SendGoal")),
        (format!("{action}/_action/get_result"), format!("{type_name}_GetResult")),
        (format!("{action}/_action/cancel_goal"), "action_msgs/srv/CancelGoal".to_string()),
    ]
}

/// Like no other goal's, here or elsewhere.
fn new_id(call: u64) -> GoalId {
    let mut id = [0; 16];
    id[..8].copy_from_slice(&RandomState::new().hash_one(call).to_le_bytes());
    id[8..].copy_from_slice(&RandomState::new().hash_one(std::process::id()).to_le_bytes());
    id
}

fn goal_id(value: &Value) -> Option<GoalId> {
    lrp_bridge::value::as_bytes(&value["uuid"])?.try_into().ok()
}
