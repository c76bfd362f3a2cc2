//! What a decoded frame has that its document does not expect.

use super::fit::{Addressing, Candidate, Decoder, Fit};
use super::{Note, hexadecimal, hexadecimal_ranges};
use crate::model::{FrameId, FrameLayout, Message, NoteRule, SelectorId, first_bytes};
use crate::words::hex;

impl<'a> Decoder<'a, '_> {
    /// Says that the number of a part means nothing without the device model.
    pub fn part_note(&self, message: &Message) -> Option<Note> {
        let (_, long) = self.protocol.long_message(message)?;
        long.first(self.model).is_none().then(|| {
            let text = format!("the first part of `{}` has another number on each model", message.name);
            Note { rule: NoteRule::ModelDependent, text }
        })
    }

    /// Says that the device model has no such message, or that the frame may be another message on another model.
    pub fn model_note(&self, best: Candidate, frames: &'a [FrameId]) -> Option<Note> {
        let message = self.message(best);
        let text = match self.model {
            Some(model) if message.is_of(model) => return None,
            Some(model) => format!("{} has no message `{}`", self.protocol[model].name, message.name),
            None if message.models.is_empty() || frames.len() < 2 => return None,
            None => {
                let rank = self.rank(&best);
                let is_equal = |other: &Candidate| {
                    message.is_apart_from(&self.protocol[other.1.message]) && self.rank(other) == rank
                };
                let others = self.candidates(frames).filter(is_equal).map(|(_, other)| other.message);
                let mut others: Vec<_> = others.collect();
                others.dedup();
                others.first()?;
                let texts: Vec<_> = others.into_iter().map(|other| self.of_models(&self.protocol[other])).collect();
                format!("it is {}", texts.join(", and "))
            }
        };
        Some(Note { rule: NoteRule::ModelDependent, text })
    }

    /// Names a message and the device models that have it.
    fn of_models(&self, message: &Message) -> String {
        let models = message.models.iter().map(|model| self.protocol[*model].name.as_str());
        format!("`{}` if the model is {}", message.name, models.collect::<Vec<_>>().join(" or "))
    }

    /// Notes bits that nothing covers, if they are not as they are sent.
    pub fn reserved_note(&self, frame: &FrameLayout, reserved: [u8; 8]) -> Option<Note> {
        let present = first_bytes(u8::try_from(self.frame.data.len()).unwrap_or(8));
        let odd = u64::from_be_bytes(reserved) ^ frame.filled() & present;
        (odd != 0 && !frame.reserved.are_free).then(|| {
            let found = if frame.reserved.are_ones { "clear" } else { "set" };
            let bits = hex::digits(&odd.to_be_bytes()[..self.frame.data.len()]);
            let text = format!("bits are {found} that no field has: 0x{bits}");
            Note { rule: NoteRule::ReservedBit, text }
        })
    }

    pub fn error_notes(&self, notes: &mut Vec<Note>, frame: &FrameLayout, selectors: &[(SelectorId, u64)]) {
        let fields = self.protocol.identifier.fields.iter().filter_map(|field| {
            let normal = u64::from(field.normal?);
            Some((&field.name, field.get(self.frame.id).into(), normal, field.enumeration))
        });
        let payload = selectors.iter().filter(|_| !frame.is_to_module()).filter_map(|(id, value)| {
            let selector = &self.protocol[*id];
            Some((&selector.name, *value, selector.normal?, selector.enumeration))
        });
        for (name, value, _, enumeration) in fields.chain(payload).filter(|(_, value, normal, _)| value != normal) {
            let named = enumeration.and_then(|id| self.protocol[id].named(value));
            let text = match named {
                Some(meaning) => format!("{name} {value}: {}", meaning.name),
                None => format!("{name} {value}, which the document does not name"),
            };
            notes.push(Note { rule: NoteRule::ErrorCode, text });
        }
    }

    pub fn address_notes(
        &self,
        notes: &mut Vec<Note>,
        message: &Message,
        frame: &FrameLayout,
        addressing: &Addressing,
    ) {
        let Some((travel, pattern)) = addressing.travel else {
            let text = format!("no addressing mode of this protocol fits a {}", frame.kind.name());
            return notes.push(Note { rule: NoteRule::Addressing, text });
        };
        if addressing.fit >= Fit::DocumentedElsewhere {
            let text = format!("`{}` is not addressed by `{}`", message.name, self.protocol[travel.mode].name);
            notes.push(Note { rule: NoteRule::Addressing, text });
        }
        let addresses = if addressing.fit == Fit::Documented { &[][..] } else { &pattern.addresses };
        for address in addresses {
            let address_type = &self.protocol[address.address_type];
            let raw = self.field(address.field);
            if !address_type.documents(raw) {
                let field = &self.protocol[address.field].name;
                let ranges = hexadecimal_ranges(&address_type.raw_ranges());
                let text = format!("{field} {} is outside {ranges} of `{}`", hexadecimal(raw), address_type.name);
                notes.push(Note { rule: NoteRule::Address, text });
            }
        }
    }
}
