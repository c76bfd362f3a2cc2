//! The three codecs say the same, as far as they can: only then is it fair to measure them.

mod common;

use canspec_benches::Codec;
use canspec_benches::frame::Frame;
use canspec_benches::infy::by_hand::Hand;
use canspec_benches::infy::dbc::Dbc;
use canspec_benches::infy::generated::Generated;
use canspec_benches::infy::hand::{self, Message, Problem, Target};
use canspec_benches::infy::{Infy as _, frames, replies};
use canspec_benches::workload::Workload;
use canspec_protocols::infy;
use common::{Refused, copied, encoded, many, of_any_type, refusals, requested};
use embedded_can::{ExtendedId, Frame as _};
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
        let generated = infy::Message::decode(&frame).map(|received| Generated::to_hand(&received));
        let generated = generated.map_err(|problem| match problem {
            infy::Problem::Frame => Problem::Frame,
            infy::Problem::Foreign => Problem::Foreign,
            infy::Problem::Identifier => Problem::Identifier,
            infy::Problem::UnknownMessage => Problem::Command,
            infy::Problem::Length => Problem::Length,
        });
        let hand = hand::decode(&frame);
        reasons[hand.map_or_else(|problem| problem as usize, |_| 5)] += 1;
        assert_eq!(hand.map(|received| received.id), generated.map(|received| received.id), "{frame:?}");
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
    assert!((200_000..900_000).contains(&refused), "{refused}");
}

#[test]
fn requests_are_built_alike() {
    let frames = all();
    let requests: Vec<_> = frames.iter().filter(|frame| requested::<Hand>(frame).is_some()).collect();
    assert!(requests.len() > frames.len() / 10);
    for frame in requests {
        assert_eq!(requested::<Generated>(frame), Some(Ok(*frame)));
        assert_eq!(requested::<Hand>(frame), Some(Ok(*frame)));
        assert!(requested::<Dbc>(frame).is_some_and(|near| near.is_ok_and(|near| near.raw_id() == frame.raw_id())));
    }
}

#[test]
fn both_refuse_the_same_requests() {
    let refused = refusals(many(3, odd), [requested::<Generated>, requested::<Hand>], &Some(Err(Refused)));
    assert!((100_000..600_000).contains(&refused), "{refused}");
}

#[test]
fn both_round_set_points_to_the_nearest_step() {
    let mut rng = Rng::with_seed(4);
    let ends = [49.9996, 0.0996, 750.0, 50.0, 0.1, f64::NAN, f64::INFINITY, -0.0004, -0.0005, -0.0];
    let some = (0..300_000).map(|_| f64::from(rng.u32(..1_600_000)) / 2000.0);
    for near in ends.into_iter().chain(some) {
        for value in [near.next_down(), near, near.next_up()] {
            let (voltage_v, current_a) = (value, value.min(50.0));
            let one = infy::SetModuleOutput { voltage_v, current_a };
            let total = infy::SetTotalOutput { voltage_v: value.clamp(50.0, 750.0), current_a: value };
            let hand = Message::ModuleSetpoint { voltage_v, current_a };
            let hand_total = Message::TotalOutput { voltage_v: total.voltage_v, current_a: value };
            for (generated, hand) in
                [(infy::Message::SetModuleOutput(one), hand), (infy::Message::SetTotalOutput(total), hand_total)]
            {
                let generated = (infy::Target::Group(2).sent_by(0xF3), generated);
                let hand = hand::Request { message: hand, target: Target::Group(2), controller: 0xF3 };
                assert_eq!(copied(hand::request(&hand)), copied(Generated::request(&generated)), "{hand:?}");
            }
        }
    }
}

#[test]
fn replies_are_found_alike() {
    let mut rng = Rng::with_seed(5);
    let mut answers = 0;
    for _ in 0..1_000_000 {
        let (module, controller) = (rng.u8(..0x40), rng.u8(0xF0..=0xF9));
        let target =
            [Target::Module(module), Target::Group(module), Target::Broadcast, Target::AllGroups][rng.usize(..4)];
        let (generated, hand) = (Generated::ask(target, controller), Hand::ask(target, controller));
        assert_eq!(generated.is_some(), hand.is_some(), "{target:?} {controller}");
        let (Some(generated), Some(hand)) = (generated, hand) else { continue };
        let frame = answer(&mut rng, module, controller);
        let bits = |reply: Option<Result<(f32, f32), _>>| {
            reply.map(|reply| reply.map(|(voltage, current)| [voltage, current].map(f32::to_bits)))
        };
        let (generated, hand) = (bits(Generated::reply(&generated, &frame)), bits(Hand::reply(&hand, &frame)));
        assert_eq!(hand, generated, "{target:?} {frame:?}");
        answers += usize::from(hand.is_some());
    }
    assert!(answers > 10_000, "{answers}");
}

#[test]
fn half_of_the_frames_that_are_measured_answer() {
    let replies = replies::<Generated>(&frames::distinct(Workload::COUNTED));
    let answers = replies.iter().filter(|(asked, frame)| matches!(Generated::reply(asked, frame), Some(Ok(_)))).count();
    assert!(replies.len() > 1000);
    assert_eq!(answers * 2, replies.len());
}

