//! Payloads as they are: RustDDS carries bytes, and the codec makes something of them.

use std::convert::Infallible;

use rustdds::RepresentationIdentifier;
use rustdds::bytes::Bytes;
use rustdds::no_key::{Decode, DefaultDecoder, DeserializerAdapter, SerializerAdapter};

use crate::cdr::Order;

/// The payload of a message, without its encapsulation header.
#[derive(Clone, Debug, PartialEq)]
pub struct Raw {
    pub bytes: Bytes,
    pub order: Order,
}

impl Raw {
    pub fn little(bytes: Vec<u8>) -> Raw {
        Raw { bytes: bytes.into(), order: Order::Little }
    }
}

pub struct RawAdapter;

#[derive(Clone)]
pub struct RawDecoder;

impl DeserializerAdapter<Raw> for RawAdapter {
    type Error = Infallible;
    type Decoded = Raw;

    fn supported_encodings() -> &'static [RepresentationIdentifier] {
        &[RepresentationIdentifier::CDR_LE, RepresentationIdentifier::CDR_BE]
    }

    fn transform_decoded(decoded: Raw) -> Raw {
        decoded
    }
}

impl DefaultDecoder<Raw> for RawAdapter {
    type Decoder = RawDecoder;
    const DECODER: RawDecoder = RawDecoder;
}

impl Decode<'_, Raw> for RawDecoder {
    type Error = Infallible;

    fn decode_bytes(self, bytes: &[u8], encoding: RepresentationIdentifier) -> Result<Raw, Infallible> {
        let order = if encoding == RepresentationIdentifier::CDR_BE { Order::Big } else { Order::Little };
        Ok(Raw { bytes: Bytes::copy_from_slice(bytes), order })
    }
}

impl SerializerAdapter<Raw> for RawAdapter {
    type Error = Infallible;

    fn output_encoding() -> RepresentationIdentifier {
        RepresentationIdentifier::CDR_LE
    }

    fn to_bytes(raw: &Raw) -> Result<Bytes, Infallible> {
        Ok(raw.bytes.clone())
    }
}
