//! From a frame to a message with its values.

use std::cmp::Reverse;

use super::value::{extended, float, in_range, named, physical};
use super::{Decoded, Form, Frame, Note, Problem, Reading, Unrecognised, Value, hex, hexadecimal};
use crate::model::{
    AddressPattern, Direction, Encoding, FieldId, FrameId, FrameLayout, Kind, Message, ModelId, Protocol, SelectorId,
    SelectorPlace, Signal, Table, Travel, Who,
};

/// Decodes a frame that goes to a device model, or comes from one.
///
/// Without a model, messages that look the same are decoded as the first one listed, and limits that depend on the model
/// do not count.
///
/// # Errors
///
/// Says why a frame is not recognised; the tests come in the order of [`Problem`]'s variants, except that a sub-command is
/// looked for after the length is known to be right.
pub fn decode(protocol: &Protocol, model: Option<ModelId>, frame: &Frame) -> Result<Decoded, Unrecognised> {
    Decoder { protocol, model, frame, data: frame.padded() }.decode()
}

/// A kind of frame that it can be.
type Candidate<'a> = (FrameId, &'a FrameLayout);

struct Decoder<'a> {
    protocol: &'a Protocol,
    model: Option<ModelId>,
    frame: &'a Frame,
    data: [u8; 8],
}

/// How well an addressing pattern fits, the best first.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
enum Fit {
    Documented,
    Tolerated,
    DocumentedElsewhere,
    ToleratedElsewhere,
    None,
}

/// The mode that a frame shows.
struct Addressing<'a> {
    fit: Fit,
    constants: usize,
    travel: Option<(Travel, &'a AddressPattern)>,
}

impl<'a> Decoder<'a> {
    fn decode(&self) -> Result<Decoded, Unrecognised> {
        if let Some(text) = self.form() {
            return Err(self.unrecognised(Problem::Frame, text.to_owned(), false, &[]));
        }
        if let Some(text) = self.foreign() {
            return Err(self.unrecognised(Problem::Foreign, text, false, &[]));
        }
        let to_module = self.direction()?;
        let candidates = self.candidates(to_module);
        let candidates = self.by_identifier(&candidates)?;
        let candidates = self.by_length(&candidates)?;
        let (best, candidates) = self.by_payload(&candidates)?;
        let mut decoded = self.decoded(best);
        decoded.notes.extend(self.model_note(best, &candidates));
        Ok(decoded)
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
        let found = self.protocol.foreign.iter().find(|foreign| foreign.ranges.iter().all(within));
        found.filter(|_| same_width).map(|foreign| {
            let title = foreign.doc.title.clone().or_else(|| foreign.doc.note.clone());
            title.map_or_else(|| foreign.name.clone(), |title| format!("{}: {title}", foreign.name))
        })
    }

    fn field(&self, id: FieldId) -> u32 {
        self.protocol[id].get(self.frame.id)
    }

    /// Tests the identifier's width and fixed bits, and whether it shows its direction.
    fn direction(&self) -> Result<bool, Unrecognised> {
        let identifier = &self.protocol.identifier;
        if self.frame.extended != identifier.extended {
            let [found, wanted] =
                [self.frame.extended, identifier.extended].map(|extended| if extended { 29 } else { 11 });
            let text = format!("the identifier has {found} bits instead of {wanted}");
            return Err(self.unrecognised(Problem::Identifier, text, false, &[]));
        }
        if self.frame.id & identifier.mask != identifier.value {
            return Err(self.unrecognised(Problem::Identifier, self.wrong_bits(), true, &[]));
        }
        let holds = |direction: &Direction| {
            direction.any.iter().any(|tests| {
                tests.iter().all(|test| {
                    let value = self.field(test.field);
                    test.ranges.iter().any(|(first, last)| (*first..=*last).contains(&value)) == test.inside
                })
            })
        };
        match (holds(&self.protocol.to_module), holds(&self.protocol.to_controller)) {
            (true, false) => Ok(true),
            (false, true) => Ok(false),
            _ => {
                let text = "the addresses do not show whether it goes to a module or to the controller";
                Err(self.unrecognised(Problem::Identifier, text.to_owned(), true, &[]))
            }
        }
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

    /// Returns every frame of this direction.
    fn candidates(&self, to_module: bool) -> Vec<Candidate<'a>> {
        self.protocol.frames.entries().filter(|(_, frame)| (frame.kind == Kind::Request) == to_module).collect()
    }

