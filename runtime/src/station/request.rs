//! The requests of a station, and how many there are at a module.

use super::settings::{SetPoint, Settings};
use crate::{Addressed, Error, Exchange, Quantities, Quantity, Request};

/// What is read in each round. The first one says whether a module delivers.
pub const READINGS: [Quantity; 3] = [Quantity::DELIVERING, Quantity::OUTPUT_VOLTAGE, Quantity::OUTPUT_CURRENT];

/// What is set, in this order.
const SETTINGS: [Quantity; 3] = [Quantity::OUTPUT_VOLTAGE, Quantity::OUTPUT_CURRENT, Quantity::DELIVERING];

/// Quantities with their values, as many as there are.
#[derive(Clone, Copy)]
struct Values([(Quantity, i32); 3], usize);

impl Values {
    fn of(point: SetPoint, is_on: Option<bool>) -> Self {
        let mut values = Self([(Quantity::OUTPUT_VOLTAGE, point.voltage_mv); 3], 1);
        if let Some(current_ma) = point.current_ma {
            values.push(Quantity::OUTPUT_CURRENT, current_ma);
        }
        if let Some(is_on) = is_on {
            values.push(Quantity::DELIVERING, is_on.into());
        }
        values
    }

    fn push(&mut self, quantity: Quantity, value: i32) {
        self.0.get_mut(self.1).into_iter().for_each(|slot| *slot = (quantity, value));
        self.1 += 1;
    }

    fn as_slice(&self) -> &[(Quantity, i32)] {
        self.0.get(..self.1).unwrap_or_default()
    }
}

/// Requests that are sent one after another.
pub type Requests<P> = [Option<Request<P, ()>>; 3];

/// Builds what lets a module deliver: what sets the output, and then what switches it on.
pub fn deliver<P: Quantities + Addressed>(
    settings: &Settings,
    target: P::Target,
    point: SetPoint,
) -> Result<Requests<P>, Error> {
    set(settings, target, Values::of(point, Some(true)))
}

/// Builds what sets the output of a module, and leaves it on or off. It is none if one message does both.
pub fn prepare<P: Quantities + Addressed>(settings: &Settings, target: P::Target, point: SetPoint) -> Requests<P> {
    set(settings, target, Values::of(point, None)).unwrap_or_default()
}

/// Builds what switches modules off. If the message sets the voltage, too, that is the least one.
pub fn switch_off<P: Quantities + Addressed>(
    settings: &Settings,
    target: P::Target,
) -> Result<Option<Request<P, ()>>, Error> {
    let off = Values([(Quantity::DELIVERING, 0); 3], 1);
    let least = SetPoint { voltage_mv: settings.limits.least_mv, current_ma: None };
    let both = |error| {
        let sets_both = matches!(error, Error::NotGiven { .. });
        if sets_both { set(settings, target, Values::of(least, Some(false))) } else { Err(error) }
    };
    let [first, ..] = set(settings, target, off).or_else(both)?;
    Ok(first)
}

fn set<P: Quantities + Addressed>(
    settings: &Settings,
    target: P::Target,
    values: Values,
) -> Result<Requests<P>, Error> {
    let mut requests = [None; 3];
    let mut slots = requests.iter_mut();
    let mut add = |request| slots.by_ref().take(1).for_each(|slot| *slot = Some(request));
    match settings.model {
        Some(model) => P::set_within(model, values.as_slice(), target)?.for_each(&mut add),
        None => P::set(values.as_slice(), target)?.for_each(&mut add),
    }
    Ok(requests)
}

/// Builds what reads a module in each round.
pub fn readings<P: Quantities + Addressed>(target: P::Target) -> Requests<P> {
    let mut requests = [None; 3];
    let mut wanted = [Quantity::DELIVERING; READINGS.len()];
    let mut count = 0;
    for quantity in READINGS.into_iter().filter(|quantity| is_read::<P>(*quantity)) {
        wanted.get_mut(count).into_iter().for_each(|slot| *slot = quantity);
        count += 1;
    }
    let reads = P::read(wanted.get(..count).unwrap_or_default(), target).into_iter().flatten();
    requests.iter_mut().zip(reads).for_each(|(slot, request)| *slot = Some(request));
    requests
}

/// Builds what reads the group of a module, if it has one.
pub fn group<P: Quantities + Addressed>(target: P::Target) -> Option<Request<P, ()>> {
    P::read(&[Quantity::GROUP], target).ok()?.next()
}

/// Tests whether a request without values asks for a quantity.
pub fn is_read<P: Quantities>(quantity: Quantity) -> bool {
    P::READS.iter().any(|path| path.quantity == quantity && path.request.is_some())
}

/// Returns how many requests a module takes in each round: those that read it, and those that set it.
pub const fn each_round<P: Quantities>() -> usize {
    let (mut count, mut index) = (0, 0);
    while index < P::READS.len() + P::SETS.len() {
        count += is_first::<P>(index) as usize;
        index += 1;
    }
    count
}

/// Tests whether a request is sent by a path, and by none of its kind before it.
const fn is_first<P: Quantities>(index: usize) -> bool {
    let Some(request) = sent::<P>(index) else { return false };
    let mut earlier = if index < P::READS.len() { 0 } else { P::READS.len() };
    while earlier < index {
        let is_one = match sent::<P>(earlier) {
            Some(known) => is_same(known.message(), request.message()) && is_same(known.access(), request.access()),
            None => false,
        };
        if is_one {
            return false;
        }
        earlier += 1;
    }
    true
}

/// Returns the request that is sent by a path if a station uses it. Paths that read come first.
const fn sent<P: Quantities>(index: usize) -> Option<&'static Exchange> {
    if index >= P::READS.len() {
        let path = &P::SETS[index - P::READS.len()];
        return if has(&SETTINGS, path.quantity) { Some(path.request) } else { None };
    }
    let path = &P::READS[index];
    match path.request {
        Some(request) if has(&READINGS, path.quantity) => Some(request),
        Some(_) | None => None,
    }
}

const fn has(wanted: &[Quantity], quantity: Quantity) -> bool {
    let mut index = 0;
    while index < wanted.len() {
        if is_same(wanted[index].name(), quantity.name()) {
            return true;
        }
        index += 1;
    }
    false
}

const fn is_same(one: &str, other: &str) -> bool {
    let (one, other) = (one.as_bytes(), other.as_bytes());
    let mut index = 0;
    while index < one.len() && index < other.len() {
        if one[index] != other[index] {
            return false;
        }
        index += 1;
    }
    one.len() == other.len()
}
