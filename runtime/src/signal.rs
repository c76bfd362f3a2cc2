//! Signals: named bit ranges of the data with all that the document says of them.

use core::marker::PhantomData;

use crate::{Data, Error, Integer, Meaning, Number, Payload, Place, Raw, Scale};

/// A named bit range of a message's data, whose raw value has the type `R`.
///
/// [`get`](Self::get) and [`put`](Self::put) deal in raw values, without floating-point arithmetic unless limits are
/// checked; [`decode`](Self::decode) and [`encode`](Self::encode) in physical values.
///
/// ```
/// use canspec_runtime::{Payload, Place, Signal};
///
/// const VOLTAGE: Signal<u32> =
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
#[derive(Clone, Copy, Debug)]
pub struct Signal<R: 'static> {
    name: &'static str,
    place: Place,
    unit: Option<&'static str>,
    scale: Option<Scale>,
    limits: Option<(f64, f64)>,
    specials: &'static [(i64, &'static str)],
    raw: PhantomData<R>,
}

impl<R: Raw> Signal<R> {
    /// Returns a signal that carries its raw value as it is.
    pub const fn new(name: &'static str, place: Place) -> Self {
        Self { name, place, unit: None, scale: None, limits: None, specials: &[], raw: PhantomData }
    }

    /// Adds the unit of the physical value.
    #[must_use]
    pub const fn unit(self, unit: &'static str) -> Self {
        Self { unit: Some(unit), ..self }
    }

    /// Adds the documented limits of the physical value, both legal.
    #[must_use]
    pub const fn limits(self, minimum: f64, maximum: f64) -> Self {
        Self { limits: Some((minimum, maximum)), ..self }
    }

    /// Adds raw values that are legal outside the limits, with their names.
    #[must_use]
    pub const fn specials(self, specials: &'static [(i64, &'static str)]) -> Self {
        Self { specials, ..self }
    }

    /// Returns the place in the data.
    pub const fn place(&self) -> Place {
        self.place
    }

    /// Returns the documented limits of the physical value, both legal.
    pub const fn documented_limits(&self) -> Option<(f64, f64)> {
        self.limits
    }

    /// Returns the raw value.
    pub fn get(&self, data: &Data) -> R {
        self.place.read(data)
    }

    /// Writes a raw value.
    ///
    /// # Errors
    ///
    /// Refuses what the signal's bits cannot hold, and what lies outside the limits if `payload` keeps to them.
    pub fn put(&self, raw: R, payload: &mut Payload) -> Result<(), Error> {
        if !raw.is_whole() {
            return Err(self.meaningless(payload));
        }
        let number = self.physical(raw);
        self.check(number, Some(raw.to_bits()), payload)?;
        self.store(raw.to_bits(), number, payload)
    }

    fn bits(&self, data: Data) -> u64 {
        if R::SIGNED { self.place.get_signed(&data).cast_unsigned() } else { self.place.get(&data) }
    }

    /// Writes bits that come back as they were.
    fn store(&self, bits: u64, number: Number, payload: &mut Payload) -> Result<(), Error> {
        let mut data = *payload.data();
        self.place.put(&mut data, bits);
        if self.bits(data) != bits {
            return Err(self.too_wide(number, payload));
        }
        payload.replace(data);
        Ok(())
    }

    /// Returns what limits apply to.
    fn physical(&self, raw: R) -> Number {
        match self.scale {
            Some(scale) => Number::Float(scale.physical(raw.to_bits().cast_signed())),
            None => raw.number(),
        }
    }

    /// Tests a physical value against the limits; a special raw value is legal outside.
    fn check(&self, number: Number, bits: Option<u64>, payload: &Payload) -> Result<(), Error> {
        let value = number.to_f64();
        if !payload.keeps_limits() {
            return Ok(());
        }
        if !value.is_finite() {
            return Err(self.not_finite(payload));
        }
        let Some((minimum, maximum)) = self.limits else { return Ok(()) };
        let is_special = bits.is_some_and(|bits| self.special(bits).is_some());
        if is_special || (R::limit(minimum)..=R::limit(maximum)).contains(&value) {
            return Ok(());
        }
        Err(self.outside(number, Number::Float(minimum), Number::Float(maximum), payload))
    }

    fn meaningless(&self, payload: &Payload) -> Error {
        Error::Meaning { message: payload.message(), signal: self.name }
    }

    fn not_finite(&self, payload: &Payload) -> Error {
        Error::NotFinite { message: payload.message(), signal: self.name }
    }

    fn outside(&self, value: Number, minimum: Number, maximum: Number, payload: &Payload) -> Error {
        Error::Limits { message: payload.message(), signal: self.name, value, unit: self.unit, minimum, maximum }
    }

    /// Names the limits of what the bits can hold.
    fn too_wide(&self, value: Number, payload: &Payload) -> Error {
        let highest = self.place.max().wrapping_shr(R::SIGNED.into());
        let lowest = if R::SIGNED { !highest } else { 0 };
        let [one, other] = [lowest, highest].map(|bits| self.physical(R::from_bits(bits)));
        let (minimum, maximum) = if one.to_f64() <= other.to_f64() { (one, other) } else { (other, one) };
        self.outside(value, minimum, maximum, payload)
    }
}

