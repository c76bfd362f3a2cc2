//! What the tests share: every protocol with both of its engines, and random frames.

use std::path::Path;

use canspec_codegen::interpret::{Form, Frame};
use canspec_codegen::model::{AddressPattern, Protocol, SelectorPlace};
use canspec_codegen::{Outcome, compile, source::Source};

include!(concat!(env!("OUT_DIR"), "/protocols.rs"));

/// The README's Rust compiles and runs.
#[cfg(doctest)]
#[doc = include_str!("../../README.md")]
struct Readme;

/// Runs a test on each protocol.
pub trait Visitor {
    /// Runs on the protocol whose generated code is `P` and whose spec stands at `path`.
    fn visit<P: canspec_runtime::Protocol>(&mut self, path: &str);
}

/// Compiles a spec.
///
/// # Panics
///
/// With the diagnostics if the spec is wrong.
pub fn protocol(path: impl AsRef<Path>) -> Protocol {
    match outcome(path) {
        Outcome { protocol: Some(protocol), .. } => protocol,
        Outcome { diagnostics, .. } => panic!("{}", diagnostics.concise()),
    }
}

/// Compiles a spec, right or wrong.
///
/// # Panics
///
/// If the file cannot be read.
pub fn outcome(path: impl AsRef<Path>) -> Outcome {
    match Source::read(path) {
        Ok(source) => compile(source),
        Err(diagnostics) => panic!("{}", diagnostics.concise()),
    }
}

/// Makes frames that are close to those of a protocol: right, nearly right, and far off.
pub struct Frames<'a> {
    protocol: &'a Protocol,
    random: fastrand::Rng,
}

impl<'a> Frames<'a> {
    /// Starts a series that depends on the seed alone.
    pub fn new(protocol: &'a Protocol, seed: u64) -> Self {
        Self { protocol, random: fastrand::Rng::with_seed(seed) }
    }

    /// Returns the next frame.
    pub fn next_frame(&mut self) -> Frame {
        let (mut id, mut data, mut length) = self.shaped();
        if self.random.u8(..4) == 0 {
            id ^= 1 << self.random.u32(..if self.protocol.identifier.extended { 29 } else { 11 });
        }
        if self.random.u8(..32) == 0 {
            length = self.random.usize(..=8);
        }
        if self.random.u8(..8) == 0 {
            data = [0; 8];
        }
        let extended = self.protocol.identifier.extended ^ (self.random.u8(..64) == 0);
        let id = id & if extended { 0x1FFF_FFFF } else { 0x7FF };
        Frame { id, extended, data: data[..length].to_vec(), form: Form::Data }
    }

    /// Returns identifier, data and length of a frame of some message.
    fn shaped(&mut self) -> (u32, [u8; 8], usize) {
        let protocol = self.protocol;
        let message = &protocol.messages[self.random.usize(..protocol.messages.len())];
        let shape = &message.shapes[self.random.usize(..message.shapes.len())];
        let mode = &protocol.modes[self.random.usize(..protocol.modes.len())];
        let patterns = [&mode.request, &mode.one, &mode.each, &mode.coordinator];
        let pattern = patterns[self.random.usize(..4)].as_ref();
        let mut id = match pattern {
            Some(pattern) => self.addressed(pattern),
            None => self.random.u32(..),
        };
        let mut data = self.random.u64(..).to_be_bytes();
        for (selector, value) in &shape.constants {
            match protocol.selectors[*selector].place {
                SelectorPlace::Identifier(field) => {
                    let field = &protocol.identifier.fields[field];
                    id = id & !field.mask() | u32::try_from(*value).unwrap_or(0) << field.shift;
                }
                SelectorPlace::Payload(place) => place.put(&mut data, *value),
                _ => {}
            }
        }
        (id, data, message.length.into())
    }

    /// Returns an identifier that fits a pattern, mostly with documented addresses.
    fn addressed(&mut self, pattern: &AddressPattern) -> u32 {
        let identifier = &self.protocol.identifier;
        let mut id = self.random.u32(..) & !pattern.mask | pattern.value;
        for field in identifier.fields.iter().filter(|field| field.normal.is_some()) {
            if self.random.u8(..4) > 0 {
                id &= !field.mask();
            }
        }
        for address in &pattern.addresses {
            let field = &identifier.fields[address.field];
            let (first, last) = self.protocol.address_types[address.address_type].raw_range();
            if self.random.u8(..8) > 0 {
                id = id & !field.mask() | self.random.u32(first..=last) << field.shift;
            }
        }
        id & !identifier.mask | identifier.value
    }
}
