//! What the tests share: every protocol with both of its engines, and random frames.

pub mod bare;
pub mod engines;
pub mod fuzz;
pub mod long;
pub mod modules;
pub mod prose;
pub mod random_specs;

use std::fmt::Debug;
use std::fs;
use std::path::{Path, PathBuf};

use canspec_codegen::interpret::{Form, Frame};
use canspec_codegen::model::{AddressPattern, FrameLayout, Id, Message, MessageId, ModeId, ModelId, Protocol, Signal};
use canspec_codegen::{Bases, Outcome, compile};
use canspec_runtime::LongLayout;
use canspec_runtime::parts::Parted;
use canspec_runtime::plumbing::{Physical, Raw};
use canspec_runtime::transfers::Transferred;
use canspec_runtime::{Error, Payload, Problem, Received, WriteSignal};

include!(concat!(env!("OUT_DIR"), "/protocols.rs"));

/// The README's Rust compiles and runs.
#[cfg(doctest)]
#[doc = include_str!("../../README.md")]
struct Readme;

/// The Rust of the page on status words compiles and runs.
#[cfg(doctest)]
#[doc = include_str!("../../docs/how-to/errors.md")]
struct Errors;

/// The Rust of the page on several controllers compiles and runs.
#[cfg(doctest)]
#[doc = include_str!("../../docs/how-to/controllers.md")]
struct Controllers;

/// The Rust of the page on two equal peers compiles and runs.
#[cfg(doctest)]
#[doc = include_str!("../../docs/how-to/peers.md")]
struct Peers;

/// The Rust of the page on messages in parts compiles and runs.
#[cfg(doctest)]
#[doc = include_str!("../../docs/how-to/parts.md")]
struct Parts;

/// The Rust of the page on transports compiles and runs.
#[cfg(doctest)]
#[doc = include_str!("../../docs/how-to/transport.md")]
struct Transports;

/// The Rust of the page on quantities compiles and runs.
#[cfg(doctest)]
#[doc = include_str!("../../docs/how-to/quantities.md")]
struct QuantitiesOfVendors;

/// The Rust of the page on a charging controller compiles and runs.
#[cfg(all(doctest, target_os = "linux"))]
#[doc = include_str!("../../docs/how-to/charger.md")]
struct Chargers;

/// Runs a test on each protocol.
pub trait Visitor {
    /// Runs on the protocol whose generated code is `P` and whose spec stands at `path`.
    fn visit<P: canspec_runtime::Protocol + Signals>(&mut self, path: &str);
}

/// Runs a test on each protocol with requests or reports of the controller.
pub trait AddressedVisitor {
    /// Runs on the protocol whose generated code is `P` and whose spec stands at `path`.
    fn visit<P: canspec_runtime::Addressed>(&mut self, path: &str);
}

/// Runs a test on each protocol whose types have the optional traits.
pub trait SwitchedVisitor {
    /// Runs on the protocol whose generated code is `P` and whose spec stands at `path`.
    fn visit<P>(&mut self, path: &str)
    where
        P: canspec_runtime::Protocol<Identifier: Optional> + Signals + Optional + PartialEq;
}

/// Runs a test on each message that is longer than a frame.
pub trait LongVisitor {
    /// Runs on the message whose struct is `L` and whose spec stands at `path`.
    fn visit<L: LongLayout + Optional + PartialEq + Debug>(&mut self, path: &str);
}

/// Runs a test on each message in parts.
pub trait PartedVisitor {
    /// Runs on the message whose struct is `L` and whose spec stands at `path`.
    fn visit<L: Parted + Optional + PartialEq + Debug>(&mut self, path: &str);
}

/// Runs a test on each message that a transport carries.
pub trait TransferredVisitor {
    /// Runs on the message whose struct is `L` and whose spec stands at `path`.
    fn visit<L: Transferred + Optional + PartialEq + Debug>(&mut self, path: &str);
}

/// The signals of a protocol's generated code, to be written by tests that do not know their types.
pub trait Signals {
    /// Each signal, in the order of the spec.
    const SIGNALS: &'static [&'static dyn KnownSignal];
}

