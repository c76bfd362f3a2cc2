//! Frames.

use core::fmt;

use serde::de::{Error, Unexpected, Visitor};
use serde::{Deserialize, Deserializer, Serialize, Serializer};

use crate::{Data, Frame};

impl Serialize for Frame {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        if serializer.is_human_readable() {
            return serializer.collect_str(self);
        }
        let extended = embedded_can::Frame::is_extended(self);
        let length = u8::try_from(self.length()).unwrap_or(8);
        (self.raw_id(), extended, length, self.bytes()).serialize(serializer)
    }
}

impl<'de> Deserialize<'de> for Frame {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        if deserializer.is_human_readable() {
            return deserializer.deserialize_str(FrameVisitor);
        }
        let (id, extended, length, data) = Deserialize::deserialize(deserializer)?;
        Ok(Self::new_raw(id, extended, data, length))
    }
}

struct FrameVisitor;

impl Visitor<'_> for FrameVisitor {
    type Value = Frame;

    fn expecting(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        formatter.write_str("a frame such as `029C03F0#000B71B000003A98`")
    }

    fn visit_str<E: Error>(self, text: &str) -> Result<Frame, E> {
        parse(text).ok_or_else(|| E::invalid_value(Unexpected::Str(text), &self))
    }
}

/// Reads a frame as a log shows it: 8 digits are a 29-bit identifier, and 3 digits an 11-bit one.
fn parse(text: &str) -> Option<Frame> {
    let (id, digits) = text.split_once('#')?;
    let extended = id.len() == 8;
    let (mut data, mut length) = (Data::default(), 0);
    for (byte, pair) in data.iter_mut().zip(digits.as_bytes().chunks(2)) {
        let pair = core::str::from_utf8(pair).ok()?;
        *byte = u8::try_from(number(pair)?).ok()?;
        length += 1;
    }
    let frame = Frame::new_raw(number(id)?, extended, data, length);
    let is_whole =
        (extended || id.len() == 3) && frame.raw_id() == number(id)? && digits.len() == usize::from(length) * 2;
    is_whole.then_some(frame)
}

/// Reads hexadecimal digits.
fn number(digits: &str) -> Option<u32> {
    let is_plain = digits.bytes().all(|digit| digit.is_ascii_hexdigit());
    if is_plain { u32::from_str_radix(digits, 16).ok() } else { None }
}
