//! The bridge while it is connected: hands what comes to whom it concerns, and what the program wants to the network.

use std::sync::Arc;
use std::time::{Duration, Instant};

use lrp_bridge::{Call, Level, News, Robot};
use serde_json::{Value, json};

use crate::actions::{Actions, OpenGoal, Reply};
use crate::client::{Clients, Outcome, Then};
use crate::config::Config;
use crate::dds::{Link, ReaderId};
use crate::graph::Incompatible;
use crate::node::Node;
use crate::offer::{Types, description};
use crate::parameters::{self, Parameters};
use crate::services::Services;
use crate::system::System;
use crate::topics::{Inputs, Outputs};
use crate::types::Struct;
use crate::wanted;

/// How late what is due may be; and a message that waits for lrp.
const TICK: Duration = Duration::from_millis(100);
const HELD: Duration = Duration::from_millis(5);

/// How often it is looked whether the network still works.
const LOOK: Duration = Duration::from_millis(500);

/// How often the list of what is found is told at most.
const FOUND: Duration = Duration::from_millis(250);

/// How long until a peer that doesn't get along is told of, although its node's name isn't known.
const NAMELESS: Duration = Duration::from_secs(4);

pub struct Core {
    config: Config,
    node: Node,
    inputs: Inputs,
    outputs: Outputs,
    services: Services,
    actions: Actions,
    clients: Clients,
    parameters: Parameters,
    system: System,
    /// Peers that don't get along with ours, and since when.
    incompatible: Vec<(Incompatible, Instant)>,
    /// The graph's version that everything follows, and the one that has been told.
    followed: u64,
    found: (u64, Instant),
    /// When it was last looked whether the network still works.
    looked: Instant,
}

impl Core {
    pub fn new(robot: Robot, config: Config, link: Link) -> Result<Core, String> {
        let mut core = Core {
            node: Node::new(robot, config.names.clone(), link)?,
            inputs: Inputs::default(),
            outputs: Outputs::default(),
            services: Services::default(),
            actions: Actions::default(),
            clients: Clients::default(),
            parameters: Parameters::default(),
            system: System::default(),
            incompatible: Vec::new(),
            followed: 0,
            found: (0, Instant::now()),
            looked: Instant::now(),
            config: config.clone(),
        };
        core.configure(config)?;
        Ok(core)
    }

    pub fn config(&self) -> &Config {
        &self.config
    }

    /// Changes what differs. Another network or name is another node: not for this.
    pub fn configure(&mut self, config: Config) -> Result<(), String> {
        let Core { node, clients, .. } = self;
        node.mapping = config.mapping;
        node.types.look_in(config.interfaces.clone());
        self.inputs.configure(node, &config.subscribe);
        self.outputs.configure(node, &config.publish);
        self.services.configure(node, clients, &config.services);
        self.actions.configure(node, clients, &config.actions);
        self.system.configure(node, &config)?;
        match config.parameters {
            true => self.parameters.open(node)?,
            false => self.parameters.close(node),
        }
        self.config = config;
        self.offer();
        self.node.tell();
        Ok(())
    }

    fn offer(&self) {
        let own = |(name, kind): (&String, &Arc<Struct>)| (name.clone(), kind.clone());
        let types = Types {
            inputs: self.inputs.types().map(own).collect(),
            outputs: self.outputs.types().map(own).collect(),
            services: self.services.types().map(own).collect(),
            actions: self.actions.types().map(own).collect(),
        };
        self.node.robot.offer(description(&self.config, &types));
    }

    /// These readers have something; and whatever is due. Gives how long the next turn may be away.
    pub fn turn(&mut self, ready: Vec<ReaderId>) -> Duration {
        let now = Instant::now();
        self.discover(now);
        for reader in ready {
            self.receive(reader);
        }
        self.inputs.release(&mut self.node);
        let outcomes = self.clients.tick(&mut self.node, now);
        self.settle(outcomes);
        let late = self.actions.tick(&mut self.node, &mut self.clients, now);
        self.reply(late);
        self.parameters.tick(&self.node, now);
        self.follow();
        wanted::ask(&mut self.node, &mut self.clients, now);
        self.outputs.greet(&self.node, &self.system.time());
        self.node.tell();
        self.tell_found(now);
        if self.inputs.is_holding() { HELD } else { TICK }
    }

    /// Whether the network still works. It is looked at now and then only.
    pub fn is_alive(&mut self) -> bool {
        let is_due = self.looked.elapsed() >= LOOK;
        if is_due {
            self.looked = Instant::now();
        }
        !is_due || self.node.is_alive()
    }

    fn discover(&mut self, now: Instant) {
        let found = self.node.discover().into_iter().map(|incompatible| (incompatible, now));
        self.incompatible.extend(found);
        let graph = &self.node.graph;
        let is_known = |(incompatible, since): &mut (Incompatible, Instant)| {
            graph.node_of(incompatible.theirs).is_some() || now > *since + NAMELESS
        };
        let known: Vec<Incompatible> =
            self.incompatible.extract_if(.., is_known).map(|(incompatible, _)| incompatible).collect();
        for incompatible in known {
            self.inputs.tell(&mut self.node, &incompatible);
            self.outputs.tell(&mut self.node, &incompatible);
        }
    }

