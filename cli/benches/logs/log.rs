//! The log that is decoded: requests, each with its reply.

use std::fs::File;
use std::io::{self, BufWriter, Write};
use std::path::Path;

use fastrand::Rng;

/// All commands of INFY.
const COMMANDS: [u32; 18] =
    [0x01, 0x02, 0x03, 0x04, 0x06, 0x08, 0x09, 0x0A, 0x0B, 0x0C, 0x13, 0x14, 0x16, 0x19, 0x1A, 0x1B, 0x1C, 0x1F];

/// The address of the controller.
const CONTROLLER: u32 = 0xF0;

/// Writes a log in which all commands are equally frequent.
pub fn write(path: &Path, lines: u32) -> io::Result<()> {
    let (mut log, mut rng) = (BufWriter::new(File::create(path)?), Rng::with_seed(0x5EED));
    for line in (0..lines).step_by(2) {
        let command = COMMANDS[rng.usize(..COMMANDS.len())];
        let (device, target, source) = addresses(&mut rng, command);
        let reply = data(&mut rng, command);
        let request = if command < 0x13 { 0 } else { reply };
        let frames = [(target, CONTROLLER, request), (CONTROLLER, source, reply)];
        for (line, (target, source, data)) in (line..).zip(frames) {
            let id = device << 22 | command << 16 | target << 8 | source;
            let time = 1_700_000_000_000_000 + u64::from(line) * 1_000;
            writeln!(log, "({}.{:06}) can0 {id:08X}#{data:016X}", time / 1_000_000, time % 1_000_000)?;
        }
    }
    log.flush()
}

/// Returns the device number, the address of a request, and the one that its reply comes from.
fn addresses(rng: &mut Rng, command: u32) -> (u32, u32, u32) {
    let (module, group) = (rng.u32(0..=0x3B), rng.u32(0..=0x3E));
    let is_of_many = rng.bool();
    match command {
        0x01 | 0x02 | 0x08 | 0x1B if is_of_many => (0xB, group, group),
        0x01 | 0x02 | 0x08 | 0x1B => (0xA, 0x3F, 0x3F),
        _ if is_of_many => (0xB, group, module),
        _ => (0xA, module, module),
    }
}

/// Returns the values of a reply.
fn data(rng: &mut Rng, command: u32) -> u64 {
    match command {
        0x01 | 0x03 => words([rng.u32(..=750_000), rng.u32(..=50_000)].map(single)),
        0x02 => rng.u64(1..=60) << 40,
        0x04 => rng.u64(1..=0x3E) << 40 | u64::from(rng.u8(..)) << 24 | status(rng),
        0x06 => halves([rng.u16(..5000), rng.u16(..5000), rng.u16(..5000), 0]),
        0x08 | 0x09 | 0x1B | 0x1C => words([rng.u32(50_000..=750_000), rng.u32(100..=50_000)]),
        0x0A => halves([rng.u16(500..=1000), rng.u16(50..=200), rng.u16(..=1000), rng.u16(..=3000)]),
        0x0B => rng.u64(0x41..=0x5A) << 56 | rng.u64(..1_000_000_000_000) << 16 | rng.u64(..10_000),
        0x0C => halves([rng.u16(..=7500), rng.u16(..=1000), 0, 0]),
        0x16 => rng.u64(1..=0x3E) << 56,
        _ => rng.u64(..=1) << 56,
    }
}

/// Returns three status words with few set bits, as most have in service.
fn status(rng: &mut Rng) -> u64 {
    rng.u64(..) & rng.u64(..) & rng.u64(..) & 0xFF_FF3D
}

/// Returns the bit pattern of a number of thousandths.
#[expect(clippy::cast_precision_loss, reason = "any float will do")]
fn single(number: u32) -> u32 {
    (number as f32 / 1000.0).to_bits()
}

fn words(words: [u32; 2]) -> u64 {
    words.into_iter().fold(0, |word, part| word << 32 | u64::from(part))
}

fn halves(halves: [u16; 4]) -> u64 {
    halves.into_iter().fold(0, |word, part| word << 16 | u64::from(part))
}
