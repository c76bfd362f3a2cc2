//! Addresses, addressing modes, and how an identifier shows its direction.

use serde::{Deserialize, Serialize};

use crate::model::{AddressTypeId, Doc, FieldId, FrameLayout, IdentifierField, ModeId, Table, Who};

/// A kind of address: a range of numbers in a field of the identifier, or a few numbers with names.
#[derive(Clone, Debug, Serialize, Deserialize)]
#[non_exhaustive]
pub struct AddressType {
    /// Name in the spec, in `snake_case`.
    pub name: String,
    /// What the spec says beside it.
    pub doc: Doc,
    /// First number that the document names.
    pub first: i64,
    /// Last number that the document names.
    pub last: i64,
    /// The only numbers that the document names, in rising order, with their names. If there are
    /// none, it names all from the first to the last.
    pub names: Vec<(i64, String)>,
    /// Number of raw 0.
    pub offset: i64,
    /// Step of the number from one raw value to the next, 1 or -1: raw = (number - offset) * sign.
    pub sign: i64,
    /// A number that the document does not name is no address of this type, not even an undocumented one.
    pub strict: bool,
    /// Number sent unless the caller says otherwise.
    pub send: Option<i64>,
}

impl AddressType {
    /// Returns the raw value of an address number.
    pub fn raw(&self, number: i64) -> i64 {
        (number - self.offset) * self.sign
    }

    /// Returns the address number of a raw value.
    pub fn number(&self, raw: u32) -> i64 {
        i64::from(raw) * self.sign + self.offset
    }

    /// Returns the documented raw values as inclusive ranges, in rising order.
    pub fn raw_ranges(&self) -> Vec<(u32, u32)> {
        let raw = |number| u32::try_from(self.raw(number)).unwrap_or(0);
        if self.names.is_empty() {
            let (one, other) = (raw(self.first), raw(self.last));
            return vec![(one.min(other), one.max(other))];
        }
        let mut ranges: Vec<_> = self.names.iter().map(|(number, _)| (raw(*number), raw(*number))).collect();
        ranges.sort_unstable();
        ranges
    }

    /// Tests whether the document names this raw value.
    pub fn documents(&self, raw: u32) -> bool {
        self.has(self.number(raw))
    }

    /// Tests whether the document names this number.
    pub fn has(&self, number: i64) -> bool {
        let is_named = self.names.is_empty() || self.names.iter().any(|(known, _)| *known == number);
        is_named && (self.first..=self.last).contains(&number)
    }

    /// Returns the number with this name.
    pub fn named(&self, name: &str) -> Option<i64> {
        self.names.iter().find(|(_, known)| known == name).map(|(number, _)| *number)
    }

    /// Returns the key that says which numbers the document names.
    pub fn key(&self) -> &'static str {
        if self.names.is_empty() { "range" } else { "values" }
    }
}

/// An addressing mode.
#[derive(Clone, Debug, Serialize, Deserialize)]
#[non_exhaustive]
pub struct Mode {
    /// Name in the spec, in `snake_case`.
    pub name: String,
    /// What the spec says beside it.
    pub doc: Doc,
    /// What the identifier of a request shows.
    pub request: Option<AddressPattern>,
    /// What the identifier of a reply or report shows if the one addressed module sends it.
    pub one: Option<AddressPattern>,
    /// What the identifier of a reply or report shows if each addressed module sends one.
    pub each: Option<AddressPattern>,
    /// What the identifier of a reply or report shows if one module sends it for all.
    pub coordinator: Option<AddressPattern>,
    /// The address type that the caller chooses in a request.
    pub target: Option<AddressTypeId>,
}

impl Mode {
    /// Returns the pattern of the replies when `who` answers.
    pub fn reply(&self, who: Who) -> Option<&AddressPattern> {
        match who {
            Who::One => self.one.as_ref(),
            Who::Each => self.each.as_ref(),
            Who::Coordinator => self.coordinator.as_ref(),
            Who::Nobody => None,
        }
    }

    /// Returns the pattern of frames that go to a module, or of those that `who` sends to the controller.
    pub fn pattern(&self, is_to_module: bool, who: Who) -> Option<&AddressPattern> {
        if is_to_module { self.request.as_ref() } else { self.reply(who) }
    }
}

/// A way through an addressing mode.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[non_exhaustive]
pub struct Way {
    /// The mode.
    pub mode: ModeId,
    /// Who sends frames to the controller; `None` for frames that go to a module.
    pub sender: Option<Who>,
}

