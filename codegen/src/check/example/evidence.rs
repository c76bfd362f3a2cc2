//! What examples say about fields.
//!
//! An example says everything twice, by its bytes and by its meaning. One slip of its writer leaves
//! the two one digit apart. If they are further apart, or several examples contradict a field, the
//! field is probably wrong.

use indexmap::IndexMap;

use super::shown;
use crate::interpret::{Frame, decode};
use crate::model::{Meaning, MessageId, Protocol, Signal, SignalId, StatusBit};
use crate::report::diagnostic::{At, Diagnostic, Diagnostics};
use crate::report::tree::{Content, Path};
use crate::resolve::rules;

/// What one example says about a field.
pub struct Evidence<'a> {
    /// What its meaning says.
    pub meaning: &'a Meaning,
    /// Its bytes.
    pub data: [u8; 8],
    /// Its bits that no field holds.
    reserved: [u8; 8],
    /// The field's bits in these bytes.
    bits: u64,
    /// Whether these bits mean what the example says.
    agrees: bool,
    /// The value of these bits as text.
    pub read: String,
}

impl Evidence<'_> {
    /// Tests whether one digit of the frame separates bytes and meaning. Set bits that no field
    /// holds count as well.
    pub fn is_slip(&self, signal: &Signal) -> bool {
        let Some(raw) = self.meaning.bits() else { return false };
        digits_apart(signal, self.data, raw) + nibbles(self.reserved).filter(|nibble| *nibble != 0).count() <= 1
    }
}

/// Counts the digits of a frame that another value of a signal changes.
pub fn digits_apart(signal: &Signal, data: [u8; 8], raw: u64) -> usize {
    let mut said = data;
    signal.place.put(&mut said, raw);
    nibbles(said).zip(nibbles(data)).filter(|(one, other)| one != other).count()
}

/// Reports that an example names an unknown bit, while its frame sets a bit without a name.
pub fn missing_bit(denial: &Evidence, bits: &[StatusBit]) -> Option<Diagnostic> {
    let names = denial.meaning.text.trim_matches(['[', ']']).split(", ").filter(|name| !name.is_empty());
    let number = |name: &str| {
        let known = bits.iter().find(|bit| bit.name == name).map(|bit| bit.bit);
        known.or_else(|| name.parse().ok().filter(|number| *number < 64))
    };
    let mut unknown = names.clone().filter(|name| number(name).is_none());
    let (name, None) = (unknown.next()?, unknown.next()) else { return None };
    let said = names.filter_map(number).fold(0, |mask, bit| mask | 1 << bit);
    let surplus = denial.bits ^ said;
    let number = surplus.trailing_zeros();
    if !surplus.is_power_of_two() || bits.iter().any(|bit| u32::from(bit.bit) == number) {
        return None;
    }
    let below = bits.iter().rfind(|bit| u32::from(bit.bit) < number).or(bits.first())?;
    let text = format!("bit {number} has no name here, but an example has it as `{name}`");
    let help = format!("add `{name}: {{bit: {number}}}`, or correct the example");
    let diagnostic = Diagnostic::error(&rules::EXAMPLE, below.doc.path.at_key(), text).help(help);
    Some(
        diagnostic.other(
            denial.meaning.path.at_key(),
            format!("according to the status word, this frame says {}", denial.read),
        ),
    )
}

fn nibbles(data: [u8; 8]) -> impl Iterator<Item = u8> {
    data.into_iter().flat_map(|byte| [byte >> 4, byte & 0xF])
}

/// Collects what examples say about each field, by message and signal. Only examples that must hold
/// count.
pub fn collect(protocol: &Protocol) -> IndexMap<(MessageId, SignalId), Vec<Evidence<'_>>> {
    let mut fields: IndexMap<_, Vec<_>> = IndexMap::new();
    for example in protocol.examples.iter().filter(|example| example.fails.is_none() && example.data.is_some()) {
        let frame = Frame::of(protocol, example);
        let Ok(decoded) = decode(protocol, example.model, &frame) else { continue };
        let data = frame.padded();
        for meaning in example.means.iter().filter(|_| example.message == Some(decoded.message)) {
            let Some(reading) = decoded.signals.iter().find(|reading| reading.signal == meaning.signal) else {
                continue;
            };
            let signal = &protocol.messages[decoded.message].signals[meaning.signal];
            // Each device model has a scale of its own, so its examples say nothing of the others.
            if !signal.encoding.by_model().is_empty() {
                continue;
            }
            let (bits, read) = (reading.bits, shown(protocol, signal, reading));
            fields.entry((decoded.message, meaning.signal)).or_default().push(Evidence {
                meaning,
                data,
                reserved: decoded.reserved,
                bits,
                agrees: meaning.is(signal, bits),
                read,
            });
        }
    }
    fields
}

