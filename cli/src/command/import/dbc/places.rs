//! Turns places of a DBC into bytes of the frame, or bits of a word.

use can_dbc::{ByteOrder, Signal};

/// The place of a signal in the data bytes.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct BitRange {
    /// The first and the last byte that it touches.
    first: u8,
    last: u8,
    low_byte_first: bool,
    /// Its lowest bit in the word of these bytes.
    low: u8,
    width: u8,
}

impl BitRange {
    /// Returns the place of a signal, or `None` if it reaches beyond `length` data bytes.
    pub fn new(signal: &Signal, length: u8) -> Option<Self> {
        let end = 8 * length;
        let start = u8::try_from(signal.start_bit).ok().filter(|start| *start < end)?;
        let width = u8::try_from(signal.size).ok().filter(|width| (1..=64).contains(width))?;
        let low_byte_first = signal.byte_order == ByteOrder::LittleEndian;
        // Bits count in the order of the bytes. Big endian has its highest bit first, which is bit
        // 7 of a byte.
        let begin = if low_byte_first { start } else { start / 8 * 8 + 7 - start % 8 };
        let behind = begin.checked_add(width).filter(|behind| *behind <= end)?;
        let (first, last) = (begin / 8, (behind - 1) / 8);
        let low = if low_byte_first { begin - 8 * first } else { 8 * (last + 1) - behind };
        Some(Self { first, last, low_byte_first, low, width })
    }

    /// Returns its bits in a frame, bit 0 of byte 0 lowest.
    pub fn mask(self) -> u64 {
        let bits = u64::MAX >> (64 - self.width) << self.low;
        let bytes = bits.to_le_bytes();
        let count = usize::from(self.last - self.first) + 1;
        let mut frame = [0; 8];
        for (index, byte) in bytes.into_iter().take(count).enumerate() {
            let offset = if self.low_byte_first { index } else { count - 1 - index };
            frame[usize::from(self.first) + offset] = byte;
        }
        u64::from_le_bytes(frame)
    }

    pub fn width(self) -> u8 {
        self.width
    }

    /// Tests whether it is made of whole bytes.
    fn is_whole(self) -> bool {
        self.low == 0 && self.width.is_multiple_of(8)
    }

    /// Writes the bytes, the most significant one first.
    pub fn bytes(self) -> String {
        match (self.first, self.last, self.low_byte_first) {
            (first, last, _) if first == last => first.to_string(),
            (first, last, true) => format!("{last}..{first}"),
            (first, last, false) => format!("{first}..{last}"),
        }
    }

    /// Writes the bits in a word that holds the place.
    pub fn bits(self, word: BitRange) -> String {
        let low = self.low_in(word);
        if self.width == 1 { low.to_string() } else { format!("{}..{low}", low + self.width - 1) }
    }

    fn low_in(self, word: BitRange) -> u8 {
        self.low + 8 * if word.low_byte_first { self.first - word.first } else { word.last - self.last }
    }

    /// Tests whether its low bits come first on the bus.
    fn begins_low(self) -> bool {
        self.low_byte_first && self.first != self.last
    }

    /// Returns the word around two places that share a byte, if they have the same byte order.
    fn joined(self, other: BitRange) -> Option<BitRange> {
        let is_single = |place: BitRange| place.first == place.last;
        let has_one_order = is_single(self) || is_single(other) || self.low_byte_first == other.low_byte_first;
        let touches = self.first <= other.last && other.first <= self.last;
        let low_byte_first = if is_single(self) { other.low_byte_first } else { self.low_byte_first };
        let (first, last) = (self.first.min(other.first), self.last.max(other.last));
        (has_one_order && touches).then_some(Self { first, last, low_byte_first, ..self })
    }

    /// Returns the name of a word of these bytes.
    pub fn word_name(self) -> String {
        match (self.first, self.last) {
            (first, last) if first == last => format!("byte_{first}"),
            (first, last) => format!("bytes_{first}_{last}"),
        }
    }
}

/// One place, or a word of several places.
pub struct Group {
    pub place: BitRange,
    pub is_word: bool,
    /// Indices of its places, in the order of their bits.
    pub of: Vec<usize>,
}

/// Groups places that are no whole bytes into words, in the order of the bytes.
///
/// A constant has the word of its own bytes in every message, so it is the same constant
/// everywhere.
pub fn groups(places: &[(BitRange, bool)]) -> Vec<Group> {
    let mut groups: Vec<Group> = Vec::new();
    let mut order: Vec<usize> = (0..places.len()).collect();
    // Places of several bytes come first, so single bytes take the order of a word. Constants come
    // last, so no word grows after them.
    order.sort_by_key(|index| {
        let (place, is_constant) = places[*index];
        (is_constant, place.first == place.last, place.first)
    });
    for index in order {
        let (place, is_constant) = places[index];
        let mut group = Group { place, is_word: !place.is_whole(), of: vec![index] };
        while let Some((known, joined)) = joinable(&groups, &group, is_constant) {
            group.of.extend(groups.remove(known).of);
            group.place = joined;
        }
        groups.push(group);
    }
    groups.sort_by_key(|group| (group.place.first, group.place.last));
    for group in &mut groups {
        group.of.sort_by_key(|index| places[*index].0.low_in(group.place));
        if !group.place.begins_low() {
            group.of.reverse();
        }
    }
    groups
}

