//! Signals and what their bits mean.

use serde::{Deserialize, Serialize};

use canspec_runtime::Place;

use crate::model::{DeviceModel, Doc, Element, Encoding, Kind, Limit, ModelId, Table, Unit, only, place};
use crate::report::tree::Path;
use crate::words::number::Rational;
use crate::words::text::Text;

/// Named values of a signal.
#[derive(Clone, Debug, Serialize, Deserialize)]
#[non_exhaustive]
pub struct Enumeration {
    /// Name of the type, in `snake_case`.
    pub name: String,
    /// What the spec says beside it.
    pub doc: Doc,
    /// Width of the raw value in bits.
    pub width: u8,
    /// Named values in the order of the spec.
    pub values: Vec<NamedValue>,
    /// Whether the last of them says that there is no value.
    pub has_absent: bool,
}

impl Enumeration {
    /// Returns the value that says that there is none.
    pub fn absent(&self) -> Option<&NamedValue> {
        self.values.last().filter(|_| self.has_absent)
    }

    /// Finds the named value of raw bits.
    pub fn named(&self, bits: u64) -> Option<&NamedValue> {
        self.values.iter().find(|value| value.raw == i128::from(bits))
    }
}

/// A raw value with a name.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[non_exhaustive]
pub struct NamedValue {
    /// Raw value, sign-extended if the signal is signed.
    pub raw: i128,
    /// Name in the spec, in `snake_case`.
    pub name: String,
    /// What it is, in a few words.
    pub title: Option<Text>,
    /// The only device models that have it; empty if every model has it.
    pub models: Vec<ModelId>,
    /// Place of that list in the spec.
    pub models_path: Path,
}

impl NamedValue {
    /// Returns its name for people, with its title, and the device models if only some have it.
    pub fn text(&self, models: &Table<ModelId, DeviceModel>) -> String {
        let title = self.title.as_ref().map(|title| title.for_people().to_owned());
        let remarks: Vec<_> = title.into_iter().chain(only(models, &self.models)).collect();
        if remarks.is_empty() { self.name.clone() } else { format!("{} ({})", self.name, remarks.join(", ")) }
    }

    /// Tests whether a device model has the value.
    pub fn is_of(&self, model: ModelId) -> bool {
        self.models.is_empty() || self.models.contains(&model)
    }
}

/// A word whose named bits are conditions.
#[derive(Clone, Debug, Serialize, Deserialize)]
#[non_exhaustive]
pub struct StatusWord {
    /// Name of the type, in `snake_case`.
    pub name: String,
    /// What the spec says beside it.
    pub doc: Doc,
    /// Number of bits, `1..=64`.
    pub width: u8,
    /// Bits by number, the lowest first.
    pub bits: Vec<StatusBit>,
}

impl StatusWord {
    /// Returns the named bits that a signal of this type has at a place, the lowest first. A narrower signal has
    /// fewer.
    pub fn bits_in(&self, place: Place) -> impl DoubleEndedIterator<Item = &StatusBit> + Clone {
        self.bits.iter().filter(move |bit| bit.bit < place.width())
    }
}

impl StatusBit {
    /// Tests whether a device model has the bit.
    pub fn is_of(&self, model: ModelId) -> bool {
        self.models.is_empty() || self.models.contains(&model)
    }
}

impl StatusWord {
    /// Returns the bits that have a name.
    pub fn known(&self) -> u64 {
        self.bits.iter().fold(0, |mask, bit| mask | 1 << bit.bit)
    }
}

/// One bit of a status word.
#[derive(Clone, Debug, Serialize, Deserialize)]
#[non_exhaustive]
pub struct StatusBit {
    /// Name in the spec, in `snake_case`.
    pub name: String,
    /// What the spec says beside it.
    pub doc: Doc,
    /// Number of the bit, 0 = least significant.
    pub bit: u8,
    /// Whether the spec counts it in its byte of the frame, and not in the word.
    pub is_by_byte: bool,
    /// Severity of the set bit, if the document says it.
    pub severity: Option<Severity>,
    /// Condition that sets the bit.
    pub set_when: Option<Text>,
    /// Condition that clears the bit.
    pub clear_when: Option<Text>,
    /// What the device does while the bit is set.
    pub effect: Option<Text>,
    /// What the device's LED shows while the bit is set.
    pub led: Option<Text>,
    /// The only device models that have it; empty if every model has it.
    pub models: Vec<ModelId>,
}

