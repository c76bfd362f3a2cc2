//! Signals: named bit ranges of the data, with all that the document says about them.

mod any;
mod optional;
mod quantity;
mod scaled;
#[cfg(test)]
mod tests;

use core::marker::PhantomData;

use crate::payload::Refusing;
use crate::physical::Physical;
use crate::plumbing::Scale;
use crate::raw::Raw;
use crate::{Data, Error, Number, Payload, Place};

pub use any::{AnySignal, Reading, WriteSignal};
pub use quantity::{ReadNumber, SetNumber};

/// A named bit range of a message's data.
///
/// Its raw value has the type `R`, and its limits the type `F`. They differ only if the physical
/// value is calculated. Then `F` is its type.
///
/// [`get`](Self::get) and [`put`](Self::put) use raw values. [`decode`](Self::decode) and
/// [`encode`](Self::encode) use physical values. Limits of raw integers are integers, and are
/// compared as integers.
///
/// ```
/// use canspec_runtime::{Payload, Place, Signal};
///
/// const VOLTAGE: Signal<u32, f64> =
///     Signal::new("voltage", Place::bytes(0, 3)).unit("V").scale(1, 1000).limits(0.0, 750.0);
///
/// let mut payload = Payload::within_limits("set_output", [0; 8]);
/// VOLTAGE.encode(500.5, &mut payload)?;
/// assert_eq!(VOLTAGE.get(payload.data()), 500_500);
/// assert_eq!(VOLTAGE.decode(payload.data()), 500.5);
///
/// let error = VOLTAGE.encode(800.0, &mut payload).unwrap_err();
/// assert_eq!(error.to_string(), "`voltage` of `set_output` is 800 V, but its limits are 0 and 750 V");
/// # Ok::<(), canspec_runtime::Error>(())
/// ```
///
/// An integer with a scale counts whole steps, without floating-point arithmetic. Readings and
/// errors have its physical value.
///
/// ```
/// use canspec_runtime::{Payload, Place, Signal};
///
/// const VOLTAGE: Signal<u32> =
///     Signal::new("voltage", Place::bytes(0, 3)).unit("V").scale(1, 1000).limits(0, 750_000);
///
/// let mut payload = Payload::within_limits("set_output", [0; 8]);
/// VOLTAGE.put(500_500, &mut payload)?;
/// assert_eq!(VOLTAGE.get(payload.data()), 500_500);
///
/// let error = VOLTAGE.put(800_000, &mut payload).unwrap_err();
/// assert_eq!(error.to_string(), "`voltage` of `set_output` is 800 V, but its limits are 0 and 750 V");
/// # Ok::<(), canspec_runtime::Error>(())
/// ```
#[derive(Clone, Copy, Debug)]
pub struct Signal<R: 'static, F: 'static = R> {
    name: &'static str,
    place: Place,
    unit: Option<&'static str>,
    scale: Option<Scale>,
    limits: Option<(F, F)>,
    model_limits: &'static [(u8, Option<(F, F)>)],
    specials: &'static [(i64, &'static str)],
    has_absent: bool,
    /// What device models do not have, by number of the model.
    lacking: &'static [(u8, Lack)],
    /// Whether a value has a meaning only on a device model.
    is_by_model: bool,
    raw: PhantomData<R>,
}

impl<R: Raw, F: Physical<R>> Signal<R, F> {
    /// Returns a signal whose physical value is its raw value.
    pub const fn new(name: &'static str, place: Place) -> Self {
        Self {
            name,
            place,
            unit: None,
            scale: None,
            limits: None,
            model_limits: &[],
            specials: &[],
            has_absent: false,
            lacking: &[],
            is_by_model: false,
            raw: PhantomData,
        }
    }

    /// Adds the unit of the physical value.
    #[must_use]
    pub const fn unit(self, unit: &'static str) -> Self {
        Self { unit: Some(unit), ..self }
    }

