//! The codecs say the same, as far as they can: only then is it fair to measure them.

mod common;

use canspec_benches::Codec;
use canspec_benches::frame::Frame;
use canspec_benches::supply::binrw::Binrw;
use canspec_benches::supply::by_hand::Hand;
use canspec_benches::supply::dbc::{Dbc, OneAddress};
use canspec_benches::supply::generated::{Generated, code};
use canspec_benches::supply::hand::{self, Message, Problem, Target};
use canspec_benches::supply::{WORKLOAD, frames};
use canspec_benches::workload::Workload;
use common::{Refused, copied, encoded, many, of_any_type, refusals, requested};
use fastrand::Rng;

#[test]
fn the_hand_written_codec_gives_the_values_of_the_generated_one() {
    for frame in all() {
        let generated = Generated::decode(&frame).expect("a frame of the protocol");
        assert_eq!(hand::decode(&frame), Ok(Generated::to_hand(&generated)), "{frame:?}");
    }
}

#[test]
fn both_refuse_the_same_frames_for_the_same_reasons() {
    let mut reasons = [0; 6];
    for frame in many(1, foreign) {
        let generated = code::Message::decode(&frame).map(|received| received.frame().raw_id());
        let generated = generated.map_err(|problem| match problem {
            code::Problem::Frame => Problem::Frame,
            code::Problem::Foreign => Problem::Foreign,
            code::Problem::Identifier => Problem::Identifier,
            code::Problem::Length => Problem::Length,
            code::Problem::UnknownMessage => Problem::Unknown,
        });
        let hand = hand::decode(&frame);
        reasons[hand.map_or_else(|problem| problem as usize, |_| 5)] += 1;
        assert_eq!(hand.map(|received| received.id), generated, "{frame:?}");
    }
    assert!(reasons.iter().all(|count| *count > 1000), "{reasons:?}");
}

#[test]
fn every_frame_is_encoded_back_by_both() {
    for frame in all() {
        assert_eq!(encoded::<Generated>(&frame), Some(frame));
        assert_eq!(encoded::<Hand>(&frame), Some(frame));
    }
}

#[test]
fn both_encode_the_same_of_what_was_received() {
    let refused = refusals(many(2, odd), [encoded::<Generated>, encoded::<Hand>], &None);
    assert!((100_000..900_000).contains(&refused), "{refused}");
}

#[test]
fn both_refuse_the_same_requests() {
    let refused = refusals(many(3, odd), [requested::<Generated>, requested::<Hand>], &Some(Err(Refused)));
    assert!((100_000..600_000).contains(&refused), "{refused}");
}

#[test]
fn half_of_the_frames_that_are_measured_are_requests_that_all_codecs_build() {
    let mut built = 0;
    let frames = all();
    for frame in frames.iter().filter(|frame| requested::<Hand>(frame).is_some()) {
        assert_eq!(requested::<Generated>(frame), Some(Ok(*frame)));
        assert_eq!(requested::<Hand>(frame), Some(Ok(*frame)));
        assert!(requested::<Dbc>(frame).is_some_and(|near| near.is_ok_and(|near| near.raw_id() == frame.raw_id())));
        built += 1;
    }
    assert!((frames.len() * 2 / 5..frames.len() * 3 / 5).contains(&built), "{built}");
}

#[test]
fn both_round_what_they_set_to_the_nearest_step() {
    let mut rng = Rng::with_seed(4);
    let ends = [49.9996, 0.0996, 750.0, 600.0, 50.0, 1000.0, -1000.0, f64::NAN, f64::INFINITY, -0.0004, -0.05, -0.0];
    let thousandths = (0..300_000).map(|_| f64::from(rng.u32(..1_600_000)) / 2000.0).collect::<Vec<_>>();
    let binary = (0..300_000).map(|_| f64::from(rng.i32(-2_100_000..2_100_000)) / 2048.0);
    for near in ends.into_iter().chain(thousandths).chain(binary) {
        for value in [near.next_down(), near, near.next_up()] {
            let (voltage_v, current_a) = (value, value.min(50.0));
            assert_built_alike(
                code::Message::SetPoint(code::SetPoint { voltage_v, current_a }),
                Message::SetPoint { voltage_v, current_a },
            );
            let (ab_v, bc_v, ca_v) = (value / 10.0, value.min(600.0), 0.05);
            assert_built_alike(
                code::Message::Input(code::Input { ab_v, bc_v, ca_v }),
                Message::Input { ab_v, bc_v, ca_v },
            );
            assert_built_alike(
                code::Message::Signal60(code::Signal60 { value_v: value }),
                Message::Signal { number: 0x13C, value_v: value },
            );
        }
    }
}

fn assert_built_alike(generated: code::Message, hand: Message) {
    let generated = (code::Target::Supply(2).sent_by(0xF3), generated);
    let hand = hand::Request { message: hand, target: Target::Supply(2), controller: 0xF3 };
    assert_eq!(copied(hand::request(&hand)), copied(Generated::request(&generated)), "{hand:?}");
}