    fn by_identifier(&self, candidates: &[Candidate<'a>]) -> Result<Vec<Candidate<'a>>, Unrecognised> {
        let chosen = |(_, frame): &Candidate| frame.identifier().all(|(field, value)| self.field(field) == value);
        let left: Vec<_> = candidates.iter().copied().filter(chosen).collect();
        if left.is_empty() {
            let text = match self.identifier_selectors(candidates).as_str() {
                "" => "no message goes this way".to_owned(),
                selectors => format!("no {} has {selectors}", kinds(candidates)),
            };
            return Err(self.unrecognised(Problem::UnknownMessage, text, true, &[]));
        }
        Ok(left)
    }

    /// Shows the values of the identifier's selectors.
    fn identifier_selectors(&self, candidates: &[Candidate]) -> String {
        let selectors = self.protocol.selectors.entries().filter(|(id, _)| chooses(candidates, *id));
        let texts = selectors.filter_map(|(id, selector)| match selector.place {
            SelectorPlace::Identifier(field) => Some(self.selector_text((id, self.field(field).into()))),
            SelectorPlace::Payload(_) => None,
        });
        texts.collect::<Vec<_>>().join(", ")
    }

    fn by_length(&self, candidates: &[Candidate<'a>]) -> Result<Vec<Candidate<'a>>, Unrecognised> {
        let length = self.frame.data.len();
        let left: Vec<_> =
            candidates.iter().copied().filter(|(_, frame)| usize::from(frame.length) == length).collect();
        if left.is_empty() {
            let wanted = candidates.iter().map(|(_, frame)| frame.length).max().unwrap_or(8);
            let bytes = if length == 1 { "byte" } else { "bytes" };
            let text = format!("{length} data {bytes} instead of {wanted}");
            return Err(self.unrecognised(Problem::Length, text, true, candidates));
        }
        Ok(left)
    }

    /// Returns the candidate that fits best, and all that have the frame's constants.
    fn by_payload(&self, candidates: &[Candidate<'a>]) -> Result<(Candidate<'a>, Vec<Candidate<'a>>), Unrecognised> {
        let chosen = |(_, frame): &Candidate| frame.payload().all(|(place, value)| place.get(&self.data) == value);
        let left: Vec<_> = candidates.iter().copied().filter(chosen).collect();
        let Some(best) = left.iter().min_by_key(|candidate| self.rank(candidate)).copied() else {
            let mut selectors = self.selectors(candidates);
            selectors.retain(|(id, _)| chooses(candidates, *id));
            let shown: Vec<_> = selectors.into_iter().map(|known| self.selector_text(known)).collect();
            let text = format!("no {} has {}", kinds(candidates), shown.join(", "));
            return Err(self.unrecognised(Problem::UnknownMessage, text, true, candidates));
        };
        Ok((best, left))
    }

    /// Puts a candidate that the device model has first, then one whose addresses fit better.
    fn rank(&self, (_, frame): &Candidate) -> (Reverse<bool>, Fit, Reverse<usize>) {
        let addressing = self.addressing(frame);
        let is_of_model = self.model.is_none_or(|model| self.protocol[frame.message].is_of(model));
        (Reverse(is_of_model), addressing.fit, Reverse(addressing.constants))
    }

    /// Says that the device model has no such message, or that the frame may be another message on another model.
    fn model_note(&self, best: Candidate, candidates: &[Candidate]) -> Option<Note> {
        let message = self.message(best);
        let text = match self.model {
            Some(model) if message.is_of(model) => return None,
            Some(model) => format!("{} has no message `{}`", self.protocol[model].name, message.name),
            None => {
                let is_equal = |other: &&Candidate| {
                    message.is_apart_from(self.message(**other)) && self.rank(other) == self.rank(&best)
                };
                let other = self.message(*candidates.iter().find(is_equal)?);
                let models = other.models.iter().map(|model| self.protocol[*model].name.as_str());
                format!("it is `{}` if the model is {}", other.name, models.collect::<Vec<_>>().join(" or "))
            }
        };
        Some(Note { rule: "model_dependent", text })
    }

    fn message(&self, (_, frame): Candidate) -> &'a Message {
        &self.protocol[frame.message]
    }

    fn selector_text(&self, (id, value): (SelectorId, u64)) -> String {
        format!("{} {}", self.protocol[id].name, self.protocol.selector_value(id, value))
    }

    /// Returns the payload selectors of the candidates, as far as the frame has the bytes.
    fn selectors(&self, candidates: &[Candidate]) -> Vec<(SelectorId, u64)> {
        let present = |id: &SelectorId| candidates.iter().any(|(_, frame)| frame.selectors.contains(id));
        let places = self.protocol.selectors.ids().filter(present);
        places
            .filter_map(|id| match self.protocol[id].place {
                SelectorPlace::Payload(place) if covered(place.mask(), self.frame.data.len()) => {
                    Some((id, place.get(&self.data)))
                }
                _ => None,
            })
            .collect()
    }

    fn unrecognised(&self, problem: Problem, text: String, split: bool, candidates: &[Candidate]) -> Unrecognised {
        let identifier = if split { self.identifier() } else { Table::default() };
        Unrecognised { problem, text, identifier, selectors: self.selectors(candidates) }
    }

    fn identifier(&self) -> Table<FieldId, u32> {
        self.protocol.identifier.fields.map(|field| field.get(self.frame.id))
    }

    /// Finds the mode that fits best: documented addresses, then tolerated ones, then modes the message does not have.
    fn addressing(&self, frame: &FrameLayout) -> Addressing<'a> {
        let patterns = self.protocol.modes.entries().flat_map(|(mode, known)| {
            let senders: &[_] = match frame.kind {
                Kind::Request => &[Who::Nobody],
                Kind::Reply | Kind::Report => &[Who::One, Who::Each, Who::Coordinator],
            };
            senders.iter().filter_map(move |who| Some((Travel { mode, who: *who }, known.pattern(frame.kind, *who)?)))
        });
        let fitting = patterns.filter_map(|(shown, pattern)| {
            let tolerated = self.fits(pattern)?;
            let is_shown =
                |own: &&Travel| own.mode == shown.mode && (frame.kind == Kind::Request || own.who == shown.who);
            let own = frame.travels.iter().find(is_shown);
            let fit = match (own.is_some(), tolerated) {
                (true, false) => Fit::Documented,
                (true, true) => Fit::Tolerated,
                (false, false) => Fit::DocumentedElsewhere,
                (false, true) => Fit::ToleratedElsewhere,
            };
            let travel = own.copied().unwrap_or(shown);
            Some(Addressing { fit, constants: pattern.constants, travel: Some((travel, pattern)) })
        });
        let none = Addressing { fit: Fit::None, constants: 0, travel: None };
        fitting.min_by_key(|known| (known.fit, Reverse(known.constants))).unwrap_or(none)
    }

    /// Tests a pattern; `Some(true)` if it holds but for an address that the document does not name.
    fn fits(&self, pattern: &AddressPattern) -> Option<bool> {
        if self.frame.id & pattern.mask != pattern.value {
            return None;
        }
        pattern.addresses.iter().try_fold(false, |tolerated, address| {
            let address_type = &self.protocol[address.address_type];
            let raw = self.field(address.field);
            let excluded = || address.excluded.iter().any(|(first, last)| (*first..=*last).contains(&raw));
            match address_type.documents(raw) {
                true => Some(tolerated),
                false if address_type.strict || excluded() => None,
                false => Some(true),
            }
        })
    }

    fn decoded(&self, (id, frame): Candidate) -> Decoded {
        let message = self.message((id, frame));
        let addressing = self.addressing(frame);
        let readings = self.protocol.signals_of(frame).map(|(id, signal)| {
            let bits = signal.place.get(&self.data);
            Reading { signal: id, bits, value: physical(self.protocol, signal, bits) }
        });
        let signals: Vec<_> = readings.collect();
        let selectors = self.selectors(&[(id, frame)]);
        let reserved = self.reserved(frame);
        let mut notes = self.error_notes(frame, &selectors);
        notes.extend(self.address_notes(message, frame, &addressing));
        let note = |reading: &Reading| signal_note(&message[reading.signal], self.model, reading);
        notes.extend(signals.iter().filter_map(note));
        if reserved != [0; 8] {
            let bits = hex(&reserved[..self.frame.data.len()]);
            notes.push(Note { rule: "reserved_bit", text: format!("bits are set that no field has: 0x{bits}") });
        }
        Decoded {
            frame: id,
            message: frame.message,
            access: frame.access,
            kind: frame.kind,
            set: frame.set,
            addressing: addressing.travel.map(|(travel, _)| travel),
            identifier: self.identifier(),
            selectors,
            signals,
            reserved,
            length: self.frame.data.len(),
            notes,
        }
    }

    /// Returns the set bits that no signal and no selector covers.
    fn reserved(&self, frame: &FrameLayout) -> [u8; 8] {
        (u64::from_be_bytes(self.data) & !frame.covered).to_be_bytes()
    }

    fn error_notes(&self, frame: &FrameLayout, selectors: &[(SelectorId, u64)]) -> Vec<Note> {
        let fields = self.protocol.identifier.fields.iter().filter_map(|field| {
            let value = u64::from(field.get(self.frame.id));
            Some((&field.name, value, field.normal.filter(|normal| u64::from(*normal) != value)?, field.enumeration))
        });
        let payload = selectors.iter().filter(|_| frame.kind != Kind::Request).filter_map(|(id, value)| {
            let selector = &self.protocol[*id];
            let normal = selector.normal.filter(|normal| normal != value)?;
            Some((&selector.name, *value, u32::try_from(normal).unwrap_or(0), selector.enumeration))
        });
        let wrong = fields.chain(payload);
        wrong
            .map(|(name, value, _, enumeration)| {
                let named = enumeration.and_then(|id| named(&self.protocol[id], value));
                let text = match named {
                    Some(meaning) => format!("{name} {value}: {}", meaning.name),
                    None => format!("{name} {value}, which the document does not name"),
                };
                Note { rule: "error_code", text }
            })
            .collect()
    }

    fn address_notes(&self, message: &Message, frame: &FrameLayout, addressing: &Addressing) -> Vec<Note> {
        let mut notes = Vec::new();
        let Some((travel, pattern)) = addressing.travel else {
            let text = format!("no addressing mode of this protocol fits a {}", frame.kind.name());
            return vec![Note { rule: "addressing", text }];
        };
        if addressing.fit >= Fit::DocumentedElsewhere {
            let text = format!("`{}` is not addressed by `{}`", message.name, self.protocol[travel.mode].name);
            notes.push(Note { rule: "addressing", text });
        }
        for address in &pattern.addresses {
            let address_type = &self.protocol[address.address_type];
            let raw = self.field(address.field);
            if !address_type.documents(raw) {
                let (first, last) = address_type.raw_range();
                let field = &self.protocol[address.field].name;
                let range = format!("{}..{}", hexadecimal(first), hexadecimal(last));
                let text = format!("{field} {} is outside {range} of `{}`", hexadecimal(raw), address_type.name);
                notes.push(Note { rule: "address", text });
            }
        }
        notes
    }
}

fn signal_note(signal: &Signal, model: Option<ModelId>, reading: &Reading) -> Option<Note> {
    let name = &signal.name;
    let note = |rule, text| Some(Note { rule, text });
    match (&signal.encoding, &reading.value) {
        (Encoding::Float, Value::None) => note("not_finite", format!("{name} is {}", float(reading.bits))),
        (Encoding::Named(_), Value::None) => note("unknown_value", format!("{name} {:#X} has no name", reading.bits)),
        (_, Value::None) => note("unknown_value", format!("{name} is not a text of the documented form")),
        (_, Value::Status { unknown, .. }) if *unknown != 0 => {
            note("unknown_bit", format!("{name} has bits {unknown:#X} set that have no name"))
        }
        (Encoding::Number { signed, .. }, Value::Integer(_)) => {
            #[allow(clippy::cast_precision_loss, reason = "ranges of unscaled signals lie below 2^53")]
            let value = extended(signal, reading.bits, *signed) as f64;
            range_note(signal, model, value)
        }
        (_, Value::Number(value)) => range_note(signal, model, *value),
        _ => None,
    }
}

fn range_note(signal: &Signal, model: Option<ModelId>, value: f64) -> Option<Note> {
    let range = signal.range_for(model).filter(|range| !in_range(signal, range, value))?;
    let unit = signal.unit.map_or_else(String::new, |unit| format!(" {}", unit.symbol));
    let text = format!("{} {value}{unit} is outside {}..{}{unit}", signal.name, range.minimum, range.maximum);
    Some(Note { rule: "out_of_range", text })
}

/// Names the kinds of these frames, for texts.
fn kinds(candidates: &[Candidate]) -> String {
    let is_there = |kind: &Kind| candidates.iter().any(|(_, frame)| frame.kind == *kind);
    Kind::ALL.into_iter().filter(is_there).map(Kind::name).collect::<Vec<_>>().join(" or ")
}

/// Tests whether a selector takes part in the choice among these frames.
fn chooses(candidates: &[Candidate], id: SelectorId) -> bool {
    candidates.iter().any(|(_, frame)| frame.constants.iter().any(|known| known.selector == id))
}

/// Tests whether all bits of a mask lie in the first bytes.
fn covered(mask: [u8; 8], length: usize) -> bool {
    mask.iter().skip(length).all(|byte| *byte == 0)
}
