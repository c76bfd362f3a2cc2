//! Chooses the encoding of a field: what its keys say that its bits mean.

use canspec_runtime::Place;

use super::Resolver;
use super::types::Merged;
use crate::model::keywords::{NUMBER_FORMATS, NumberFormat};
use crate::model::{Doc, Encoding, Numeral, TextForm};
use crate::read::syntax::ast::Key;
use crate::report::tree::Path;
use crate::resolve::rules;
use crate::words::number::Rational;

impl Resolver<'_> {
    /// Returns the encoding. Types without a name of their own are called after `owner` and the field.
    pub fn encoding(&mut self, name: &str, merged: &Merged, place: Place, doc: &Doc, owner: &str) -> Option<Encoding> {
        let field = &merged.field;
        let otherwise = if owner.is_empty() { name.to_owned() } else { format!("{owner}_{name}") };
        if field.status.is_some() {
            return Some(Encoding::Status(self.status_word(merged, &otherwise, place, doc)));
        }
        let numeral = match self.number_format(merged)? {
            NumberFormat::Integer(Numeral::Bcd) => self.decimal(name, merged, place)?,
            NumberFormat::Integer(numeral @ (Numeral::Unsigned | Numeral::Signed)) => numeral,
            NumberFormat::Float => return self.float(name, merged, place),
            NumberFormat::Text => return self.text(name, merged, place),
            NumberFormat::Bytes => return self.hexadecimal(name, merged, place),
        };
        let number = field.scale.is_some() || field.offset.is_some() || field.unit.is_some() || field.range.is_some();
        let number = number || self.is_scaled_by_models(merged);
        if !field.values.is_empty() && !number {
            return self.enumeration(merged, &otherwise, place.width(), doc).map(Encoding::Named);
        }
        let mut read = |key: Key, text: &Option<String>, otherwise: Rational| match text {
            Some(text) => self.number(&merged.path(self.diagnostics, key), text),
            None => Some(otherwise),
        };
        let scale = read(Key::Scale, &field.scale, Rational::ONE)?;
        let offset = read(Key::Offset, &field.offset, Rational::ZERO)?;
        Some(Encoding::Number { numeral, scale, offset })
    }

    /// Reads `as`.
    fn number_format(&mut self, merged: &Merged) -> Option<NumberFormat> {
        let Some(word) = &merged.field.format_of_number else { return Some(NumberFormat::Integer(Numeral::Unsigned)) };
        let at = merged.path(self.diagnostics, Key::As);
        let index = self.lookup(&at, "number format", word, NUMBER_FORMATS.iter().map(|(word, _)| *word))?;
        Some(NUMBER_FORMATS[index].1)
    }

    fn decimal(&mut self, name: &str, merged: &Merged, place: Place) -> Option<Numeral> {
        if !place.width().is_multiple_of(4) {
            let text = format!("a decimal digit has four bits, the place of `{name}` has {}", place.width());
            let help = "give the field a multiple of four bits, or take `as: bcd` out";
            self.error_with_help(&rules::TYPE, merged.sources[0].key("as").at_value(), text, help);
            return None;
        }
        Some(Numeral::Bcd)
    }

    fn float(&mut self, name: &str, merged: &Merged, place: Place) -> Option<Encoding> {
        if place.width() != 32 {
            let at = merged.sources[0].key("as").at_value();
            let text = format!("a float has 32 bits, the place of `{name}` has {}", place.width());
            self.error_with_help(&rules::TYPE, at, text, "give the field four bytes, or take `as: float` out");
            return None;
        }
        let linear = [(Key::Scale, &merged.field.scale), (Key::Offset, &merged.field.offset)];
        let Some((key, _)) = linear.into_iter().find(|(_, written)| written.is_some()) else {
            return Some(Encoding::Float);
        };
        // A type says it once for all of its fields.
        let at = merged.path(self.diagnostics, key).at_key();
        let message = "a float is neither scaled nor offset".to_owned();
        self.error_with_help(&rules::TYPE, at, message, "take `scale` and `offset` out, or `as: float`");
        None
    }

    fn text(&mut self, name: &str, merged: &Merged, place: Place) -> Option<Encoding> {
        self.whole_bytes(name, merged, place, "a text has")?;
        let fill = match &merged.field.fill {
            Some(text) => {
                let path = merged.path(self.diagnostics, Key::Fill);
                self.filling(&path, text)?
            }
            None => 0,
        };
        Some(Encoding::Text(TextForm::Ascii { fill }))
    }

    /// Reads the byte that fills up a text. A character is refused, since the character `0` is not the byte 0.
    fn filling(&mut self, path: &Path, text: &str) -> Option<u8> {
        let &[byte] = text.as_bytes() else { return self.integer(path, text, 0, u8::MAX) };
        if byte.is_ascii_digit() {
            return self.integer(path, text, 0, u8::MAX);
        }
        let (message, help) = (format!("`{text}` is not a number"), format!("write `{byte:#04X}` for this character"));
        self.error_with_help(&rules::NUMBER, path.at_value(), message, help);
        None
    }

    fn hexadecimal(&mut self, name: &str, merged: &Merged, place: Place) -> Option<Encoding> {
        self.whole_bytes(name, merged, place, "raw bytes are")?;
        Some(Encoding::Text(TextForm::Hexadecimal))
    }

    /// Tests that a text has a place of whole bytes.
    fn whole_bytes(&mut self, name: &str, merged: &Merged, place: Place, subject: &str) -> Option<()> {
        if !place.width().is_multiple_of(8) {
            let message = format!("{subject} whole bytes, the place of `{name}` has {} bits", place.width());
            let format = merged.field.format_of_number.as_deref().unwrap_or_default();
            let help = format!("give the field whole bytes, or take `as: {format}` out");
            self.error_with_help(&rules::TYPE, merged.sources[0].key("as").at_value(), message, help);
            return None;
        }
        Some(())
    }
}
