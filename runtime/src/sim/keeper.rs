//! A device that keeps what it is told.

#[cfg(test)]
mod tests;

use super::{Answer, Device};
use crate::{Addressed, AfterSilence, OutOfRange, Quantities, Quantity, Received};

/// Builds what a device says to a request that sets no quantity, or that it does not obey.
pub type Tell<P, const Q: usize> = fn(&Received<P>, &Keeper<P, Q>) -> Answer<P>;

/// A device that keeps the quantities which requests set, at most `Q` of them, and echoes such requests. A
/// function builds its other answers from what it keeps.
///
/// When it starts anew, it forgets all but what the document says it keeps without power. It does with a value out of
/// range what the document says, and then the function answers.
///
/// When its watchdog runs out, it does with [`DELIVERING`](Quantity::DELIVERING) what the document says of
/// [silence](crate::Protocol::AFTER_SILENCE). It goes off if the document says nothing, and delivers with the values that it was
/// told last if it starts by itself.
///
/// Each quantity takes 24 bytes on a processor of 64 bits, and 12 on one of 32 bits.
#[derive(Clone, Copy, Debug)]
pub struct Keeper<P: Addressed, const Q: usize> {
    tell: Tell<P, Q>,
    group: Option<P::Target>,
    kept: [Option<(Quantity, i32)>; Q],
    after_silence: AfterSilence,
    /// Whether it delivered when its watchdog ran out, and has heard nothing since.
    resumes: bool,
}

impl<P: Addressed, const Q: usize> Keeper<P, Q> {
    /// Returns a device that keeps nothing yet. Any request to several devices is also for it.
    pub const fn new(tell: Tell<P, Q>) -> Self {
        Self { tell, group: None, kept: [None; Q], after_silence: P::AFTER_SILENCE, resumes: false }
    }

    /// Returns the device in a group. Of requests to several devices, those to this target are for it.
    #[must_use]
    pub fn in_group(self, group: P::Target) -> Self {
        Self { group: Some(group), ..self }
    }

    /// Sets what it does when its watchdog runs out, where the document does not say it.
    #[must_use]
    pub const fn after_silence(self, after_silence: AfterSilence) -> Self {
        Self { after_silence, ..self }
    }

    /// Returns the value of a quantity, if it keeps one.
    pub fn value(&self, quantity: Quantity) -> Option<i32> {
        self.kept.iter().flatten().find(|(kept, _)| *kept == quantity).map(|(_, value)| *value)
    }

    /// Keeps a value. It is dropped if there is no room for another quantity.
    pub fn keep(&mut self, quantity: Quantity, value: i32) {
        let place = self.kept.iter().position(|slot| slot.is_some_and(|(kept, _)| kept == quantity));
        let place = place.or_else(|| self.kept.iter().position(Option::is_none));
        if let Some(slot) = place.and_then(|place| self.kept.get_mut(place)) {
            *slot = Some((quantity, value));
        }
    }
}

impl<P: Quantities + Addressed<Target: PartialEq>, const Q: usize> Device<P> for Keeper<P, Q> {
    fn answer(&mut self, request: &Received<P>, _now: u32) -> Answer<P> {
        let is_legal = request.encode().is_ok();
        let (mut is_set, mut is_obeyed) = (false, true);
        for path in P::SETS {
            let Some(value) = request.setting(path.quantity) else { continue };
            is_set = true;
            match (path.out_of_range.filter(|_| !is_legal), self.value(path.quantity)) {
                (None, _) => self.keep(path.quantity, value),
                (Some(OutOfRange::Limited), Some(kept)) => {
                    self.keep(path.quantity, path.limited(value, kept));
                    is_obeyed = false;
                }
                (Some(_), _) => is_obeyed = false,
            }
        }
        if is_set && is_obeyed { Answer::Values(*request.content()) } else { (self.tell)(request, self) }
    }

    fn is_asked(&self, request: &Received<P>) -> bool {
        self.group.is_none_or(|group| request.target() == Some(group))
    }

    fn silence(&mut self, _now: u32) {
        let delivers = self.value(Quantity::DELIVERING) == Some(1);
        match self.after_silence {
            AfterSilence::Unknown | AfterSilence::Off => self.keep(Quantity::DELIVERING, 0),
            AfterSilence::Resumes => {
                self.resumes = delivers;
                self.keep(Quantity::DELIVERING, 0);
            }
            AfterSilence::Starts => self.keep(Quantity::DELIVERING, 1),
            AfterSilence::Keeps => {}
        }
    }

    fn wake(&mut self, _now: u32) {
        if core::mem::take(&mut self.resumes) {
            self.keep(Quantity::DELIVERING, 1);
        }
    }

    fn power_on(&mut self, _now: u32) {
        let is_kept = |(quantity, _): &(Quantity, i32)| {
            P::SETS.iter().any(|path| path.quantity == *quantity && path.is_kept == Some(true))
        };
        self.resumes = false;
        self.kept = self.kept.map(|slot| slot.filter(is_kept));
    }
}
