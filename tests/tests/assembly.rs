//! Long messages of many devices at once: whatever is lost, repeated or late, each message that is reported was sent.

use std::path::Path;

use canspec_codegen::interpret::{Assembly, Form, Frame, decode};
use canspec_codegen::model::Protocol;
use canspec_codegen::source::Source;
use fastrand::Rng;

/// Most devices that send at once.
const DEVICES: u32 = 8;

/// Parts of a message of 8 cells: 2 bytes and 16 of cells, in parts of 6.
const PARTS: u8 = 3;

fn protocol() -> Protocol {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("specs/features/parts.yaml");
    let outcome = canspec_codegen::compile(Source::read(&path).expect("the spec is there"));
    outcome.protocol.unwrap_or_else(|| panic!("{}", outcome.diagnostics.concise()))
}

/// What a device sends: a request before, then the parts.
#[derive(Clone, Debug)]
struct Transfer {
    device: u32,
    /// The data of the message. Each transfer has its own.
    data: Vec<u8>,
}

impl Transfer {
    fn new(device: u32, rng: &mut Rng) -> Self {
        Self { device, data: std::iter::repeat_with(|| rng.u8(..)).take(18).collect() }
    }

    fn request(&self) -> Frame {
        frame(2 << 5 | self.device, vec![0; 8])
    }

    fn parts(&self) -> Vec<Frame> {
        let parts = (1..=PARTS).zip(self.data.chunks(6));
        parts.map(|(number, data)| frame(2 << 5 | 1 << 4 | self.device, [&[number], data, &[0]].concat())).collect()
    }
}

fn frame(id: u32, data: Vec<u8>) -> Frame {
    Frame { id, extended: false, data, form: Form::Data }
}

/// What the bus does to the parts of a message.
fn spoilt(parts: Vec<Frame>, rng: &mut Rng) -> Vec<Frame> {
    let mut came = Vec::new();
    for part in parts {
        match rng.u8(..8) {
            0 => {}
            1 => came.extend([part.clone(), part]),
            2 if !came.is_empty() => came.insert(came.len() - 1, part),
            _ => came.push(part),
        }
    }
    came
}

/// Mixes what several devices send, keeping the order of each.
fn mixed(mut queues: Vec<Vec<Frame>>, rng: &mut Rng) -> Vec<Frame> {
    for queue in &mut queues {
        queue.reverse();
    }
    let mut bus = Vec::new();
    while !queues.is_empty() {
        let index = rng.usize(..queues.len());
        match queues[index].pop() {
            Some(frame) => bus.push(frame),
            None => drop(queues.swap_remove(index)),
        }
    }
    bus
}

#[test]
fn each_message_that_is_reported_was_sent_and_each_one_lost_is_reported() {
    let protocol = protocol();
    let (mut whole, mut incomplete) = (0, 0);
    for seed in 0..2_000 {
        let mut rng = Rng::with_seed(seed);
        let mut sent = Vec::new();
        let mut begun = 0;
        let mut queue = |device: u32, rng: &mut Rng| {
            let mut frames = Vec::new();
            for _ in 0..rng.usize(1..6) {
                let transfer = Transfer::new(device, rng);
                let came = spoilt(transfer.parts(), rng);
                begun += usize::from(!came.is_empty());
                frames.push(transfer.request());
                frames.extend(came);
                sent.push(transfer);
            }
            frames
        };
        let queues = (1..=rng.u32(1..=DEVICES)).map(|device| queue(device, &mut rng)).collect();
        let mut assembly = Assembly::default();
        let mut ended = Vec::new();
        for frame in mixed(queues, &mut rng) {
            let decoded = decode(&protocol, None, &frame).expect("the frame is one of the protocol");
            ended.extend(assembly.take(&protocol, None, (), &frame, &decoded).ended);
        }
        ended.extend(assembly.finish(&protocol, None));
        assert!(ended.len() >= begun, "seed {seed}: {} of {begun} messages are reported", ended.len());
        for message in ended {
            let Some(data) = message.data else {
                incomplete += 1;
                assert!(message.incomplete.is_some(), "seed {seed}");
                continue;
            };
            let of_one = |known: &Transfer| known.device == message.frame.id & 0xF && known.data.starts_with(&data);
            assert!(sent.iter().any(of_one), "seed {seed}: nobody sent {data:X?}");
            whole += usize::from(data.len() == 18);
        }
    }
    assert!(whole > 5_000 && incomplete > 5_000, "{whole} whole and {incomplete} incomplete messages");
}
