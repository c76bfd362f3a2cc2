//! Signals: named bit ranges of the data, with all that the document says about them.

mod any;
mod optional;
mod quantity;
mod refused;
mod scaled;
#[cfg(test)]
mod tests;

use core::marker::PhantomData;

use crate::error::{Fault, Value};
use crate::physical::{Physical, limits_of_steps, of_steps};
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
// The order of the fields is kept. What is the same for all types comes first, so programs have the code once that reads
// it.
#[derive(Clone, Copy, Debug)]
#[repr(C)]
pub struct Signal<R: 'static, F: 'static = R> {
    scale: Option<Scale>,
    name: &'static str,
    unit: Option<&'static str>,
    specials: &'static [(i64, &'static str)],
    /// What device models do not have, by number of the model.
    lacking: &'static [(u8, Lack)],
    place: Place,
    has_absent: bool,
    /// Whether a value has a meaning only on a device model.
    is_by_model: bool,
    limits: Option<(F, F)>,
    model_limits: &'static [(u8, Option<(F, F)>)],
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
    pub const fn unit(mut self, unit: &'static str) -> Self {
        self.unit = Some(unit);
        self
    }

    /// Adds the scale: physical = raw × `numerator` / `denominator`.
    #[must_use]
    pub const fn scale(mut self, numerator: i64, denominator: i64) -> Self {
        self.scale = Some(Scale::new(numerator, denominator));
        self
    }

    /// Adds the offset `numerator` / `denominator`, in units of the physical value.
    ///
    /// # Panics
    ///
    /// Panics if `denominator` is 0. In a constant this is a compile error.
    #[must_use]
    pub const fn offset(mut self, numerator: i64, denominator: i64) -> Self {
        self.scale = Some(self.exact_scale().offset(numerator, denominator));
        self
    }

    /// Adds the documented limits, both legal. They are physical values, or raw values if `F` is
    /// `R`. They hold if no device model is chosen.
    #[must_use]
    pub const fn limits(mut self, minimum: F, maximum: F) -> Self {
        self.limits = Some((minimum, maximum));
        self
    }

    /// Adds the minimum and maximum of device models, by number of the model. Some models have
    /// none.
    #[must_use]
    pub const fn model_limits(mut self, model_limits: &'static [(u8, Option<(F, F)>)]) -> Self {
        self.model_limits = model_limits;
        self
    }

    /// Adds raw values that are legal outside the limits, with their names.
    #[must_use]
    pub const fn specials(mut self, specials: &'static [(i64, &'static str)]) -> Self {
        self.specials = specials;
        self
    }

    /// Says that all ones, or the greatest signed number, mean that there is no value.
    #[must_use]
    pub const fn absent(mut self) -> Self {
        self.has_absent = true;
        self
    }

    /// Adds what device models do not have, by number of the model. Requests to such a model do not
    /// have it.
    #[must_use]
    pub const fn lacking(mut self, lacking: &'static [(u8, Lack)]) -> Self {
        self.lacking = lacking;
        self
    }

    /// Says that the scale depends on the device model. Without a model, the raw value has no meaning.
    #[must_use]
    pub const fn by_model(mut self) -> Self {
        self.is_by_model = true;
        self
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

    /// Returns the name of a raw or physical value if it is a special one. Such a value is no number in the unit.
    ///
    /// What is decoded has its bits, so that the same bits can be sent again.
    ///
    /// ```
    /// use canspec_runtime::{Place, Signal};
    ///
    /// const VOLTAGE: Signal<u16, f64> = Signal::new("voltage", Place::bytes(0, 1))
    ///     .unit("V")
    ///     .scale(1, 200)
    ///     .specials(&[(0xFFFE, "out_of_range"), (0xFFFF, "not_available")])
    ///     .absent();
    ///
    /// let measured = |data| VOLTAGE.decode_some(data, 8).filter(|volts| VOLTAGE.special_of(*volts).is_none());
    /// assert_eq!(measured(&[0x09, 0xC4, 0, 0, 0, 0, 0, 0]), Some(12.5));
    /// assert_eq!(measured(&[0xFF, 0xFE, 0, 0, 0, 0, 0, 0]), None);
    ///
    /// assert_eq!(VOLTAGE.decode(&[0xFF, 0xFE, 0, 0, 0, 0, 0, 0]), 327.67);
    /// assert_eq!(VOLTAGE.special_of(327.67), Some("out_of_range"));
    /// assert_eq!(VOLTAGE.special_of(0xFFFE_u16), Some("out_of_range"));
    /// ```
    pub fn special_of<P: Physical<R>>(&self, value: P) -> Option<&'static str> {
        let (value, of) = (value.told(), |raw: i64| P::of(R::from_bits(raw as u64), self.scale).told());
        self.specials.iter().find(|(raw, _)| of(*raw) == value).map(|(_, name)| *name)
    }

    /// Writes a raw value.
    ///
    /// # Errors
    ///
    /// Refuses values that the signal's bits cannot hold. If `payload` keeps to limits, it also
    /// refuses values outside them.
    #[inline(always)]
    pub fn put(&'static self, raw: R, payload: &mut Payload) -> Result<(), Error> {
        if !raw.is_whole() {
            return Err(self.refused(Fault::Meaning, payload));
        }
        if payload.keeps_limits() && self.check_model(raw.to_bits(), payload)? && self.special(raw.to_bits()).is_none()
        {
            self.check(self.physical(raw), payload)?;
        }
        if self.store(raw.to_bits(), payload) {
            Ok(())
        } else {
            Err(self.refused(Fault::Width(Value::Raw(raw.to_bits())), payload))
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
    pub fn keep(&'static self, raw: R, payload: &mut Payload) -> Result<(), Error> {
        if payload.keeps_limits() && self.bits(*payload.data()) != raw.to_bits() {
            return Err(self.refused(Fault::Part, payload));
        }
        self.put(raw, payload)
    }

    /// Returns data with the low bits of a raw value in place.
    #[inline(always)]
    fn with(&self, mut data: Data, bits: u64) -> Data {
        self.place.put(&mut data, bits);
        data
    }

    /// Tests whether bits can be read back from the place unchanged.
    #[inline(always)]
    const fn holds(&self, bits: u64) -> bool {
        let unused = 64_u32.wrapping_sub(self.place.width() as u32);
        if R::SIGNED {
            (bits.wrapping_shl(unused) as i64).wrapping_shr(unused) as u64 == bits
        } else {
            bits <= self.place.max()
        }
    }

    /// Writes bits if they can be read back unchanged. Returns whether they can.
    #[inline(always)]
    fn store(&self, bits: u64, payload: &mut Payload) -> bool {
        let is_kept = self.holds(bits);
        if is_kept {
            payload.replace(self.with(*payload.data(), bits));
        }
        is_kept
    }

    /// Tests bits against what the device model has. It returns whether limits apply to them.
    #[inline(always)]
    fn check_model(&'static self, bits: u64, payload: &Payload) -> Result<bool, Error> {
        if !self.lacking.is_empty() && shows_lack(self.lacking, payload.model(), bits) {
            return Err(self.refused(Fault::Meaning, payload));
        }
        Ok(!self.lacks_bits(payload))
    }

    /// Tests whether the device model does not have bits of the signal.
    #[inline(always)]
    fn lacks_bits(&self, payload: &Payload) -> bool {
        !self.lacking.is_empty() && has_lacking_bits(self.lacking, payload.model())
    }

    /// Returns what the bits are on the device model, if it does not have the signal.
    #[inline(always)]
    pub(crate) fn blank(&self, model: Option<u8>) -> Option<u64> {
        if self.lacking.is_empty() { None } else { blank_on(self.lacking, model) }
    }

    /// Returns the value that limits apply to.
    #[inline(always)]
    fn physical(&self, raw: R) -> F {
        F::of(raw, self.scale)
    }

    /// Tests the value that limits apply to.
    #[inline(always)]
    fn check(&'static self, value: F, payload: &Payload) -> Result<(), Error> {
        if self.is_legal(value, payload.model()) {
            Ok(())
        } else {
            Err(self.refused(Fault::Limits(value.told()), payload))
        }
    }

    /// Tests a value against the limits. None lies between them that is not finite.
    #[inline(always)]
    fn is_legal(&self, value: F, model: Option<u8>) -> bool {
        match self.limits_in(model) {
            Some((minimum, maximum)) => value.is_within(minimum, maximum),
            None => value.is_finite(),
        }
    }

    #[inline(always)]
    fn limits_in(&self, model: Option<u8>) -> Option<(F, F)> {
        match model {
            Some(model) if !self.model_limits.is_empty() => self.limits_for(model),
            _ => self.limits,
        }
    }

    /// Returns a value as a number in the unit.
    #[inline(always)]
    fn number(&self, value: F) -> Number {
        of_steps(value.number(), self.steps())
    }

    /// Returns limits as numbers in the unit, the lower one first.
    #[inline(always)]
    fn numbers(&self, (minimum, maximum): (F, F)) -> (Number, Number) {
        limits_of_steps(&(minimum.number(), maximum.number()), self.steps())
    }

    /// Returns the scale if values of the type `F` count its steps.
    #[inline(always)]
    const fn steps(&self) -> Option<&Scale> {
        if F::IS_RAW { self.scale.as_ref() } else { None }
    }

    pub(crate) const fn is_scaled(&self) -> bool {
        self.scale.is_some()
    }

    /// Tests the value that the caller gave against the limits, if `payload` keeps to them.
    pub(crate) fn check_asked(&'static self, asked: F, payload: &Payload) -> Result<(), Error> {
        if payload.keeps_limits() && !self.lacks_bits(payload) { self.check(asked, payload) } else { Ok(()) }
    }

    /// Returns which special raw value bits are.
    #[inline(always)]
    fn special(&self, bits: u64) -> Option<u32> {
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
    /// All bits of the signal, and what they are on such a model.
    Signal(u64, u64),
    /// Bits of a signal that the model has. They are 0 there.
    Bits(u64),
    /// A raw value that has a name on other models.
    Value(i64),
}

impl Lack {
    /// Tests whether the bits of a signal show it.
    #[inline(always)]
    const fn is_shown_by(self, bits: u64) -> bool {
        match self {
            Self::Signal(mask, blank) => (bits ^ blank) & mask != 0,
            Self::Bits(mask) => bits & mask != 0,
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
    lacking.iter().any(|(known, lack)| Some(*known) == model && !matches!(lack, Lack::Value(_)))
}

/// Returns what the bits of a signal are on a device model that does not have it. All types of signals share the code.
#[cold]
fn blank_on(lacking: &[(u8, Lack)], model: Option<u8>) -> Option<u64> {
    lacking.iter().find_map(|(known, lack)| match lack {
        Lack::Signal(_, blank) if Some(*known) == model => Some(*blank),
        Lack::Signal(..) | Lack::Bits(_) | Lack::Value(_) => None,
    })
}

/// Returns which named value bits are. All types of signals share the code.
#[inline]
fn named(specials: &[(i64, &'static str)], bits: u64) -> Option<u32> {
    let index = specials.iter().position(|(raw, _)| *raw as u64 == bits)?;
    u32::try_from(index).ok()
}
