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
    /// Decodes frames in the loop that takes the values.
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
}

/// Inputs of a codec.
pub struct Inputs<C: Codec> {
    frames: Vec<Frame>,
    payloads: BTreeMap<u8, Vec<[u8; 8]>>,
    values: Vec<C::Values>,
    requests: Vec<C::Request>,
    replies: Vec<(C::Asked, Frame)>,
}

impl<C: Codec> Inputs<C> {
    /// Makes all inputs of these frames.
    ///
    /// # Panics
    ///
    /// If the codec refuses one.
    pub fn new(frames: Vec<Frame>) -> Self {
        let values: Vec<_> = frames.iter().map(|frame| C::to_values(&received::<C>(frame))).collect();
        let requests = values.iter().filter_map(C::to_request).collect();
        let mut payloads = BTreeMap::<_, Vec<_>>::new();
        for frame in &frames {
            let Received { id, message } = received::<Hand>(frame);
            if !matches!(message, Message::Read(_)) {
                let [_, command, ..] = id.to_be_bytes();
                payloads.entry(command & 0x3F).or_default().push(frame.bytes());
            }
        }
        let replies = replies::<C>(&frames);
        Self { frames, payloads, values, requests, replies }
    }

    /// Returns how often a work is done.
    pub fn count(&self, work: Work) -> usize {
        match work {
            Work::Decode | Work::DecodeByCall => self.frames.len(),
            Work::Payload => self.payloads.values().map(Vec::len).sum(),
            Work::Request => self.requests.len(),
            Work::Encode => self.values.len(),
            Work::Reply => self.replies.len(),
        }
    }

    /// Returns how many of the frames for [`Work::Reply`] answer with values.
    pub fn answers(&self) -> usize {
        self.replies.iter().filter(|(asked, frame)| matches!(C::reply(asked, frame), Some(Ok(_)))).count()
    }

    /// Does a work once with each input.
    pub fn run(&self, work: Work) {
        match work {
            Work::Decode => each(&self.frames, |frame| {
                C::decode(frame).as_ref().map(C::take).ok();
            }),
            Work::DecodeByCall => each(&self.frames, |frame| {
                called::<C>(frame).as_ref().map(C::take).ok();
            }),
            Work::Payload => self.payloads.iter().for_each(|(command, payloads)| C::payloads(*command, payloads)),
            Work::Request => each(&self.requests, |request| {
                black_box(&C::request(request));
            }),
            Work::Encode => each(&self.values, |values| {
                black_box(&C::encode(values));
            }),
            Work::Reply => each(&self.replies, |(asked, frame)| {
                if let Some(Ok((voltage, current))) = C::reply(asked, frame) {
                    take!(voltage, current);
                }
            }),
        }
    }
}

#[inline(never)]
fn called<C: Codec>(frame: &Frame) -> Result<C::Received, impl Debug> {
    C::decode(frame)
}

fn received<C: Codec>(frame: &Frame) -> C::Received {
    called::<C>(frame).expect("a frame of the protocol")
}

/// Pairs each output of a module with two requests: one that it answers, and one to another module.
fn replies<C: Codec>(frames: &[Frame]) -> Vec<(C::Asked, Frame)> {
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