impl<R: Raw> Signal<R> {
    /// Returns the name of a special raw value.
    fn special(&self, bits: u64) -> Option<&'static str> {
        self.specials.iter().find(|(raw, _)| raw.cast_unsigned() == bits).map(|(_, name)| *name)
    }

    /// Returns the special raw value of a name.
    fn special_value(&self, meaning: Meaning<'_>) -> Option<R> {
        let Meaning::Name(wanted) = meaning else { return None };
        let special = self.specials.iter().find(|(_, name)| *name == wanted);
        special.map(|(raw, _)| R::from_bits(raw.cast_unsigned()))
    }

    /// Returns the raw value that means `meaning` where the one is not scaled from the other.
    fn unscaled(&self, meaning: Meaning<'_>) -> Option<R> {
        if self.scale.is_none() { R::from_meaning(meaning) } else { None }
    }

    const fn exact_scale(&self) -> Scale {
        match self.scale {
            Some(scale) => scale,
            None => Scale::ONE,
        }
    }
}

impl<R: Integer> Signal<R> {
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

    /// Returns the physical value: the double nearest to the true one.
    pub fn decode(&self, data: &Data) -> f64 {
        self.exact_scale().physical(self.bits(*data).cast_signed())
    }

    /// Writes the raw value nearest to a physical value, ties away from zero.
    ///
    /// # Errors
    ///
    /// Refuses what the signal's bits cannot hold, and what lies outside the limits if `payload` keeps to them.
    pub fn encode(&self, physical: f64, payload: &mut Payload) -> Result<(), Error> {
        encode_scaled(self, self.exact_scale(), physical, payload)
    }
}

#[expect(clippy::float_cmp, reason = "a special value must be met exactly")]
fn encode_scaled<R: Raw>(signal: &Signal<R>, scale: Scale, physical: f64, payload: &mut Payload) -> Result<(), Error> {
    let number = Number::Float(physical);
    let raw = scale.raw(physical);
    let exact = raw.filter(|raw| scale.physical(*raw) == physical).map(i64::cast_unsigned);
    signal.check(number, exact, payload)?;
    match raw {
        Some(raw) if R::SIGNED || raw >= 0 => signal.store(raw.cast_unsigned(), number, payload),
        _ if physical.is_nan() => Err(signal.not_finite(payload)),
        _ => Err(signal.too_wide(number, payload)),
    }
}

/// What a signal says in one frame, for code that does not know the message.
#[derive(Clone, Copy, Debug)]
#[non_exhaustive]
pub struct Reading<'a> {
    /// Name of the signal.
    pub name: &'static str,
    /// Unit of the physical value.
    pub unit: Option<&'static str>,
    /// The integer in the frame; the bit pattern of a float, the bytes of a text.
    pub raw: Number,
    /// What it means.
    pub meaning: Meaning<'a>,
}

/// A signal for code that does not know its type.
pub trait AnySignal {
    /// Returns the name.
    fn name(&self) -> &'static str;

    /// Returns the unit of the physical value.
    fn unit(&self) -> Option<&'static str>;

    /// Returns the place in the data.
    fn place(&self) -> Place;

    /// Shows what the signal says in a frame.
    fn read(&self, data: &Data, visitor: &mut dyn FnMut(Reading<'_>));

    /// Writes the value that means `meaning`.
    ///
    /// # Errors
    ///
    /// Refuses what the signal's bits cannot hold, names that it does not have, and what lies outside the limits if
    /// `payload` keeps to them.
    fn write(&self, meaning: Meaning<'_>, payload: &mut Payload) -> Result<(), Error>;
}

impl<R: Raw> AnySignal for Signal<R> {
    fn name(&self) -> &'static str {
        self.name
    }

    fn unit(&self) -> Option<&'static str> {
        self.unit
    }

    fn place(&self) -> Place {
        self.place
    }

    fn read(&self, data: &Data, visitor: &mut dyn FnMut(Reading<'_>)) {
        let value = self.get(data);
        let bits = self.bits(*data);
        let meaning = match (self.special(bits), self.scale) {
            (Some(name), _) => Meaning::Name(name),
            (None, Some(_)) => Meaning::Number(self.physical(value)),
            (None, None) => value.meaning(),
        };
        let raw = if R::SIGNED { Number::Signed(bits.cast_signed()) } else { Number::Unsigned(bits) };
        visitor(Reading { name: self.name, unit: self.unit, raw, meaning });
    }

    fn write(&self, meaning: Meaning<'_>, payload: &mut Payload) -> Result<(), Error> {
        if let Some(raw) = self.special_value(meaning).or_else(|| self.unscaled(meaning)) {
            return self.put(raw, payload);
        }
        match meaning {
            Meaning::Number(number) => encode_scaled(self, self.exact_scale(), number.to_f64(), payload),
            _ => Err(self.meaningless(payload)),
        }
    }
}
