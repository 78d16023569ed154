//! The bridge as lrp sees it: one thread that joins, receives and gives up; lrp's thread, which sends.

use std::path::Path;
use std::sync::{Arc, Condvar, Mutex, MutexGuard};
use std::thread::{Builder, JoinHandle};
use std::time::Duration;

use lrp_bridge::{About, Bridge, Call, Description, Form, Level, News, Problem, Robot, Want};
use serde_json::Value;

use crate::actions::OpenGoal;
use crate::config::{Config, settings};
use crate::core::Core;
use crate::dds::{Link, Signals};
use crate::offer::before_connecting;

/// How long until another try to join.
const TRY_AGAIN: Duration = Duration::from_secs(2);

pub struct Ros2 {
    shared: Arc<Shared>,
    thread: Option<JoinHandle<()>>,
}

struct Shared {
    robot: Robot,
    state: Mutex<State>,
    changed: Condvar,
}

#[derive(Default)]
struct State {
    wanted: Form,
    core: Option<Core>,
    signals: Option<Arc<Signals>>,
    is_over: bool,
    /// Goals of an earlier node, to be cancelled.
    open: Vec<OpenGoal>,
}

impl Bridge for Ros2 {
    fn about() -> About {
        About {
            kind: "ros2".to_string(),
            version: env!("CARGO_PKG_VERSION").to_string(),
            summary: "robots that speak ROS 2; needs no ROS here".to_string(),
            settings: settings(),
            wants: vec![Want::Variables, Want::States, Want::Log],
        }
    }

    fn offer(config: &Value) -> Result<Description, Vec<Problem>> {
        before_connecting(&Config::read(config, Path::new(""))?)
    }

    fn connect(robot: Robot, form: Form) -> Ros2 {
        robot.connecting("joining");
        let state = State { wanted: form, ..State::default() };
        let shared = Arc::new(Shared { robot, state: Mutex::new(state), changed: Condvar::new() });
        let own = Arc::clone(&shared);
        let thread = Builder::new().name("ros2".into()).spawn(move || own.run());
        if let Err(error) = &thread {
            shared.robot.lost(format!("no thread: {error}"));
        }
        Ros2 { shared, thread: thread.ok() }
    }

    fn configure(&mut self, form: Form) {
        self.shared.state().configure(form, &self.shared.robot);
    }

    fn send(&mut self, output: &str, message: Value) {
        if let Some(core) = &mut self.shared.state().core {
            core.send(output, &message);
        }
    }

    fn call(&mut self, call: Call) {
        match &mut self.shared.state().core {
            Some(core) => core.call(call),
            None => self.shared.robot.reply(call.id, Err("the bridge isn't connected".to_string())),
        }
    }

    fn cancel(&mut self, id: u64) {
        if let Some(core) = &mut self.shared.state().core {
            core.cancel(id);
        }
    }

    fn stop(&mut self) {
        if let Some(core) = &mut self.shared.state().core {
            core.stop();
        }
    }

    fn hear(&mut self, news: News) {
        // What is said before is said again once it is up.
        if let Some(core) = &mut self.shared.state().core {
            core.hear(news);
        }
    }
}

impl Drop for Ros2 {
    fn drop(&mut self) {
        let mut state = self.shared.state();
        state.is_over = true;
        if let Some(signals) = &state.signals {
            signals.close();
        }
        drop(state);
        self.shared.changed.notify_all();
        if let Some(thread) = self.thread.take() {
            // It says goodbye to the others.
            let _ = thread.join();
        }
    }
}

impl State {
    /// What is connected takes over what differs; on another network or under another name the thread begins anew.
    fn configure(&mut self, form: Form, robot: &Robot) {
        self.wanted = form;
        let (Some(core), Ok(config)) = (&mut self.core, Config::read(&self.wanted.config, &self.wanted.folder)) else {
            return;
        };
        if core.config().network == config.network && core.config().names == config.names {
            if let Err(why) = core.configure(config) {
                robot.log(Level::Error, why);
            }
        } else if let Some(signals) = &self.signals {
            signals.close();
        }
    }
}

impl Shared {
    fn state(&self) -> MutexGuard<'_, State> {
        self.state.lock().unwrap_or_else(|poisoned| poisoned.into_inner())
    }

    /// Joins, serves until it is to be left, and joins again, until it is over.
    fn run(&self) {
        loop {
            let wanted = match &*self.state() {
                State { is_over: true, .. } => return,
                state => state.wanted.clone(),
            };
            match self.join(&wanted) {
                Ok(signals) => {
                    let why = self.serve(&signals);
                    self.leave(why);
                }
                Err(why) => {
                    self.robot.lost(why);
                    let waited = self.changed.wait_timeout_while(self.state(), TRY_AGAIN, |state| !state.is_over);
                    drop(waited);
                }
            }
        }
    }

    fn join(&self, wanted: &Form) -> Result<Arc<Signals>, String> {
        let wrong = |problems: Vec<Problem>| problems.into_iter().map(|problem| problem.message).collect::<String>();
        let config = Config::read(&wanted.config, &wanted.folder).map_err(wrong)?;
        let link = Link::open(config.network.domain, config.network.only.clone())?;
        let signals = link.signals();
        let mut core = Core::new(self.robot.clone(), config, link)?;
        let state = &mut *self.state();
        core.cancel_goals(&std::mem::take(&mut state.open));
        state.core = Some(core);
        state.signals = Some(Arc::clone(&signals));
        self.robot.up();
        if state.is_over {
            signals.close();
        } else if state.wanted != *wanted {
            state.configure(state.wanted.clone(), &self.robot);
        }
        Ok(signals)
    }

    /// Until the network is to be left; gives why.
    fn serve(&self, signals: &Signals) -> &'static str {
        let mut soon = Duration::ZERO;
        while let Some(ready) = signals.wait(soon) {
            if let Some(core) = &mut self.state().core {
                soon = core.turn(ready);
                if !core.is_alive() {
                    return "joining again: this process was held up, and its network with it";
                }
            }
        }
        "joining another network, or under another name"
    }

    fn leave(&self, why: &str) {
        let mut state = self.state();
        state.signals = None;
        let core = state.core.take();
        if !state.is_over {
            self.robot.connecting(why);
        }
        drop(state);
        if let Some(mut core) = core {
            let open = core.leave(why);
            drop(core);
            self.state().open = open;
        }
    }
}
