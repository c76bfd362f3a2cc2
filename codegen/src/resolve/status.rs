//! Makes status words: which bit has which name.

use std::mem;

use canspec_runtime::Place;
use indexmap::IndexMap;

use super::Resolver;
use super::texts::{remarks, text};
use super::types::Merged;
use crate::model::keywords::SEVERITIES;
use crate::model::{Doc, StatusBit, StatusWord, StatusWordId};
use crate::read::syntax::ast::{self, Key};
use crate::report::claims::{Claim, misplaced};
use crate::report::diagnostic::{At, Diagnostic};
use crate::report::tree::Path;
use crate::resolve::rules;
use crate::words::number::Rational;
use crate::words::text::Text;

/// Bits of the widest word.
const WIDEST: u8 = 64;

/// What names a bit, or several in a row.
struct Entry {
    path: Path,
    first: u8,
    count: usize,
}

/// A bit that is named by its byte in the frame.
pub struct BitByByte {
    name: String,
    byte: u8,
    /// Each word that has it, and its number there.
    words: Vec<(At, Option<u8>)>,
}

impl Resolver<'_> {
    /// Finds or makes the status word of a field. Its bits may lie anywhere, until the widest place of the word is known.
    pub fn status_word(&mut self, merged: &Merged, otherwise: &str, place: Place, doc: &Doc) -> StatusWordId {
        self.keep_bits_by_byte(merged, place);
        let (name, source) = self.type_name(merged, Key::Status, otherwise);
        if let Some(&index) = self.tables.status_words_made.get(&(name.clone(), source.clone())) {
            if place.width() > self.tables.status_words[index].width {
                self.tables.status_words[index].width = place.width();
                self.tables.widest_words[index] = self.place_of_word(merged);
            }
            return index;
        }
        let doc = self.type_doc(&name, &source, doc);
        let mut bits = self.status_bits(merged, place, &doc);
        self.check_status_bits(&bits);
        bits.sort_by_key(|bit| bit.bit);
        let at = self.place_of_word(merged);
        self.tables.widest_words.push(at);
        let origin = (name.clone(), doc.path.clone());
        let made = self.tables.status_words.push(StatusWord { name, doc, width: place.width(), bits });
        self.tables.status_words_made.insert(origin, made);
        made
    }

    /// Returns where the spec says how wide a word is.
    fn place_of_word(&mut self, merged: &Merged) -> At {
        let key = if merged.field.bytes.is_some() { Key::Bytes } else { Key::Bits };
        merged.path(self.diagnostics, key).at_value()
    }

    /// Tests that the bits of each status word lie in its widest place, and takes out the others.
    pub fn check_width_of_words(&mut self) {
        for id in self.tables.status_words.ids() {
            let StatusWord { width, bits, .. } = &self.tables.status_words[id];
            let (width, entries) = (*width, entries(bits));
            let beyond = |width: u8| entries.iter().filter(move |entry| (width..WIDEST).contains(&entry.first));
            let is_place_wrong = beyond(width).count() > 1;
            if is_place_wrong {
                self.refuse_place(width, &beyond(width).collect::<Vec<_>>(), id);
            }
            let width = if is_place_wrong { WIDEST } else { width };
            for entry in &entries {
                self.check_entry(entry, width);
            }
            self.tables.status_words[id].bits.retain(|bit| bit.bit < width);
        }
    }

    /// Refuses the place of a word. If several of its bits lie beyond the end, the place is probably wrong.
    fn refuse_place(&mut self, width: u8, beyond: &[&Entry], id: StatusWordId) {
        let text = format!("this word has {width} bits, and {} of its status bits lie beyond", beyond.len());
        let help = "correct the place of the word, or the numbers of the bits";
        let diagnostic = Diagnostic::error(&rules::NUMBER, self.tables.widest_words[id].clone(), text).help(help);
        let first = beyond.iter().map(|entry| entry.path.key("bit").at_value()).next();
        self.diagnostics.push(match first {
            Some(first) => diagnostic.other(first, "the first of them"),
            None => diagnostic,
        });
    }

    /// Tests that a bit, or a row of bits, lies in a word.
    fn check_entry(&mut self, Entry { path, first, count }: &Entry, width: u8) {
        if *first >= width {
            let help = format!("its bits are 0 to {}; correct the bit, or the place of the word", width - 1);
            let text = format!("there is no bit {first} in this word of {width} bits");
            self.error_with_help(&rules::NUMBER, path.key("bit").at_value(), text, help);
        } else if *count > usize::from(width - first) {
            let text = format!("{count} bits from bit {first} on are more than this word of {width} has");
            let help = format!("at most {} bits are left; correct the count, or the place", width - first);
            self.error_with_help(&rules::NUMBER, path.key("repeat").at_value(), text, help);
        }
    }

    /// Remembers which bits of a word are named by their byte.
    fn keep_bits_by_byte(&mut self, merged: &Merged, place: Place) {
        let path = merged.path(self.diagnostics, Key::Status);
        for (name, bit) in merged.field.status.iter().flatten() {
            let Some((byte, bit)) = byte_and_bit(bit) else { continue };
            let word = (self.place_of_word(merged), in_byte(byte, bit, place));
            let known = self.tables.bits_by_byte.entry(path.key(name));
            known.or_insert_with(|| BitByByte { name: name.clone(), byte, words: Vec::new() }).words.push(word);
        }
    }

    /// Tests that each bit which is named by its byte is one bit of its word, the same wherever its type stands.
    pub fn check_bits_by_byte(&mut self) {
        for (path, BitByByte { name, byte, words }) in mem::take(&mut self.tables.bits_by_byte) {
            let Some((first, number)) = words.first() else { continue };
            let at = path.key("byte").at_value();
            let problem = match words.iter().find(|(_, other)| other != number) {
                Some((other, _)) => {
                    let text = format!("`{name}` is not the same bit in each word of its type");
                    let help = "a `byte` counts in the frame; write `bit` alone, which counts in the word";
                    let problem = Diagnostic::error(&rules::STATUS_BIT, at, text).help(help);
                    problem.other(first.clone(), "a word").other(other.clone(), "another one")
                }
                None if number.is_none() => {
                    let help = "a `byte` counts in the frame, from 0; correct it, or the place of the word";
                    Diagnostic::error(&rules::NUMBER, at, format!("byte {byte} is not in this word")).help(help)
                }
                None => continue,
            };
            self.diagnostics.push(problem);
        }
    }

    fn status_bits(&mut self, merged: &Merged, word: Place, outer: &Doc) -> Vec<StatusBit> {
        let path = merged.path(self.diagnostics, Key::Status);
        let entries = merged.field.status.iter().flatten();
        entries.flat_map(|(name, bit)| self.status_entry(&path.key(name), name, bit, word, outer)).collect()
    }

    /// Reads one entry, which names a bit or several bits in a row.
    fn status_entry(
        &mut self,
        path: &Path,
        name: &str,
        entry: &ast::StatusBit,
        word: Place,
        outer: &Doc,
    ) -> Vec<StatusBit> {
        let Some(first) = self.status_bit(path, name, entry, word, outer) else { return Vec::new() };
        let Some(text) = &entry.repeat else {
            if entry.first.is_some() {
                let text = "`first` means nothing without `repeat`".to_owned();
                self.error_with_help(&rules::MISPLACED_KEY, path.key("first").at_key(), text, "take it out");
            }
            return vec![first];
        };
        let Some(count) = self.integer(&path.key("repeat"), text, 2, WIDEST) else { return Vec::new() };
        let start = entry.first.as_ref().map_or(Some(1), |text| self.integer(&path.key("first"), text, 0, u16::MAX));
        let Some(start) = start else { return Vec::new() };
        let bits = (0..count).filter_map(|index| numbered(&first, index, start + u16::from(index)));
        bits.collect()
    }

    fn status_bit(
        &mut self,
        path: &Path,
        name: &str,
        bit: &ast::StatusBit,
        word: Place,
        outer: &Doc,
    ) -> Option<StatusBit> {
        self.check_name(path, name);
        self.check_not_empty(path, &["models"]);
        let severity = bit.severity.as_ref().and_then(|text| {
            self.lookup(&path.key("severity"), "severity", text, SEVERITIES.iter().map(|(name, _)| *name))
        });
        Some(StatusBit {
            name: name.to_owned(),
            doc: remarks!(bit).doc(path, Some(outer)),
            bit: self.number_of_bit(path, bit, word)?,
            is_by_byte: bit.byte.is_some(),
            severity: severity.map(|index| SEVERITIES[index].1),
            set_when: text(bit.set_when.as_ref()),
            clear_when: text(bit.clear_when.as_ref()),
            effect: text(bit.effect.as_ref()),
            led: text(bit.led.as_ref()),
            models: self.models_named(&path.key("models"), &bit.models),
        })
    }

    /// Reads the number of a bit in its word. With a `byte` it is written as the number in that byte.
    fn number_of_bit(&mut self, path: &Path, bit: &ast::StatusBit, word: Place) -> Option<u8> {
        let at = path.key("bit");
        let Some(byte) = &bit.byte else { return self.integer(&at, &bit.bit, 0, u8::MAX) };
        self.integer(&path.key("byte"), byte, 0, 7_u8)?;
        self.integer(&at, &bit.bit, 0, 7)?;
        byte_and_bit(bit).and_then(|(byte, bit)| in_byte(byte, bit, word))
    }

    fn check_status_bits(&mut self, bits: &[StatusBit]) {
        let claims: Vec<_> = bits.iter().map(|bit| Claim { first: bit.bit, last: bit.bit }).collect();
        for (later, bit) in bits.iter().enumerate() {
            let find = |is_alike: &dyn Fn(&StatusBit) -> bool| bits[..later].iter().position(is_alike);
            if let Some(earlier) = find(&|known| known.bit == bit.bit) {
                let wrong = misplaced(&claims, earlier, later);
                let right = if wrong == later { earlier } else { later };
                let message = format!("bit {} has two names: `{}` and `{}`", bit.bit, bits[earlier].name, bit.name);
                let at = |index: usize| bits[index].doc.path.key("bit").at_value();
                let diagnostic = Diagnostic::error(&rules::STATUS_BIT, at(wrong), message);
                self.diagnostics.push(diagnostic.other(at(right), "the other name"));
            } else if let Some(earlier) = find(&|known| known.name == bit.name) {
                let message = format!("two bits are called `{}`", bit.name);
                let diagnostic = Diagnostic::error(&rules::STATUS_BIT, bit.doc.path.at_key(), message);
                let diagnostic = diagnostic.help("rename one of the two entries");
                self.diagnostics.push(diagnostic.other(bits[earlier].doc.path.at_key(), "the other one"));
            }
        }
    }
}

