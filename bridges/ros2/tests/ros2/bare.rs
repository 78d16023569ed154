//! Participants of DDS without a bridge around them, to measure against.

use std::fs::read_to_string;
use std::sync::{Arc, Mutex};
use std::task::{Wake, Waker};
use std::thread::{self, Builder, Thread};
use std::time::Duration;

use rustdds::no_key::{DataWriter, SimpleDataReader};
use rustdds::policy::{History, Reliability};
use rustdds::{
    CDRDeserializerAdapter, CDRSerializerAdapter, DomainParticipant, QosPolicies, QosPolicyBuilder, Topic, TopicKind,
};

type Reader = SimpleDataReader<i64, CDRDeserializerAdapter<i64>>;

fn qos() -> QosPolicies {
    let longest = rustdds::Duration::from_millis(50);
    QosPolicyBuilder::new()
        .reliability(Reliability::Reliable { max_blocking_time: longest })
        .history(History::KeepLast { depth: 10 })
        .build()
}

/// A wake that never came is no reason to hang.
const LOST: Duration = Duration::from_secs(1);

/// Of `std_msgs/msg/Int64`.
fn topic(participant: &DomainParticipant, name: &str) -> Topic {
    let kind = "std_msgs::msg::dds_::Int64_".to_string();
    participant.create_topic(name.into(), kind, &qos(), TopicKind::NoKey).expect("a topic")
}

fn reader(participant: &DomainParticipant, name: &str) -> Reader {
    let subscriber = participant.create_subscriber(&qos()).expect("a subscriber");
    subscriber.create_simple_datareader_no_key(&topic(participant, name), None).expect("a reader")
}

/// The next one; none: when there is, its number is among the woken, and this thread is unparked.
fn take(reader: &Reader, at: usize, woken: &Arc<Mutex<Vec<usize>>>) -> Option<i64> {
    let look = || reader.try_take_one().expect("a sample").map(|sample| sample.sample);
    look().or_else(|| {
        reader.drain_read_notifications();
        let wake = Unpark { at, woken: Arc::clone(woken), thread: thread::current() };
        reader.set_waker(Some(Waker::from(Arc::new(wake))));
        look()
    })
}

struct Unpark {
    at: usize,
    woken: Arc<Mutex<Vec<usize>>>,
    thread: Thread,
}

impl Wake for Unpark {
    fn wake(self: Arc<Self>) {
        self.woken.lock().expect("a list").push(self.at);
        self.thread.unpark();
    }
}

/// Sends a number and waits until it comes back.
pub struct Bare {
    writer: DataWriter<i64, CDRSerializerAdapter<i64>>,
    reader: Reader,
    _participant: DomainParticipant,
}

impl Bare {
    pub fn new(out: &str, back: &str) -> Bare {
        let participant = DomainParticipant::new(0).expect("a participant");
        let publisher = participant.create_publisher(&qos()).expect("a publisher");
        Bare {
            writer: publisher.create_datawriter_no_key(&topic(&participant, out), None).expect("a writer"),
            reader: reader(&participant, back),
            _participant: participant,
        }
    }

    pub fn ping(&self, number: i64) {
        self.writer.write(number, None).expect("written");
        let woken = Arc::default();
        while take(&self.reader, 0, &woken) != Some(number) {
            thread::park_timeout(LOST);
        }
    }
}

/// Takes what comes, on a thread of its own, and makes nothing of it.
pub struct Listener;

const LISTENER: &str = "listener";

impl Listener {
    pub fn start(topics: impl Iterator<Item = String>) -> Listener {
        let participant = DomainParticipant::new(0).expect("a participant");
        let readers: Vec<Reader> = topics.map(|name| reader(&participant, &name)).collect();
        let listen = move || {
            let (_participant, woken) = (participant, Arc::default());
            let mut ready: Vec<usize> = (0..readers.len()).collect();
            loop {
                for at in ready {
                    while take(&readers[at], at, &woken).is_some() {}
                }
                thread::park();
                ready = std::mem::take(&mut *woken.lock().expect("a list"));
            }
        };
        Builder::new().name(LISTENER.into()).spawn(listen).expect("a thread");
        Listener
    }

    /// Seconds of processor time so far: its own, and that of RustDDS in this process.
    pub fn usage(&self) -> f64 {
        let threads = std::fs::read_dir("/proc/self/task").expect("threads").flatten();
        let is_ours = |name: &str| name.starts_with("RustDDS") || name.trim_end() == LISTENER;
        let ours = threads.filter(|thread| is_ours(&read_to_string(thread.path().join("comm")).unwrap_or_default()));
        // Nanoseconds on a processor are its first number.
        let spent = ours.filter_map(|thread| {
            read_to_string(thread.path().join("schedstat")).ok()?.split(' ').next()?.parse::<f64>().ok()
        });
        spent.sum::<f64>() / 1e9
    }
}
