//! `defmt` for words, texts, elements, frames, times and sets of modules, behind the feature `defmt`. Generated code
//! calls it.

use defmt::{Display2Format, Format, Formatter, write};

use crate::client::Nodes;
use crate::plumbing::{Integer, Raw, Word};
use crate::{Bcd, Bytes, Elements, Frame, Meaning, StatusBit, Text, Timing, status, text};

/// Writes a named value by its name, a status word by the names of its set bits, and a packed value
/// by its text.
///
/// Values without a name are written as hexadecimal numbers.
pub fn format<W: Word>(word: W, formatter: Formatter<'_>) {
    match word.meaning() {
        Meaning::Name(name) => write!(formatter, "{=str}", name),
        Meaning::Packed(text) => write!(formatter, "{}", Display2Format(&text)),
        Meaning::Status(raw, bits) => set_bits(raw, bits, formatter),
        Meaning::Number(_) | Meaning::Text(_) | Meaning::Bytes(_) | Meaning::None => {
            write!(formatter, "{=u64:#X}", word.to_bits());
        }
    }
}

/// Writes `dc_off | hot | 0x80`.
fn set_bits(raw: u64, bits: &'static [StatusBit], formatter: Formatter<'_>) {
    let unknown = status::unknown(raw, bits);
    for (index, bit) in status::set_bits(raw, bits).enumerate() {
        write!(formatter, "{=str}{=str}", if index == 0 { "" } else { " | " }, bit.name);
    }
    match (raw, unknown) {
        (0, _) => write!(formatter, "none"),
        (_, 0) => {}
        (raw, unknown) if raw == unknown => write!(formatter, "{=u64:#X}", unknown),
        _ => write!(formatter, " | {=u64:#X}", unknown),
    }
}

impl<const N: usize, const FILL: u8> Format for Text<N, FILL> {
    fn format(&self, formatter: Formatter<'_>) {
        match self.as_str() {
            Some(text) if !text::needs_escapes(text) => write!(formatter, "{=str}", text),
            Some(_) => write!(formatter, "{}", Display2Format(self)),
            None => write!(formatter, "{=[u8]:#04X}", self.as_bytes().as_slice()),
        }
    }
}

impl<const N: usize> Format for Bytes<N> {
    fn format(&self, formatter: Formatter<'_>) {
        for byte in self.as_bytes() {
            write!(formatter, "{=u8:02X}", *byte);
        }
    }
}

impl<R: Integer> Format for Bcd<R> {
    fn format(&self, formatter: Formatter<'_>) {
        if let Some(number) = self.number() {
            write!(formatter, "{=u64}", number);
        } else {
            write!(formatter, "{=u64:#X}", self.to_bits());
        }
    }
}

impl<T: Format, const N: usize> Format for Elements<T, N> {
    fn format(&self, formatter: Formatter<'_>) {
        (**self).format(formatter);
    }
}

impl Format for Nodes {
    fn format(&self, formatter: Formatter<'_>) {
        for (index, node) in self.iter().enumerate() {
            write!(formatter, "{=str}{=u8}", if index == 0 { "" } else { ", " }, node);
        }
    }
}

impl Format for Timing {
    fn format(&self, formatter: Formatter<'_>) {
        let Self { request_gap, reply_timeout, tries, watchdog, boot, settling, of_messages } = self;
        write!(formatter, "request_gap: {}, reply_timeout: {}, tries: {}", request_gap, reply_timeout, tries);
        write!(formatter, ", watchdog: {}, boot: {}, settling: {}", watchdog, boot, settling);
        for (message, own) in *of_messages {
            write!(formatter, ", {=str}: ({})", message, own);
        }
    }
}

impl Format for Frame {
    fn format(&self, formatter: Formatter<'_>) {
        write!(formatter, "{}", Display2Format(self));
    }
}
