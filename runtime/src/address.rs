//! Addressing modes: where a request goes, and who answers.

use core::ptr;

use crate::{Bits, Error};

/// A kind of address: a documented range of numbers, or a few numbers.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct AddressType {
    name: &'static str,
    first: i32,
    last: i32,
    only: &'static [i32],
    offset: i32,
    descending: bool,
    strict: bool,
    default: Option<i32>,
}

impl AddressType {
    /// Returns addresses from `first` to `last`, which are the values of the field.
    pub const fn new(name: &'static str, first: i32, last: i32) -> Self {
        Self { name, first, last, only: &[], offset: 0, descending: false, strict: false, default: None }
    }

    /// Documents only these numbers of the range.
    #[must_use]
    pub const fn only(self, only: &'static [i32]) -> Self {
        Self { only, ..self }
    }

    /// Adds the number of field value 0.
    #[must_use]
    pub const fn offset(self, offset: i32) -> Self {
        Self { offset, ..self }
    }

    /// Makes the field value fall while the number rises.
    #[must_use]
    pub const fn descending(self) -> Self {
        Self { descending: true, ..self }
    }

    /// Refuses numbers outside the range. They are then no addresses of this type.
    #[must_use]
    pub const fn strict(self) -> Self {
        Self { strict: true, ..self }
    }

    /// Adds the number that is sent unless the caller says otherwise.
    #[must_use]
    pub const fn default_number(self, number: i32) -> Self {
        Self { default: Some(number), ..self }
    }

    /// Returns the number that a field value stands for.
    pub const fn number(&self, raw: u32) -> i32 {
        let raw = raw as i32;
        self.offset.wrapping_add(if self.descending { raw.wrapping_neg() } else { raw })
    }

    /// Returns the field value that stands for a number.
    #[inline(always)]
    pub const fn raw(&self, number: i32) -> u32 {
        let raw = number.wrapping_sub(self.offset);
        (if self.descending { raw.wrapping_neg() } else { raw }) as u32
    }

    /// Tests whether the document names this number.
    #[inline(always)]
    pub const fn documents(&self, number: i32) -> bool {
        self.first <= number && number <= self.last && (self.only.is_empty() || has(self.only, number))
    }

    /// Returns the number that is sent unless the caller says otherwise.
    #[inline(always)]
    pub const fn sent_number(&self) -> i32 {
        match self.default {
            Some(number) => number,
            None => self.first,
        }
    }

    /// Returns the number that the caller chose, or the one that is sent otherwise. Generated code calls it.
    #[doc(hidden)]
    #[inline(always)]
    pub const fn chosen(&self, number: Option<i32>) -> i32 {
        match number {
            Some(number) => number,
            None => self.sent_number(),
        }
    }

    /// Tests whether such an address is sent unless the caller says otherwise, as that of a controller.
    pub(crate) const fn is_sent(&self) -> bool {
        self.default.is_some()
    }

    /// Tests whether this is the same kind of address.
    pub(crate) fn is(&self, other: &Self) -> bool {
        ptr::eq(self, other) || self == other
    }

    /// Refuses a number that the document does not name.
    #[inline(always)]
    pub(crate) const fn documented(&self, number: i32) -> Result<(), Error> {
        let Self { name: address, first, last, only, .. } = *self;
        match only {
            _ if self.documents(number) => Ok(()),
            [] => Err(Error::Address { address, number, first, last }),
            _ => Err(Error::UnnamedAddress { address, number }),
        }
    }
}

/// Tests whether a number is one of some.
const fn has(mut numbers: &[i32], number: i32) -> bool {
    while let [first, rest @ ..] = numbers {
        if *first == number {
            return true;
        }
        numbers = rest;
    }
    false
}

/// A field of the identifier that holds an address.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Address {
    bits: Bits,
    kind: &'static AddressType,
    excluded: &'static [(u32, u32)],
}

impl Address {
    /// Returns an address in these bits of the identifier.
    pub const fn new(bits: Bits, kind: &'static AddressType) -> Self {
        Self { bits, kind, excluded: &[] }
    }

    /// Adds inclusive ranges of field values that are no such address.
    #[must_use]
    pub const fn excluding(self, excluded: &'static [(u32, u32)]) -> Self {
        Self { excluded, ..self }
    }

    /// Returns the field.
    pub(crate) const fn bits(&self) -> Bits {
        self.bits
    }

    /// Returns the kind of address.
    pub(crate) const fn kind(&self) -> &'static AddressType {
        self.kind
    }

    #[inline(always)]
    pub(crate) fn number(&self, id: u32) -> i32 {
        self.kind.number(self.bits.of(id))
    }

    #[inline(always)]
    pub(crate) fn is_documented(&self, id: u32) -> bool {
        self.kind.documents(self.number(id))
    }

    #[inline(always)]
    pub(crate) fn is_tolerated(&self, id: u32) -> bool {
        let raw = self.bits.of(id);
        !self.kind.strict && !self.excluded.iter().any(|(first, last)| (*first..=*last).contains(&raw))
    }
}

/// Constants and addresses that an identifier must show.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Pattern {
    /// Fields of the identifier and what they must be.
    pub constants: &'static [(Bits, u32)],
    /// Fields of the identifier that hold an address.
    pub addresses: &'static [Address],
}

