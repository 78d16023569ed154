//! The network: a participant with readers and writers of bytes, and what is discovered of others. Knows names of DDS
//! only, and no types.

mod join;
pub mod qos;
mod raw;
mod signals;

use std::collections::{BTreeSet, HashMap};
use std::net::IpAddr;
use std::path::PathBuf;
use std::pin::pin;
use std::sync::Arc;
use std::task::{Context, Poll};
use std::time::Duration;

use futures_core::Stream;
use rustdds::no_key::{DataWriter, DeserializedCacheChange, SimpleDataReader};
use rustdds::{
    DomainParticipant, DomainParticipantBuilder, DomainParticipantStatusEvent, Publisher, RTPSEntity, SampleIdentity,
    StatusEvented, Subscriber, TopicKind, WriteOptionsBuilder,
};

pub use raw::Raw;
pub use signals::Signals;

use self::join::{threads, without_multicast};
use self::qos::Qos;
use self::raw::RawAdapter;
use self::signals::{Source, waker};

pub type Sample = DeserializedCacheChange<Raw>;

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
            reader.set_waker(Some(waker(&self.signals, Source::Reader(id.0))));
            // What came between the last look and the waker would wake nobody.
            look()
        })
    }

    /// The next change in what others offer; none: as with samples.
    pub fn discover(&self) -> Option<DomainParticipantStatusEvent> {
        let waker = waker(&self.signals, Source::Discovery);
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