/// The severity of a status bit.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub enum Severity {
    /// Describes a condition.
    State,
    /// A warning from which the device recovers.
    Alarm,
    /// A defect.
    Fault,
}

/// A named value in the data bytes.
#[derive(Clone, Debug, Serialize, Deserialize)]
#[non_exhaustive]
pub struct Signal {
    /// Name in the spec, in `snake_case`.
    pub name: String,
    /// What the spec says beside it.
    pub doc: Doc,
    /// The entries of `types` that it takes keys from, the last first.
    pub types: Vec<String>,
    /// How many data bytes of a long message come before the eight that `place` counts. It is 0 in a frame.
    pub window: u16,
    /// Bits of the data bytes. Of a run it is the first byte.
    #[serde(with = "place")]
    pub place: Place,
    /// The whole bytes whose bits the spec counts: those of the word around it, or else its own. They have the window
    /// and the byte order of `place`.
    #[serde(with = "place")]
    pub word: Place,
    /// How many bytes it takes from its window on, if it is a text that no place can hold.
    pub run: Option<ByteRun>,
    /// What these bits mean.
    pub encoding: Encoding,
    /// Unit of the physical value.
    pub unit: Option<Unit>,
    /// Physical limits.
    pub range: Option<Range>,
    /// Place of the limits in the spec: of the signal itself or of one of its types.
    pub range_path: Path,
    /// Named raw values that are legal outside the range.
    pub specials: Vec<NamedValue>,
    /// Whether the last of the special values says that there is no value.
    pub has_absent: bool,
    /// Raw value that the device starts with.
    pub default: Option<i128>,
    /// Place of that value in the spec.
    pub default_path: Path,
    /// Physical limits of device models, if they have their own.
    pub model_ranges: Vec<OfModel<Range>>,
    /// The limit of the product that requests keep to, if it has one for the signal's quantity.
    pub limit: Option<Limit>,
    /// Raw values that device models start with, if they have their own.
    pub model_defaults: Vec<OfModel<i128>>,
    /// What a device does with the value.
    pub conduct: Conduct,
    /// The only kinds of frames that have it; empty if the access decides.
    pub kinds: Vec<Kind>,
    /// The only device models that have it; empty if every model has it.
    pub models: Vec<ModelId>,
    /// The array of the message that it is an element of.
    pub element: Option<Element>,
}

/// What a device does with a value that it is told, as far as the document says it.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[non_exhaustive]
pub struct Conduct {
    /// What it does with a value outside the range.
    pub out_of_range: Option<OutOfRange>,
    /// It keeps the value without power.
    pub keeps: Option<bool>,
}

/// What a device does with a value outside the range.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub enum OutOfRange {
    /// It answers the request with an error.
    Refused,
    /// It goes on with the value before.
    Ignored,
    /// It takes the nearest value inside.
    Limited,
}

/// The number of whole bytes that a text takes, if they are more than eight or may vary.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[non_exhaustive]
pub struct ByteRun {
    /// The least number.
    pub least: u16,
    /// The greatest number.
    pub most: u16,
}

impl ByteRun {
    /// Tests whether the number varies.
    pub fn varies(self) -> bool {
        self.least < self.most
    }
}

/// A value that a device model has of its own.
#[derive(Clone, Debug, Serialize, Deserialize)]
#[non_exhaustive]
pub struct OfModel<T> {
    /// The model.
    pub model: ModelId,
    /// The value.
    pub value: T,
    /// Place in the spec.
    pub path: Path,
}

impl Signal {
    /// Tests whether a device model has the signal.
    pub fn is_of(&self, model: ModelId) -> bool {
        self.models.is_empty() || self.models.contains(&model)
    }

    /// Returns the signal as a device model has it, if its scale depends on the model.
    #[inline]
    pub fn on(&self, model: Option<ModelId>) -> &Self {
        let own = self.encoding.by_model().iter().find(|own| Some(own.model) == model);
        own.map_or(self, |own| &own.value)
    }

    /// Changes the signal, and what it is on each device model.
    #[must_use]
    pub(crate) fn changed(mut self, change: impl Fn(&mut Self)) -> Self {
        change(&mut self);
        if let Encoding::ByModel { signals, .. } = &mut self.encoding {
            for own in signals {
                change(&mut own.value);
            }
        }
        self
    }

