//! Decodes a frame to a message with its values.

use std::collections::BTreeSet;

use super::fit::{Addressing, Candidate, Decoder};
use super::oddities::signal_note;
use super::{Decoded, Form, Frame, Note, Problem, Reading, Unrecognised, hexadecimal, hexadecimal_ranges};
use crate::model::{
    AddressType, Choice, Course, Direction, FieldId, FieldTest, FrameId, FrameLayout, Group, Id, ModelId, Protocol,
    Recognition, Reserved, Scope, SelectorId, SelectorPlace, Table, Way,
};

/// Decodes a frame that goes to or comes from a device model.
///
/// Without a model, a frame of several messages that look the same is decoded as the first of them.
/// Limits of models then do not count.
///
/// # Errors
///
/// Says why a frame is not recognised. The tests come in the order of [`Problem`]'s variants, with
/// one exception. Constants in the data bytes are tested after the length.
pub fn decode(protocol: &Protocol, model: Option<ModelId>, frame: &Frame) -> Result<Decoded, Unrecognised> {
    recognise(protocol, model, frame).map(|recognised| recognised.decode(frame))
}

/// Finds the kind of a frame that goes to or comes from a device model, and its addressing mode.
///
/// # Errors
///
/// Says why a frame is not recognised, as [`decode`] does.
pub fn recognise<'a>(
    protocol: &'a Protocol,
    model: Option<ModelId>,
    frame: &Frame,
) -> Result<Recognised<'a>, Unrecognised> {
    Decoder { protocol, model, frame, data: frame.padded() }.recognise()
}

/// What a frame is, before its values are read.
pub struct Recognised<'a> {
    protocol: &'a Protocol,
    model: Option<ModelId>,
    best: Candidate<'a>,
    addressing: Addressing<'a>,
    note: Option<Note>,
    id: u32,
    length: usize,
    /// No data byte counted.
    is_by_identifier: bool,
}

impl Recognised<'_> {
    /// Tests whether another frame is surely recognised as the same: it has the same identifier and length, and
    /// nothing else decided.
    pub fn is_known_of(&self, frame: &Frame) -> bool {
        self.is_by_identifier
            && (frame.form, frame.id, frame.data.len()) == (Form::Data, self.id, self.length)
            && frame.extended == self.protocol.identifier.extended
    }

    /// Reads the values of a frame that is recognised so.
    pub fn decode(&self, frame: &Frame) -> Decoded {
        let Self { protocol, model, best, addressing, note, .. } = self;
        let known = Decoder { protocol, model: *model, frame, data: frame.padded() };
        let mut decoded = known.decoded(*best, addressing);
        decoded.notes.extend(note.clone());
        decoded
    }
}

/// Decodes the identifier of a long message that came by a transport. `frame` is what it would be if one frame were
/// enough, with the bytes that choose it.
pub fn transported(protocol: &Protocol, model: Option<ModelId>, layout: &FrameLayout, frame: &Frame) -> Decoded {
    let decoder = Decoder { protocol, model, frame, data: frame.padded() };
    let bare = FrameLayout { signals: Vec::new(), covered: u64::MAX, reserved: Reserved::default(), ..layout.clone() };
    decoder.decoded((FrameId::new(0), &bare), &decoder.addressing(&bare))
}

/// Returns tests of one field that keep a frame from showing a direction. They are those
/// of the lists with the fewest failed tests.
pub fn failed_tests<'a>(protocol: &'a Protocol, frame: &Frame, is_to_module: bool) -> Vec<&'a FieldTest> {
    let decoder = Decoder { protocol, model: None, frame, data: frame.padded() };
    let Recognition { to_module, to_controller, .. } = &protocol.recognition;
    let direction = if is_to_module { to_module } else { to_controller };
    let failed = |tests: &'a Vec<FieldTest>| tests.iter().filter(|test| !decoder.passes(test)).collect::<Vec<_>>();
    let lists: Vec<_> = direction.any.iter().map(failed).collect();
    let fewest = lists.iter().map(Vec::len).min();
    let first =
        lists.into_iter().filter(|tests| Some(tests.len()) == fewest).filter_map(|tests| tests.first().copied());
    let mut found: Vec<&FieldTest> = Vec::new();
    for test in first {
        let is_alike = found.first().is_none_or(|known| (known.field, known.inside) == (test.field, test.inside));
        if is_alike && !found.contains(&test) {
            found.push(test);
        }
    }
    found
}

