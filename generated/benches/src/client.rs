//! The client of INFY with sixty modules, each of which it asks for its output again and again.

use std::collections::VecDeque;
use std::hint::black_box;

use canspec_protocols::infy::{Message, ModuleOutput, Target};
use canspec_runtime::client::{Client, Heard, Pace, Step};

use crate::frame::Frame;
use crate::infy::frames;
use crate::work::{Prepared, Work};
use crate::workload::{Kind, Measured, Workload};

/// The workload.
pub const WORKLOAD: Workload = Workload {
    name: "client",
    kinds: &[Kind { name: "sixty modules", frames: frames::distinct }],
    codecs: &[Measured { codec: "canspec", works: &[IDLE, SENDING, ANSWER, FOREIGN] }],
    counted: Some("canspec_benches::client::measured_*"),
};

const IDLE: Work = Work { name: "poll with nothing due", prepare: |_| polls(|step| matches!(step, Step::Wait(_))) };
const SENDING: Work = Work { name: "poll that sends", prepare: |_| polls(|step| matches!(step, Step::Send { .. })) };
const ANSWER: Work = Work { name: "handle an answer", prepare: |_| handles(answer) };
const FOREIGN: Work = Work { name: "handle a foreign frame", prepare: |_| handles(foreign) };

type Sixty = Client<Message, 60>;

const MODULES: u8 = 60;
/// The pace of document 2.3, a chosen wait, and time for late answers.
const PACE: Pace = Pace { gap: 50, wait: 100, tries: 3, late: 200 };
/// Modules are asked again before their ten seconds without a frame are over.
const PERIOD: u32 = 3300;
/// How long a conversation lasts, and from when on it is measured, in milliseconds.
const CONVERSATION: u32 = 12_000;
const SETTLED: u32 = 10_000;

#[inline(never)]
fn measured_poll(client: &mut Sixty, now: u32) -> Step {
    client.poll(now)
}

#[inline(never)]
fn measured_handle(client: &mut Sixty, frame: &Frame, now: u32) -> Heard<Message> {
    client.handle(frame, now)
}

fn client() -> Sixty {
    let mut client = Client::new(PACE);
    for module in 0..MODULES {
        let request = ModuleOutput::read(Target::Module(module)).expect("the document names the module");
        client.every(PERIOD, request, 0).expect("there is room for each module");
    }
    client
}

/// Calls `moment` at each step of a conversation: with the client before it, its frame and the time.
fn converse(mut moment: impl FnMut(&Sixty, Option<&Frame>, u32)) {
    let (mut client, mut asked) = (client(), VecDeque::new());
    for now in 0..CONVERSATION {
        // Modules answer after 20 ms.
        while let Some((_, frame)) = asked.pop_front_if(|(sent, _)| now >= *sent + 20) {
            moment(&client, Some(&frame), now);
            black_box(&client.handle(&answer(&frame), now));
        }
        loop {
            moment(&client, None, now);
            match client.poll(now) {
                Step::Send { frame, .. } => {
                    asked.push_back((now, Frame::copy(&frame).expect("a frame of eight bytes")));
                }
                Step::Wait(_) => break,
                step => panic!("{step:?}"),
            }
        }
    }
}

/// Prepares polls of a settled conversation that come to a step of one kind.
fn polls(is_wanted: fn(&Step) -> bool) -> Prepared {
    let mut before = Vec::new();
    converse(|client, frame, now| {
        if now >= SETTLED && frame.is_none() && is_wanted(&client.clone().poll(now)) {
            before.push((*client, now));
        }
    });
    Prepared::new(before.len(), move || {
        for (client, now) in &before {
            black_box(&measured_poll(&mut client.clone(), *now));
        }
    })
}

/// Prepares frames of a settled conversation, each made of a request that waits for its answer.
fn handles(of: fn(&Frame) -> Frame) -> Prepared {
    let mut before = Vec::new();
    converse(|client, frame, now| {
        if let Some(frame) = frame.filter(|_| now >= SETTLED) {
            before.push((*client, of(frame), now));
        }
    });
    Prepared::new(before.len(), move || {
        for (client, frame, now) in &before {
            black_box(&measured_handle(&mut client.clone(), frame, *now));
        }
    })
}

/// Returns the answer to a request: 500 V and 10 A.
fn answer(request: &Frame) -> Frame {
    let id = request.raw_id();
    let answer = id & 0x1FFF_0000 | id << 8 & 0xFF00 | id >> 8 & 0xFF;
    Frame::of(answer, [0x43, 0xFA, 0, 0, 0x41, 0x20, 0, 0])
}

/// Returns a frame of another protocol, which a vehicle sends on the same bus.
fn foreign(_: &Frame) -> Frame {
    Frame::of(0x18FF_50E5, [0; 8])
}
