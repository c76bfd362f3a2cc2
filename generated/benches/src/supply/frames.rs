//! The frames that are measured: requests and replies of a kind, with valid addresses and values.

use std::collections::HashSet;
use std::iter;

use fastrand::Rng;

use crate::frame::Frame;
use crate::steps::{halves, words};

/// Returns `count` different frames of a command.
pub fn of(command: u32, count: usize) -> Vec<Frame> {
    let mut rng = Rng::with_seed(0x5EED);
    let mut seen = HashSet::with_capacity(count);
    iter::repeat_with(|| frame(&mut rng, command)).filter(|frame| seen.insert(*frame)).take(count).collect()
}

fn frame(rng: &mut Rng, command: u32) -> Frame {
    let one = 0x2A << 23 | rng.u32(..=0x3F) << 8;
    let addressed = [one | 1 << 22, one | 1 << 22, one, 0x2B << 23 | 0xFF << 8][rng.usize(..4)];
    Frame::of(addressed | command << 16 | rng.u32(0xF0..=0xF8), word(rng, command).to_be_bytes())
}

/// Returns data whose values lie within their limits. A limit itself may lie outside once it is an `f32`.
fn word(rng: &mut Rng, command: u32) -> u64 {
    match command {
        1 => words(thousandths(rng, 1_000_000), thousandths(rng, 500_000)),
        2 => words(rng.u32(50_001..750_000), rng.u32(101..50_000)),
        3 => rng.u64(..) & 0x0000_FF00_FFFF_FFFF,
        4 => halves([rng.u16(..6000), rng.u16(..6000), rng.u16(..6000), 0]),
        5 => match rng.u16(1..=40) {
            real @ ..=20 => halves([real, 0, 0, 0]) | u64::from(thousandths(rng, 1_000_000)),
            whole => halves([whole, 0, 0, 0]) | u64::from(rng.u32(..=1_000_000)),
        },
        _ => {
            let steps = rng.i32(-1000 * 1024..=1000 * 1024);
            halves([rng.u16(0x101..=0x13C), 0, 0, 0]) | u64::from(steps.cast_unsigned())
        }
    }
}

/// Returns the bit pattern of a floating-point number.
#[expect(clippy::cast_precision_loss, reason = "any float will do")]
fn thousandths(rng: &mut Rng, most: u32) -> u32 {
    (rng.u32(..=most) as f32 / 1000.0).to_bits()
}