    /// Adds the scale: physical = raw × `numerator` / `denominator`.
    #[must_use]
    pub const fn scale(self, numerator: i64, denominator: i64) -> Self {
        Self { scale: Some(Scale::new(numerator, denominator)), ..self }
    }

    /// Adds the offset `numerator` / `denominator`, in units of the physical value.
    #[must_use]
    pub const fn offset(self, numerator: i64, denominator: i64) -> Self {
        let scale = self.exact_scale().offset(numerator, denominator);
        Self { scale: Some(scale), ..self }
    }

    /// Adds the documented limits, both legal. They are physical values, or raw values if `F` is
    /// `R`. They hold if no device model is chosen.
    #[must_use]
    pub const fn limits(self, minimum: F, maximum: F) -> Self {
        Self { limits: Some((minimum, maximum)), ..self }
    }

    /// Adds the minimum and maximum of device models, by number of the model. Some models have
    /// none.
    #[must_use]
    pub const fn model_limits(self, model_limits: &'static [(u8, Option<(F, F)>)]) -> Self {
        Self { model_limits, ..self }
    }

    /// Adds raw values that are legal outside the limits, with their names.
    #[must_use]
    pub const fn specials(self, specials: &'static [(i64, &'static str)]) -> Self {
        Self { specials, ..self }
    }

    /// Says that all ones, or the greatest signed number, mean that there is no value.
    #[must_use]
    pub const fn absent(self) -> Self {
        Self { has_absent: true, ..self }
    }

    /// Adds what device models do not have, by number of the model. Requests to such a model do not
    /// have it.
    #[must_use]
    pub const fn lacking(self, lacking: &'static [(u8, Lack)]) -> Self {
        Self { lacking, ..self }
    }

    /// Says that the scale depends on the device model. Without a model, the raw value has no meaning.
    #[must_use]
    pub const fn by_model(self) -> Self {
        Self { is_by_model: true, ..self }
    }

    /// Returns the signal of a device model, with physical values of the type `P`, and without unit, scale and limits.
    #[must_use]
    pub const fn on_model<P: Physical<R>>(self) -> Signal<R, P> {
        let Self { name, place, specials, has_absent, .. } = self;
        Signal { specials, has_absent, ..Signal::new(name, place) }
    }

    /// Returns the name.
    pub(crate) const fn own_name(&self) -> &'static str {
        self.name
    }

    /// Returns the place in the data.
    pub const fn place(&self) -> Place {
        self.place
    }

    /// Returns the documented limits, both legal. They hold if no device model is chosen.
    pub const fn documented_limits(&self) -> Option<(F, F)> {
        self.limits
    }

    /// Returns the documented limits for a device model, both legal.
    pub fn limits_for(&self, model: impl Into<u8>) -> Option<(F, F)> {
        let model = model.into();
        let own = self.model_limits.iter().find(|(known, _)| *known == model);
        own.map_or(self.limits, |(_, limits)| *limits)
    }

    /// Returns the raw value.
    #[inline(always)]
    pub fn get(&self, data: &Data) -> R {
        self.place.read(data)
    }

    /// Writes a raw value.
    ///
    /// # Errors
    ///
    /// Refuses values that the signal's bits cannot hold. If `payload` keeps to limits, it also
    /// refuses values outside them.
    #[inline(always)]
    pub fn put<E: Refusing>(&self, raw: R, payload: &mut Payload<E>) -> Result<(), E> {
        if !raw.is_whole() {
            return Err(payload.refusal(move |message| self.meaningless(message)));
        }
        if payload.keeps_limits() && self.check_model(raw.to_bits(), payload)? && self.special(raw.to_bits()).is_none()
        {
            self.check(self.physical(raw), payload)?;
        }
        if self.store(raw.to_bits(), payload) {
            Ok(())
        } else {
            Err(payload.refusal(move |message| self.too_wide(self.physical(raw), message)))
        }
    }

    #[inline(always)]
    fn bits(&self, data: Data) -> u64 {
        if R::SIGNED { self.place.get_signed(&data) as u64 } else { self.place.get(&data) }
    }

    /// Writes the raw value of a part of a long message. Generated code calls it.
    ///
    /// # Errors
    ///
    /// The same as [`put`](Self::put). If `payload` keeps to limits, it also refuses any other value than the one that
    /// is there. The limits of a long message hold for all of its parts together.
    #[doc(hidden)]
    pub fn keep<E: Refusing>(&self, raw: R, payload: &mut Payload<E>) -> Result<(), E> {
        if payload.keeps_limits() && self.bits(*payload.data()) != raw.to_bits() {
            return Err(payload.refusal(move |message| Error::Part { message, signal: self.name }));
        }
        self.put(raw, payload)
    }

    /// Returns data with the low bits of a raw value in place.
    #[inline(always)]
    fn with(&self, mut data: Data, bits: u64) -> Data {
        self.place.put(&mut data, bits);
        data
    }

    /// Writes bits if they can be read back unchanged. Returns whether they can.
    #[inline(always)]
    fn store<E: Refusing>(&self, bits: u64, payload: &mut Payload<E>) -> bool {
        let data = self.with(*payload.data(), bits);
        let is_kept = self.bits(data) == bits;
        if is_kept {
            payload.replace(data);
        }
        is_kept
    }

    /// Tests bits against what the device model has. It returns whether limits apply to them.
    #[inline(always)]
    fn check_model<E: Refusing>(&self, bits: u64, payload: &Payload<E>) -> Result<bool, E> {
        if !self.lacking.is_empty() && shows_lack(self.lacking, payload.model(), bits) {
            return Err(payload.refusal(move |message| self.meaningless(message)));
        }
        Ok(!self.lacks_bits(payload))
    }

    /// Tests whether the device model does not have bits of the signal.
    #[inline(always)]
    fn lacks_bits<E: Refusing>(&self, payload: &Payload<E>) -> bool {
        !self.lacking.is_empty() && has_lacking_bits(self.lacking, payload.model())
    }

    /// Returns the value that limits apply to.
    #[inline(always)]
    fn physical(&self, raw: R) -> F {
        F::of(raw, self.scale)
    }

    /// Tests the value that limits apply to.
    #[inline(always)]
    fn check<E: Refusing>(&self, value: F, payload: &Payload<E>) -> Result<(), E> {
        let (model, message) = (payload.model(), payload.message());
        if F::IS_RAW { self.check_limits(value, model, message) } else { self.check_physical(value, model, message) }
    }

    /// Tests a physical value against the limits. Small programs have the code once for all signals of a type, because
    /// comparing doubles is large where the processor does not do it. It takes the parts of the payload, or there would
    /// have to be one in memory.
    #[inline]
    fn check_physical<E: Refusing>(&self, value: F, model: Option<u8>, message: &'static str) -> Result<(), E> {
        self.check_limits(value, model, message)
    }

    /// Tests a value against the limits. None lies between them that is not finite.
    #[inline(always)]
    fn check_limits<E: Refusing>(&self, value: F, model: Option<u8>, message: &'static str) -> Result<(), E> {
        match self.limits_in(model) {
            Some((minimum, maximum)) if value.is_within(minimum, maximum) => Ok(()),
            None if value.is_finite() => Ok(()),
            Some((minimum, maximum)) if value.is_finite() => {
                Err(E::of(move || self.outside(value, minimum, maximum, message)))
            }
            _ => Err(E::of(move || self.not_finite(message))),
        }
    }

    #[inline(always)]
    fn limits_in(&self, model: Option<u8>) -> Option<(F, F)> {
        match model {
            Some(model) if !self.model_limits.is_empty() => self.limits_for(model),
            _ => self.limits,
        }
    }

    #[cold]
    fn meaningless(&self, message: &'static str) -> Error {
        Error::Meaning { message, signal: self.name }
    }

    #[cold]
    fn not_finite(&self, message: &'static str) -> Error {
        Error::NotFinite { message, signal: self.name }
    }

    #[cold]
    fn outside(&self, value: F, minimum: F, maximum: F, message: &'static str) -> Error {
        let (minimum, maximum) = self.numbers((minimum, maximum));
        self.beyond([value.number(self.scale), minimum, maximum], message)
    }

    /// Returns limits as physical values, the lower one first.
    fn numbers(&self, (minimum, maximum): (F, F)) -> (Number, Number) {
        let numbers = (minimum.number(self.scale), maximum.number(self.scale));
        if F::IS_RAW { self.rising(numbers) } else { numbers }
    }

    /// Returns the physical values of a lower and a higher raw value, the lower one first.
    fn rising(&self, (one, other): (Number, Number)) -> (Number, Number) {
        if self.scale.is_some_and(Scale::is_falling) { (other, one) } else { (one, other) }
    }

    /// Says that a value lies outside what a minimum and a maximum allow.
    #[cold]
    fn beyond(&self, [value, minimum, maximum]: [Number; 3], message: &'static str) -> Error {
        Error::Limits { message, signal: self.name, value, unit: self.unit, minimum, maximum }
    }

    #[cold]
    fn hidden(&self, value: Number, name: &'static str, message: &'static str) -> Error {
        Error::Special { message, signal: self.name, value, unit: self.unit, name }
    }

    pub(crate) const fn is_scaled(&self) -> bool {
        self.scale.is_some()
    }

    /// Tests the value that the caller gave against the limits, if `payload` keeps to them.
    pub(crate) fn check_asked(&self, asked: F, payload: &Payload) -> Result<(), Error> {
        if payload.keeps_limits() && !self.lacks_bits(payload) { self.check(asked, payload) } else { Ok(()) }
    }

    /// Says that a value does not fit, with the limits of what the bits hold.
    #[cold]
    fn too_wide(&self, value: F, message: &'static str) -> Error {
        self.unfit(value.number(self.scale), message)
    }

    /// Says that a number does not fit, with the limits of what the bits hold.
    #[cold]
    fn unfit(&self, number: Number, message: &'static str) -> Error {
        let [one, other] = R::ends(self.place.max()).map(|bits| self.physical(R::from_bits(bits)).number(self.scale));
        let (minimum, maximum) = self.rising((one, other));
        self.beyond([number, minimum, maximum], message)
    }

    /// Returns the name of a special raw value.
    #[inline(always)]
    fn special(&self, bits: u64) -> Option<&'static str> {
        if self.specials.is_empty() { None } else { named(self.specials, bits) }
    }

    #[inline(always)]
    const fn exact_scale(&self) -> Scale {
        match self.scale {
            Some(scale) => scale,
            None => Scale::ONE,
        }
    }
}

