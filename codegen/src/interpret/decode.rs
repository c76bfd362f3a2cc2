//! From a frame to a message with its values.

use std::cmp::Reverse;

use super::value::{extended, float, in_range, named, physical};
use super::{Decoded, Form, Frame, Note, Problem, Reading, Unrecognised, Value, hex, hexadecimal, mode_name};
use crate::model::{AddressPattern, Direction, Encoding, Kind, Message, Protocol, SelectorPlace, Shape, Signal, Who};

/// Decodes a frame that goes to a device `model`, an index into [`Protocol::models`], or comes from one.
///
/// Without a model, messages that look the same are decoded as the first one listed, and limits that depend on the model
/// do not count.
///
/// # Errors
///
/// Says why a frame is not recognised; the tests come in the order of [`Problem`]'s variants, except that a sub-command is
/// looked for after the length is known to be right.
pub fn decode(protocol: &Protocol, model: Option<usize>, frame: &Frame) -> Result<Decoded, Unrecognised> {
    Decoder { protocol, model, frame, data: padded(&frame.data) }.decode()
}

/// Returns the data bytes, filled up with zeros.
fn padded(bytes: &[u8]) -> [u8; 8] {
    let mut data = [0; 8];
    data.iter_mut().zip(bytes).for_each(|(byte, given)| *byte = *given);
    data
}

/// A message and one of its frames.
type Candidate<'a> = (usize, &'a Message, &'a Shape);