impl Way {
    /// Returns the ways through some modes, with their patterns.
    pub(crate) fn all(modes: &Table<ModeId, Mode>) -> impl Iterator<Item = (Self, &AddressPattern)> {
        let senders = [None, Some(Who::One), Some(Who::Each), Some(Who::Coordinator)];
        let ways = modes.ids().flat_map(move |mode| senders.map(|sender| Self { mode, sender }));
        ways.filter_map(|way| Some((way, way.pattern(&modes[way.mode])?)))
    }

    /// Returns what the identifier shows.
    pub(crate) fn pattern(self, mode: &Mode) -> Option<&AddressPattern> {
        mode.pattern(self.is_to_module(), self.sender.unwrap_or(Who::Nobody))
    }

    /// Returns the key of the spec language.
    pub(crate) fn key(self) -> &'static str {
        match self.sender {
            None | Some(Who::Nobody) => "request",
            Some(Who::One) => "one",
            Some(Who::Each) => "each",
            Some(Who::Coordinator) => "coordinator",
        }
    }

    /// Tests whether its frames go to a module.
    pub fn is_to_module(self) -> bool {
        self.sender.is_none()
    }

    /// Tests whether a frame is sent so.
    pub(crate) fn has(self, frame: &FrameLayout) -> bool {
        let is_its_own = |sender| frame.travels.iter().any(|own| own.mode == self.mode && sender == own.who);
        match self.sender {
            None => frame.is_to_module() && frame.travels.iter().any(|own| own.mode == self.mode),
            Some(sender) => !frame.is_to_module() && is_its_own(sender),
        }
    }
}

/// Constants and addresses that an identifier must show.
#[derive(Clone, Debug, Default, Serialize, Deserialize)]
#[non_exhaustive]
pub struct AddressPattern {
    /// Bits of the identifier that are constant.
    pub mask: u32,
    /// Values of these bits.
    pub value: u32,
    /// How many fields the constants cover.
    pub constants: usize,
    /// Fields that hold addresses.
    pub addresses: Vec<Address>,
}

impl AddressPattern {
    /// Tests whether a field of the identifier holds one of the constants or addresses.
    pub fn fixes(&self, field: &IdentifierField, fields: &Table<FieldId, IdentifierField>) -> bool {
        let mut addresses = self.addresses.iter();
        self.mask & field.mask() != 0 || addresses.any(|address| fields[address.field].shift == field.shift)
    }
}

/// A field of the identifier that holds an address.
#[derive(Clone, Debug, Serialize, Deserialize)]
#[non_exhaustive]
pub struct Address {
    /// The field.
    pub field: FieldId,
    /// The kind of address.
    pub address_type: AddressTypeId,
    /// Raw ranges that belong to other types or modes. Other undocumented values are tolerated,
    /// unless the type is strict.
    pub excluded: Vec<(u32, u32)>,
}

/// How an identifier shows its direction.
#[derive(Clone, Debug, Default, Serialize, Deserialize)]
#[non_exhaustive]
pub struct Direction {
    /// Lists of tests. The identifier shows the direction if all tests of one list hold.
    pub any: Vec<Vec<FieldTest>>,
}

/// A test of one identifier field.
#[derive(Clone, Debug, PartialEq, Eq, Hash, Serialize, Deserialize)]
#[non_exhaustive]
pub struct FieldTest {
    /// The field.
    pub field: FieldId,
    /// Inclusive raw ranges.
    pub ranges: Vec<(u32, u32)>,
    /// The value must lie in one of the ranges. Otherwise it must lie in none.
    pub inside: bool,
}

impl FieldTest {
    /// Makes a test for one value.
    pub(crate) fn constant(field: FieldId, value: u32) -> Self {
        Self { field, ranges: vec![(value, value)], inside: true }
    }

    /// Tests whether a value of the field passes.
    pub fn holds(&self, value: u32) -> bool {
        self.ranges.iter().any(|(first, last)| (*first..=*last).contains(&value)) == self.inside
    }

    /// Tests whether no value that lies inside passes both tests of one field.
    fn excludes(&self, other: &Self) -> bool {
        let apart = |(first, last): &(u32, u32), (start, end): &(u32, u32)| last < start || end < first;
        let contains = |(first, last): &(u32, u32), (start, end): &(u32, u32)| first <= start && end <= last;
        self.field == other.field
            && self.inside
            && self.ranges.iter().all(|range| {
                if other.inside {
                    other.ranges.iter().all(|opposite| apart(range, opposite))
                } else {
                    other.ranges.iter().any(|opposite| contains(opposite, range))
                }
            })
    }
}

/// Tests whether no identifier passes both lists of tests.
pub(crate) fn exclude(tests: &[FieldTest], others: &[FieldTest]) -> bool {
    tests.iter().any(|test| others.iter().any(|other| test.excludes(other) || other.excludes(test)))
}
