//! A network that ends at this machine, and in it nodes of rclpy that do what a test tells them.

use std::collections::VecDeque;
use std::io::{BufRead, BufReader, Write};
use std::process::{Child, ChildStdin, Command, Stdio};
use std::sync::mpsc::{Receiver, channel};
use std::time::{Duration, Instant};

use serde_json::{Value, json};

use crate::peers;

/// How long a test waits before it fails.
pub const PATIENCE: Duration = Duration::from_secs(30);

const INSIDE: &str = "LRP_INSIDE_NETWORK";

/// Runs a test of this binary again, in a network namespace of its own with nothing but loopback. Whether this is that run;
/// none: it is over, or the peers are missing.
pub fn enter(test: &str) -> Option<()> {
    enter_with(test, &[])
}

/// The same, with something in the environment.
pub fn enter_with(test: &str, environment: &[(&str, &str)]) -> Option<()> {
    if std::env::var_os(INSIDE).is_some() {
        return Some(());
    }
    peers::python("")?;
    let unshare = lrp_peers::program("unshare")?;
    let ready = "ip link set lo up multicast on && ip route add 224.0.0.0/4 dev lo && exec \"$@\"";
    let status = Command::new(unshare)
        .args(["--map-root-user", "--net", "sh", "-c", ready, "sh"])
        .arg(std::env::current_exe().expect("this program"))
        .args([test, "--exact", "--include-ignored", "--nocapture", "--test-threads=1"])
        .env(INSIDE, "1")
        // Logs of the peers' own would go into the user's home.
        .env("ROS_LOG_DIR", std::env::temp_dir())
        .env("RUST_BACKTRACE", "0")
        .env_remove("ROS_DOMAIN_ID")
        .env_remove("ROS_LOCALHOST_ONLY")
        .env_remove("ROS_AUTOMATIC_DISCOVERY_RANGE")
        .env_remove("AMENT_PREFIX_PATH")
        .envs(environment.iter().copied())
        .status()
        .expect("unshare");
    assert!(status.success(), "{test} failed inside its network");
    None
}

/// A node of rclpy.
pub struct Node {
    child: Child,
    orders: Option<ChildStdin>,
    said: Receiver<Value>,
    /// What nobody has asked about yet.
    kept: VecDeque<Value>,
}

impl Node {
    pub fn start(name: &str) -> Node {
        Node::of(peers::python("node.py").expect("a peer").arg(name))
    }

    pub fn of(command: &mut Command) -> Node {
        let mut child = command.stdin(Stdio::piped()).stdout(Stdio::piped()).spawn().expect("python");
        let (orders, said) = (child.stdin.take().expect("its input"), child.stdout.take().expect("its output"));
        let (sender, receiver) = channel();
        std::thread::spawn(move || {
            for line in BufReader::new(said).lines().map_while(Result::ok) {
                if serde_json::from_str(&line).map(|said| sender.send(said)).is_err() {
                    eprintln!("{line}");
                }
            }
        });
        let mut node = Node { child, orders: Some(orders), said: receiver, kept: VecDeque::new() };
        node.until("up");
        node
    }

    pub fn tell(&mut self, order: Value) {
        self.order(order);
        self.until("done");
    }

    fn order(&mut self, order: Value) {
        writeln!(self.orders.as_mut().expect("its input"), "{order}").expect("a peer that listens");
    }

    /// The next thing said that has this key. The others are kept.
    pub fn until(&mut self, key: &str) -> Value {
        self.until_where(key, |_| true)
    }

    pub fn until_where(&mut self, key: &str, fits: impl Fn(&Value) -> bool) -> Value {
        let end = Instant::now() + PATIENCE;
        let is_it = |said: &Value| said.get(key).is_some() && fits(said);
        loop {
            if let Some(said) = self.kept.iter().position(is_it).and_then(|at| self.kept.remove(at)) {
                return said;
            }
            match self.said.recv_timeout(end.saturating_duration_since(Instant::now())) {
                Ok(said) => self.kept.push_back(said),
                Err(_) => panic!("the peer said no `{key}`, but {:#?}", self.kept),
            }
        }
    }

    /// Asks again until what it sees is as wanted: discovery takes its time.
    pub fn graph_where(&mut self, node: &str, fits: impl Fn(&Value) -> bool) -> Value {
        let end = Instant::now() + PATIENCE;
        loop {
            self.order(json!({ "do": "graph", "node": node }));
            let seen = self.until("graph");
            if fits(&seen) {
                return seen;
            }
            assert!(Instant::now() < end, "the peer sees {seen:#?}");
            std::thread::sleep(Duration::from_millis(50));
        }
    }

    /// Says goodbye to the others, and ends.
    pub fn leave(mut self) {
        self.orders = None;
        self.child.wait().expect("its end");
    }

    pub fn kill(mut self) {
        self.child.kill().expect("a peer to kill");
        self.child.wait().expect("its end");
    }
}

impl Drop for Node {
    fn drop(&mut self) {
        let _ = self.child.kill();
        let _ = self.child.wait();
    }
}
