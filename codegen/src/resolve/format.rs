//! Resolves the form of a packed value: the pieces of its text, and the bytes that they fill.

use canspec_runtime::Place;

use super::{Resolver, rules};
use crate::model::{PartId, Piece, Signal, Table, TextForm};
use crate::report::diagnostic::Diagnostic;
use crate::report::tree::Path;

impl Resolver<'_> {
    /// Reads the form of a packed value, and returns its pieces and the run of bytes that its parts fill.
    pub fn format(&mut self, path: &Path, format: &str, parts: &Table<PartId, Signal>) -> Option<(Vec<Piece>, Place)> {
        let pieces = self.pieces(path, format, parts)?;
        self.check_pieces(path, &pieces, parts);
        self.check_no_bytes(parts)?;
        self.check_ends(path, &pieces, parts);
        Some((pieces, self.packed_place(path, parts)?))
    }

    /// Reads `{number:12}{letter}`.
    fn pieces(&mut self, path: &Path, format: &str, parts: &Table<PartId, Signal>) -> Option<Vec<Piece>> {
        let mut pieces = Vec::new();
        let mut rest = format;
        while let Some((literal, after)) = rest.split_once('{') {
            let Some((inside, after)) = after.split_once('}') else {
                let message = format!("the `{{` before `{after}` is not closed");
                self.error_with_help(
                    &rules::FORMAT,
                    path.at_value(),
                    message,
                    "write parts as `{name}` or `{name:digits}`",
                );
                return None;
            };
            if !literal.is_empty() {
                pieces.push(Piece::Literal(literal.to_owned()));
            }
            let (part, digits) = inside.split_once(':').map_or((inside, None), |(part, digits)| (part, Some(digits)));
            let part = self.lookup_in(path, "part", part, parts, |part| &part.name)?;
            let digits = match digits {
                Some(digits) => Some(usize::from(self.integer(path, digits, 1_u8, 20)?)),
                None => None,
            };
            pieces.push(Piece::Part { part, digits });
            rest = after;
        }
        if !rest.is_empty() {
            pieces.push(Piece::Literal(rest.to_owned()));
        }
        Some(pieces)
    }

    /// Tests that a text shows every part once.
    fn check_pieces(&mut self, path: &Path, pieces: &[Piece], parts: &Table<PartId, Signal>) {
        for (id, part) in parts.entries() {
            let shows = |piece: &&Piece| matches!(piece, Piece::Part { part, .. } if *part == id);
            let times = pieces.iter().filter(shows).count();
            if times != 1 {
                let message = match times {
                    0 => format!("the format does not show the part `{}`", part.name),
                    _ => format!("the format shows the part `{}` {times} times", part.name),
                };
                let help = "show every part once, or the text cannot be read back";
                self.error_with_help(&rules::FORMAT, path.at_value(), message, help);
            }
        }
    }

    /// Tests that no part is raw bytes.
    fn check_no_bytes(&mut self, parts: &[Signal]) -> Option<()> {
        let part = parts.iter().find(|part| part.encoding.text_form() == Some(TextForm::Hexadecimal));
        part.map_or(Some(()), |part| {
            let name = &part.name;
            let text = format!("a packed value shows characters and decimal numbers, but `{name}` is raw bytes");
            let help = format!("give `{name}` another `as`, or make it a field of its own");
            self.error_with_help(&rules::TYPE, part.doc.path.at_key(), text, help);
            None
        })
    }

    /// Tests that no digit follows a number without a count of digits.
    fn check_ends(&mut self, path: &Path, pieces: &[Piece], parts: &Table<PartId, Signal>) {
        let number = |piece: &Piece| match piece {
            Piece::Part { part, digits } if parts[*part].encoding.text_form().is_none() => Some((*part, *digits)),
            Piece::Part { .. } | Piece::Literal(_) => None,
        };
        for pair in pieces.windows(2) {
            let Some((part, None)) = number(&pair[0]) else { continue };
            let name = &parts[part].name;
            let after = match (&pair[1], number(&pair[1])) {
                (_, Some((other, _))) => format!("the number `{}`", parts[other].name),
                (Piece::Literal(text), _) if text.starts_with(|letter: char| letter.is_ascii_digit()) => {
                    format!("the text `{text}`")
                }
                _ => continue,
            };
            let text = format!("nothing shows where the number `{name}` ends and {after} begins");
            let help = format!(
                "write its number of digits, as in `{{{name}:3}}`, or put a text without digits between the two"
            );
            self.error_with_help(&rules::FORMAT, path.at_value(), text, help);
        }
    }

    /// Returns the run of bytes that the parts fill.
    fn packed_place(&mut self, path: &Path, parts: &[Signal]) -> Option<Place> {
        let mask = parts.iter().fold(0, |mask, part| mask | u64::from_be_bytes(part.place.mask()));
        let (before, after) = (mask.leading_zeros(), mask.trailing_zeros());
        let filled = mask != 0 && mask.count_ones() + before + after == 64 && before % 8 == 0 && after % 8 == 0;
        if !filled {
            let help = "let the parts follow each other, from the first to the last bit of a run of bytes";
            self.diagnostics.push(unfilled(path, parts).help(help));
            return None;
        }
        let byte = |bits: u32| u8::try_from(bits / 8).unwrap_or(0);
        Some(Place::bytes(byte(before), 7 - byte(after)))
    }
}

/// Says that parts do not fill whole bytes, because of a gap between two parts or because of their
/// ends.
fn unfilled(path: &Path, parts: &[Signal]) -> Diagnostic {
    let mask = |part: &Signal| u64::from_be_bytes(part.place.mask());
    let mut parts: Vec<_> = parts.iter().collect();
    parts.sort_by_key(|part| mask(part).leading_zeros());
    let has_gap = |pair: &&[&Signal]| mask(pair[0]).trailing_zeros() + mask(pair[1]).leading_zeros() > 64;
    match parts.windows(2).find(has_gap) {
        Some(pair) => {
            let text = format!("bits between the parts `{}` and `{}` are in neither", pair[0].name, pair[1].name);
            let places = pair.iter().map(|part| part.doc.path.at_key());
            let diagnostic = Diagnostic::error(&rules::FORMAT, path.at_value(), text);
            places.fold(diagnostic, |known, at| known.other(at, "beside the gap"))
        }
        None => Diagnostic::error(&rules::FORMAT, path.at_value(), "the parts do not begin and end with whole bytes"),
    }
}
