//! Makes signals of the elements of arrays: equal fields in a row.

use std::collections::HashMap;

use canspec_runtime::Place;
use canspec_runtime::plumbing::ByteOrder;

use super::Resolver;
use super::leaves::Leaves;
use super::types::Merged;
use super::window::{MOST_BYTES, Windowed};
use crate::model::{Array, ArrayId, Doc, Element, Signal, SignalId, Table};
use crate::read::syntax::ast::Key;
use crate::report::diagnostic::Diagnostic;
use crate::report::tree::Path;
use crate::resolve::rules;
use crate::words::number::Rational;
use crate::words::text::Text;

/// Most elements of an array in a frame. A status word has room for more bits.
const MOST_ELEMENTS: u16 = 32;

/// Most elements of an array in a long message.
const MOST_LONG_ELEMENTS: u16 = 256;

/// How many equal fields stand in a row, and where.
#[derive(Clone, Copy)]
pub struct Row {
    count: u16,
    /// The least number of elements, if some may be missing.
    least: Option<u16>,
    /// Number of the first element.
    first: u16,
    /// Bits from an element to the next one, in the eight bytes read in this order.
    distance: i16,
    order: ByteOrder,
    /// Bytes from an element's window to that of the next one, in a long message.
    stride: i16,
}

/// What the steps of a row are counted in.
struct Unit {
    name: &'static str,
    /// How many of them an element takes.
    size: i16,
    /// Bits from one to the next.
    bits: i16,
}

impl Row {
    /// A field that stands alone.
    pub const ALONE: Self = Self { count: 1, least: None, first: 1, distance: 0, order: ByteOrder::Big, stride: 0 };

    /// Tests whether there are several elements.
    pub fn is_array(self) -> bool {
        self.count > 1
    }

    /// Returns the place of an element, if the data bytes have it. `place` is that of the first.
    fn place(self, (window, place): Windowed, index: u16) -> Option<Windowed> {
        let index = i16::try_from(index).ok()?;
        if self.stride != 0 {
            let moved = i32::from(window) + i32::from(self.stride) * i32::from(index);
            let moved = u16::try_from(moved).ok().filter(|moved| *moved < MOST_BYTES)?;
            return Some((moved, place));
        }
        let distance = if place.order() == self.order { self.distance } else { -self.distance };
        let low = i16::from(place.bits_of_payload().shift()).checked_add(distance.checked_mul(index)?)?;
        let low = u8::try_from(low).ok().filter(|low| *low <= 64 - place.width())?;
        let payload = if place.order() == ByteOrder::Big { Place::bytes(0, 7) } else { Place::bytes(7, 0) };
        Some((window, payload.bits(low + place.width() - 1, low)))
    }

    /// Returns the word in which the spec counts the bits of an element. Elements in one word share it; else each has
    /// its own. `word` is that of the first one.
    fn word(self, word: Windowed, element: Windowed, index: u16) -> Place {
        let bits = |place: Place| u64::from_be_bytes(place.mask());
        let is_shared = word.0 == element.0 && bits(element.1) & !bits(word.1) == 0;
        let own = self.place(word, index).filter(|_| !is_shared);
        own.map_or(word.1, |(_, word)| word)
    }

    /// Tests whether an element lies inside the word that counts its bits.
    fn is_inside(self, place: Windowed, index: u16, word: Option<Windowed>) -> bool {
        let bits = |(_, place): Windowed| u64::from_be_bytes(place.mask());
        self.place(place, index).is_some_and(|moved| word.is_none_or(|word| bits(moved) & !bits(word) == 0))
    }
}

impl Unit {
    /// Returns the unit of a place: bits of a word, or else bytes.
    fn of(place: Place, word: Option<Place>) -> Self {
        let width = i16::from(place.width());
        let along = if place.order() == ByteOrder::Big { -8 } else { 8 };
        match word {
            Some(_) => Self { name: "bits", size: width, bits: 1 },
            None => Self { name: "bytes", size: width / 8, bits: along },
        }
    }
}

