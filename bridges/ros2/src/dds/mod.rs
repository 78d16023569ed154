//! The network: a participant with readers and writers of bytes, and what is discovered of others. Knows names of DDS
//! only, and no types.

pub mod qos;
mod raw;

use std::collections::{BTreeSet, HashMap};
use std::fs::{read_dir, read_to_string};
use std::io;
use std::net::{IpAddr, Ipv4Addr, SocketAddrV4};
use std::path::PathBuf;
use std::pin::pin;
use std::sync::{Arc, Condvar, Mutex, MutexGuard};
use std::task::{Context, Poll, Wake, Waker};
use std::thread::sleep;
use std::time::{Duration, Instant};

use futures_core::Stream;
use rustdds::no_key::{DataWriter, DeserializedCacheChange, SimpleDataReader};
use rustdds::{
    DomainParticipant, DomainParticipantBuilder, DomainParticipantStatusEvent, Publisher, RTPSEntity, SampleIdentity,
    StatusEvented, Subscriber, TopicKind, WriteOptionsBuilder,
};

use socket2::{Socket, Type};

pub use raw::Raw;
use raw::RawAdapter;

use crate::dds::qos::Qos;

pub type Sample = DeserializedCacheChange<Raw>;

/// Where messages to a multicast address go, by the RTPS specification (9.6.2.3).
const MESSAGES_PORT: u16 = 7401;
const PORTS_PER_DOMAIN: u16 = 250;

/// How long the port may be somebody else's.
const PORT_PATIENCE: Duration = Duration::from_millis(100);

pub struct Link {
    participant: DomainParticipant,
    discovery: rustdds::DomainParticipantStatusListener,
    publisher: Publisher,
    subscriber: Subscriber,
    readers: HashMap<usize, SimpleDataReader<Raw, RawAdapter>>,
    next: usize,
    signals: Arc<Signals>,
    /// RustDDS's, in /proc.
    threads: BTreeSet<PathBuf>,
}

/// A reader of the link.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub struct ReaderId(usize);

/// Which readers have something, and whether discovery has, for the thread that waits for it.
#[derive(Default)]
pub struct Signals {
    ready: Mutex<Ready>,
    woken: Condvar,
}

#[derive(Default)]
struct Ready {
    readers: BTreeSet<usize>,
    discovery: bool,
    closed: bool,
}

pub struct Writer {
    writer: DataWriter<Raw, RawAdapter>,
    pub qos: Qos,
}

impl Link {
    /// With addresses: only their networks are used.
    pub fn open(domain: u16, networks: Option<Vec<IpAddr>>) -> Result<Link, String> {
        let mut builder = DomainParticipantBuilder::new(domain);
        if let Some(networks) = networks {
            builder = builder.with_only_networks(networks);
        }
        let failed = |error: rustdds::dds::CreateError| format!("can't join DDS domain {domain}: {error:?}");
        let others = threads();
        let participant = without_multicast(domain, || builder.build()).map_err(failed)?;
        let policies = Qos::DEFAULT.for_writer();
        Ok(Link {
            discovery: participant.status_listener(),
            publisher: participant.create_publisher(&policies).map_err(failed)?,
            subscriber: participant.create_subscriber(&policies).map_err(failed)?,
            participant,
            readers: HashMap::new(),
            next: 0,
            signals: Arc::default(),
            threads: &threads() - &others,
        })
    }

    pub fn guid(&self) -> [u8; 16] {
        self.participant.guid().to_bytes()
    }

    pub fn signals(&self) -> Arc<Signals> {
        Arc::clone(&self.signals)
    }

    pub fn read(&mut self, topic: &str, type_name: &str, qos: Qos) -> Result<ReaderId, String> {
        let policies = qos.for_reader();
        let topic = self.topic(topic, type_name, &policies)?;
        let reader = self
            .subscriber
            .create_simple_datareader_no_key(&topic, Some(policies))
            .map_err(|error| format!("can't read `{}`: {error:?}", rustdds::TopicDescription::name(&topic)))?;
        let id = self.next;
        self.next += 1;
        self.readers.insert(id, reader);
        // What comes before the first look must not be missed.
        self.signals.wake(Source::Reader(id));
        Ok(ReaderId(id))
    }

    pub fn close_reader(&mut self, id: ReaderId) {
        self.readers.remove(&id.0);
    }

    pub fn write(&self, topic: &str, type_name: &str, qos: Qos) -> Result<Writer, String> {
        let topic = self.topic(topic, type_name, &qos.for_reader())?;
        let writer = self
            .publisher
            .create_datawriter_no_key(&topic, Some(qos.for_writer()))
            .map_err(|error| format!("can't write `{}`: {error:?}", rustdds::TopicDescription::name(&topic)))?;
        Ok(Writer { writer, qos })
    }

    fn topic(&self, name: &str, type_name: &str, policies: &rustdds::QosPolicies) -> Result<rustdds::Topic, String> {
        self.participant
            .create_topic(name.to_string(), type_name.to_string(), policies, TopicKind::NoKey)
            .map_err(|error| format!("can't use `{name}` as {type_name}: {error:?}"))
    }

    pub fn reader_guid(&self, id: ReaderId) -> Option<[u8; 16]> {
        self.readers.get(&id.0).map(|reader| reader.guid().to_bytes())
    }

