//! A bridge's process: reads orders, has the bridge carry them out on one thread, writes what it says. The robot is
//! stopped whenever lrp is gone or held up, and when the bridge panics.

use std::fs::File;
use std::io::{BufRead, BufReader, Read, Write};
use std::os::fd::{FromRawFd, RawFd};
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::sync::Arc;
use std::sync::mpsc::{RecvTimeoutError, Sender, channel};
use std::thread::Builder;
use std::time::Duration;

use crate::message::{Event, Form, Item, Level, Order, Output};
use crate::orders::{End, Orders};
use crate::robot::Robot;
use crate::{Bridge, News, PROTOCOL, read};

/// How long a bridge may take to stop its robot and end, once lrp is gone.
const END: Duration = Duration::from_secs(2);

const LAST_WORDS: Duration = Duration::from_millis(500);

/// How long lrp, which pings every second, may say nothing before nobody steers the robot: lrp's process was stopped, or
/// gets no time to run.
const SILENCE: Duration = Duration::from_secs(3);

/// What a bridge's process ends with.
const FINE: i32 = 0;
const PANICKED: i32 = 101;
const HUNG: i32 = 70;

/// Speaks for a bridge over the process's standard input and output: the whole `main` of a bridge that is a program.
pub fn run<B: Bridge>() -> i32 {
    Conversation::of_process().speak::<B>(std::io::stdin(), std::io::stdout())
}

/// What the `bridge!` macro exports. The descriptors are the bridge's from now on.
#[doc(hidden)]
pub fn run_on<B: Bridge>(input: RawFd, output: RawFd) -> i32 {
    // SAFETY: whoever loads the library hands over two open descriptors that nobody else uses.
    let (input, output) = unsafe { (File::from_raw_fd(input), File::from_raw_fd(output)) };
    Conversation::of_process().speak::<B>(input, output)
}

pub(crate) struct Conversation {
    robot: Robot,
    orders: Arc<Orders>,
    /// Called, from another thread, where a bridge doesn't end.
    give_up: fn(),
}

impl Conversation {
    fn of_process() -> Conversation {
        let conversation = Conversation::new(|| std::process::exit(HUNG));
        watch_panics(&conversation.robot, &conversation.orders);
        conversation
    }

    pub fn new(give_up: fn()) -> Conversation {
        Conversation { robot: Robot::default(), orders: Arc::default(), give_up }
    }

    /// Until the input is closed.
    pub fn speak<B: Bridge>(self, input: impl Read + Send + 'static, mut output: impl Write + Send + 'static) -> i32 {
        let Conversation { robot, orders, give_up } = self;
        robot.say(Event::Hello { protocol: PROTOCOL, about: B::about() });
        let (alive, ended) = channel::<()>();
        let (written, all_written) = channel::<()>();
        let (reading, telling, writing) = (Arc::clone(&orders), robot.clone(), robot.clone());
        let reader = Builder::new().name("reader".into()).spawn(move || {
            read(input, &reading, &telling);
            if ended.recv_timeout(END) == Err(RecvTimeoutError::Timeout) {
                give_up();
            }
        });
        let writer = Builder::new().name("writer".into()).spawn(move || {
            let _written: Sender<()> = written;
            writing.write(&mut output);
        });
        if reader.is_err() || writer.is_err() {
            return HUNG;
        }
        let code = serve::<B>(&robot, &orders);
        robot.close();
        // Perhaps nobody reads any more.
        let _ = all_written.recv_timeout(LAST_WORDS);
        drop(alive);
        code
    }
}

fn read(input: impl Read, orders: &Orders, robot: &Robot) {
    for line in BufReader::new(input).lines() {
        let Ok(line) = line else { break };
        // What this version doesn't know is left out, so that a newer lrp can say more.
        if let Some(order) = read::order(&line) {
            let is_stop = order == Order::Stop;
            let dropped = orders.put(order);
            if !is_stop && !dropped.is_empty() {
                robot.dropped("outputs and calls", dropped.len() as u64);
            }
            for item in dropped {
                if let Item::Call(call) = item {
                    robot.reply(call.id, Err("given up before it began".to_string()));
                }
            }
        }
    }
    orders.end(End::Closed);
}

