//! A frame and a value of one of the protocols: both engines say the same of them.

use std::sync::LazyLock;

use canspec_codegen::interpret::{Form, Frame, Input, Limits, decode, raw_of};
use canspec_codegen::model::{Id, Message, ModelId, Protocol, Signal, SignalId};
use fastrand::Rng;

use crate::engines::{candidates, compare_decoding, compare_encoding};
use crate::{Signals, Visitor, protocol, received, signals, visit};

/// A protocol, and how its engines are compared.
struct Engines {
    protocol: Protocol,
    compare: fn(&Protocol, &Case),
}

static ENGINES: LazyLock<Vec<Engines>> = LazyLock::new(|| {
    let mut engines = All(Vec::new());
    visit(&mut engines);
    engines.0
});

struct All(Vec<Engines>);

impl Visitor for All {
    fn visit<P: canspec_runtime::Protocol + Signals>(&mut self, path: &str) {
        self.0.push(Engines { protocol: protocol(path), compare: compare::<P> });
    }
}

/// What the bytes of an input mean, in this order; missing ones are 0.
#[derive(Clone, Debug, Default)]
struct Case {
    protocol: u8,
    /// Number of the device model; none if there is no such model.
    model: u8,
    /// Not 0 if the identifier has the width that the protocol does not have.
    other_width: u8,
    length: u8,
    id: u32,
    data: [u8; 8],
    /// What the signals of the frame are to encode.
    value: f64,
}

impl Case {
    fn read(bytes: &[u8]) -> Self {
        let mut all = [0; 24];
        all.iter_mut().zip(bytes).for_each(|(byte, given)| *byte = *given);
        let [protocol, model, other_width, length, i0, i1, i2, i3, data @ ..] = all;
        let eight = |from: usize| std::array::from_fn(|index| data[from + index]);
        let value = f64::from_be_bytes(eight(8));
        Self { protocol, model, other_width, length, id: u32::from_be_bytes([i0, i1, i2, i3]), data: eight(0), value }
    }

    fn written(&self) -> Vec<u8> {
        let choices = [self.protocol, self.model, self.other_width, self.length];
        [&choices[..], &self.id.to_be_bytes(), &self.data, &self.value.to_be_bytes()].concat()
    }

    fn engines(&self) -> &'static Engines {
        &ENGINES[usize::from(self.protocol) % ENGINES.len()]
    }

    fn model(&self, protocol: &Protocol) -> Option<ModelId> {
        protocol.models.ids().nth(self.model.into())
    }

    fn frame(&self, protocol: &Protocol) -> Frame {
        let extended = protocol.identifier.extended ^ (self.other_width != 0);
        let id = self.id & if extended { 0x1FFF_FFFF } else { 0x7FF };
        let length = usize::from(self.length % 9);
        Frame { id, extended, data: self.data[..length].to_vec(), form: Form::Data }
    }

    /// Returns the message that the frame is one of.
    fn message(&self) -> Option<&'static Message> {
        let protocol = &self.engines().protocol;
        let decoded = decode(protocol, self.model(protocol), &self.frame(protocol)).ok()?;
        Some(&protocol.messages[decoded.message])
    }
}

/// Compares what both engines make of the bytes.
pub fn run(data: &[u8]) {
    let case = Case::read(data);
    let engines = case.engines();
    (engines.compare)(&engines.protocol, &case);
}

fn compare<P: canspec_runtime::Protocol + Signals>(protocol: &Protocol, case: &Case) {
    let (model, frame) = (case.model(protocol), case.frame(protocol));
    compare_decoding::<P>(protocol, model, &frame);
    let (Some(message), Ok(received)) = (case.message(), received::<P>(model, &frame)) else { return };
    let carried = received.signals().iter().map(|signal| signal.name()).collect::<Vec<_>>();
    let own = signals::<P>(protocol).filter(|(owner, ..)| owner.name == message.name);
    for (message, signal, known) in own.filter(|(_, _, known)| carried.contains(&known.name())) {
        compare_encoding(protocol, message, signal, known, case.value);
    }
}

/// Returns the examples of all documents.
pub fn seeds() -> Vec<Vec<u8>> {
    let protocols = (0..).zip(ENGINES.iter());
    let cases = protocols.flat_map(|(number, engines)| examples(number, &engines.protocol));
    cases.map(|case| case.written()).collect()
}

fn examples(number: u8, protocol: &Protocol) -> impl Iterator<Item = Case> {
    protocol.examples.iter().map(move |example| {
        let frame = Frame::of(protocol, example);
        let mut data = [0; 8];
        data.iter_mut().zip(&frame.data).for_each(|(byte, given)| *byte = *given);
        Case {
            protocol: number,
            model: example.model.and_then(|model| u8::try_from(model.place()).ok()).unwrap_or(u8::MAX),
            other_width: u8::from(frame.extended != protocol.identifier.extended),
            length: u8::try_from(frame.data.len()).unwrap_or(u8::MAX),
            id: frame.id,
            data,
            value: 1.0,
        }
    })
}

/// Flips bits of the identifier, puts a signal to the edges of what it can hold, or changes what else a case says.
pub fn mutated(bytes: &[u8], random: &mut Rng) -> Vec<u8> {
    let mut case = Case::read(bytes);
    match random.u8(..16) {
        0..6 => (0..random.u8(1..=3)).for_each(|_| case.id ^= 1 << random.u32(..29)),
        6..10 => to_an_edge(&mut case, random),
        10..12 => to_a_candidate(&mut case, random),
        12 => case.data = random.u64(..).to_be_bytes(),
        13 => case.length = random.u8(..=8),
        14 => case.model = random.u8(..4),
        _ => case.other_width ^= u8::from(random.u8(..4) == 0),
    }
    case.written()
}

/// Puts a signal of the frame to a value that is next to where its meaning changes.
fn to_an_edge(case: &mut Case, random: &mut Rng) {
    let Some((message, signal)) = signal(case, random) else { return };
    let protocol = &case.engines().protocol;
    let place = signal.place;
    let limits = signal.limits().flat_map(|(range, _)| [range.minimum.to_f64(), range.maximum.to_f64()]);
    let limits = limits.filter_map(|limit| raw_of(protocol, message, signal, &Input::Number(limit), Limits::Bits).ok());
    let half = 1 << (place.width() - 1);
    let edges: Vec<u64> = limits.chain([0, half, place.max()]).collect();
    let raw = edges[random.usize(..edges.len())];
    let raw = [raw.wrapping_sub(1), raw, raw.wrapping_add(1)][random.usize(..3)];
    place.put(&mut case.data, raw & place.max());
}

/// Takes a value that is next to where a signal of the frame begins to refuse it.
fn to_a_candidate(case: &mut Case, random: &mut Rng) {
    let Some((_, signal)) = signal(case, random) else { return };
    let candidates = candidates(signal, random);
    if !candidates.is_empty() {
        case.value = candidates[random.usize(..candidates.len())];
    }
}

/// Returns a signal of the message that the frame is one of.
fn signal(case: &Case, random: &mut Rng) -> Option<(&'static Message, &'static Signal)> {
    let message = case.message()?;
    let count = message.signals.len();
    (count > 0).then(|| (message, &message[SignalId::new(random.usize(..count))]))
}