/// A signal that is written by tests that do not know its type.
pub trait KnownSignal: WriteSignal {
    /// Writes a raw value.
    ///
    /// # Errors
    ///
    /// As [`Signal::put`](canspec_runtime::Signal::put) has them.
    fn put_bits(&'static self, bits: u64, payload: &mut Payload) -> Result<(), Error>;
}

impl<R: Raw, F: Physical<R>> KnownSignal for canspec_runtime::Signal<R, F> {
    fn put_bits(&'static self, bits: u64, payload: &mut Payload) -> Result<(), Error> {
        self.put(R::from_bits(bits), payload)
    }
}

/// Returns each signal of a protocol: its message, what the interpreter knows of it, and the one of the generated code.
///
/// # Panics
///
/// If the engines differ in them.
pub fn signals<P: Signals>(protocol: &Protocol) -> impl Iterator<Item = (&Message, &Signal, &'static dyn KnownSignal)> {
    let known =
        protocol.messages.iter().flat_map(|message| message.signals.iter().map(move |signal| (message, signal)));
    assert_eq!(known.clone().count(), P::SIGNALS.len(), "both engines have the same signals");
    known.zip(P::SIGNALS).map(|((message, signal), generated)| {
        assert_eq!(signal.name, generated.name(), "both engines have them in the same order");
        (message, signal, *generated)
    })
}

/// The optional traits, beside `Arbitrary`, which only the structs of messages have.
pub trait Optional: serde::Serialize + serde::de::DeserializeOwned + canspec_runtime::plumbing::defmt::Format {}

impl<T: serde::Serialize + serde::de::DeserializeOwned + canspec_runtime::plumbing::defmt::Format> Optional for T {}

/// Returns the specs of a folder of the workspace, in order.
///
/// # Panics
///
/// If the folder cannot be read.
pub fn specs(folder: &str) -> Vec<PathBuf> {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("..").join(folder);
    let entries = fs::read_dir(folder).expect("the folder exists").flatten().map(|entry| entry.path());
    let mut specs: Vec<_> = entries.filter(|path| path.extension().is_some_and(|ending| ending == "yaml")).collect();
    specs.sort();
    specs
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
    match Bases::default().read(path) {
        Ok(source) => compile(source),
        Err(diagnostics) => panic!("{}", diagnostics.concise()),
    }
}

/// Recognises a frame by the generated code, as one of a device model if one is chosen.
///
/// # Errors
///
/// As the generated code has them.
pub fn received<P: canspec_runtime::Protocol>(model: Option<ModelId>, frame: &Frame) -> Result<Received<P>, Problem> {
    let mut data = [0; 8];
    data.iter_mut().zip(&frame.data).for_each(|(byte, given)| *byte = *given);
    let length = u8::try_from(frame.data.len()).unwrap_or(u8::MAX);
    let frame = canspec_runtime::Frame::new_raw(frame.id, frame.extended, data, length);
    model.map_or_else(|| Received::decode(&frame), |model| Received::decode_for(number(model), &frame))
}

/// Returns the number that a device model has in the generated code.
///
/// # Panics
///
/// If a spec has more models than a byte counts.
pub fn number(model: ModelId) -> u8 {
    u8::try_from(model.place()).expect("a spec of the tests has few models")
}

/// Returns no device model, and then each.
pub fn models(protocol: &Protocol) -> impl Iterator<Item = Option<ModelId>> + Clone {
    std::iter::once(None).chain(protocol.models.ids().map(Some))
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
        let message = &protocol[MessageId::new(self.random.usize(..protocol.messages.len()))];
        let Some(layout) = self.layout_of(message) else { return self.shaped() };
        let mode = &protocol[ModeId::new(self.random.usize(..protocol.modes.len()))];
        let patterns = [&mode.request, &mode.one, &mode.each, &mode.coordinator];
        let pattern = patterns[self.random.usize(..4)].as_ref();
        let mut id = match pattern {
            Some(pattern) => self.addressed(pattern),
            None => self.random.u32(..),
        };
        let mut data = self.random.u64(..).to_be_bytes();
        for (field, value) in layout.identifier() {
            id = protocol[field].put(id, value);
        }
        for (place, value) in layout.payload() {
            place.put(&mut data, value);
        }
        (id, data, layout.lengths[self.random.usize(..layout.lengths.len())].into())
    }

    /// Returns one of the kinds of frames of a message; a set whose requests are split too has none of its own.
    fn layout_of(&mut self, message: &Message) -> Option<&'a FrameLayout> {
        let count = message.frames.len();
        (count > 0).then(|| &self.protocol[message.frames[self.random.usize(..count)]])
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
            let field = &self.protocol[address.field];
            let ranges = self.protocol[address.address_type].raw_ranges();
            let (first, last) = ranges[self.random.usize(..ranges.len())];
            if self.random.u8(..8) > 0 {
                id = id & !field.mask() | self.random.u32(first..=last) << field.shift;
            }
        }
        id & !identifier.mask | identifier.value
    }
}