fn serve<B: Bridge>(robot: &Robot, orders: &Orders) -> i32 {
    let mut bridge: Option<B> = None;
    // Once it pings; and no longer than it is heard.
    let mut is_to_be_heard = false;
    loop {
        let taken = if is_to_be_heard { orders.take_within(SILENCE) } else { Some(orders.take()) };
        let end = match taken {
            Some(Ok(order)) => {
                is_to_be_heard |= matches!(order, Order::Ping { .. });
                let obey = AssertUnwindSafe(|| obey(&mut bridge, order, robot));
                catch_unwind(obey).err().map(|_| End::Panicked)
            }
            Some(Err(end)) => Some(end),
            None => {
                is_to_be_heard = false;
                let stop = AssertUnwindSafe(|| unsteered(&mut bridge, robot));
                catch_unwind(stop).err().map(|_| End::Panicked)
            }
        };
        if let Some(end) = end {
            let stop = AssertUnwindSafe(|| {
                if let Some(mut bridge) = bridge {
                    bridge.stop();
                }
            });
            return match (catch_unwind(stop), end) {
                (Ok(()), End::Closed) => FINE,
                _ => PANICKED,
            };
        }
    }
}

fn obey<B: Bridge>(bridge: &mut Option<B>, order: Order, robot: &Robot) {
    match order {
        Order::Describe { config } => match B::offer(&config) {
            Ok(description) => robot.offer(description),
            Err(problems) => robot.refuse(problems),
        },
        Order::Configure(form) => configure(bridge, form, robot),
        Order::Ping { id } => robot.say(Event::Pong { id }),
        Order::Stop => {
            bridge.iter_mut().for_each(Bridge::stop);
            robot.say(Event::Stopped);
        }
        order => {
            // Before anything is configured there is nobody to tell.
            if let Some(bridge) = bridge {
                tell(bridge, order);
            }
        }
    }
}

fn unsteered<B: Bridge>(bridge: &mut Option<B>, robot: &Robot) {
    if let Some(bridge) = bridge {
        bridge.stop();
        let silence = SILENCE.as_secs();
        robot.log(Level::Warn, format!("the robot was stopped: lrp was held up, and said nothing for {silence} s"));
    }
}

fn configure<B: Bridge>(bridge: &mut Option<B>, form: Form, robot: &Robot) {
    match B::offer(&form.config) {
        Err(problems) => robot.refuse(problems),
        Ok(description) => {
            robot.offer(description);
            match bridge {
                Some(bridge) => bridge.configure(form),
                None => *bridge = Some(B::connect(robot.clone(), form)),
            }
        }
    }
}

fn tell<B: Bridge>(bridge: &mut B, order: Order) {
    match order {
        Order::Send { items } => {
            for item in items {
                match item {
                    Item::Output(Output { output, value }) => bridge.send(&output, value),
                    Item::Call(call) => bridge.call(call),
                }
            }
            bridge.flush();
        }
        Order::Cancel { id } => bridge.cancel(id),
        Order::Answer { id, error } => bridge.hear(News::Answer { id, error }),
        Order::Variables { variables } => bridge.hear(News::Variables(variables)),
        Order::States { t, machines } => bridge.hear(News::States { t, machines }),
        Order::Log { level, message, state } => bridge.hear(News::Log { level, message, state }),
        Order::Describe { .. } | Order::Configure(_) | Order::Ping { .. } | Order::Stop => {}
    }
}

/// A bridge with a panicked thread can't be relied on: it stops its robot and ends, and lrp starts it anew.
fn watch_panics(robot: &Robot, orders: &Arc<Orders>) {
    let (robot, orders, usual) = (robot.clone(), Arc::clone(orders), std::panic::take_hook());
    std::panic::set_hook(Box::new(move |panic| {
        robot.log(Level::Error, format!("the bridge panicked: {panic}"));
        orders.end(End::Panicked);
        usual(panic);
    }));
}
