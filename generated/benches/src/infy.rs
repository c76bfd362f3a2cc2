//! INFY: every message in every direction.

pub mod by_hand;
pub mod dbc;
pub mod frames;
pub mod generated;
pub mod hand;

use std::collections::BTreeMap;
use std::hint::black_box;

use crate::Codec;
use crate::frame::{self, Frame};
use crate::steps;
use crate::work::{self, Prepared, Work, received};
use crate::workload::{Kind, Measured, Workload};
use by_hand::Hand;
use dbc::Dbc;
use generated::Generated;
use hand::{Message, Received, Target};

/// The workload.
pub const WORKLOAD: Workload = Workload {
    name: "infy",
    kinds: &[Kind { name: "every message", frames: frames::distinct }],
    codecs: &[measured::<Generated>(), measured::<Hand>(), measured::<Dbc>()],
    counted: None,
};

const fn measured<C: Infy>() -> Measured {
    Measured { codec: C::NAME, works: C::WORKS }
}

/// A codec of INFY.
pub trait Infy: Codec<ByHand = Received> {
    /// What is measured of it.
    const WORKS: &'static [Work] = &[
        work::decode::<Self>(),
        work::decode_by_call::<Self>(),
        payload::<Self>(),
        work::request::<Self>(),
        kept::<Self>(),
        reply::<Self>(),
        work::encode::<Self>(),
    ];
    /// A request that waits for its reply.
    type Asked: 'static;

    /// Decodes payloads of one command, and takes their values.
    fn payloads(command: u8, payloads: &[[u8; 8]]);

    /// Builds a request, and keeps it whole, or the reason for which it is refused, as far as the codec has them.
    #[inline(always)]
    fn keep(request: &Self::Request) {
        black_box(&Self::request(request));
    }

    /// Asks for a module's output, if the codec knows of replies.
    fn ask(target: Target, controller: u8) -> Option<Self::Asked>;

    /// Returns voltage and current from a frame that answers.
    fn reply(asked: &Self::Asked, frame: &Frame) -> Option<Result<(f32, f32), hand::Failure>>;
}

/// Decodes payloads whose message is known.
const fn payload<C: Infy>() -> Work {
    let prepare = |frames: &[Frame]| {
        let mut payloads = BTreeMap::<_, Vec<_>>::new();
        for frame in frames {
            let Received { id, message } = received::<Hand>(frame);
            if !matches!(message, Message::Read(_)) {
                payloads.entry(hand::command(id)).or_default().push(frame.bytes());
            }
        }
        let count = payloads.values().map(Vec::len).sum();
        Prepared::new(count, move || payloads.iter().for_each(|(command, payloads)| C::payloads(*command, payloads)))
    };
    Work { name: "payload alone", prepare }
}

/// Builds requests, and keeps each whole or its error.
const fn kept<C: Infy>() -> Work {
    let prepare = |frames: &[Frame]| work::with_each!(work::requests::<C>(frames), |request| C::keep(request));
    Work { name: "request that is kept", prepare }
}

/// Decodes the reply to a request out of the frames of several modules.
const fn reply<C: Infy>() -> Work {
    let prepare = |frames: &[Frame]| {
        work::with_each!(replies::<C>(frames), |(asked, frame)| {
            if let Some(Ok((voltage, current))) = C::reply(asked, frame) {
                take!(voltage, current);
            }
        })
    };
    Work { name: "reply to a request", prepare }
}

/// Pairs each output of a module with two requests: one that it answers, and one to another module.
///
/// # Panics
///
/// If the codec written by hand refuses a frame.
pub fn replies<C: Infy>(frames: &[Frame]) -> Vec<(C::Asked, Frame)> {
    let outputs = frames.iter().filter(|frame| matches!(received::<Hand>(frame).message, Message::ModuleOutput { .. }));
    let pairs = outputs.flat_map(|frame| {
        let [.., controller, module] = frame.raw_id().to_be_bytes();
        let is_single = frame.raw_id() >> 22 & 0xF == 0xA;
        let answered = if is_single { Target::Module(module) } else { Target::Group(module) };
        let asked = [C::ask(answered, controller), C::ask(Target::Module(module ^ 1), controller)];
        asked.into_iter().flatten().map(|asked| (asked, *frame))
    });
    pairs.collect()
}
