//! Finds one change of a field that makes its examples hold.

use canspec_runtime::Place;
use canspec_runtime::plumbing::ByteOrder;

use super::evidence::{Evidence, Field};
use crate::encoding::{Words, said};
use crate::model::{Encoding, Linear, Meaning, Protocol, Signal, Unit};
use crate::report::diagnostic::Diagnostics;
use crate::report::tree::Path;
use crate::words::number::Rational;

/// A change of one key.
pub struct Repair {
    /// Place of the value to change.
    pub at: Path,
    /// The key with its new value.
    pub text: String,
    change: Change,
}

/// What replaces a part of a field.
enum Change {
    Place(Place),
    Unit(Unit),
    Encoding(Encoding),
}

impl Change {
    fn of(&self, signal: &Signal) -> Signal {
        match self {
            Self::Place(place) => Signal { place: *place, ..signal.clone() },
            Self::Unit(unit) => Signal { unit: Some(*unit), ..signal.clone() },
            Self::Encoding(encoding) => Signal { encoding: encoding.clone(), ..signal.clone() },
        }
    }

    /// Tests whether a text still has the same raw value.
    fn keeps_raw(&self, signal: &Signal) -> bool {
        matches!(self, Self::Place(place) if place.max() == signal.place.max())
    }

    /// Tests whether it moves a field onto the bits of another one.
    fn overlaps(&self, field: &Field) -> bool {
        matches!(self, Self::Place(place) if u64::from_be_bytes(place.mask()) & field.taken != 0)
    }
}

/// Largest distance that a place can be off, in bytes or bits.
const FARTHEST: i8 = 7;

/// Lists how far the ends of a place can be off: one end by one, or both by the same distance.
fn shifts() -> impl Iterator<Item = (i8, i8)> {
    let ends = [(0, 1), (0, -1), (-1, 0), (1, 0)];
    ends.into_iter().chain((1..=FARTHEST).flat_map(|shift| [(shift, shift), (-shift, -shift)]))
}

/// Finds the first change that makes all examples hold, in the fields or in their common type.
pub fn find(
    protocol: &Protocol,
    fields: &[&Field],
    written: impl Fn(&str) -> Option<Path>,
    diagnostics: &Diagnostics,
) -> Option<Repair> {
    let text = |path: &Path| diagnostics.tree()?.get(path)?.text().map(str::to_owned);
    let signal = fields.first()?.signal;
    let examples: Vec<_> =
        fields.iter().flat_map(|field| field.denials().map(|denial| (field.signal, denial))).collect();
    let places = ["bytes", "bits"].into_iter().find_map(|key| {
        let at = written(key)?;
        Some(moved(signal, key, &text(&at)?, &at))
    });
    let unit = written("unit").and_then(|at| with_unit(&examples, at));
    let scale = written("scale").and_then(|at| with_scale(&examples, &text(&at)?, at));
    let offset = written("offset").and_then(|at| with_offset(&examples, &text(&at)?, at));
    let holds = |repair: &Repair| {
        fields.iter().all(|field| {
            let signal = repair.change.of(field.signal);
            let bears_out = |evidence: &Evidence| {
                let Meaning { said: as_is, text, .. } = evidence.meaning;
                let keeps = repair.change.keeps_raw(field.signal);
                let said = if keeps { as_is.clone() } else { said(Words::from(protocol), &signal, text) };
                said.is_ok_and(|said| said.is(&signal, signal.place.get(&evidence.data)))
            };
            !repair.change.overlaps(field) && field.evidence.iter().all(bears_out)
        })
    };
    places.into_iter().flatten().chain(unit).chain(scale).chain(offset).find(holds)
}