struct Decoder<'a> {
    protocol: &'a Protocol,
    model: Option<usize>,
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
    mode: Option<(usize, &'a AddressPattern)>,
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
        let mut decoded = self.decoded(best.0, best.2);
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
        let within = |(field, first, last): &(Option<usize>, u32, u32)| {
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

    fn field(&self, index: usize) -> u32 {
        self.protocol.identifier.fields[index].get(self.frame.id)
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
        let messages = self.protocol.messages.iter().enumerate();
        messages
            .flat_map(|(index, message)| message.shapes.iter().map(move |shape| (index, message, shape)))
            .filter(|(_, _, shape)| (shape.kind == Kind::Request) == to_module)
            .collect()
    }

    fn by_identifier(&self, candidates: &[Candidate<'a>]) -> Result<Vec<Candidate<'a>>, Unrecognised> {
        let fits = |constant: &&(usize, u64)| match self.protocol.selectors[constant.0].place {
            SelectorPlace::Identifier(field) => u64::from(self.field(field)) == constant.1,
            SelectorPlace::Payload(_) => true,
        };
        let chosen = |(_, _, shape): &Candidate| shape.constants.iter().all(|constant| fits(&constant));
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
        let selectors = self.protocol.selectors.iter().enumerate().filter(|(index, _)| chooses(candidates, *index));
        let texts = selectors.filter_map(|(index, selector)| match selector.place {
            SelectorPlace::Identifier(field) => Some(self.selector_text((index, self.field(field).into()))),
            SelectorPlace::Payload(_) => None,
        });
        texts.collect::<Vec<_>>().join(", ")
    }

    fn by_length(&self, candidates: &[Candidate<'a>]) -> Result<Vec<Candidate<'a>>, Unrecognised> {
        let length = self.frame.data.len();
        let left: Vec<_> =
            candidates.iter().copied().filter(|(_, message, _)| usize::from(message.length) == length).collect();
        if left.is_empty() {
            let wanted = candidates.iter().map(|(_, message, _)| message.length).max().unwrap_or(8);
            let bytes = if length == 1 { "byte" } else { "bytes" };
            let text = format!("{length} data {bytes} instead of {wanted}");
            return Err(self.unrecognised(Problem::Length, text, true, candidates));
        }
        Ok(left)
    }

    /// Returns the candidate that fits best, and all that have the frame's constants.
    fn by_payload(&self, candidates: &[Candidate<'a>]) -> Result<(Candidate<'a>, Vec<Candidate<'a>>), Unrecognised> {
        let fits = |(selector, value): &(usize, u64)| match self.protocol.selectors[*selector].place {
            SelectorPlace::Identifier(_) => true,
            SelectorPlace::Payload(place) => place.get(&self.data) == *value,
        };
        let left: Vec<_> =
            candidates.iter().copied().filter(|(_, _, shape)| shape.constants.iter().all(fits)).collect();
        let Some(best) = left.iter().min_by_key(|candidate| self.rank(candidate)).copied() else {
            let mut selectors = self.selectors(candidates);
            selectors.retain(|(index, _)| chooses(candidates, *index));
            let shown: Vec<_> = selectors.into_iter().map(|known| self.selector_text(known)).collect();
            let text = format!("no {} has {}", kinds(candidates), shown.join(", "));
            return Err(self.unrecognised(Problem::UnknownMessage, text, true, candidates));
        };
        Ok((best, left))
    }

    /// Puts a candidate that the device model has first, then one whose addresses fit better.
    fn rank(&self, (_, message, shape): &Candidate) -> (Reverse<bool>, Fit, Reverse<usize>) {
        let addressing = self.addressing(message, shape);
        let is_of_model = self.model.is_none_or(|model| message.is_of(model));
        (Reverse(is_of_model), addressing.fit, Reverse(addressing.constants))
    }

    /// Says that the device model has no such message, or that the frame may be another message on another model.
    fn model_note(&self, best: Candidate, candidates: &[Candidate]) -> Option<Note> {
        let (_, message, _) = best;
        let text = match self.model {
            Some(model) if message.is_of(model) => return None,
            Some(model) => format!("{} has no message `{}`", self.protocol.models[model].name, message.name),
            None => {
                let is_equal =
                    |other: &&Candidate| message.is_apart_from(other.1) && self.rank(other) == self.rank(&best);
                let (_, other, _) = candidates.iter().find(is_equal)?;
                let models = other.models.iter().map(|model| self.protocol.models[*model].name.as_str());
                format!("it is `{}` if the model is {}", other.name, models.collect::<Vec<_>>().join(" or "))
            }
        };
        Some(Note { rule: "model_dependent", text })
    }

    fn selector_text(&self, (index, value): (usize, u64)) -> String {
        format!("{} {}", self.protocol.selectors[index].name, self.protocol.selector_value(index, value))
    }

    /// Returns the payload selectors of the candidates, as far as the frame has the bytes.
    fn selectors(&self, candidates: &[Candidate]) -> Vec<(usize, u64)> {
        let present = |index: &usize| candidates.iter().any(|(_, _, shape)| shape.selectors.contains(index));
        let places = (0..self.protocol.selectors.len()).filter(present);
        places
            .filter_map(|index| match self.protocol.selectors[index].place {
                SelectorPlace::Payload(place) if covered(place.mask(), self.frame.data.len()) => {
                    Some((index, place.get(&self.data)))
                }
                _ => None,
            })
            .collect()
    }

    fn unrecognised(&self, problem: Problem, text: String, split: bool, candidates: &[Candidate]) -> Unrecognised {
        let identifier = if split { self.identifier() } else { Vec::new() };
        Unrecognised { problem, text, identifier, selectors: self.selectors(candidates) }
    }

    fn identifier(&self) -> Vec<u32> {
        (0..self.protocol.identifier.fields.len()).map(|index| self.field(index)).collect()
    }

    /// Finds the mode that fits best: documented addresses, then tolerated ones, then modes the message does not have.
    fn addressing(&self, message: &Message, shape: &Shape) -> Addressing<'a> {
        let answers = &message.accesses[shape.access].answers;
        let patterns = self.protocol.modes.iter().enumerate().flat_map(|(index, mode)| {
            let request = mode.request.iter().map(move |pattern| (index, pattern, None));
            let replies = [Who::One, Who::Each, Who::Coordinator];
            let replies = replies.into_iter().filter_map(move |who| Some((index, mode.reply(who)?, Some(who))));
            let wanted = shape.kind == Kind::Request;
            request.filter(move |_| wanted).chain(replies.filter(move |_| !wanted))
        });
        let fitting = patterns.filter_map(|(index, pattern, who)| {
            let tolerated = self.fits(pattern)?;
            let has = match who {
                None => answers[index].is_some(),
                Some(who) => answers[index] == Some(who),
            };
            let fit = match (has, tolerated) {
                (true, false) => Fit::Documented,
                (true, true) => Fit::Tolerated,
                (false, false) => Fit::DocumentedElsewhere,
                (false, true) => Fit::ToleratedElsewhere,
            };
            Some(Addressing { fit, constants: pattern.constants, mode: Some((index, pattern)) })
        });
        let none = Addressing { fit: Fit::None, constants: 0, mode: None };
        fitting.min_by_key(|known| (known.fit, Reverse(known.constants))).unwrap_or(none)
    }

    /// Tests a pattern; `Some(true)` if it holds but for an address that the document does not name.
    fn fits(&self, pattern: &AddressPattern) -> Option<bool> {
        if self.frame.id & pattern.mask != pattern.value {
            return None;
        }
        pattern.addresses.iter().try_fold(false, |tolerated, address| {
            let address_type = &self.protocol.address_types[address.address_type];
            let raw = self.field(address.field);
            let excluded = || address.excluded.iter().any(|(first, last)| (*first..=*last).contains(&raw));
            match address_type.documents(raw) {
                true => Some(tolerated),
                false if address_type.strict || excluded() => None,
                false => Some(true),
            }
        })
    }

    fn decoded(&self, index: usize, shape: &Shape) -> Decoded {
        let message = &self.protocol.messages[index];
        let addressing = self.addressing(message, shape);
        let signals: Vec<_> = shape
            .signals
            .iter()
            .map(|index| {
                let signal = &message.signals[*index];
                let bits = signal.place.get(&self.data);
                Reading { signal: *index, bits, value: physical(self.protocol, signal, bits) }
            })
            .collect();
        let selectors = self.selectors(&[(index, message, shape)]);
        let reserved = self.reserved(message, shape);
        let mut notes = self.error_notes(shape, &selectors);
        notes.extend(self.address_notes(message, shape, &addressing));
        let note = |reading: &Reading| signal_note(&message.signals[reading.signal], self.model, reading);
        notes.extend(signals.iter().filter_map(note));
        if reserved != [0; 8] {
            let bits = hex(&reserved[..self.frame.data.len()]);
            notes.push(Note { rule: "reserved_bit", text: format!("bits are set that no field has: 0x{bits}") });
        }
        Decoded {
            message: index,
            access: message.accesses[shape.access].access,
            kind: shape.kind,
            set: message.accesses[shape.access].set,
            addressing: addressing.mode.map(|(mode, _)| mode),
            identifier: self.identifier(),
            selectors,
            signals,
            reserved,
            length: self.frame.data.len(),
            notes,
        }
    }

    /// Returns the set bits that no signal and no selector covers.
    fn reserved(&self, message: &Message, shape: &Shape) -> [u8; 8] {
        let covered = coverage(self.protocol, message, shape);
        (u64::from_be_bytes(self.data) & !covered).to_be_bytes()
    }

    fn error_notes(&self, shape: &Shape, selectors: &[(usize, u64)]) -> Vec<Note> {
        let fields = self.protocol.identifier.fields.iter().filter_map(|field| {
            let value = u64::from(field.get(self.frame.id));
            Some((&field.name, value, field.normal.filter(|normal| u64::from(*normal) != value)?, field.enumeration))
        });
        let payload = selectors.iter().filter(|_| shape.kind != Kind::Request).filter_map(|(index, value)| {
            let selector = &self.protocol.selectors[*index];
            let normal = selector.normal.filter(|normal| normal != value)?;
            Some((&selector.name, *value, u32::try_from(normal).unwrap_or(0), selector.enumeration))
        });
        let wrong = fields.chain(payload);
        wrong
            .map(|(name, value, _, enumeration)| {
                let named = enumeration.and_then(|index| named(&self.protocol.enumerations[index], value));
                let text = match named {
                    Some(meaning) => format!("{name} {value}: {}", meaning.name),
                    None => format!("{name} {value}, which the document does not name"),
                };
                Note { rule: "error_code", text }
            })
            .collect()
    }

    fn address_notes(&self, message: &Message, shape: &Shape, addressing: &Addressing) -> Vec<Note> {
        let mut notes = Vec::new();
        let Some((mode, pattern)) = addressing.mode else {
            let text = format!("no addressing mode of this protocol fits a {}", shape.kind.name());
            return vec![Note { rule: "addressing", text }];
        };
        if addressing.fit >= Fit::DocumentedElsewhere {
            let text = format!("`{}` is not addressed by `{}`", message.name, mode_name(self.protocol, mode));
            notes.push(Note { rule: "addressing", text });
        }
        for address in &pattern.addresses {
            let address_type = &self.protocol.address_types[address.address_type];
            let raw = self.field(address.field);
            if !address_type.documents(raw) {
                let (first, last) = address_type.raw_range();
                let field = &self.protocol.identifier.fields[address.field].name;
                let range = format!("{}..{}", hexadecimal(first), hexadecimal(last));
                let text = format!("{field} {} is outside {range} of `{}`", hexadecimal(raw), address_type.name);
                notes.push(Note { rule: "address", text });
            }
        }
        notes
    }
}

fn signal_note(signal: &Signal, model: Option<usize>, reading: &Reading) -> Option<Note> {
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

fn range_note(signal: &Signal, model: Option<usize>, value: f64) -> Option<Note> {
    let range = signal.range_for(model).filter(|range| !in_range(signal, range, value))?;
    let unit = signal.unit.map_or_else(String::new, |unit| format!(" {}", unit.symbol));
    let text = format!("{} {value}{unit} is outside {}..{}{unit}", signal.name, range.minimum, range.maximum);
    Some(Note { rule: "out_of_range", text })
}

/// Names the kinds of these frames, for texts.
fn kinds(candidates: &[Candidate]) -> String {
    let is_there = |kind: &Kind| candidates.iter().any(|(_, _, shape)| shape.kind == *kind);
    Kind::ALL.into_iter().filter(is_there).map(Kind::name).collect::<Vec<_>>().join(" or ")
}

/// Tests whether a selector takes part in the choice among these frames.
fn chooses(candidates: &[Candidate], index: usize) -> bool {
    candidates.iter().any(|(_, _, shape)| shape.constants.iter().any(|known| known.0 == index))
}

/// Tests whether all bits of a mask lie in the first bytes.
fn covered(mask: [u8; 8], length: usize) -> bool {
    mask.iter().skip(length).all(|byte| *byte == 0)
}

/// Returns the payload bits that a frame's signals and selectors cover, byte 0 highest.
pub fn coverage(protocol: &Protocol, message: &Message, shape: &Shape) -> u64 {
    let signals = shape.signals.iter().map(|index| &message.signals[*index]).map(signal_mask);
    let selectors = shape.selectors.iter().filter_map(|index| match protocol.selectors[*index].place {
        SelectorPlace::Payload(place) => Some(u64::from_be_bytes(place.mask())),
        SelectorPlace::Identifier(_) => None,
    });
    signals.chain(selectors).fold(0, |mask, bits| mask | bits)
}

/// Returns the payload bits of a signal, byte 0 highest.
fn signal_mask(signal: &Signal) -> u64 {
    u64::from_be_bytes(signal.place.mask())
}