impl Resolver<'_> {
    /// Reads `repeat`, `step` and `first` of a field. `word` is the word around it.
    pub fn row(&mut self, merged: &Merged, placed: Windowed, word: Option<Windowed>, is_long: bool) -> Option<Row> {
        let field = &merged.field;
        let [repeat, step, first] = [Key::Repeat, Key::Step, Key::First].map(|key| merged.path(self.diagnostics, key));
        let Some(count) = &field.repeat else {
            for (path, text) in [(step, &field.step), (first, &field.first)] {
                self.check_repeated(&path, text.as_ref());
            }
            return Some(Row::ALONE);
        };
        let (least, count) = self.count(&repeat, count, is_long)?;
        let word = word.filter(|_| field.bits.is_some());
        let (_, place) = placed;
        let unit = Unit::of(place, word.map(|(_, word)| word));
        let length = match &field.step {
            Some(text) => self.step(&step, text, &unit)?,
            None => unit.size,
        };
        let first = field
            .first
            .as_ref()
            .map_or(Some(1), |text| self.integer(&first, text, 0, u16::MAX - MOST_LONG_ELEMENTS))?;
        let stride = if is_long && word.is_none() { length } else { 0 };
        let row = Row { count, least, first, distance: length * unit.bits, order: place.order(), stride };
        self.check_inside(&repeat, row, placed, word)?;
        Some(row)
    }

    /// Reads how many elements there are. In a long message it can be a range.
    fn count(&mut self, path: &Path, text: &str, is_long: bool) -> Option<(Option<u16>, u16)> {
        match text.split_once("..") {
            Some(ends) if is_long => self.counts(path, text, ends).map(|(least, most)| (Some(least), most)),
            Some(numbers) => {
                self.refuse_numbers(path, text, numbers);
                None
            }
            None => {
                let most = if is_long { MOST_LONG_ELEMENTS } else { MOST_ELEMENTS };
                Some((None, self.integer(path, text, 2, most)?))
            }
        }
    }

    /// Reads the least and the greatest number of elements.
    fn counts(&mut self, path: &Path, text: &str, (least, most): (&str, &str)) -> Option<(u16, u16)> {
        let [least, most] = [least, most].map(|end| u16::try_from(Rational::parse(end)?.to_integer()?).ok());
        let known = least.zip(most).filter(|(least, most)| (1..*most).contains(least) && *most <= MOST_LONG_ELEMENTS);
        if known.is_none() {
            let message = format!("`{text}` is no range of how many elements there are");
            let help =
                format!("write the least number, from 1, and a greater one up to {MOST_LONG_ELEMENTS}, as in `1..48`");
            self.error_with_help(&rules::NUMBER, path.at_value(), message, help);
        }
        known
    }

    /// Refuses the numbers of the elements in place of how many there are.
    fn refuse_numbers(&mut self, path: &Path, text: &str, (first, last): (&str, &str)) {
        let [first, last] = [first, last].map(|end| end.trim().parse::<u16>().ok());
        let of_numbers =
            first.zip(last).and_then(|(first, last)| Some((first, last.checked_sub(first)?.checked_add(1)?)));
        let how_many = format!("write how many elements there are, from 2 to {MOST_ELEMENTS}");
        let help = match of_numbers {
            Some((_, count)) if !(2..=MOST_ELEMENTS).contains(&count) => how_many,
            Some((1, count)) => format!("write `repeat: {count}`"),
            Some((first, count)) => format!("for elements with these numbers, write `repeat: {count}, first: {first}`"),
            None => how_many,
        };
        let message =
            format!("`{text}` is a range, and only a message longer than a frame has arrays of several lengths");
        self.error_with_help(&rules::ARRAY, path.at_value(), message, help);
    }

    /// Refuses a key that needs `repeat` beside it.
    fn check_repeated(&mut self, path: &Path, text: Option<&String>) {
        if text.is_some() {
            let text = "this key means nothing without `repeat`".to_owned();
            self.error_with_help(
                &rules::MISPLACED_KEY,
                path.at_key(),
                text,
                "take it out, or write `repeat` beside it",
            );
        }
    }

    /// Reads how far the next element is.
    fn step(&mut self, path: &Path, text: &str, unit: &Unit) -> Option<i16> {
        let step: i16 = self.integer(path, text, -64, 64)?;
        if step.abs() < unit.size {
            let text =
                format!("each element takes {} {}, so a step of {step} makes them overlap", unit.size, unit.name);
            let help = format!("write the {} from one element to the next, or take `step` out", unit.name);
            self.error_with_help(&rules::ARRAY, path.at_value(), text, help);
            return None;
        }
        Some(step)
    }

    /// Tests that the word or the frame has room for all elements.
    fn check_inside(&mut self, path: &Path, row: Row, place: Windowed, word: Option<Windowed>) -> Option<()> {
        let fitting = (0..row.count).take_while(|index| row.is_inside(place, *index, word)).count();
        if fitting == usize::from(row.count) {
            return Some(());
        }
        let around = if word.is_some() { "word" } else { "frame" };
        let text = format!("the {around} has room for {fitting} of the {} elements", row.count);
        let help = "correct the count, the place or the `step`; a negative step leads the other way";
        self.error_with_help(&rules::ARRAY, path.at_value(), text, help);
        None
    }

    /// Refuses a field that cannot be a part of an element.
    pub fn check_in_no_array(&mut self, path: &Path, what: &str, around: Row) -> Option<()> {
        if !around.is_array() {
            return Some(());
        }
        let text = format!("{what} cannot be a part of an array's elements");
        let help = "write the elements as fields of their own, without `repeat`";
        self.error_with_help(&rules::ARRAY, path.at_key(), text, help);
        None
    }

    /// Adds a signal, or the elements of an array whose first one it is.
    pub fn add_signal(&mut self, signal: Signal, row: Row, leaves: &mut Leaves) -> Option<()> {
        if !row.is_array() {
            leaves.signals.push(signal);
            return Some(());
        }
        let Signal { name, doc, window, place, word, .. } = &signal;
        let least = row.least.map(usize::from);
        let array = leaves.arrays.push(Array { name: name.clone(), doc: doc.clone(), elements: Vec::new(), least });
        for index in 0..row.count {
            let Some((moved, place)) = row.place((*window, *place), index) else {
                let text = format!("the frame has no room for element {} of `{name}`", index + 1);
                let help = "correct the count, the places or the `step`";
                self.error_with_help(&rules::ARRAY, doc.path.at_key(), text, help);
                return None;
            };
            let number = row.first + index;
            leaves.signals.push(signal.clone().changed(|element| {
                element.name = format!("{name}_{number}");
                element.doc = numbered(doc, number);
                (element.window, element.place) = (moved, place);
                element.word = row.word((*window, *word), (moved, place), index);
                element.element = Some(Element { array, index: u8::try_from(index).unwrap_or(u8::MAX) });
            }));
        }
        Some(())
    }

    /// Adds their elements to arrays, and tests that no two fields have one name.
    pub fn arrays(
        &mut self,
        mut arrays: Table<ArrayId, Array>,
        signals: &Table<SignalId, Signal>,
    ) -> Table<ArrayId, Array> {
        let mut elements: Vec<_> = signals.entries().filter_map(|(id, signal)| Some((signal.element?, id))).collect();
        elements.sort_by_key(|(element, _)| element.index);
        for (element, id) in elements {
            arrays[element.array].elements.push(id);
        }
        self.check_element_names(&arrays, signals);
        arrays
    }

    fn check_element_names(&mut self, arrays: &Table<ArrayId, Array>, signals: &Table<SignalId, Signal>) {
        let alone = signals.iter().filter(|signal| signal.element.is_none());
        let mut known: HashMap<&str, &Path> = alone.map(|signal| (signal.name.as_str(), &signal.doc.path)).collect();
        for array in arrays {
            let path = &array.doc.path;
            let names = array.elements.iter().map(|element| &signals[*element].name);
            for name in std::iter::once(&array.name).chain(names) {
                let Some(other) = known.insert(name, path) else { continue };
                let text = format!("`{}` brings the name `{name}`, which another field has", array.name);
                let problem = Diagnostic::error(&rules::ARRAY, path.at_key(), text).help("rename one of the two");
                self.diagnostics.push_first(problem.other(other.at_key(), "the other one"));
            }
        }
    }
}

/// Returns the remarks of an element, with its number in the title.
fn numbered(doc: &Doc, number: u16) -> Doc {
    let title = doc.title.as_ref().map(|title| Text::new(&format!("{} {number}", title.for_people())));
    Doc { title, ..doc.clone() }
}
