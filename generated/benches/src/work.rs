//! What is measured, and its inputs.

use std::collections::BTreeMap;
use std::fmt::Debug;
use std::hint::black_box;

use crate::by_hand::Hand;
use crate::frame::Frame;
use crate::hand::{Message, Received, Target};
use crate::{Codec, each};

/// What is measured.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Work {
    /// Decodes frames in the loop that takes the values, the only place that decodes.
    Decode,
    /// Decodes frames by a function that is not inlined, as in a program that decodes in several places.
    DecodeByCall,
    /// Decodes payloads whose message is known.
    Payload,
    /// Builds requests.
    Request,
    /// Encodes what was received.
    Encode,
    /// Decodes the reply to a request out of the frames of several modules.
    Reply,
}

impl Work {
    /// All works.
    pub const ALL: [Self; 6] =
        [Self::Decode, Self::DecodeByCall, Self::Payload, Self::Request, Self::Reply, Self::Encode];

    /// Returns the name in the table.
    pub const fn name(self) -> &'static str {
        match self {
            Self::Decode => "decode",
            Self::DecodeByCall => "decode by a call",
            Self::Payload => "payload alone",
            Self::Request => "request",
            Self::Encode => "encode what was received",
            Self::Reply => "reply to a request",
        }
    }

    /// Returns the word by which `count` is compiled for it.
    pub const fn word(self) -> &'static str {
        match self {
            Self::Decode => "decode",
            Self::DecodeByCall => "decode_by_call",
            Self::Payload => "payload",
            Self::Request => "request",
            Self::Encode => "encode",
            Self::Reply => "reply",
        }
    }
}

/// A work with its inputs.
pub struct Prepared {
    count: usize,
    pass: Box<dyn Fn()>,
}

impl Prepared {
    /// Prepares work on each input. A pass does it once with each.
    fn each<T: 'static>(inputs: Vec<T>, work: impl Fn(&T) + 'static) -> Self {
        Self { count: inputs.len(), pass: Box::new(move || each(&inputs, &work)) }
    }

    /// Prepares any work.
    ///
    /// # Panics
    ///
    /// If the codec refuses a frame.
    pub fn new<C: Codec>(work: Work, frames: &[Frame]) -> Self {
        let prepare = match work {
            Work::Decode => decode::<C>,
            Work::DecodeByCall => decode_by_call::<C>,
            Work::Payload => payload::<C>,
            Work::Request => request::<C>,
            Work::Encode => encode::<C>,
            Work::Reply => reply::<C>,
        };
        prepare(frames)
    }

    /// Returns how often a pass does the work.
    pub const fn count(&self) -> usize {
        self.count
    }

    /// Does the work once with each input.
    pub fn run(&self) {
        (self.pass)();
    }
}

/// Prepares [`Work::Decode`].
pub fn decode<C: Codec>(frames: &[Frame]) -> Prepared {
    Prepared::each(frames.to_vec(), |frame| {
        C::decode(frame).as_ref().map(C::take).ok();
    })
}

/// Prepares [`Work::DecodeByCall`].
pub fn decode_by_call<C: Codec>(frames: &[Frame]) -> Prepared {
    Prepared::each(frames.to_vec(), |frame| {
        called::<C>(frame).as_ref().map(C::take).ok();
    })
}

/// Prepares [`Work::Payload`].
///
/// # Panics
///
/// If the codec written by hand refuses a frame.
pub fn payload<C: Codec>(frames: &[Frame]) -> Prepared {
    let mut payloads = BTreeMap::<_, Vec<_>>::new();
    for frame in frames {
        let Received { id, message } = received::<Hand>(frame);
        if !matches!(message, Message::Read(_)) {
            let [_, command, ..] = id.to_be_bytes();
            payloads.entry(command & 0x3F).or_default().push(frame.bytes());
        }
    }
    let count = payloads.values().map(Vec::len).sum();
    let pass = move || payloads.iter().for_each(|(command, payloads)| C::payloads(*command, payloads));
    Prepared { count, pass: Box::new(pass) }
}

/// Prepares [`Work::Request`].
///
/// # Panics
///
/// If the codec refuses a frame.
pub fn request<C: Codec>(frames: &[Frame]) -> Prepared {
    Prepared::each(values::<C>(frames).iter().filter_map(C::to_request).collect(), |request| {
        black_box(&C::request(request));
    })
}

/// Prepares [`Work::Encode`].
///
/// # Panics
///
/// If the codec refuses a frame.
pub fn encode<C: Codec>(frames: &[Frame]) -> Prepared {
    Prepared::each(values::<C>(frames), |values| {
        black_box(&C::encode(values));
    })
}

/// Prepares [`Work::Reply`].
///
/// # Panics
///
/// If the codec written by hand refuses a frame.
pub fn reply<C: Codec>(frames: &[Frame]) -> Prepared {
    Prepared::each(replies::<C>(frames), |(asked, frame)| {
        if let Some(Ok((voltage, current))) = C::reply(asked, frame) {
            take!(voltage, current);
        }
    })
}

#[inline(never)]
fn called<C: Codec>(frame: &Frame) -> Result<C::Received, impl Debug> {
    C::decode(frame)
}

fn received<C: Codec>(frame: &Frame) -> C::Received {
    called::<C>(frame).expect("a frame of the protocol")
}

fn values<C: Codec>(frames: &[Frame]) -> Vec<C::Values> {
    frames.iter().map(|frame| C::to_values(&received::<C>(frame))).collect()
}

/// Pairs each output of a module with two requests: one that it answers, and one to another module.
///
/// # Panics
///
/// If the codec written by hand refuses a frame.
pub fn replies<C: Codec>(frames: &[Frame]) -> Vec<(C::Asked, Frame)> {
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