    /// Returns what the signal is on each device model if its scale depends on the model, or else the signal.
    pub fn on_each(&self) -> impl Iterator<Item = &Self> {
        let own = self.encoding.by_model();
        own.is_empty().then_some(self).into_iter().chain(own.iter().map(|own| &own.value))
    }

    /// Returns the physical limits that a device model states, or else those of the type.
    pub fn range_for(&self, model: Option<ModelId>) -> Option<Range> {
        own(&self.model_ranges, model).or(self.range)
    }

    /// Returns the limits of a request to a device model: the range, as far as the limit of the product goes.
    pub fn limits_for(&self, model: Option<ModelId>) -> Option<Range> {
        self.narrowed(self.range_for(model))
    }

    /// Returns the limits of a request to any of these device models. They are the hull of the
    /// models' ranges, as far as the limit of the product goes.
    ///
    /// A model without a range has that of the type. If the type has none either, the model does
    /// not widen the hull.
    pub fn hull(&self, models: impl Iterator<Item = ModelId>) -> Option<Range> {
        self.narrowed(models.filter_map(|model| self.range_for(Some(model))).reduce(Range::hull).or(self.range))
    }

    fn narrowed(&self, range: Option<Range>) -> Option<Range> {
        let Some(limit) = &self.limit else { return range };
        Some(range.map_or(limit.range, |range| range.shared(limit.range)))
    }

    /// Returns the raw value that a device model, or a device of an unknown model, starts with.
    pub fn default_for(&self, model: Option<ModelId>) -> Option<i128> {
        own(&self.model_defaults, model).or(self.default)
    }

    /// Returns the physical limits of what the bits hold, if they are a number.
    pub fn held(&self) -> Option<Range> {
        let linear = self.encoding.linear()?;
        let (first, last) = linear.numeral.limits(self.place.width());
        let (one, other) = (linear.value(first)?, linear.value(last)?);
        Some(Range { minimum: one.min(other), maximum: one.max(other) })
    }

    /// Tests whether a raw value stands for a number inside a range.
    pub fn is_inside(&self, range: Range, raw: i128) -> bool {
        self.encoding.value_of(raw).is_some_and(|value| range.minimum <= value && value <= range.maximum)
    }

    /// Returns the raw value that says that there is no value.
    pub fn absent(&self) -> Option<&NamedValue> {
        self.specials.last().filter(|_| self.has_absent)
    }

    /// Tests a physical value against limits. For a float, the floats nearest to the limits are
    /// legal too.
    pub fn is_within(&self, limits: &Range, value: f64) -> bool {
        let is_within = |minimum: f64, maximum: f64| (minimum..=maximum).contains(&value);
        #[allow(clippy::cast_possible_truncation, reason = "the nearest float is what can be met")]
        let nearest = |limit: f64| f64::from(limit as f32);
        let (minimum, maximum) = (limits.minimum.to_f64(), limits.maximum.to_f64());
        is_within(minimum, maximum) || (self.encoding.is_single() && is_within(nearest(minimum), nearest(maximum)))
    }

    /// Returns the first data byte in which it has bits.
    pub fn start(&self) -> u8 {
        u8::try_from(u64::from_be_bytes(self.place.mask()).leading_zeros() / 8).unwrap_or(7)
    }

    /// Returns how many data bytes a frame with the signal has at least.
    pub fn end(&self) -> u8 {
        let last = u64::from_be_bytes(self.place.mask()).trailing_zeros() / 8;
        u8::try_from(8 - last).unwrap_or(8)
    }

    /// Returns how many data bytes a long message with the signal has at least, or with the longest text.
    pub fn reach(&self) -> usize {
        self.reach_with(None)
    }

    /// Returns the same for a text of some number of bytes, if that varies. It has at least its least number.
    pub fn reach_with(&self, bytes: Option<usize>) -> usize {
        let [least, most] = self.run.map_or([0, self.end().into()], |run| [run.least, run.most]).map(usize::from);
        let own = bytes.filter(|_| self.run.is_some_and(ByteRun::varies));
        usize::from(self.window) + own.map_or(most, |bytes| bytes.clamp(least, most))
    }

    /// Returns its bits in each data byte from its window on.
    pub fn masks(&self) -> Vec<u8> {
        match self.run {
            Some(run) => vec![u8::MAX; run.most.into()],
            None => self.place.mask().to_vec(),
        }
    }

