//! The three codecs say the same, as far as they can: only then is it fair to time them.

use canspec_benches::dbc::Dbc;
use canspec_benches::frame::Frame;
use canspec_benches::generated::Generated;
use canspec_benches::hand::{Hand, Message};
use canspec_benches::{Codec, frames, requests};

#[test]
fn the_hand_written_codec_gives_the_values_of_the_generated_one() {
    for frame in all() {
        let generated = Generated::decode(&frame).expect("a frame of the protocol");
        assert_eq!(Hand::decode(&frame).ok(), Some(Generated::to_hand(&generated)), "{frame:?}");
    }
}

#[test]
fn every_frame_is_encoded_back_by_both() {
    for frame in all() {
        assert_eq!(encoded::<Generated>(&frame), Some(frame));
        assert_eq!(encoded::<Hand>(&frame), Some(frame));
    }
}

#[test]
fn requests_are_built_alike() {
    let frames = all();
    let (generated, hand) = (requests::<Generated>(&frames), requests::<Hand>(&frames));
    assert_eq!(generated.len(), hand.len());
    for (generated, hand) in generated.iter().zip(&hand) {
        let one = Generated::request(generated).and_then(|frame| Frame::copy(&frame));
        assert!(one.is_some(), "{hand:?}");
        assert_eq!(one, Hand::request(hand).and_then(|frame| Frame::copy(&frame)), "{hand:?}");
    }
}

/// A DBC's codec works with `f32` and cuts off: that is as near as it comes.
#[test]
fn the_codec_of_the_dbc_comes_near() {
    let frames = all();
    let mut wrong = 0;
    for frame in &frames {
        let (near, exact) = (Dbc::decode(frame).expect("in the DBC"), Hand::decode(frame).expect("of the protocol"));
        assert_eq!(near.0, exact.0);
        assert_near(&near.1, &exact.1);
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

fn encoded<C: Codec>(frame: &Frame) -> Option<Frame> {
    C::encode(&C::decode(frame).ok()?).and_then(|frame| Frame::copy(&frame))
}

fn all() -> Vec<Frame> {
    let mut frames = frames::distinct(frames::MANY);
    frames.extend(frames::few());
    frames
}
