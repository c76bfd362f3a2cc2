//! The documents' own frames in the generated code: the values that the spec states, and the same bytes back.

use canspec_codegen::interpret::Frame;
use canspec_codegen::model::{Example, Protocol, Signal};
use canspec_runtime::Number;
use canspec_tests::{Visitor, protocol, received, visit, visit_in_steps};
use embedded_can::Frame as _;

struct Examples {
    frames: usize,
}

impl Visitor for Examples {
    fn visit<P: canspec_runtime::Protocol>(&mut self, path: &str) {
        let protocol = protocol(path);
        for example in protocol.examples.iter().filter(|example| example.fails.is_none()) {
            self.frames += usize::from(holds::<P>(&protocol, example));
        }
    }
}

/// Runs an example that has data; `false` for an identifier alone.
fn holds<P: canspec_runtime::Protocol>(protocol: &Protocol, example: &Example) -> bool {
    let (Some(bytes), Some(message)) = (&example.data, example.message) else { return false };
    let message = &protocol.messages[message];
    let at = format!("{}: {}", protocol.name, example.doc.path);
    let received = received::<P>(example.model, &Frame::of(protocol, example));
    let received = received.unwrap_or_else(|problem| panic!("{at}: {problem}"));
    assert_eq!(received.exchange().message(), message.name, "{at}");
    let mut is_borne = true;
    let mut read = Vec::new();
    received.visit(|reading| read.push((reading.name, bits(reading.raw))));
    assert!(read.is_empty() || !example.means.is_empty(), "{at}");
    for meaning in &example.means {
        let signal = &message.signals[meaning.signal];
        let Some((_, raw)) = read.iter().find(|(name, _)| *name == signal.name) else {
            // What the model lacks is not shown while no bit of it is set.
            let is_lacking = example.model.is_some_and(|model| !signal.is_of(model));
            assert!(is_lacking && meaning.is(signal, 0), "{at}: {} is not read", signal.name);
            continue;
        };
        let width = signal.place.width();
        let mask = u64::MAX >> (64 - width);
        assert!(meaning.is(signal, raw & mask), "{at}: {} means {}", signal.name, meaning.text);
        assert!(signal.encoding.numeral().is_signed() || raw & !mask == 0, "{at}");
        is_borne &= is_borne_by_product(signal, raw & mask);
    }
    if received.is_to_module() && !is_borne {
        assert!(received.encode().is_err(), "{at}: the product does not bear it");
    } else if !received.is_to_module() || example.notes.is_empty() {
        let encoded = received.encode().unwrap_or_else(|error| panic!("{at}: {error}"));
        assert_eq!(encoded.data(), bytes, "{at}");
        assert_eq!(encoded.raw_id(), example.id, "{at}");
    }
    true
}

/// Tests whether the limit of a product allows bits, which may stand for a special value.
fn is_borne_by_product(signal: &Signal, bits: u64) -> bool {
    let is_special = signal.specials.iter().any(|special| special.raw == signal.raw_of(bits));
    is_special || signal.limit.as_ref().is_none_or(|limit| signal.is_in(&limit.range, bits))
}

/// Returns a raw value as bits.
fn bits(raw: Number) -> u64 {
    match raw {
        Number::Unsigned(raw) => raw,
        Number::Signed(raw) => raw.cast_unsigned(),
        Number::Single(_) | Number::Float(_) | Number::Fraction { .. } => panic!("a raw value is an integer"),
    }
}

#[test]
fn every_frame_that_a_document_prints_holds_in_the_generated_code() {
    let mut examples = Examples { frames: 0 };
    visit(&mut examples);
    assert!(examples.frames >= 140, "{} frames", examples.frames);
}

#[test]
fn every_frame_that_a_document_prints_holds_in_whole_steps_too() {
    let mut examples = Examples { frames: 0 };
    visit_in_steps(&mut examples);
    assert!(examples.frames >= 140, "{} frames", examples.frames);
}