/// A DBC's codec works with `f32` and cuts off: that is as near as it comes.
#[test]
fn the_codec_of_the_dbc_comes_near() {
    let frames = all();
    let mut wrong = 0;
    for frame in &frames {
        let near = Dbc::to_hand(&Dbc::decode(frame).expect("in the DBC"));
        let exact = hand::decode(frame).expect("of the protocol");
        assert_eq!(near.id, exact.id);
        assert_near(&near.message, &exact.message);
        wrong += usize::from(encoded::<Dbc>(frame) != Some(*frame));
    }
    println!("{wrong} of {} frames are not encoded back by the codec of the DBC", frames.len());
}

fn assert_near(near: &Message, exact: &Message) {
    let numbers = |message: &Message| match *message {
        Message::InputVoltage { ab_v, bc_v, ca_v } => Some([ab_v, bc_v, ca_v]),
        Message::ModuleLimits { maximum_a, rated_w, .. } => Some([maximum_a, rated_w, 0.0]),
        Message::ExternalVoltage { voltage_v, allowed_current_a: current_a }
        | Message::SystemOutputFixed { voltage_v, current_a }
        | Message::ModuleOutputFixed { voltage_v, current_a }
        | Message::TotalOutput { voltage_v, current_a }
        | Message::ModuleSetpoint { voltage_v, current_a } => Some([voltage_v, current_a, 0.0]),
        _ => None,
    };
    match (numbers(near), numbers(exact)) {
        (Some(near), Some(exact)) => {
            let is_near = near.iter().zip(exact).all(|(near, exact)| (near - exact).abs() <= exact * 2e-7);
            assert!(is_near, "{near:?} {exact:?}");
        }
        _ => assert_eq!(near, exact),
    }
}

fn all() -> Vec<Frame> {
    frames::distinct(Workload::TIMED)
}

/// Returns a frame of any type and length, often with an identifier of the protocol.
fn foreign(rng: &mut Rng) -> Frame {
    let near = 0x0280_00F0 ^ rng.u32(..) & rng.u32(..) & 0x1FFF_FFFF;
    let id = [near, near & 0x1FFF_FF00 | 0xF0, near & 0x1FFF_00FF | 0xF400, 0x0757_F800 | rng.u32(..0x200)];
    let id = id[rng.usize(..4)];
    of_any_type(rng, id, [0; 8])
}

/// Returns a frame of the protocol with random addresses and values, whose reserved bits are 0.
fn odd(rng: &mut Rng) -> Frame {
    let command = rng.u32(1..0x20);
    let device = [0xA, 0xB, rng.u32(..16)][rng.usize(..3)];
    let [one, other] = [rng.u32(0xF0..=0xF8), [rng.u32(..0x40), rng.u32(..=0xFF)][rng.usize(..2)]];
    let (target, source) = if rng.bool() { (one, other) } else { (other, one) };
    let error = if rng.u8(..4) == 0 { rng.u32(..8) } else { 0 };
    let id = error << 26 | device << 22 | command << 16 | target << 8 | source;
    let is_read = command < 0x13 && source >= 0xF0;
    let values = u64::from(rng.u32(..1_000_000)) << 32 | u64::from(rng.u32(..100_000));
    let word = match command {
        _ if is_read => 0,
        0x01 | 0x03 => u64::from(rng.f32().to_bits()) << 32 | u64::from((rng.f32() * 1e9).to_bits()),
        0x02 => rng.u64(..) & 0xFF << 40,
        0x04 => rng.u64(..) & 0x0000_FF00_FFFF_FFFF,
        0x06 => rng.u64(..) << 16,
        0x0C => rng.u64(..) << 32,
        0x08 | 0x09 | 0x1B | 0x1C => [rng.u64(..), values, values][rng.usize(..3)],
        0x0A => rng.u64(..),
        0x0B => rng.u64(..) >> 8 | u64::from(rng.u8(b'A'..=b'Z')) << 56,
        _ => rng.u64(..) << 56,
    };
    Frame::of(id, word.to_be_bytes())
}

/// Returns a frame that nearly answers a module's request from a controller.
fn answer(rng: &mut Rng, module: u8, controller: u8) -> Frame {
    let module = if rng.u8(..4) == 0 { rng.u8(..) } else { module };
    let id = rng.u32(0xA..=0xB) << 22 | 0x03 << 16 | u32::from(controller) << 8 | u32::from(module);
    let id = if rng.u8(..4) == 0 { id ^ 1 << rng.u8(..29) } else { id };
    let id = ExtendedId::new(id).expect("29 bits");
    let data: [u8; 8] = rng.u64(..).to_be_bytes();
    match rng.u8(..20) {
        0 => Frame::new_remote(id, 8),
        1 => Frame::new(id, &data[..rng.usize(..8)]),
        _ => Frame::new(id, &data),
    }
    .expect("at most eight bytes")
}
