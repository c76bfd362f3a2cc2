//! Sweeps every raw value of 32 bits through each scale that the built-in specs give a signal of 32 bits.
//!
//! The physical value must be the double nearest to the exact one, which integers tell. It and both doubles beside it
//! must go back to the raw value. Prints a line for each scale.
#![expect(clippy::print_stdout, reason = "people read what came of each scale")]

use std::collections::BTreeMap;
use std::fs;
use std::ops::Range;
use std::thread;
use std::time::Instant;

use canspec_codegen::model::{Numeral, Protocol};
use canspec_runtime::plumbing::Scale;
use canspec_tests::protocol;

/// Distances are counted in parts of 2 to this power.
const FINENESS: u32 = 80;

/// A scale and an offset, as fractions, and whether raw values have a sign.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
struct Case {
    scale: [i64; 2],
    offset: [i64; 2],
    is_signed: bool,
}

fn main() {
    let folder = fs::read_dir(concat!(env!("CARGO_MANIFEST_DIR"), "/../specs")).expect("the built-in specs are there");
    let paths = folder.flatten().map(|entry| entry.path());
    let mut cases = BTreeMap::<Case, Vec<String>>::new();
    for path in paths.filter(|path| path.extension().is_some_and(|ending| ending == "yaml")) {
        of(&protocol(path)).for_each(|(case, name)| cases.entry(case).or_default().push(name));
    }
    for (case, names) in cases {
        let start = Instant::now();
        let wrong = case.wrong();
        let seconds = start.elapsed().as_secs();
        println!("{case:?}: {} signals, first {}; wrong {wrong:?}; {seconds} s", names.len(), names[0]);
        assert_eq!(wrong, None, "{names:?}");
    }
}

/// Returns the cases of a protocol, with the names of their signals.
fn of(protocol: &Protocol) -> impl Iterator<Item = (Case, String)> {
    let signals =
        protocol.messages.iter().flat_map(|message| message.signals.iter().map(move |signal| (message, signal)));
    signals.filter(|(_, signal)| signal.place.width() == 32).filter_map(|(message, signal)| {
        let linear = signal.encoding.linear().filter(|_| !signal.encoding.is_unscaled())?;
        let fraction = |number: canspec_codegen::number::Rational| {
            [number.numerator(), number.denominator()]
                .map(|part| i64::try_from(part).expect("the compiler keeps it small"))
        };
        let is_signed = linear.numeral == Numeral::Signed;
        let case = Case { scale: fraction(linear.scale), offset: fraction(linear.offset), is_signed };
        Some((case, format!("{}.{}.{}", protocol.name, message.name, signal.name)))
    })
}

impl Case {
    /// Returns the first raw value that breaks a promise. All cores share the work.
    fn wrong(self) -> Option<i64> {
        let first = if self.is_signed { i64::from(i32::MIN) } else { 0 };
        let cores = thread::available_parallelism().map_or(1, |cores| i64::try_from(cores.get()).unwrap_or(1));
        let ends = |part: i64| first + (1_i64 << 32) * part / cores;
        thread::scope(|scope| {
            let parts: Vec<_> =
                (0..cores).map(|part| scope.spawn(move || self.wrong_in(ends(part)..ends(part + 1)))).collect();
            parts.into_iter().find_map(|part| part.join().expect("a sweep does not panic"))
        })
    }

    fn wrong_in(self, mut raws: Range<i64>) -> Option<i64> {
        let ([scale, below_scale], [offset, below_offset]) = (self.scale, self.offset);
        let runtime = Scale::new(scale, below_scale).offset(offset, below_offset);
        raws.find(|raw| {
            let physical = runtime.physical(*raw);
            let back = [physical, physical.next_up(), physical.next_down()].map(|value| runtime.raw(value));
            back != [Some(*raw); 3] || !self.is_nearest(*raw, physical)
        })
    }

    /// Tests whether no other double is nearer to the exact value of a raw value.
    fn is_nearest(self, raw: i64, physical: f64) -> bool {
        let ([scale, below_scale], [offset, below_offset]) = (self.scale.map(i128::from), self.offset.map(i128::from));
        let exact = i128::from(raw) * scale * below_offset + offset * below_scale;
        let below = below_scale * below_offset;
        let bits = physical.to_bits();
        let mantissa = i128::from(bits & ((1 << 52) - 1) | 1 << 52);
        // The distance between doubles here, in parts of `below` and of 2⁸⁰.
        let places = (bits >> 52 & 0x7FF) as u32;
        let Some(ulp) = places.checked_sub(1075 - FINENESS).map(|places| below << places) else { return exact == 0 };
        let distance = (mantissa * ulp - (exact.abs() << FINENESS)).abs();
        2 * distance <= ulp
    }
}