/// Reads the byte of a bit, and its number there.
fn byte_and_bit(bit: &ast::StatusBit) -> Option<(u8, u8)> {
    let number = |text: &str| Rational::parse(text)?.to_integer().and_then(|number| u8::try_from(number).ok());
    let (byte, bit) = (number(bit.byte.as_ref()?)?, number(&bit.bit)?);
    (byte < 8 && bit < 8).then_some((byte, bit))
}

/// Returns the number in its word of a bit that is named by its byte in the frame.
fn in_byte(byte: u8, bit: u8, place: Place) -> Option<u8> {
    let mut data = [0; 8];
    *data.get_mut(usize::from(byte))? = 1_u8.checked_shl(bit.into())?;
    u8::try_from(place.get(&data).trailing_zeros()).ok().filter(|number| *number < WIDEST)
}

/// Returns the bit of a row that comes `index` bits after the first, with its number in name and title. There are no
/// more than 256.
fn numbered(first: &StatusBit, index: u8, number: u16) -> Option<StatusBit> {
    let title = first.doc.title.as_ref().map(|title| Text::new(&format!("{} {number}", title.for_people())));
    Some(StatusBit {
        name: format!("{}_{number}", first.name),
        doc: Doc { title, ..first.doc.clone() },
        bit: first.bit.checked_add(index)?,
        ..first.clone()
    })
}

/// Returns the entries that name bits, in the order of the spec.
fn entries(bits: &[StatusBit]) -> Vec<Entry> {
    let mut entries: IndexMap<&Path, Entry> = IndexMap::new();
    for bit in bits {
        let path = &bit.doc.path;
        let entry = entries.entry(path).or_insert_with(|| Entry { path: path.clone(), first: bit.bit, count: 0 });
        entry.count += 1;
    }
    entries.into_values().collect()
}
