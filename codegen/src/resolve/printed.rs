//! Reads frames as documents print them.

use crate::words::hex;

/// A frame as an example prints it.
#[derive(Debug, PartialEq, Eq)]
pub struct Printed {
    /// The identifier, which can have more bits than its width allows.
    pub id: u32,
    pub extended: bool,
    /// The data bytes; `None` if there is only an identifier.
    pub data: Option<Vec<u8>>,
}

impl Printed {
    /// Reads `108180FE#0175`, `0x108180FE 01 75`, `108180FE: 01 75` or an identifier alone.
    ///
    /// It is `None` for any other text, also if the identifier and the data are not apart.
    pub fn read(text: &str) -> Option<Self> {
        let text = text.trim();
        let (id, rest) = text.split_at(text.find(['#', ':', ' ']).unwrap_or(text.len()));
        let digits = id.strip_prefix("0x").or_else(|| id.strip_prefix("0X")).unwrap_or(id);
        let is_identifier = matches!(digits.len(), 3 | 8) && digits.bytes().all(|digit| digit.is_ascii_hexdigit());
        let id = u32::from_str_radix(digits, 16).ok().filter(|_| is_identifier)?;
        let data = if rest.is_empty() { None } else { Some(data(rest)?) };
        Some(Self { id, extended: digits.len() == 8, data })
    }
}

/// Reads what follows an identifier. Only `#` may stand before no data at all.
fn data(rest: &str) -> Option<Vec<u8>> {
    let rest = rest.trim_start();
    let digits = rest.strip_prefix(['#', ':']).unwrap_or(rest);
    let bytes = digits.split(' ').map(hex::bytes).collect::<Option<Vec<_>>>()?.concat();
    let is_said = !bytes.is_empty() || rest == "#";
    (is_said && bytes.len() <= 8).then_some(bytes)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn read(text: &str) -> Option<(u32, bool, Option<Vec<u8>>)> {
        Printed::read(text).map(|Printed { id, extended, data }| (id, extended, data))
    }

    #[test]
    fn an_identifier_and_bytes_are_read_in_every_form_that_documents_print() {
        let frame = Some((0x1081_407F, true, Some(vec![0x01, 0x75, 0x00])));
        for text in [
            "1081407F#017500",
            "0x1081407F 01 75 00",
            "0X1081407f  01 7500",
            "1081407F: 01 75 00",
            "1081407F:017500",
            "1081407F#01 75 00",
        ] {
            assert_eq!(read(text), frame, "{text}");
        }
        assert_eq!(read("0x123 # 01"), Some((0x123, false, Some(vec![1]))));
    }

    #[test]
    fn an_identifier_may_stand_alone_or_before_no_data() {
        assert_eq!(read("123"), Some((0x123, false, None)));
        assert_eq!(read("0x0003F002"), Some((0x0003_F002, true, None)));
        assert_eq!(read("123#"), Some((0x123, false, Some(Vec::new()))));
    }

    #[test]
    fn what_could_be_read_in_two_ways_is_no_frame() {
        let texts = [
            "",
            "12",
            "0011#00",
            "1081407F017500",
            "10 81 40 7F 01 75",
            "123 1 2 3",
            "123#0",
            "123:",
            "123##0",
            "123#:00",
            "+23 00",
            "123 0x01",
            "123#000000000000000000",
        ];
        for text in texts {
            assert_eq!(read(text), None, "{text}");
        }
    }
}