/// Reverses the byte order, or moves one or both ends of the place by bytes or bits.
///
/// A status word is only reversed. In another place, other bits of the frame would look like its own.
fn moved(signal: &Signal, key: &str, text: &str, at: &Path) -> Vec<Repair> {
    let ends = text.split_once("..").unwrap_or((text, text));
    let (Ok(first), Ok(last)) = (ends.0.parse::<i8>(), ends.1.parse::<i8>()) else { return Vec::new() };
    let repair = |first: i8, last: i8, place: Place| {
        let ends = if first == last { first.to_string() } else { format!("{first}..{last}") };
        Repair { at: at.clone(), text: format!("{key}: {ends}"), change: Change::Place(place) }
    };
    let reversed = (key == "bytes" && first != last).then(|| Some(repair(last, first, bytes(last, first)?)));
    let is_movable = signal.encoding.status_word().is_none();
    let shifted = shifts().filter(|_| is_movable).filter_map(|(of_first, of_last)| {
        let (first, last) = (first + of_first, last + of_last);
        let place = if key == "bytes" { bytes(first, last)? } else { bits(signal.place, of_first, of_last)? };
        Some(repair(first, last, place))
    });
    reversed.flatten().into_iter().chain(shifted).collect()
}

fn bytes(first: i8, last: i8) -> Option<Place> {
    let byte = |end: i8| u8::try_from(end).ok().filter(|end| *end < 8);
    Some(Place::bytes(byte(first)?, byte(last)?))
}

/// Moves the two ends of bits within the word around them.
fn bits(place: Place, of_first: i8, of_last: i8) -> Option<Place> {
    let word = if place.order() == ByteOrder::Big { Place::bytes(0, 7) } else { Place::bytes(7, 0) };
    let bits = place.bits_of_payload();
    let low = bits.shift().checked_add_signed(of_last)?;
    let high = (bits.shift() + bits.width() - 1).checked_add_signed(of_first)?;
    (low <= high && high < 64).then(|| word.bits(high, low))
}

/// Replaces the unit by that of the examples.
fn with_unit(examples: &[(&Signal, &Evidence)], at: Path) -> Option<Repair> {
    let (_, example) = examples.first().filter(|_| examples.len() > 1)?;
    let (_, symbol) = example.meaning.text.split_once(' ')?;
    Some(Repair { at, text: format!("unit: {symbol}"), change: Change::Unit(Unit::find(symbol)?) })
}

/// Replaces the scale by that of the first example, if the two are easily mistaken for each other.
fn with_scale(examples: &[(&Signal, &Evidence)], text: &str, at: Path) -> Option<Repair> {
    let (signal, example) = examples.iter().find(|(signal, example)| signal.place.get(&example.data) != 0)?;
    let Linear { numeral, offset, .. } = signal.encoding.linear()?;
    let (number, integer) = sides(signal, &example.meaning.text, signal.place.get(&example.data))?;
    let scale = number.minus(offset)?.over(integer)?;
    let change = Change::Encoding(Encoding::Number { numeral, scale, offset });
    linear(examples, "scale", scale, text, at, change)
}

/// Replaces the offset by that of the first example, if the two are easily mistaken for each other.
fn with_offset(examples: &[(&Signal, &Evidence)], text: &str, at: Path) -> Option<Repair> {
    let (signal, example) = examples.first()?;
    let Linear { numeral, scale, .. } = signal.encoding.linear()?;
    let offset = offset_of(signal, &example.meaning.text, signal.place.get(&example.data))?;
    let change = Change::Encoding(Encoding::Number { numeral, scale, offset });
    linear(examples, "offset", offset, text, at, change)
}

/// Returns the offset with which these bits of a frame mean a text.
pub fn offset_of(signal: &Signal, text: &str, bits: u64) -> Option<Rational> {
    let Linear { scale, .. } = signal.encoding.linear()?;
    let (number, integer) = sides(signal, text, bits)?;
    number.minus(integer.times(scale)?)
}

/// Returns the number in a text, and the integer in the bits of a frame.
fn sides(signal: &Signal, text: &str, bits: u64) -> Option<(Rational, Rational)> {
    let number = text.split(' ').next().and_then(Rational::parse)?;
    let integer = signal.encoding.linear()?.numeral.integer(signal.raw_of(bits))?;
    Some((number, Rational::integer(integer)))
}

/// Replaces the number after a key, if several examples say so or one digit is wrong.
fn linear(
    examples: &[(&Signal, &Evidence)],
    key: &str,
    right: Rational,
    text: &str,
    at: Path,
    change: Change,
) -> Option<Repair> {
    let right = right.fraction();
    let is_near = examples.len() > 1 || strsim::osa_distance(&right, text) == 1;
    is_near.then(|| Repair { at, text: format!("{key}: {right}"), change })
}
