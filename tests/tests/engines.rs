//! The interpreter and the generated code agree, to the last bit.

use std::collections::BTreeMap;

use canspec_codegen::model::Protocol;
use canspec_runtime::AnySignal;
use canspec_tests::engines::{candidates, compare_decoding, compare_encoding};
use canspec_tests::{Frames, Visitor, models, protocol, received, visit};

/// How many random frames each protocol sees.
const FRAMES: usize = 50_000;

struct Decoding {
    recognised: usize,
}

impl Visitor for Decoding {
    fn visit<P: canspec_runtime::Protocol>(&mut self, path: &str) {
        let protocol = protocol(path);
        let mut frames = Frames::new(&protocol, 0xCA25);
        for model in models(&protocol).cycle().take(FRAMES) {
            let frame = frames.next_frame();
            self.recognised += usize::from(compare_decoding::<P>(&protocol, model, &frame));
        }
    }
}

#[test]
fn random_frames_mean_the_same_to_both_engines_and_encode_to_the_same_bytes() {
    let mut decoding = Decoding { recognised: 0 };
    visit(&mut decoding);
    assert!(decoding.recognised > FRAMES, "only {} frames were recognised at all", decoding.recognised);
}

/// The signals of the generated code, by message.
type Signals = BTreeMap<&'static str, &'static [&'static dyn AnySignal]>;

/// Collects the signals of the generated code from frames that carry them.
fn signals<P: canspec_runtime::Protocol>(protocol: &Protocol) -> Signals {
    let mut frames = Frames::new(protocol, 0x516);
    let mut signals = Signals::new();
    for model in models(protocol).cycle().take(20_000) {
        let Ok(received) = received::<P>(model, &frames.next_frame()) else { continue };
        let carried = received.content().layout().signals();
        let known = signals.entry(received.exchange().message()).or_insert(carried);
        if known.len() < carried.len() {
            *known = carried;
        }
    }
    signals
}

struct Values;

impl Visitor for Values {
    fn visit<P: canspec_runtime::Protocol>(&mut self, path: &str) {
        let protocol = protocol(path);
        let mut random = fastrand::Rng::with_seed(0xE2C0);
        let generated = signals::<P>(&protocol);
        for message in &protocol.messages {
            for signal in &message.signals {
                let known = generated[message.name.as_str()].iter().find(|known| known.name() == signal.name);
                let known = known.expect("both engines know the signal");
                for value in candidates(signal, &mut random) {
                    compare_encoding(&protocol, message, signal, *known, value);
                }
            }
        }
    }
}

#[test]
fn random_values_are_refused_by_both_engines_or_encode_to_the_same_bits() {
    visit(&mut Values);
}
