//! Resolves what the frame of a part carries: bytes, or elements of arrays.

use canspec_runtime::Place;
use canspec_runtime::plumbing::ByteOrder;

use super::DATA;
use crate::model::{FrameLayout, SelectorId, SelectorPlace, Signal, SignalId, Table};
use crate::read::syntax::ast::{self, PartData};
use crate::report::tree::Path;
use crate::resolve::Resolver;
use crate::resolve::leaves::Leaves;
use crate::resolve::rules;

/// Most elements in a part, whose data are up to eight bytes.
const MOST_ELEMENTS: u8 = 8;

impl Resolver<'_> {
    /// Finds the place of the data in the frame of a part. Elements in it become signals of the frame.
    pub fn part_data(&mut self, path: &Path, parts: &ast::Parts, whole: &Leaves, frame: &mut Leaves) -> Option<Place> {
        let path = path.key("data");
        let PartData::Elements(elements) = &parts.data else {
            let data = frame.signals.iter().find(|signal| signal.name == DATA)?;
            return self.forwards(&path, data.place);
        };
        let place = self.part_elements(&path, elements, parts.length.is_some(), whole, frame);
        if place.is_none() {
            let names = whole.signals.iter().map(|signal| &signal.name);
            frame.given_up.extend(names.chain(whole.arrays.iter().map(|array| &array.name)).cloned());
        }
        place
    }

    /// Refuses a place that is read from its last byte to its first.
    fn forwards(&mut self, path: &Path, place: Place) -> Option<Place> {
        if place.order() == ByteOrder::Big {
            return Some(place);
        }
        let text = "the data of a part run from its first byte to its last".to_owned();
        let help = "write the lower number first, as in `1..6`";
        self.error_with_help(&rules::PARTS, path.at_value(), text, help);
        None
    }

    fn part_elements(
        &mut self,
        path: &Path,
        written: &ast::Elements,
        has_length: bool,
        whole: &Leaves,
        frame: &mut Leaves,
    ) -> Option<Place> {
        let bytes = self.bytes(&path.key("bytes"), &written.bytes)?;
        let bytes = self.forwards(&path.key("bytes"), bytes)?;
        let count: u8 = self.integer(&path.key("repeat"), &written.repeat, 2, MOST_ELEMENTS)?;
        let size = bytes.width() / 8;
        let first = 8 - (bytes.bits_of_payload().shift() / 8 + size);
        let room = (8 - first) / size;
        if room < count {
            let text = format!("the frame has room for {room} of the {count} elements");
            self.error_with_help(&rules::PARTS, path.key("repeat").at_value(), text, "correct the count or the place");
            return None;
        }
        // A field with an error is reported there.
        if !whole.given_up.is_empty() || !frame.arrays.is_empty() {
            return None;
        }
        let last = first + size * count - 1;
        if let Some(text) = unlike(whole, size.into(), count.into(), has_length) {
            let help = format!("correct the places, or write `data: {first}..{last}`; then the frame shows bytes");
            self.error_with_help(&rules::PARTS, path.at_key(), text, help);
            return None;
        }
        let (signals, arrays) = whole.in_one_frame(first.into(), (size * count).into());
        frame.signals.extend(signals);
        frame.arrays = arrays;
        Some(Place::bytes(first, last))
    }

    /// Tests that the frames of parts can show elements. Nothing else stands between these, and nobody sends them, since
    /// limits hold for the whole message.
    pub fn check_elements(
        &mut self,
        path: &Path,
        written: &ast::Parts,
        data: Place,
        (frames, signals): (&[FrameLayout], &Table<SignalId, Signal>),
    ) {
        let PartData::Elements(_) = &written.data else { return };
        let at = path.key("parts").key("data").at_key();
        let mut carrying = frames.iter().filter(|frame| !frame.signals.is_empty());
        if carrying.clone().any(FrameLayout::is_to_module) {
            let text = "the frames go to a module, so they show no elements".to_owned();
            let help = "write the bytes with the data, as in `data: 1..6`; limits hold for the whole message";
            self.error_with_help(&rules::PARTS, at, text, help);
            return;
        }
        let (elements, beside): (Vec<_>, Vec<_>) = signals.iter().partition(|signal| signal.element.is_some());
        let gaps = elements.iter().fold(mask(data), |gaps, element| gaps & !mask(element.place));
        let is_beside = |selector: &&SelectorId| match self.tables.selectors[**selector].place {
            SelectorPlace::Payload(place) => mask(place) & gaps != 0,
            SelectorPlace::Identifier(_) => false,
        };
        let selector = carrying.find_map(|frame| frame.selectors.iter().find(is_beside));
        let selector = selector.map(|selector| &self.tables.selectors[*selector].name);
        let number = beside.iter().find(|signal| mask(signal.place) & gaps != 0).map(|signal| &signal.name);
        if let Some(other) = selector.or(number) {
            let text = format!("`{other}` stands between the elements");
            let help = "correct one of the places; each part has the elements without a gap";
            self.error_with_help(&rules::PARTS, at, text, help);
        }
    }
}

/// Returns the bits of a place, byte 0 highest.
fn mask(place: Place) -> u64 {
    u64::from_be_bytes(place.mask())
}

/// Says why the parts of a message do not all have the same elements.
fn unlike(whole: &Leaves, size: usize, count: usize, has_length: bool) -> Option<String> {
    if has_length {
        return Some("the length shifts the elements of the first part".to_owned());
    }
    let is_in_element = |signal: &&Signal| {
        let start = signal.element.map(|element| size * usize::from(element.index));
        start.is_some_and(|start| start <= signal.bytes().start && signal.reach() <= start + size)
    };
    if let Some(other) = whole.signals.iter().find(|signal| !is_in_element(signal)) {
        let first = if size == 1 { "byte 0".to_owned() } else { format!("bytes 0..{}", size - 1) };
        return Some(format!("`{}` does not stand in an element; the first one has {first} of all data", other.name));
    }
    let elements = whole.signals.iter().filter_map(|signal| signal.element);
    let most = elements.map(|element| usize::from(element.index) + 1).max()?;
    if whole.signals.len() != most * whole.arrays.len() {
        return Some("not all arrays have the same number of elements".to_owned());
    }
    (most < count).then(|| format!("the message has {most} elements, and each part {count}"))
}