    fn receive(&mut self, reader: ReaderId) {
        let node = &mut self.node;
        let is_taken = self.inputs.receive(node, reader)
            || self.actions.receive(node, reader)
            || self.parameters.receive(node, reader)
            || self.system.receive(node, reader)
            || node.hear_of_nodes(reader);
        if !is_taken && let Some(outcomes) = self.clients.receive(node, reader) {
            self.settle(outcomes);
        }
    }

    /// Adapts to what others offer by now.
    fn follow(&mut self) {
        let version = self.node.graph.version();
        if version == self.followed {
            return;
        }
        self.followed = version;
        let Core { node, clients, .. } = self;
        let mut news = self.inputs.follow(node);
        news |= self.outputs.follow(node);
        news |= self.services.follow(node, clients);
        news |= self.actions.follow(node, clients);
        if news {
            self.offer();
        }
    }

    fn learn(&mut self, type_name: &str, result: Result<Value, String>) {
        match wanted::learn(&mut self.node, result) {
            // All look again whether they can go on.
            Ok(()) => self.followed = 0,
            Err(why) => self.node.complain(Level::Warn, format!("no node tells what {type_name} is: {why}")),
        }
    }

    fn tell_found(&mut self, now: Instant) {
        let version = self.node.graph.version();
        if version != self.found.0 && now >= self.found.1 + FOUND {
            self.found = (version, now);
            self.node.robot.found(self.node.graph.list());
        }
    }

    fn settle(&mut self, outcomes: Vec<Outcome>) {
        for (then, result) in outcomes {
            let replies = self.settle_one(then, result);
            self.reply(replies);
        }
    }

    fn settle_one(&mut self, then: Then, result: Result<Value, String>) -> Option<Reply> {
        let Core { node, clients, actions, .. } = self;
        match then {
            Then::Reply { call } => Some((call, result)),
            Then::Accept { goal } => actions.accepted(node, clients, goal, result),
            Then::Finish { goal } => actions.finished(goal, result),
            Then::Cancel { goal } => {
                actions.cancelled(node, goal, result);
                None
            }
            Then::Learn { type_name } => {
                self.learn(&type_name, result);
                None
            }
            Then::Get { call, name } => Some((call, result.and_then(|response| parameters::got(&name, &response)))),
            Then::List { call } => Some((call, result.map(|response| parameters::listed(&response)))),
            Then::Set { call } => Some((call, result.and_then(|response| parameters::was_set(&response)))),
            Then::Typed { call, node: of, name, value } => {
                let set = result.and_then(|types| parameters::set(node, clients, (call, &of, &name, &value), &types));
                set.err().map(|why| (call, Err(why)))
            }
        }
    }

    fn reply(&self, replies: impl IntoIterator<Item = Reply>) {
        replies.into_iter().for_each(|(call, result)| self.node.robot.reply(call, result));
    }

    pub fn send(&mut self, output: &str, message: &Value) {
        self.outputs.send(&mut self.node, output, message);
    }

    pub fn call(&mut self, call: Call) {
        let Call { call: name, id, arguments } = call;
        let Core { node, clients, .. } = self;
        let first = arguments.first().cloned().unwrap_or_else(|| json!({}));
        let begun = parameters::call(node, clients, &name, id, &arguments)
            .or_else(|| self.services.call(node, clients, &name, id, &first))
            .or_else(|| self.actions.start(node, clients, &name, id, &first))
            .unwrap_or_else(|| Err(format!("there is no call `{name}`")));
        if let Err(why) = begun {
            self.node.robot.reply(id, Err(why));
        }
    }

    pub fn cancel(&mut self, id: u64) {
        const WHY: &str = "cancelled by the program";
        match self.actions.cancel(&mut self.node, &mut self.clients, id, WHY) {
            Some(replies) => self.reply(replies),
            None => {
                self.clients.forget(id);
                self.node.robot.reply(id, Err(WHY.to_string()));
            }
        }
    }

    /// Zero velocity to all that moves, and an end to what was to be reached.
    pub fn stop(&mut self) {
        self.outputs.halt(self.system.time());
        let replies = self.actions.cancel_all(&mut self.node, &mut self.clients, "the robot was stopped");
        self.reply(replies);
    }

    /// A halt, and an end to every call: whoever would reply is out of reach from now on.
    /// Gives the goals that are to be cancelled once somebody can be reached.
    pub fn leave(&mut self, why: &str) -> Vec<OpenGoal> {
        self.stop();
        let goals = self.actions.open();
        let mut outcomes = self.clients.give_up(why);
        outcomes.retain(|(then, _)| !matches!(then, Then::Cancel { .. } | Then::Learn { .. }));
        self.settle(outcomes);
        goals
    }

    /// Cancels what an earlier node of ours has begun.
    pub fn cancel_goals(&mut self, goals: &[OpenGoal]) {
        goals.iter().for_each(|goal| goal.ask_to_cancel(&mut self.node, &mut self.clients));
    }

    pub fn hear(&mut self, news: News) {
        match news {
            News::Variables(variables) => self.parameters.learn(variables),
            News::States { machines, .. } => self.system.states(&mut self.node, machines),
            News::Log { level, message, state } => {
                self.system.log(&self.node, level, &message, state.as_deref().unwrap_or_default());
            }
            News::Answer { id, error } => self.parameters.answered(&self.node, id, error),
        }
    }
}