/// Finds a word that another word can join, and the word around both.
fn joinable(groups: &[Group], one: &Group, must_keep_bytes: bool) -> Option<(usize, BitRange)> {
    let words = groups.iter().enumerate().filter(|(_, group)| group.is_word && one.is_word);
    let mut joined = words.filter_map(|(index, group)| Some((index, group.place.joined(one.place)?)));
    joined.find(|(_, word)| !must_keep_bytes || (word.first, word.last) == (one.place.first, one.place.last))
}

#[cfg(test)]
mod tests {
    use can_dbc::Dbc;

    use super::*;

    fn places(signals: &[&str]) -> Vec<Option<BitRange>> {
        let signals: Vec<_> = signals.iter().map(|place| format!(" SG_ s : {place}+ (1,0) [0|0] \"\" y\n")).collect();
        let dbc = Dbc::try_from(format!("BO_ 1 m: 8 x\n{}", signals.concat()).as_str()).expect("the DBC is right");
        dbc.messages[0].signals.iter().map(|signal| BitRange::new(signal, 8)).collect()
    }

    /// Writes words and what is in them.
    fn shown(signals: &[&str]) -> Vec<String> {
        let places: Vec<BitRange> =
            places(signals).into_iter().map(|place| place.expect("it lies in the frame")).collect();
        let shown = |group: Group| {
            let bits: Vec<_> = group.of.iter().map(|index| places[*index].bits(group.place)).collect();
            let bits = if group.is_word { format!(": {}", bits.join(" ")) } else { String::new() };
            group.place.bytes() + &bits
        };
        groups(&places.iter().map(|place| (*place, false)).collect::<Vec<_>>()).into_iter().map(shown).collect()
    }

    #[test]
    fn whole_bytes_need_no_word() {
        assert_eq!(shown(&["0|16@1", "23|16@0", "32|8@1", "47|8@0"]), ["1..0", "2..3", "4", "5"]);
        assert_eq!(shown(&["7|64@0"]), ["0..7"]);
        assert_eq!(shown(&["0|64@1"]), ["7..0"]);
    }

    #[test]
    fn what_shares_a_byte_shares_a_word() {
        assert_eq!(shown(&["0|12@1", "12|12@1", "24|1@1"]), ["2..0: 11..0 23..12", "3: 0"]);
        assert_eq!(shown(&["7|12@0", "11|12@0"]), ["0..2: 23..12 11..0"]);
        assert_eq!(shown(&["0|4@1", "7|4@0"]), ["0: 7..4 3..0"]);
        // A single bit takes the order of the word around it. Bit 1 of byte 3 is bit 17 of bytes
        // 3..1, and bit 1 of bytes 1..3.
        assert_eq!(shown(&["25|1@1", "26|1@0", "8|17@1"]), ["3..1: 16..0 17 18"]);
        assert_eq!(shown(&["25|1@1", "15|22@0"]), ["1..3: 23..2 1"]);
    }

    #[test]
    fn a_constant_has_the_word_of_its_bytes() {
        let [small, large] = places(&["0|4@1", "4|12@1"])[..] else { panic!("two places") };
        let (small, large) = (small.expect("it fits"), large.expect("it fits"));
        let words = |is_constant| {
            groups(&[(small, is_constant), (large, false)]).iter().map(|group| group.place.bytes()).collect::<Vec<_>>()
        };
        assert_eq!(words(false), ["1..0"]);
        assert_eq!(words(true), ["0", "1..0"]);
    }

    #[test]
    fn words_of_two_byte_orders_stay_apart() {
        // The high half of byte 1 goes with the low half of byte 2, its low half with the high half.
        assert_eq!(shown(&["12|8@1", "11|8@0"]), ["2..1: 11..4", "1..2: 11..4"]);
    }

    #[test]
    fn bits_in_a_frame_are_those_of_the_format() {
        let masks: Vec<_> =
            places(&["0|12@1", "7|12@0", "10|3@0", "63|1@1"]).into_iter().flatten().map(BitRange::mask).collect();
        assert_eq!(masks, [0x0FFF, 0xF0FF, 0x0700, 1 << 63]);
    }

    #[test]
    fn what_leaves_the_frame_has_no_place() {
        assert_eq!(places(&["60|5@1", "56|9@0", "64|1@1", "0|0@1", "400|1@1"]), [None; 5]);
    }
}
