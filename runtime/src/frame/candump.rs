//! Frames as texts, in the form of candump.

use core::fmt;
use core::str::FromStr;

use super::Frame;

/// Why a text is no classic data frame in the form of candump: `18FF0102#0011223344`.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub enum NotAFrame {
    /// Nothing parts the identifier from the data.
    Hash,
    /// The identifier has neither 3 nor 8 hexadecimal digits, or is greater than 7FF or 1FFFFFFF.
    Identifier,
    /// The data are not up to 8 bytes of two hexadecimal digits each. CAN FD and remote frames are among these.
    Data,
}

impl fmt::Display for NotAFrame {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        formatter.write_str(match self {
            Self::Hash => "no `#` parts the identifier from the data, as in `18FF0102#0011`",
            Self::Identifier => "the identifier is not 3 digits up to `7FF`, or 8 digits up to `1FFFFFFF`",
            Self::Data => "the data are not 0 to 8 bytes of two hexadecimal digits each",
        })
    }
}

impl core::error::Error for NotAFrame {}

impl FromStr for Frame {
    type Err = NotAFrame;

    /// Reads what [`Display`](fmt::Display) writes. An identifier of 8 digits is an extended one. Small letters are
    /// digits, too.
    ///
    /// ```
    /// use canspec_runtime::Frame;
    ///
    /// let frame: Frame = "18FF0102#0011223344".parse()?;
    /// assert_eq!((frame.raw_id(), frame.to_string().as_str()), (0x18FF_0102, "18FF0102#0011223344"));
    /// # Ok::<(), canspec_runtime::NotAFrame>(())
    /// ```
    fn from_str(text: &str) -> Result<Self, NotAFrame> {
        let (id, data) = text.split_once('#').ok_or(NotAFrame::Hash)?;
        let (extended, most) = match id.len() {
            3 => (false, 0x7FF),
            8 => (true, 0x1FFF_FFFF),
            _ => return Err(NotAFrame::Identifier),
        };
        let id = id.bytes().try_fold(0, |id, digit| Some(id << 4 | value(digit)?));
        let id = id.filter(|id| *id <= most).ok_or(NotAFrame::Identifier)?;
        let (data, length) = bytes(data).ok_or(NotAFrame::Data)?;
        Ok(Self::new_raw(id, extended, data, length))
    }
}

/// Reads up to eight bytes, and counts them.
fn bytes(text: &str) -> Option<([u8; 8], u8)> {
    let mut data = [0; 8];
    let pairs = text.as_bytes().chunks(2);
    let length = u8::try_from(pairs.len()).ok()?;
    let mut rest = data.iter_mut();
    for pair in pairs {
        let [high, low] = *pair else { return None };
        *rest.next()? = u8::try_from(value(high)? << 4 | value(low)?).ok()?;
    }
    Some((data, length))
}

/// Returns the value of a hexadecimal digit.
fn value(digit: u8) -> Option<u32> {
    char::from(digit).to_digit(16)
}

#[cfg(test)]
mod tests {
    use std::string::ToString;

    use super::*;

    #[test]
    fn a_text_of_candump_is_a_frame() {
        let frame = |text: &str| text.parse::<Frame>();
        assert_eq!(
            frame("18FF0102#0011223344"),
            Ok(Frame::new_raw(0x18FF_0102, true, [0, 0x11, 0x22, 0x33, 0x44, 0, 0, 0], 5))
        );
        assert_eq!(frame("7ff#"), Ok(Frame::new_raw(0x7FF, false, [0; 8], 0)));
        assert_eq!(
            frame("00000001#aBcDeF0123456789"),
            Ok(Frame::new_raw(1, true, [0xAB, 0xCD, 0xEF, 1, 0x23, 0x45, 0x67, 0x89], 8))
        );
    }

    #[test]
    fn what_is_written_is_read_again() {
        for frame in [Frame::new_raw(0x1FFF_FFFF, true, [0xA5; 8], 8), Frame::new_raw(0, false, [9; 8], 1)] {
            assert_eq!(frame.to_string().parse(), Ok(frame));
        }
    }

    #[test]
    fn what_is_no_classic_data_frame_is_refused_with_its_reason() {
        let refused = [
            ("", NotAFrame::Hash),
            ("18FF01020011", NotAFrame::Hash),
            ("#00", NotAFrame::Identifier),
            ("12#00", NotAFrame::Identifier),
            ("1234#00", NotAFrame::Identifier),
            ("12345678 #00", NotAFrame::Identifier),
            ("800#00", NotAFrame::Identifier),
            ("20000000#00", NotAFrame::Identifier),
            ("12G#00", NotAFrame::Identifier),
            ("+12#00", NotAFrame::Identifier),
            ("123#0", NotAFrame::Data),
            ("123#0G", NotAFrame::Data),
            ("123#+1", NotAFrame::Data),
            ("123#00 ", NotAFrame::Data),
            ("123#R", NotAFrame::Data),
            ("123##100", NotAFrame::Data),
            ("123#001122334455667788", NotAFrame::Data),
            ("123#é", NotAFrame::Data),
        ];
        for (text, reason) in refused {
            assert_eq!(text.parse::<Frame>(), Err(reason), "{text}");
        }
        let long = "123#".to_string() + &"00".repeat(300);
        assert_eq!(long.parse::<Frame>(), Err(NotAFrame::Data));
        let texts = [NotAFrame::Hash, NotAFrame::Identifier, NotAFrame::Data].map(|reason| reason.to_string());
        assert!(texts[0].contains("no `#`") && texts[1].contains("`1FFFFFFF`") && texts[2].contains("0 to 8 bytes"));
    }
}
