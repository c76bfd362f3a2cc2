//! Places in the data bytes: as a spec writes them, and as they are stored.
//!
//! A stored place says whether its word is big endian, and which are its highest and its lowest bit.

use std::fmt;

use canspec_runtime::Place;
use canspec_runtime::plumbing::ByteOrder;
use serde::de::Error;
use serde::{Deserialize, Deserializer, Serialize, Serializer};

use super::{Signal, StatusBit};

type Stored = (bool, u8, u8);

/// A place as a spec writes it: whole bytes, and bits of the word that they are.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
#[non_exhaustive]
pub struct WrittenPlace {
    /// The data byte with the most significant bits of the word.
    pub first: usize,
    /// The data byte with the least significant bits of the word. It comes before `first` if the word is little endian.
    pub last: usize,
    /// The most significant bit of the place. Bit 0 is the least significant one of the word.
    pub high: usize,
    /// The least significant bit of the place.
    pub low: usize,
}

impl WrittenPlace {
    /// Returns a place whose bits are counted in the bytes that it touches.
    pub fn of(place: Place) -> Self {
        Self::in_word(0, place, place)
    }

    /// Returns a place whose bits are counted in a word. `window` is how many data bytes come before both.
    fn in_word(window: u16, place: Place, word: Place) -> Self {
        let (bits, around) = (place.bits_of_payload(), word.bits_of_payload());
        let ends = [around.shift() + around.width() - 1, around.shift()].map(|bit| usize::from(bit / 8));
        let [first, last] = ends.map(|byte| match place.order() {
            ByteOrder::Big => 7 - byte,
            ByteOrder::Little => byte,
        });
        let low = usize::from(bits.shift()).saturating_sub(8 * ends[1]);
        let [first, last] = [first, last].map(|byte| usize::from(window) + byte);
        Self { first, last, high: low + usize::from(bits.width()) - 1, low }
    }

    /// Returns a text of whole bytes.
    fn run(window: u16, bytes: u16) -> Self {
        let [first, bytes] = [window, bytes].map(usize::from);
        Self { first, last: (first + bytes).saturating_sub(1), high: (8 * bytes).saturating_sub(1), low: 0 }
    }

    /// Tests whether it is all bits of its bytes.
    fn is_whole(self) -> bool {
        self.low == 0 && self.high + 1 == 8 * (self.first.abs_diff(self.last) + 1)
    }
}

impl fmt::Display for WrittenPlace {
    /// Writes `0..3`, `4`, `6..5 bits 10..0` or `4 bit 7`.
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        let span = |from: usize, to: usize| if from == to { from.to_string() } else { format!("{from}..{to}") };
        write!(formatter, "{}", span(self.first, self.last))?;
        if self.is_whole() {
            return Ok(());
        }
        let word = if self.high == self.low { "bit" } else { "bits" };
        write!(formatter, " {word} {}", span(self.high, self.low))
    }
}

impl Signal {
    /// Returns its place as the spec writes it. Bytes are those of the frame, or of the data of a long message.
    pub fn written(&self) -> WrittenPlace {
        match self.run {
            Some(run) => WrittenPlace::run(self.window, run.most),
            None => WrittenPlace::in_word(self.window, self.place, self.word),
        }
    }

    /// Returns the byte of one of its status bits, and its number there, if the spec counts it so.
    pub fn byte_of(&self, bit: &StatusBit) -> Option<(usize, usize)> {
        let is_known = bit.is_by_byte && bit.bit < self.place.width();
        let place = is_known.then(|| self.place.bit(bit.bit))?;
        let WrittenPlace { first, high, .. } = WrittenPlace::in_word(self.window, place, place);
        Some((first, high))
    }
}

#[expect(clippy::trivially_copy_pass_by_ref, reason = "serde calls it so")]
pub fn serialize<S: Serializer>(place: &Place, serializer: S) -> Result<S::Ok, S::Error> {
    let (is_big, bits) = (place.order() == ByteOrder::Big, place.bits_of_payload());
    let stored: Stored = (is_big, bits.shift() + bits.width() - 1, bits.shift());
    stored.serialize(serializer)
}

pub fn deserialize<'de, D: Deserializer<'de>>(deserializer: D) -> Result<Place, D::Error> {
    let (is_big, high, low) = Stored::deserialize(deserializer)?;
    let word = if is_big { Place::bytes(0, 7) } else { Place::bytes(7, 0) };
    if low <= high && high < 64 { Ok(word.bits(high, low)) } else { Err(D::Error::custom("no such bits")) }
}