    /// The next sample of a reader; none: there is no more for now, and its signal comes when there is.
    pub fn take(&self, id: ReaderId) -> Option<Result<Sample, String>> {
        let reader = self.readers.get(&id.0)?;
        let look = || reader.try_take_one().map_err(|error| format!("{error:?}")).transpose();
        look().or_else(|| {
            reader.drain_read_notifications();
            reader.set_waker(Some(self.waker(Source::Reader(id.0))));
            // What came between the last look and the waker would wake nobody.
            look()
        })
    }

    /// The next change in what others offer; none: as with samples.
    pub fn discover(&self) -> Option<DomainParticipantStatusEvent> {
        let waker = self.waker(Source::Discovery);
        match pin!(self.discovery.as_async_status_stream()).poll_next(&mut Context::from_waker(&waker)) {
            Poll::Ready(event) => event,
            Poll::Pending => None,
        }
    }

    /// Whether RustDDS still works: its threads end, and nobody is told, where a process is held up for a moment, as by
    /// SIGSTOP or on a computer that sleeps (its poll is interrupted). Known on Linux only.
    pub fn is_alive(&self) -> bool {
        self.threads.iter().all(|thread| thread.exists())
    }

    fn waker(&self, source: Source) -> Waker {
        Waker::from(Arc::new(Signal { source, signals: self.signals() }))
    }
}

/// Threads of RustDDS in this process.
fn threads() -> BTreeSet<PathBuf> {
    let all = read_dir("/proc/self/task").into_iter().flatten().flatten().map(|thread| thread.path());
    let is_one = |thread: &PathBuf| read_to_string(thread.join("comm")).is_ok_and(|name| name.starts_with("RustDDS"));
    all.filter(is_one).collect()
}

/// Builds a participant that offers no multicast address for messages, only one for discovery. RustDDS would offer both
/// that and its own address, and then Fast DDS sends everything twice, on wireless networks at a crawl; and the second copy
/// of a big message's last part is kept as if it were a message to come.
///
/// There is no setting for it, but RustDDS goes without where it can't have the port; so nobody else can for these few
/// milliseconds either.
fn without_multicast<T>(domain: u16, build: impl FnOnce() -> T) -> T {
    let address = SocketAddrV4::new(Ipv4Addr::UNSPECIFIED, MESSAGES_PORT + domain * PORTS_PER_DOMAIN);
    let end = Instant::now() + PORT_PATIENCE;
    let mut taken = take(address);
    // Another bridge may be at the same point.
    while taken.is_err() && Instant::now() < end {
        sleep(Duration::from_millis(5));
        taken = take(address);
    }
    let built = build();
    drop(taken);
    built
}

/// Takes a port that others may share, as those of Cyclone do, and from now on shares it with nobody else.
fn take(address: SocketAddrV4) -> io::Result<Socket> {
    let socket = Socket::new(socket2::Domain::IPV4, Type::DGRAM, None)?;
    socket.set_reuse_address(true)?;
    socket.bind(&address.into())?;
    socket.set_reuse_address(false)?;
    Ok(socket)
}

impl Writer {
    pub fn guid(&self) -> [u8; 16] {
        self.writer.guid().to_bytes()
    }

    pub fn write(&self, bytes: Vec<u8>) -> Result<SampleIdentity, String> {
        self.write_related(bytes, None)
    }

    /// In answer to something.
    pub fn write_related(&self, bytes: Vec<u8>, to: Option<SampleIdentity>) -> Result<SampleIdentity, String> {
        let options = WriteOptionsBuilder::new()
            .source_timestamp(rustdds::Timestamp::now())
            .related_sample_identity_opt(to)
            .build();
        self.writer.write_with_options(Raw::little(bytes), options).map_err(|error| match error {
            rustdds::dds::WriteError::WouldBlock { .. } => "those who listen are too far behind".to_string(),
            other => format!("{other:?}"),
        })
    }

    /// Waits until all who listen have what was written, or it takes too long.
    pub fn settle(&self, longest: Duration) {
        let _ = self.writer.wait_for_acknowledgments(longest);
    }
}

/// What may have something.
#[derive(Clone, Copy)]
enum Source {
    Reader(usize),
    Discovery,
}

struct Signal {
    source: Source,
    signals: Arc<Signals>,
}

impl Wake for Signal {
    fn wake(self: Arc<Self>) {
        self.signals.wake(self.source);
    }
}

impl Signals {
    fn wake(&self, source: Source) {
        let mut ready = self.ready();
        match source {
            Source::Reader(id) => _ = ready.readers.insert(id),
            Source::Discovery => ready.discovery = true,
        }
        drop(ready);
        self.woken.notify_one();
    }

    /// Ends the waiting for good.
    pub fn close(&self) {
        self.ready().closed = true;
        self.woken.notify_one();
    }

    /// Waits, but no longer than this, and gives the readers that have something. None: it is over.
    pub fn wait(&self, longest: Duration) -> Option<Vec<ReaderId>> {
        let is_quiet = |ready: &mut Ready| ready.readers.is_empty() && !ready.discovery && !ready.closed;
        let woken = self.woken.wait_timeout_while(self.ready(), longest, is_quiet);
        let mut ready = woken.unwrap_or_else(|poisoned| poisoned.into_inner()).0;
        ready.discovery = false;
        (!ready.closed).then(|| std::mem::take(&mut ready.readers).into_iter().map(ReaderId).collect())
    }

    fn ready(&self) -> MutexGuard<'_, Ready> {
        self.ready.lock().unwrap_or_else(|poisoned| poisoned.into_inner())
    }
}
