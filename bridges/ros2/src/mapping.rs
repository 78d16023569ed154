//! How a request says whose it is, and a reply which request it answers. Vendors do it differently: Fast DDS beside the
//! payload, Cyclone in a header in front of it.

use rustdds::SampleIdentity;

use crate::cdr::Order;
use crate::dds::{Raw, Sample, Writer};
use crate::graph::{Guid, is_cyclone};

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Mapping {
    /// Beside the payload.
    FastDds,
    /// In front of it.
    Cyclone,
}

impl Mapping {
    /// As the vendor of an endpoint does it.
    pub fn of(guid: Guid) -> Mapping {
        if is_cyclone(&guid) { Mapping::Cyclone } else { Mapping::FastDds }
    }
}

/// What Cyclone puts in front of a request, and of the reply to it: both numbers in the message's byte order. What follows
/// is aligned as if nothing were before it, since the header is as long as two of the widest fields.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Header {
    client: u64,
    pub number: i64,
}

impl Header {
    /// For a request of the client that has this writer.
    pub fn new(writer: Guid, number: i64) -> Header {
        // The end of a guid differs within a participant, its middle among them.
        let [.., a, b, c, d, e, f, g, h] = writer;
        Header { client: u64::from_le_bytes([a, b, c, d, e, f, g, h]), number }
    }

    /// Whether a reply is for the client that has this writer.
    pub fn is_of(&self, writer: Guid) -> bool {
        self.client == Header::new(writer, 0).client
    }

    /// The message behind it, to be sent.
    pub fn before(self, message: &[u8]) -> Vec<u8> {
        [&self.client.to_le_bytes(), self.number.to_le_bytes().as_slice(), message].concat()
    }

    /// A header, and the message that came behind it.
    pub fn read(raw: &Raw) -> Option<(Header, Raw)> {
        let (client, rest) = raw.bytes.split_first_chunk()?;
        let (number, message) = rest.split_first_chunk()?;
        let header = match raw.order {
            Order::Little => Header { client: u64::from_le_bytes(*client), number: i64::from_le_bytes(*number) },
            Order::Big => Header { client: u64::from_be_bytes(*client), number: i64::from_be_bytes(*number) },
        };
        Some((header, Raw { bytes: raw.bytes.slice_ref(message), order: raw.order }))
    }
}

/// Whom a reply is for.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Asker {
    /// One of its endpoints.
    pub guid: Guid,
    request: Identity,
}

/// Which request is answered, as the asker wants to be told.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Identity {
    Beside(SampleIdentity),
    InFront(Header),
}

impl Asker {
    pub fn answer(&self, writer: &Writer, bytes: Vec<u8>) -> Result<(), String> {
        let written = match self.request {
            Identity::Beside(identity) => writer.write_related(bytes, Some(identity)),
            Identity::InFront(header) => writer.write(header.before(&bytes)),
        };
        written.map(|_| ())
    }
}

/// Who asks, and what. Clients of several vendors may ask the same service.
pub fn request(sample: Sample, mapping: Option<Mapping>) -> Option<(Asker, Raw)> {
    let guid = sample.writer_guid().to_bytes();
    let (request, raw) = match mapping.unwrap_or_else(|| Mapping::of(guid)) {
        Mapping::FastDds => (Identity::Beside(identity(&sample)), sample.sample),
        Mapping::Cyclone => {
            let (header, raw) = Header::read(&sample.sample)?;
            (Identity::InFront(header), raw)
        }
    };
    Some((Asker { guid, request }, raw))
}

/// Some clients say that another one than who wrote wants the reply.
fn identity(sample: &Sample) -> SampleIdentity {
    let own = SampleIdentity { writer_guid: sample.writer_guid(), sequence_number: sample.sequence_number };
    match sample.related_sample_identity() {
        Some(related) if related.writer_guid.to_bytes() != [0; 16] => {
            SampleIdentity { writer_guid: related.writer_guid, ..own }
        }
        _ => own,
    }
}

/// What a reply to the client that has this writer says, and to which of its requests. None: it is for somebody else.
pub fn reply(sample: Sample, writer: Guid, mapping: Option<Mapping>) -> Option<(i64, Raw)> {
    match mapping.unwrap_or_else(|| Mapping::of(sample.writer_guid().to_bytes())) {
        Mapping::FastDds => {
            let SampleIdentity { writer_guid, sequence_number } = sample.related_sample_identity()?;
            (writer_guid.to_bytes() == writer).then(|| (i64::from(sequence_number), sample.sample))
        }
        Mapping::Cyclone => {
            let (header, raw) = Header::read(&sample.sample)?;
            header.is_of(writer).then_some((header.number, raw))
        }
    }
}
