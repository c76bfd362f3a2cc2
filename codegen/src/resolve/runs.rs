//! Reads the places of texts that no eight bytes can hold, and how long the open ones may be.

use super::Resolver;
use super::leaves::Leaves;
use super::types::Merged;
use super::window::{MOST_BYTES, Windowed};
use crate::model::keywords::{NUMBER_FORMATS, NumberFormat};
use crate::model::{ByteRun, Signal};
use crate::read::syntax::ast::Key;
use crate::report::tree::Path;
use crate::resolve::rules;

/// Most bytes of a place.
const MOST_OF_PLACE: u16 = 8;

/// The ends of a place; the second one is missing if it is open.
type Ends<'a> = (&'a str, Option<&'a str>);

/// Returns the ends of a text's `bytes` if no place can hold it.
fn ends(merged: &Merged) -> Option<Ends<'_>> {
    let word = merged.field.format_of_number.as_deref()?;
    let format = NUMBER_FORMATS.iter().find(|(known, _)| *known == word)?.1;
    let (first, last) = merged.field.bytes.as_deref()?.split_once("..")?;
    let last = Some(last.trim()).filter(|last| !last.is_empty());
    let number = |end: &str| end.trim().parse::<u16>().ok();
    let is_long = last.is_none_or(|last| {
        number(first).zip(number(last)).is_some_and(|(first, last)| first.abs_diff(last) >= MOST_OF_PLACE)
    });
    (is_long && matches!(format, NumberFormat::Text | NumberFormat::Bytes)).then_some((first.trim(), last))
}

/// Tests for a text that no eight bytes can hold.
pub fn is_run(merged: &Merged) -> bool {
    ends(merged).is_some()
}

impl Resolver<'_> {
    /// Reads the place of a text that no eight bytes can hold.
    pub fn run(&mut self, merged: &Merged, is_long: bool) -> Option<(Windowed, ByteRun)> {
        let (first, last) = ends(merged)?;
        let path = merged.path(self.diagnostics, Key::Bytes);
        if !is_long {
            let text = match last {
                Some(_) => "a frame has 8 bytes, and the field has more".to_owned(),
                None => format!("the text from byte {first} on has no end"),
            };
            let help = if path.to_string().ends_with("parts.data") {
                "write its last byte, up to 7"
            } else {
                "write its last byte, up to 7; or let several frames carry the message, by `parts` or `via`"
            };
            self.error_with_help(&rules::PLACE, path.at_value(), text, help);
            return None;
        }
        let start = self.integer(&path, first, 0, MOST_BYTES - 1)?;
        let Some(last) = last else {
            return Some(run(start, 0, MOST_BYTES - start));
        };
        let last = self.integer(&path, last, 0, MOST_BYTES - 1)?;
        if last < start {
            let text = "a text of more than eight bytes runs from its first byte to its last".to_owned();
            self.error_with_help(&rules::PLACE, path.at_value(), text, format!("write `{last}..{start}`"));
            return None;
        }
        let count = last - start + 1;
        Some(run(start, count, count))
    }

    /// Sets how long the open text of a message can be. `range` are the lengths of the message.
    pub fn bound(&mut self, path: &Path, range: Option<&String>, contents: &mut Leaves) {
        let place = contents.signals.iter().position(|signal| signal.run.is_some_and(ByteRun::varies));
        let Some(place) = place else { return self.check_no_range(path, range, contents) };
        let signal = &mut contents.signals[place];
        let is_bound = match range {
            Some(text) => self.range_of_lengths(path, text).and_then(|range| self.bound_text(path, range, signal)),
            None => self.no_range(signal),
        };
        if is_bound.is_none() {
            contents.given_up.push(contents.signals.remove(place).name);
        }
    }

    /// Reads the least and the greatest number of data bytes.
    fn range_of_lengths(&mut self, path: &Path, text: &str) -> Option<(u16, u16)> {
        let (least, most) = text.split_once("..")?;
        let most = self.integer(path, most.trim(), 1, MOST_BYTES)?;
        Some((self.integer(path, least.trim(), 0, most - 1)?, most))
    }

    fn no_range(&mut self, signal: &Signal) -> Option<()> {
        let text = format!("nothing says how many bytes `{}` has at most", signal.name);
        let help = "write the least and the greatest length of the message, as in `length: 0..400`";
        let at = self.diagnostics.written(&signal.doc.path, &["bytes"]);
        self.error_with_help(&rules::PLACE, at, text, help);
        None
    }

    /// Refuses a range of lengths of a message in which nothing is open.
    fn check_no_range(&mut self, path: &Path, range: Option<&String>, contents: &Leaves) {
        if range.is_some() && contents.given_up.is_empty() {
            let text = "a range of lengths needs a last field that ends open".to_owned();
            let help = "write the place of the text as `bytes: 12..`; or list the lengths, as in `[41, 49]`";
            self.error_with_help(&rules::NUMBER, path.at_value(), text, help);
        }
    }

    fn bound_text(&mut self, path: &Path, (least, most): (u16, u16), signal: &mut Signal) -> Option<()> {
        let start = signal.window;
        let (Some(least), Some(most)) = (least.checked_sub(start), most.checked_sub(start)) else {
            let text = format!("`{}` begins at byte {start}, so the message is never shorter", signal.name);
            let help = format!("write `{start}..{most}`, with the greatest length that the document allows");
            self.error_with_help(&rules::NUMBER, path.at_value(), text, help);
            return None;
        };
        signal.run = Some(ByteRun { least, most });
        Some(())
    }
}

fn run(start: u16, least: u16, most: u16) -> (Windowed, ByteRun) {
    ((start, canspec_runtime::Place::byte(0)), ByteRun { least, most })
}
