//! The frames that are measured: every message in every direction, with valid addresses and values.

use std::collections::HashSet;
use std::iter;

use fastrand::Rng;

use crate::frame::Frame;

/// Returns `count` different frames in a random order.
///
/// All messages are equally frequent until their frames are used up. There are few reads, and many
/// set-points.
pub fn distinct(count: usize) -> Vec<Frame> {
    let mut rng = Rng::with_seed(0x5EED);
    let mut seen = HashSet::with_capacity(count);
    let mut frames: Vec<_> =
        iter::repeat_with(|| frame(&mut rng)).filter(|frame| seen.insert(*frame)).take(count).collect();
    rng.shuffle(&mut frames);
    frames
}

const COMMANDS: [u32; 18] =
    [0x01, 0x02, 0x03, 0x04, 0x06, 0x08, 0x09, 0x0A, 0x0B, 0x0C, 0x13, 0x14, 0x16, 0x19, 0x1A, 0x1B, 0x1C, 0x1F];

/// Returns a frame of any command and direction.
fn frame(rng: &mut Rng) -> Frame {
    let (command, is_reply) = (COMMANDS[rng.usize(..COMMANDS.len())], rng.bool());
    let (device, address) = target(rng, command, is_reply);
    let controller = rng.u32(0xF0..=0xF8);
    let (target, source) = if is_reply { (controller, address) } else { (address, controller) };
    let id = device << 22 | command << 16 | target << 8 | source;
    let is_read = command < 0x13 && !is_reply;
    Frame::of(id, if is_read { [0; 8] } else { data(rng, command) })
}

/// Returns the device number and the address of modules, as the command allows.
fn target(rng: &mut Rng, command: u32, is_reply: bool) -> (u32, u32) {
    let module = (0xA, rng.u32(0..=0x3B));
    let group = (0xB, rng.u32(0..=0x3E));
    let of_group = (0xB, rng.u32(0..=0x3B));
    match command {
        0x01 | 0x02 | 0x08 | 0x1B => [group, (0xA, 0x3F), (0xB, 0x3F)][rng.usize(..3)],
        _ if is_reply => [module, of_group][rng.usize(..2)],
        0x1A => [module, group, (0xA, 0x3F), (0xB, 0x3F)][rng.usize(..4)],
        0x13.. => [module, group, (0xA, 0x3F)][rng.usize(..3)],
        _ => [module, group][rng.usize(..2)],
    }
}

fn data(rng: &mut Rng, command: u32) -> [u8; 8] {
    match command {
        0x01 | 0x03 => words([rng.u32(..=750_000), rng.u32(..=900_000)].map(thousandths)),
        0x02 => [0, 0, rng.u8(1..=60), 0, 0, 0, 0, 0],
        0x04 => [0, 0, rng.u8(..=0x3E), 0, rng.u8(..), rng.u8(..), rng.u8(..), rng.u8(..) & 0x3D],
        0x06 => halves([rng.u16(..5000), rng.u16(..5000), rng.u16(..5000), 0]),
        0x08 | 0x09 => words([rng.u32(..=750_000), rng.u32(..=900_000)]),
        0x1B => words([rng.u32(50_000..=750_000), rng.u32(..=900_000)]),
        0x1C => words([rng.u32(50_000..=750_000), rng.u32(100..=50_000)]),
        0x0A => halves([rng.u16(500..=1000), rng.u16(50..=200), rng.u16(..=1000), rng.u16(..=3000)]),
        0x0B => barcode(rng.u64(..1_000_000_000_000), rng.u8(b'A'..=b'Z'), rng.u16(..10_000)),
        0x0C => halves([rng.u16(..=7500), rng.u16(..=1000), 0, 0]),
        0x16 => [rng.u8(1..=0x3E), 0, 0, 0, 0, 0, 0, 0],
        _ => [rng.u8(..=1), 0, 0, 0, 0, 0, 0, 0],
    }
}

/// Returns the bit pattern of a floating-point number.
#[expect(clippy::cast_precision_loss, reason = "any float will do")]
fn thousandths(number: u32) -> u32 {
    (number as f32 / 1000.0).to_bits()
}

fn words(words: [u32; 2]) -> [u8; 8] {
    let [first, second] = words.map(u64::from);
    (first << 32 | second).to_be_bytes()
}

fn halves(halves: [u16; 4]) -> [u8; 8] {
    halves.into_iter().fold(0, |word, half| word << 16 | u64::from(half)).to_be_bytes()
}

fn barcode(number: u64, letter: u8, suffix: u16) -> [u8; 8] {
    (u64::from(letter) << 56 | number << 16 | u64::from(suffix)).to_be_bytes()
}
