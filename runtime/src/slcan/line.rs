//! The lines of SLCAN: `tIIILDD..` and `TIIIIIIIILDD..`, which a carriage return ends.

use crate::Frame;

/// The length of the longest line that counts: a long identifier, eight bytes and a stamp.
const LONGEST: usize = 31;

/// A line that sends a frame.
#[derive(Clone, Copy, Debug)]
pub struct Line {
    bytes: [u8; LONGEST],
    length: usize,
    /// How much of it was sent.
    sent: usize,
}

impl Line {
    /// Nothing is to be sent.
    pub const NONE: Self = Self { bytes: [b'\r'; LONGEST], length: 0, sent: 0 };

    /// Returns the line of a frame.
    pub fn of(frame: &Frame) -> Self {
        let mut line = Self::NONE;
        let is_extended = embedded_can::Frame::is_extended(frame);
        line.push(if is_extended { b'T' } else { b't' });
        for digit in (0..if is_extended { 8 } else { 3 }).rev() {
            line.push_digit(frame.raw_id() >> (4 * digit));
        }
        let data = embedded_can::Frame::data(frame);
        line.push_digit(u32::try_from(data.len()).unwrap_or_default());
        for byte in data {
            line.push_digit(u32::from(byte >> 4));
            line.push_digit(u32::from(*byte));
        }
        line.push(b'\r');
        line
    }

    /// Returns what was not sent, with the carriage return.
    pub fn rest(&self) -> &[u8] {
        self.bytes.get(self.sent..self.length).unwrap_or_default()
    }

    /// Notes how many more bytes were sent.
    pub const fn took(&mut self, count: usize) {
        self.sent = self.sent.saturating_add(count);
    }

    /// Tests whether a part of it was sent.
    pub const fn has_begun(&self) -> bool {
        self.sent > 0
    }

    fn push(&mut self, byte: u8) {
        if let Some(slot) = self.bytes.get_mut(self.length) {
            *slot = byte;
            self.length += 1;
        }
    }

    /// Adds the lowest four bits as a digit.
    fn push_digit(&mut self, bits: u32) {
        let digit = char::from_digit(bits & 0xF, 16).unwrap_or('0').to_ascii_uppercase();
        self.push(u8::try_from(digit).unwrap_or(b'0'));
    }
}

/// Takes lines apart as they come.
#[derive(Clone, Copy, Debug)]
pub struct Lines {
    /// What has come, and where what was not read begins and ends.
    bytes: [u8; 256],
    from: usize,
    to: usize,
    line: [u8; LONGEST],
    /// How long the line is so far. One that is too long is dropped up to its end.
    length: usize,
}

impl Lines {
    /// Nothing has come.
    pub const NEW: Self = Self { bytes: [0; 256], from: 0, to: 0, line: [0; LONGEST], length: 0 };

    /// Returns the room for what comes. What has come before must have been read.
    pub fn room(&mut self) -> &mut [u8] {
        (self.from, self.to) = (0, 0);
        &mut self.bytes
    }

    /// Notes how much of the room was filled.
    pub const fn took(&mut self, count: usize) {
        self.to = count;
    }

    /// Returns the next frame. Lines that are none are passed over, such as answers of the adapter.
    pub fn frame(&mut self) -> Option<Frame> {
        while let Some(byte) = self.bytes.get(self.from..self.to).and_then(|rest| rest.first().copied()) {
            self.from += 1;
            if let b'\r' | b'\n' | 0x07 = byte {
                let length = core::mem::take(&mut self.length);
                let frame = self.line.get(..length).and_then(frame);
                if frame.is_some() {
                    return frame;
                }
                continue;
            }
            if let Some(slot) = self.line.get_mut(self.length) {
                *slot = byte;
            }
            self.length = self.length.saturating_add(1);
        }
        None
    }
}

/// Reads a line without its end, if it is a data frame.
fn frame(line: &[u8]) -> Option<Frame> {
    let (letter, digits) = line.split_first()?;
    let (is_extended, width) = match letter {
        b't' => (false, 3),
        b'T' => (true, 8),
        _ => return None,
    };
    let (id, digits) = digits.split_at_checked(width)?;
    let id = id.iter().try_fold(0, |id: u32, digit| Some(id << 4 | value(*digit)?))?;
    let (length, digits) = digits.split_first()?;
    let length = value(*length).filter(|length| *length <= 8)?;
    let most = if is_extended { 0x1FFF_FFFF } else { 0x7FF };
    let mut data = [0; 8];
    let (bytes, stamp) = digits.split_at_checked(usize::try_from(length).ok()? * 2)?;
    for (slot, pair) in data.iter_mut().zip(bytes.chunks_exact(2)) {
        let [high, low] = pair else { return None };
        *slot = u8::try_from(value(*high)? << 4 | value(*low)?).ok()?;
    }
    let is_whole = id <= most && matches!(stamp.len(), 0 | 4);
    is_whole.then(|| Frame::new_raw(id, is_extended, data, u8::try_from(length).unwrap_or_default()))
}

/// Returns the value of a hexadecimal digit.
fn value(digit: u8) -> Option<u32> {
    char::from(digit).to_digit(16)
}

#[cfg(test)]
mod tests {
    use std::string::ToString;
    use std::vec::Vec;

    use super::*;

    /// Returns the frames of what comes, in pieces of a size.
    fn frames(text: &[u8], size: usize) -> Vec<std::string::String> {
        let mut lines = Lines::NEW;
        let mut frames = Vec::new();
        for piece in text.chunks(size) {
            lines.room()[..piece.len()].copy_from_slice(piece);
            lines.took(piece.len());
            frames.extend(core::iter::from_fn(|| lines.frame()).map(|frame| frame.to_string()));
        }
        frames
    }

    #[test]
    fn a_frame_is_a_line_of_the_manual() {
        // t100 with two bytes, and T00000100 without: the LAWICEL CAN232 manual.
        let short = Frame::new_raw(0x100, false, [0x11, 0x33, 0, 0, 0, 0, 0, 0], 2);
        assert_eq!(Line::of(&short).rest(), b"t10021133\r");
        let long = Frame::new_raw(0x0284_F003, true, [0xAB, 0, 2, 0, 0x16, 0, 0x40, 0xFF], 8);
        assert_eq!(Line::of(&long).rest(), b"T0284F0038AB000200160040FF\r");
        assert_eq!(Line::of(&Frame::new_raw(0x100, true, [0; 8], 0)).rest(), b"T000001000\r");
    }

    #[test]
    fn what_comes_in_any_pieces_is_taken_apart() {
        let text = b"\rz\rt10021133\rT0284f0038AB000200160040FF\r\x07t7FF0EA5F\rT1FFFFFFF10A\r";
        let expected = ["100#1133", "0284F003#AB000200160040FF", "7FF#", "1FFFFFFF#0A"];
        for size in 1..=text.len() {
            assert_eq!(frames(text, size), expected, "{size}");
        }
    }

    #[test]
    fn what_is_no_whole_frame_is_passed_over() {
        let wrong: [&[u8]; 12] = [
            b"t1002113\r",
            b"t800211\r",
            b"T2000000000\r",
            b"t1009112233445566778899\r",
            b"t10021133EA5\r",
            b"t100211x3\r",
            b"r1002\r",
            b"R000001000\r",
            b"t10\r",
            b"T0284F0038AB000200160040FF00001\r",
            b"t10021133 \r",
            b"x10021133\r",
        ];
        for line in wrong {
            assert_eq!(frames(&[line, b"t10021133\r"].concat(), 7), ["100#1133"], "{line:?}");
        }
    }
}
