//! The interpreter and the generated code agree, to the last bit.

use canspec_tests::engines::{candidates, compare_decoding, compare_encoding};
use canspec_tests::{Frames, Signals, Visitor, models, protocol, signals, visit, visit_in_steps};

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

#[test]
fn random_frames_mean_the_same_in_whole_steps_and_encode_to_the_same_bytes() {
    let mut decoding = Decoding { recognised: 0 };
    visit_in_steps(&mut decoding);
    assert!(decoding.recognised > FRAMES, "only {} frames were recognised at all", decoding.recognised);
}

struct Values;

impl Visitor for Values {
    fn visit<P: canspec_runtime::Protocol + Signals>(&mut self, path: &str) {
        let protocol = protocol(path);
        let mut random = fastrand::Rng::with_seed(0xE2C0);
        for (message, signal, known) in signals::<P>(&protocol) {
            for value in candidates(signal, &mut random) {
                compare_encoding(&protocol, message, signal, known, value);
            }
        }
    }
}

#[test]
fn random_values_are_refused_by_both_engines_or_encode_to_the_same_bits() {
    visit(&mut Values);
}