impl<'a> Decoder<'a, '_> {
    fn recognise(&self) -> Result<Recognised<'a>, Unrecognised> {
        if let Some(text) = self.form() {
            return Err(self.unrecognised(Problem::Frame, text.to_owned(), false, None));
        }
        if let Some(text) = self.foreign() {
            return Err(self.unrecognised(Problem::Foreign, text, false, None));
        }
        let group = self.by_identifier(self.course()?)?;
        let of_length = self.by_length(group)?;
        let (best, frames) = self.by_payload(group, of_length)?;
        Ok(Recognised {
            protocol: self.protocol,
            model: self.model,
            best,
            addressing: self.addressing(best.1),
            note: self.model_note(best, frames),
            id: self.frame.id,
            length: self.frame.data.len(),
            is_by_identifier: matches!(group.choice, Some(Choice::End(_))),
        })
    }

    fn form(&self) -> Option<&'static str> {
        match self.frame.form {
            Form::Data => None,
            Form::Remote => Some("a remote frame carries no data"),
            Form::Error => Some("an error frame"),
            Form::Fd => Some("a CAN FD frame"),
        }
    }

    fn foreign(&self) -> Option<String> {
        let within = |(field, first, last): &(Option<FieldId>, u32, u32)| {
            let value = field.map_or(self.frame.id, |field| self.field(field));
            (*first..=*last).contains(&value)
        };
        let same_width = self.frame.extended == self.protocol.identifier.extended;
        let known = if same_width { &self.protocol.foreign[..] } else { &[] };
        let found = known.iter().find(|foreign| foreign.ranges.iter().all(within));
        found.map(|foreign| {
            let title = foreign.doc.title.as_ref().or(foreign.doc.note.as_ref());
            title.map_or_else(|| foreign.name.clone(), |title| format!("{}: {}", foreign.name, title.for_people()))
        })
    }

    /// Tests the identifier's width and fixed bits, and returns the frames of the direction that it shows.
    fn course(&self) -> Result<&'a Course, Unrecognised> {
        let identifier = &self.protocol.identifier;
        if self.frame.extended != identifier.extended {
            let [found, wanted] =
                [self.frame.extended, identifier.extended].map(|extended| if extended { 29 } else { 11 });
            let text = format!("the identifier has {found} bits instead of {wanted}");
            return Err(self.unrecognised(Problem::Identifier, text, false, None));
        }
        if self.frame.id & identifier.mask != identifier.value {
            return Err(self.unrecognised(Problem::Identifier, self.wrong_bits(), true, None));
        }
        let holds =
            |direction: &Direction| direction.any.iter().any(|tests| tests.iter().all(|test| self.passes(test)));
        let Recognition { to_module, to_controller, requests, replies, either, .. } = &self.protocol.recognition;
        match (holds(to_module), holds(to_controller)) {
            (true, false) => Ok(requests),
            (false, true) => Ok(replies),
            (true, true) => Ok(either),
            (false, false) => Err(self.unrecognised(Problem::Identifier, self.undirected(), true, None)),
        }
    }

    /// Says why the identifier shows no direction. It names the first field whose value no addressing mode has, and the
    /// values that they have.
    fn undirected(&self) -> String {
        let strange = self.protocol.identifier.fields.ids().find_map(|field| {
            let known = self.documented_values(field)?;
            let found = self.field(field);
            let is_strange = !known.iter().any(|(first, last)| (*first..=*last).contains(&found));
            is_strange.then_some((&self.protocol[field].name, found, known))
        });
        let Some((name, found, known)) = strange else {
            return format!("the addresses do not show whether it goes to {}", self.protocol.sides.either());
        };
        format!("no addressing mode has {name} {}; they have {}", hexadecimal(found), hexadecimal_ranges(&known))
    }

    /// Returns the raw values of a field that the addressing modes name, if each of them names some.
    fn documented_values(&self, id: FieldId) -> Option<Vec<(u32, u32)>> {
        let (protocol, field) = (self.protocol, &self.protocol[id]);
        let values = Way::all(&protocol.modes).map(|(_, pattern)| {
            let address = pattern.addresses.iter().find(|address| address.field == id);
            let known = address.map(|address| &protocol[address.address_type]).filter(|known| known.strict);
            let constant = field.get(pattern.value);
            let is_constant = pattern.mask & field.mask() == field.mask();
            known.map(AddressType::raw_ranges).or_else(|| is_constant.then(|| vec![(constant, constant)]))
        });
        let mut known = values.collect::<Option<Vec<_>>>()?.concat();
        known.sort_unstable();
        known.dedup();
        Some(known)
    }

    fn passes(&self, test: &FieldTest) -> bool {
        test.holds(self.field(test.field))
    }

    /// Says what is wrong with the fixed bits.
    fn wrong_bits(&self) -> String {
        let identifier = &self.protocol.identifier;
        let ids = [self.frame.id, identifier.value];
        let wrong = (self.frame.id & identifier.mask) ^ identifier.value;
        let Some(field) = identifier.fields.iter().find(|field| field.mask() & wrong != 0) else {
            let bit = wrong.checked_ilog2().unwrap_or_default();
            let [found, wanted] = ids.map(|id| id >> bit & 1);
            return format!("bit {bit} of the identifier is {found} instead of {wanted}");
        };
        let [found, wanted] = ids.map(|id| hexadecimal(field.get(id)));
        format!("the identifier's {} is {found} instead of {wanted}", field.name)
    }

    /// Returns the value of a selector in this frame.
    fn read(&self, place: SelectorPlace) -> u64 {
        match place {
            SelectorPlace::Identifier(field) => self.field(field).into(),
            SelectorPlace::Payload(place) => place.get(&self.data),
        }
    }

    fn by_identifier(&self, course: &'a Course) -> Result<&'a Group, Unrecognised> {
        let found = course.choice.as_ref().and_then(|choice| choice.find(|place| self.read(place)));
        found.ok_or_else(|| {
            let text = match self.identifier_selectors(&course.all).as_str() {
                "" => "no message goes this way".to_owned(),
                selectors => format!("no {} has {selectors}", kinds(&course.all)),
            };
            self.unrecognised(Problem::UnknownMessage, text, true, None)
        })
    }

    /// Shows the values of the identifier's selectors.
    fn identifier_selectors(&self, scope: &Scope) -> String {
        let texts = scope.choosing.iter().filter_map(|id| match self.protocol[*id].place {
            SelectorPlace::Identifier(field) => Some(self.selector_text((*id, self.field(field).into()))),
            SelectorPlace::Payload(_) => None,
        });
        texts.collect::<Vec<_>>().join(", ")
    }

    /// Shows the values of the selectors in the data. Bits that several of them have are shown once.
    fn payload_selectors(&self, scope: &Scope) -> String {
        let mut selectors = self.selectors(&scope.selectors);
        selectors.retain(|(id, _)| scope.choosing.contains(id));
        let mask = |id: SelectorId| match self.protocol[id].place {
            SelectorPlace::Payload(place) => u64::from_be_bytes(place.mask()),
            SelectorPlace::Identifier(_) => 0,
        };
        let is_shown = |index: usize, own: u64| {
            let mut others = selectors.iter().enumerate().map(|(other, (id, _))| (other, mask(*id)));
            others.any(|(other, known)| own & !known == 0 && (own != known || other < index))
        };
        let shown = selectors.iter().enumerate().filter(|(index, (id, _))| !is_shown(*index, mask(*id)));
        shown.map(|(_, known)| self.selector_text(*known)).collect::<Vec<_>>().join(", ")
    }

    fn by_length(&self, group: &'a Group) -> Result<&'a Scope, Unrecognised> {
        let length = self.frame.data.len();
        group.of_length(length).ok_or_else(|| {
            let wanted = self.fitting_lengths(group);
            let bytes = if length == 1 { "byte" } else { "bytes" };
            let text = format!("{length} data {bytes} instead of {wanted}");
            self.unrecognised(Problem::Length, text, true, Some(&group.all))
        })
    }

    /// Names the lengths of the frames whose constants and addresses fit best: `4 or 6`.
    fn fitting_lengths(&self, group: &Group) -> String {
        let by_constants = group.choice.as_ref().and_then(|choice| choice.find(|place| self.read(place)));
        let all = || group.choice.iter().flat_map(Choice::ends).collect();
        let frames: Vec<_> = by_constants.map_or_else(all, |frames| vec![frames]);
        let frames = || frames.iter().copied().flatten().map(|id| &self.protocol[*id]);
        let fit = |frame: &FrameLayout| self.addressing(frame).fit;
        let best = frames().map(fit).min();
        let of_best = frames().filter(|frame| Some(fit(frame)) == best);
        let lengths: BTreeSet<_> = of_best.flat_map(|frame| &frame.lengths).collect();
        lengths.into_iter().map(u8::to_string).collect::<Vec<_>>().join(" or ")
    }

    /// Returns the kind of frame that fits best, and all that have the frame's constants.
    fn by_payload(&self, group: &'a Group, of_length: &Scope) -> Result<(Candidate<'a>, &'a [FrameId]), Unrecognised> {
        let found = group.choice.as_ref().and_then(|choice| choice.find(|place| self.read(place)));
        let frames = found.map_or(&[][..], Vec::as_slice);
        let best = match frames {
            [only] => self.candidates(frames).next().filter(|(id, _)| id == only),
            _ => self.candidates(frames).min_by_key(|candidate| self.rank(candidate)),
        };
        best.map(|best| (best, frames)).ok_or_else(|| {
            let text = format!("no {} has {}", kinds(of_length), self.payload_selectors(of_length));
            self.unrecognised(Problem::UnknownMessage, text, true, Some(of_length))
        })
    }

    fn selector_text(&self, (id, value): (SelectorId, u64)) -> String {
        format!("{} {}", self.protocol[id].name, self.protocol.selector_value(id, value))
    }

    /// Returns the values of payload selectors whose bytes the frame has.
    fn selectors(&self, ids: &[SelectorId]) -> Vec<(SelectorId, u64)> {
        if ids.is_empty() {
            return Vec::new();
        }
        let values = ids.iter().filter_map(|id| match self.protocol[*id].place {
            SelectorPlace::Payload(place) if covered(place.mask(), self.frame.data.len()) => {
                Some((*id, place.get(&self.data)))
            }
            SelectorPlace::Payload(_) | SelectorPlace::Identifier(_) => None,
        });
        values.collect()
    }

    fn unrecognised(&self, problem: Problem, text: String, split: bool, scope: Option<&Scope>) -> Unrecognised {
        let identifier = if split { self.identifier() } else { Table::default() };
        let selectors = scope.map_or(Vec::new(), |scope| self.selectors(&scope.selectors));
        Unrecognised { problem, text, identifier, selectors }
    }

    fn identifier(&self) -> Table<FieldId, u32> {
        self.protocol.identifier.fields.map(|field| field.get(self.frame.id))
    }

    fn decoded(&self, (id, frame): Candidate, addressing: &Addressing) -> Decoded {
        let message = self.message((id, frame));
        let mut signals = Vec::with_capacity(frame.signals.len());
        for (id, signal) in self.protocol.signals_of(frame) {
            if usize::from(signal.end()) <= self.frame.data.len() {
                let bits = signal.place.get(&self.data);
                signals.push(Reading::of(self.protocol, (id, signal.on(self.model)), bits));
            }
        }
        let selectors = self.selectors(&frame.selectors);
        let reserved = self.reserved(frame);
        let mut notes = Vec::new();
        self.error_notes(&mut notes, frame, &selectors);
        self.address_notes(&mut notes, message, frame, addressing);
        let note =
            |reading: &Reading| signal_note(self.protocol, (message, message.shortest().into()), self.model, reading);
        notes.extend(signals.iter().filter_map(note));
        notes.extend(self.part_note(message).filter(|_| !signals.is_empty()));
        notes.extend(self.reserved_note(frame, reserved));
        Decoded {
            frame: id,
            message: frame.message,
            access: frame.access,
            kind: frame.kind,
            sender: frame.sender,
            model: self.model,
            set: frame.set,
            addressing: addressing.travel.map(|(travel, _)| travel),
            id: self.frame.id,
            selectors,
            long: None,
            signals,
            reserved,
            length: self.frame.data.len(),
            notes,
        }
    }

    /// Returns the set bits that neither a signal nor a selector covers.
    fn reserved(&self, frame: &FrameLayout) -> [u8; 8] {
        (u64::from_be_bytes(self.data) & !frame.covered).to_be_bytes()
    }
}

/// Names the kinds of frames in words.
fn kinds(scope: &Scope) -> String {
    scope.kinds.iter().map(|kind| kind.name()).collect::<Vec<_>>().join(" or ")
}

/// Tests whether all bits of a mask lie in the first bytes.
fn covered(mask: [u8; 8], length: usize) -> bool {
    mask.iter().skip(length).all(|byte| *byte == 0)
}