impl Pattern {
    /// Tests an identifier: `Some(true)` with documented addresses, `Some(false)` with tolerated ones.
    fn fit(&self, id: u32) -> Option<bool> {
        if self.constants.iter().any(|(bits, value)| bits.of(id) != *value) {
            return None;
        }
        let is_documented = self.addresses.iter().all(|address| address.is_documented(id));
        let mut addresses = self.addresses.iter();
        let is_fit = is_documented || addresses.all(|address| address.is_documented(id) || address.is_tolerated(id));
        is_fit.then_some(is_documented)
    }
}

/// An addressing mode: what the identifiers of requests and replies look like.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Mode {
    /// Name of the mode.
    pub name: &'static str,
    /// The kind of address that a caller chooses.
    pub target: Option<&'static AddressType>,
    /// Identifier of the request.
    pub request: Option<Pattern>,
    /// Identifier of the reply if the addressed module answers.
    pub one: Option<Pattern>,
    /// Identifier of the replies if each addressed module answers.
    pub each: Option<Pattern>,
    /// Identifier of the reply if one module answers for all.
    pub coordinator: Option<Pattern>,
}

/// Who answers a request.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize), serde(rename_all = "snake_case"))]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub enum Who {
    /// The module addressed.
    One,
    /// Each module addressed.
    Each,
    /// One module for all.
    Coordinator,
    /// Nobody.
    Nobody,
}

/// What a frame is for.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize), serde(rename_all = "snake_case"))]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub enum Kind {
    /// Goes to a module, to read or to set.
    Request,
    /// Goes to the controller, echoes and failures included.
    Reply,
    /// Sent unasked.
    Report,
}

impl Mode {
    pub(crate) const fn reply(&self, who: Who) -> Option<&Pattern> {
        match who {
            Who::One => self.one.as_ref(),
            Who::Each => self.each.as_ref(),
            Who::Coordinator => self.coordinator.as_ref(),
            Who::Nobody => None,
        }
    }

    /// Returns the patterns of frames that go to a module or to the controller. Those to the controller have a
    /// sender.
    fn patterns(&self, is_to_module: bool) -> [(Option<Who>, Option<&Pattern>); 3] {
        if is_to_module {
            [(None, self.request.as_ref()), (None, None), (None, None)]
        } else {
            [Who::One, Who::Each, Who::Coordinator].map(|who| (Some(who), self.reply(who)))
        }
    }
}

/// The addressing mode that an identifier shows.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Addressing {
    rank: Rank,
    mode: &'static Mode,
    pattern: &'static Pattern,
}

/// How well a mode fits. First counts whether the message has it, then documented addresses, then
/// the number of constants.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub(crate) struct Rank {
    is_offered: bool,
    is_documented: bool,
    constants: usize,
}

impl Addressing {
    /// Finds the mode that fits best. `answers` says who answers in each mode.
    pub(crate) fn find(modes: &'static [Mode], answers: &[Option<Who>], is_to_module: bool, id: u32) -> Option<Self> {
        let fitting = modes.iter().zip(answers).flat_map(|(mode, answer)| {
            mode.patterns(is_to_module).into_iter().filter_map(move |(who, pattern)| {
                let is_offered = if who.is_none() { answer.is_some() } else { *answer == who };
                let pattern = pattern?;
                let rank = Rank { is_offered, is_documented: pattern.fit(id)?, constants: pattern.constants.len() };
                Some(Self { rank, mode, pattern })
            })
        });
        fitting.reduce(|best, next| if next.rank > best.rank { next } else { best })
    }

    /// Returns the number of a kind of address, if the mode shows one.
    pub(crate) fn number(&self, kind: &AddressType, id: u32) -> Option<i32> {
        self.pattern.addresses.iter().find(|address| address.kind.is(kind)).map(|address| address.number(id))
    }

    /// Returns where the identifier has addresses.
    pub(crate) const fn addresses(&self) -> &'static [Address] {
        self.pattern.addresses
    }

    /// Returns the mode.
    pub const fn mode(&self) -> &'static Mode {
        self.mode
    }

    /// Tests whether the message travels in this mode.
    pub const fn is_offered(&self) -> bool {
        self.rank.is_offered
    }

    /// Tests whether the document names every address.
    pub const fn is_documented(&self) -> bool {
        self.rank.is_documented
    }

    pub(crate) const fn rank(&self) -> Rank {
        self.rank
    }

    /// Refuses addresses that the document does not name.
    pub(crate) fn documented(&self, id: u32) -> Result<(), Error> {
        self.pattern.addresses.iter().try_for_each(|address| address.kind.documented(address.number(id)))
    }
}

#[cfg(test)]
mod tests {
    use std::string::ToString;

    use super::*;

    #[test]
    fn only_single_numbers_are_documented_if_a_type_has_some() {
        let host = AddressType::new("host", 0x20, 0x60).only(&[0x20, 0x40, 0x60]);
        let documented = [0x1F, 0x20, 0x21, 0x40, 0x41, 0x60, 0x61].map(|number| host.documented(number).is_ok());
        assert_eq!(documented, [false, true, false, true, false, true, false]);
        let refused = host.documented(0x30).expect_err("a number without a name");
        assert_eq!(refused.to_string(), "`host` is 0x30, which has no name");
        let module = AddressType::new("module", 1, 3);
        let refused = module.documented(4).expect_err("a number outside the range");
        assert_eq!(refused.to_string(), "`module` is 0x04, but its limits are 0x01..=0x03");
    }
}
