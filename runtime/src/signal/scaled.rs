//! Signals whose physical value is calculated.

use crate::error::Fault;
use crate::physical::{Physical, Scaled};
use crate::raw::Raw;
use crate::{Data, Error, Payload, Signal};

impl<R: Raw, F: Physical<R> + Scaled> Signal<R, F> {
    /// Returns the physical value of a raw value; `None` if the raw value means something else.
    ///
    /// ```
    /// use canspec_runtime::{Place, Signal};
    ///
    /// const LIMIT: Signal<u16> = Signal::new("limit", Place::bytes(0, 1)).specials(&[(0, "off")]).by_model();
    /// const ON_SMALL: Signal<u16, f64> = LIMIT.on_model().unit("A").scale(1, 20).limits(1.0, 40.0);
    ///
    /// assert_eq!(ON_SMALL.physical_of(440), Some(22.0));
    /// assert_eq!(ON_SMALL.physical_of(0), None);
    /// assert_eq!(ON_SMALL.raw_of(22.0, "set_limit"), Ok(440));
    /// let error = ON_SMALL.raw_of(41.0, "set_limit").unwrap_err();
    /// assert_eq!(error.to_string(), "`limit` of `set_limit` is 41 A, but its limits are 1 and 40 A");
    /// ```
    pub fn physical_of(&self, raw: R) -> Option<F> {
        let bits = raw.to_bits();
        self.special(bits).is_none().then(|| F::scaled(bits as i64, self.exact_scale()))
    }

    /// Returns the raw value nearest to a physical value within the limits, with ties away from zero.
    ///
    /// # Errors
    ///
    /// The same as those of [`encode`](Self::encode) into a request of `message`.
    pub fn raw_of(&'static self, physical: F, message: &'static str) -> Result<R, Error> {
        let mut payload = Payload::within_limits(message, [0; 8]);
        self.encode(physical, &mut payload)?;
        Ok(self.get(payload.data()))
    }

    /// Returns the physical value: the number of type `F` nearest to the exact one.
    #[inline(always)]
    pub fn decode(&self, data: &Data) -> F {
        F::decoded(self.bits(*data) as i64, self.exact_scale())
    }

    /// Writes the raw value nearest to a physical value, with ties away from zero.
    ///
    /// # Errors
    ///
    /// Refuses values that the signal's bits cannot hold. If `payload` keeps to limits, it also
    /// refuses values outside them, before or after rounding. It then refuses values, too, that
    /// would be rounded to a special raw value.
    #[inline(always)]
    pub fn encode(&'static self, physical: F, payload: &mut Payload) -> Result<(), Error> {
        let is_decided = payload.keeps_limits() && self.limits_decide(payload);
        let raw = if is_decided {
            self.check(physical, payload)?;
            physical.raw_held(self.exact_scale(), self.place.width(), R::SIGNED)
        } else {
            physical.raw_of(self.exact_scale(), self.place.width(), R::SIGNED)
        };
        let Some((raw, bits)) = raw.and_then(|raw| Some((raw, R::bits_of(raw)?))) else {
            return Err(self.unheld(physical, self.bits_on_models(physical), payload));
        };
        if payload.keeps_limits() && !is_decided && self.check_model(bits, payload)? {
            self.check_rounded(physical, raw, bits, payload)?;
        }
        // What was tested already needs no second test, and no second error for the compiler to place.
        let is_tested = !R::IS_DECIMAL && self.place.width() <= F::TESTED;
        if is_tested {
            payload.replace(self.with(*payload.data(), bits));
            return Ok(());
        }
        if self.store(bits, payload) { Ok(()) } else { Err(self.unheld(physical, bits, payload)) }
    }

    /// Returns the bits that a physical value would need, if there are device models without some.
    #[inline(always)]
    fn bits_on_models(&self, physical: F) -> u64 {
        if self.lacking.is_empty() {
            return 0;
        }
        physical.raw(self.exact_scale()).and_then(R::bits_of).unwrap_or_default()
    }

    /// Says why a value is refused that the bits cannot hold.
    #[inline(always)]
    fn unheld(&'static self, physical: F, bits: u64, payload: &Payload) -> Error {
        let has_limits = if payload.keeps_limits() { self.check_model(bits, payload) } else { Ok(false) };
        match has_limits {
            Err(error) => error,
            Ok(true) if !self.is_legal(physical, payload.model()) => {
                self.refused(Fault::Limits(physical.told()), payload)
            }
            Ok(_) => self.refused(Fault::Width(physical.told()), payload),
        }
    }

    /// Tests a physical value, and the raw value that it is rounded to. A special raw value would
    /// have another meaning.
    #[inline(always)]
    fn check_rounded(&'static self, physical: F, raw: i64, bits: u64, payload: &Payload) -> Result<(), Error> {
        let sent = || F::scaled(raw, self.exact_scale());
        match self.special(bits) {
            Some(_) if sent() == physical => Ok(()),
            Some(index) => {
                self.check(physical, payload)?;
                Err(self.refused(Fault::Special(physical.told(), Some(index)), payload))
            }
            None => {
                self.check(physical, payload)?;
                if self.has_limits_on_steps(payload) || sent() == physical {
                    Ok(())
                } else {
                    self.check(sent(), payload)
                }
            }
        }
    }

    /// Tests whether the limits alone decide which values are refused, and the compiler knows it.
    ///
    /// They are steps that the bits hold, no value between them means something else, and no device model has others.
    #[inline(always)]
    fn limits_decide(&'static self, payload: &Payload) -> bool {
        let has_no_others = self.specials.is_empty() && self.lacking.is_empty() && self.model_limits.is_empty();
        match self.limits {
            Some((minimum, maximum)) if has_no_others && self.has_limits_on_steps(payload) => {
                self.is_held(minimum) && self.is_held(maximum)
            }
            _ => false,
        }
    }

    /// Tests whether the bits hold a physical value.
    #[inline(always)]
    fn is_held(&self, physical: F) -> bool {
        physical.raw_of(self.exact_scale(), self.place.width(), R::SIGNED).is_some()
    }

    /// Tests whether the limits are steps, and known when a program is compiled.
    ///
    /// What is rounded between them stays between them. The general limits are constants, so the
    /// compiler answers.
    #[inline(always)]
    fn has_limits_on_steps(&'static self, payload: &Payload) -> bool {
        let is_general = self.model_limits.is_empty() || payload.model().is_none();
        is_general
            && match self.limits {
                Some((minimum, maximum)) => minimum.is_step(self.exact_scale()) && maximum.is_step(self.exact_scale()),
                None => true,
            }
    }
}