/// A DBC's codec works with `f32` and cuts off: that is as near as it comes.
#[test]
fn the_codec_of_the_dbc_comes_near() {
    for frame in all() {
        let near = Dbc::to_hand(&Dbc::decode(&frame).expect("in the DBC"));
        let exact = hand::decode(&frame).expect("of the protocol");
        assert_eq!(near.id, exact.id);
        assert_near(&near.message, &exact.message);
        assert!(encoded::<Dbc>(&frame).is_some(), "{frame:?}");
    }
}

#[test]
fn without_addresses_the_codec_of_the_dbc_says_and_builds_the_same() {
    for frame in all() {
        let known = OneAddress::known(&frame);
        let message = OneAddress::to_hand(&OneAddress::decode(&known).expect("in the DBC"));
        assert_eq!(message, Dbc::to_hand(&Dbc::decode(&frame).expect("in the DBC")).message, "{frame:?}");
        let built = encoded::<OneAddress>(&known);
        assert_eq!(built, encoded::<Dbc>(&known), "{frame:?}");
        assert_eq!(requested::<OneAddress>(&known).and_then(Result::ok), built, "{frame:?}");
    }
}

#[test]
fn binrw_gives_the_values_of_the_codec_by_hand_and_builds_its_frames() {
    for frame in all() {
        let values = Binrw::to_hand(&Binrw::decode(&frame).expect("a frame of the protocol"));
        assert_eq!(hand::decode(&frame), Ok(values), "{frame:?}");
        assert_eq!(encoded::<Binrw>(&frame), Some(frame));
        assert_eq!(requested::<Binrw>(&frame), requested::<Hand>(&frame));
    }
}

#[test]
fn binrw_refuses_the_frames_that_the_codec_by_hand_refuses() {
    for frame in many(1, foreign) {
        let decoded = Binrw::decode(&frame).ok().map(|received| Binrw::to_hand(&received));
        assert_eq!(decoded, hand::decode(&frame).ok(), "{frame:?}");
    }
}

fn assert_near(near: &Message, exact: &Message) {
    let numbers = |message: &Message| match *message {
        Message::Input { ab_v, bc_v, ca_v } => Some([ab_v, bc_v, ca_v]),
        Message::SetPoint { voltage_v, current_a } => Some([voltage_v, current_a, 0.0]),
        Message::Signal { number, value_v } => Some([value_v, number.into(), 0.0]),
        _ => None,
    };
    match (numbers(near), numbers(exact)) {
        (Some(near), Some(exact)) => {
            let is_near = near.iter().zip(exact).all(|(near, exact)| (near - exact).abs() <= exact.abs() * 2e-7);
            assert!(is_near, "{near:?} {exact:?}");
        }
        _ => assert_eq!(near, exact),
    }
}

/// Returns frames of all kinds.
fn all() -> Vec<Frame> {
    WORKLOAD.kinds.iter().flat_map(|kind| (kind.frames)(Workload::COUNTED)).collect()
}

/// Returns a frame of any type and length, often with an identifier of the protocol.
fn foreign(rng: &mut Rng) -> Frame {
    let near = 0x1500_00F0 ^ rng.u32(..) & rng.u32(..) & 0x1FFF_FFFF;
    let id = [near, near & 0x1FFF_FF00 | 0xF0, near & 0x1FF8_FF00 | 0x5_00F8, 0x1F00_0000 | rng.u32(..0x200)];
    let id = id[rng.usize(..4)];
    let [high, low] = [rng.u8(..3), rng.u8(..0x42)];
    of_any_type(rng, id, [high, low, 0, 0, 0, 0, 0, 0])
}

/// Returns a frame of the protocol with random addresses and values, whose reserved bits are 0.
fn odd(rng: &mut Rng) -> Frame {
    let command = rng.u32(1..=6);
    let device = [0x54, 0x55, 0x56, rng.u32(..0x80)][rng.usize(..4)];
    let supply = [rng.u32(..0x40), rng.u32(..0x100), 0xFF][rng.usize(..3)];
    let id = device << 22 | command << 16 | supply << 8 | rng.u32(0xF0..=0xF8);
    let [usual, other] = [frames::of(command, 1)[0], Frame::of(id, rng.u64(..).to_be_bytes())];
    let kept = match command {
        3 => 0x0000_FF00_FFFF_FFFF,
        4 => u64::MAX << 16,
        5 | 6 => 0x0000_0000_FFFF_FFFF,
        _ => u64::MAX,
    };
    let number = match command {
        5 => rng.u64(1..=40) << 48,
        6 => rng.u64(0x101..=0x13C) << 48,
        _ => 0,
    };
    let near = [usual.bytes(), other.bytes()].map(u64::from_be_bytes)[rng.usize(..2)];
    Frame::of(id, (near & kept | number).to_be_bytes())
}