/// Finds the place of a key in the field of a signal, or else in one of its types.
pub fn written(signal: &Signal, key: &str, diagnostics: &Diagnostics) -> Option<Path> {
    let types = Path::default().key("types");
    let own = std::iter::once(signal.doc.path.clone());
    let mut sources = own.chain(signal.types.iter().map(|name| types.key(name)));
    sources.find_map(|source| Some(source.key(key)).filter(|path| diagnostics.has(path)))
}

/// A field and what the examples say about it.
pub struct Field<'a> {
    /// The names of its message and of itself.
    pub name: String,
    pub signal: &'a Signal,
    pub evidence: &'a [Evidence<'a>],
    /// Bits that its frames use for other fields, or do not have, byte 0 highest.
    pub taken: u64,
}

impl<'a> Field<'a> {
    pub fn new(protocol: &'a Protocol, message: MessageId, id: SignalId, evidence: &'a [Evidence<'a>]) -> Self {
        let message = &protocol[message];
        let signal = &message[id];
        let carrying = protocol.frames_of(message).filter(|frame| frame.signals.contains(&id));
        let others = carrying.map(|frame| frame.covered & !u64::from_be_bytes(signal.place.mask()));
        let behind = u64::MAX.checked_shr(8 * u32::from(message.longest())).unwrap_or(0);
        let taken = others.fold(behind, |taken, bits| taken | bits);
        Self { name: format!("{}.{}", message.name, signal.name), signal, evidence, taken }
    }

    pub fn denials(&self) -> impl Iterator<Item = &'a Evidence<'a>> + use<'a> {
        self.evidence.iter().filter(|evidence| !evidence.agrees)
    }

    /// Tests whether an example agrees in bits that count.
    pub fn is_borne_out(&self, counts: impl Fn(u64) -> bool) -> bool {
        self.evidence.iter().any(|evidence| evidence.agrees && counts(evidence.bits))
    }

    /// Finds the place of a key in the field, or else in one of its types.
    pub fn written(&self, key: &str, diagnostics: &Diagnostics) -> Option<Path> {
        written(self.signal, key, diagnostics)
    }

    /// Reports that the frame sets a bit without a name in place of the one that the example names.
    pub fn moved_bit(&self, denial: &Evidence, bits: &[StatusBit]) -> Option<Diagnostic> {
        let said = denial.meaning.bits()?;
        let (missing, surplus) = (said & !denial.bits, denial.bits & !said);
        let is_moved = missing.is_power_of_two() && surplus.is_power_of_two();
        let has_name = |bit: u32| bits.iter().any(|known| u32::from(known.bit) == bit);
        if !is_moved || has_name(surplus.trailing_zeros()) || self.is_borne_out(|bits| bits & missing != 0) {
            return None;
        }
        let bit = bits.iter().find(|bit| 1 << bit.bit == missing)?;
        let text = format!(
            "`{}` is bit {} here, but an example has it as bit {}",
            bit.name,
            bit.bit,
            surplus.trailing_zeros()
        );
        let at = bit.doc.path.key("bit").at_value();
        Some(Diagnostic::error(&rules::EXAMPLE, at, text).help("correct the bit, or else the example").other(
            denial.meaning.path.at_key(),
            format!("according to the status word, this frame says {}", denial.read),
        ))
    }

    /// Reports that the frame has a number without a name where the example has a name.
    pub fn misnumbered(&self, denial: &Evidence, diagnostics: &Diagnostics) -> Option<Diagnostic> {
        let raw = denial.meaning.bits()?;
        let at = self.written("values", diagnostics)?;
        let Content::Map(values) = &diagnostics.tree()?.get(&at)?.content else { return None };
        let name = Content::Text(denial.meaning.text.clone());
        let (number, _) = values.iter().find(|(_, entry)| entry.value.content == name)?;
        let read = Content::Text(denial.read.clone());
        if values.values().any(|entry| entry.value.content == read) || self.is_borne_out(|bits| bits == raw) {
            return None;
        }
        let text = format!("`{}` is {number} here, but an example has it as {}", denial.meaning.text, denial.bits);
        let diagnostic = Diagnostic::error(&rules::EXAMPLE, At::Key(at.key(number)), text);
        let shown = format!("according to these names, this frame says {}", denial.read);
        Some(diagnostic.help("correct the number, or else the example").other(denial.meaning.path.at_value(), shown))
    }
}