    /// Returns the data bytes that have its bits.
    pub fn bytes(&self) -> std::ops::Range<usize> {
        usize::from(self.window) + usize::from(self.start())..self.reach()
    }

    /// Tests whether bits are a number inside limits. It is exact but for a float, which is compared
    /// with the doubles nearest to the limits.
    pub fn is_in(&self, limits: &Range, bits: u64) -> bool {
        if self.encoding.is_single() {
            let value = u32::try_from(bits).map_or(f64::NAN, |bits| f32::from_bits(bits).into());
            return (limits.minimum.to_f64()..=limits.maximum.to_f64()).contains(&value);
        }
        let raw = self.raw_of(bits);
        let is_special = self.specials.iter().any(|special| special.raw == raw);
        let value = self.encoding.value_of(raw).filter(|_| !is_special);
        value.is_some_and(|value| (limits.minimum..=limits.maximum).contains(&value))
    }

    /// Returns the least and the greatest raw value.
    pub fn raw_limits(&self) -> (i128, i128) {
        self.encoding.numeral().raw_limits(self.place.width())
    }

    /// Returns the raw value of bits, sign-extended if the signal is signed.
    #[inline]
    pub fn raw_of(&self, bits: u64) -> i128 {
        let width = self.place.width();
        let is_negative = self.encoding.numeral().is_signed() && bits >> (width - 1) & 1 == 1;
        i128::from(bits) - if is_negative { 1 << width } else { 0 }
    }

    /// Returns the bits of a raw value, if there are enough for it.
    pub fn bits_of(&self, raw: i128) -> Option<u64> {
        let (first, last) = self.raw_limits();
        #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "the mask keeps the bits that fit")]
        let bits = raw as u64 & self.place.max();
        (first..=last).contains(&raw).then_some(bits)
    }

    /// Returns the unit as it stands after a number, with a blank before it, or an empty text.
    pub fn unit_text(&self) -> String {
        self.unit.map_or_else(String::new, |unit| format!(" {}", unit.symbol))
    }

    /// Tests whether no limit has a fraction.
    pub fn has_whole_limits(&self) -> bool {
        let mut limits = self.limits().flat_map(|(range, _)| [range.minimum, range.maximum]);
        limits.all(|limit| limit.to_integer().is_some())
    }

    /// Returns all limits of requests, each with its place in the spec: the ranges, and the limit of the product.
    pub fn limits(&self) -> impl Iterator<Item = (Range, Path)> {
        self.ranges().chain(self.limit.iter().map(|limit| (limit.range, limit.path.clone())))
    }

    /// Returns all ranges of the document, each with its place in the spec.
    pub fn ranges(&self) -> impl Iterator<Item = (Range, Path)> {
        let general = self.range.map(|range| (range, self.range_path.clone()));
        general.into_iter().chain(self.model_ranges.iter().map(|own| (own.value, own.path.clone())))
    }
}

/// Returns what a device model has of its own.
fn own<T: Copy>(known: &[OfModel<T>], model: Option<ModelId>) -> Option<T> {
    known.iter().find(|own| Some(own.model) == model).map(|own| own.value)
}

/// Physical limits, both legal.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[non_exhaustive]
pub struct Range {
    /// Lowest value.
    pub minimum: Rational,
    /// Highest value.
    pub maximum: Rational,
}

impl Range {
    /// Tests an integer of any size that is its own physical value.
    pub fn has_whole(&self, value: i128) -> bool {
        (self.minimum..=self.maximum).contains(&Rational::integer(value))
    }

    /// Returns what lies in both. Its end lies below its start if nothing does.
    pub(crate) fn shared(self, other: Self) -> Self {
        Self { minimum: self.minimum.max(other.minimum), maximum: self.maximum.min(other.maximum) }
    }

    /// Returns the least range that holds both.
    pub(crate) fn hull(self, other: Self) -> Self {
        Self { minimum: self.minimum.min(other.minimum), maximum: self.maximum.max(other.maximum) }
    }
}

impl Signal {
    /// Returns the remarks of the signal and of its parts.
    pub(super) fn docs(&self) -> Vec<&Doc> {
        std::iter::once(&self.doc).chain(self.encoding.parts().iter().map(|part| &part.doc)).collect()
    }
}