/// What a device model does not have of a signal.
#[derive(Clone, Copy, Debug)]
pub enum Lack {
    /// Bits, and what they are on such a model.
    Bits(u64, u64),
    /// A raw value that has a name on other models.
    Value(i64),
}

impl Lack {
    /// Tests whether the bits of a signal show it.
    #[inline(always)]
    const fn is_shown_by(self, bits: u64) -> bool {
        match self {
            Self::Bits(mask, blank) => (bits ^ blank) & mask != 0,
            Self::Value(raw) => raw as u64 == bits,
        }
    }
}

/// Tests whether bits show what a device model does not have. All types of signals share the code.
#[cold]
fn shows_lack(lacking: &[(u8, Lack)], model: Option<u8>, bits: u64) -> bool {
    lacking.iter().any(|(known, lack)| Some(*known) == model && lack.is_shown_by(bits))
}

/// Tests whether a device model does not have bits of a signal. All types of signals share the code.
#[cold]
fn has_lacking_bits(lacking: &[(u8, Lack)], model: Option<u8>) -> bool {
    lacking.iter().any(|(known, lack)| Some(*known) == model && matches!(lack, Lack::Bits(..)))
}

/// Returns the name of a raw value. All types of signals share the code.
#[inline]
fn named(specials: &[(i64, &'static str)], bits: u64) -> Option<&'static str> {
    specials.iter().find(|(raw, _)| *raw as u64 == bits).map(|(_, name)| *name)
}
