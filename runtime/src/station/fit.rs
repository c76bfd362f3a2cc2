//! Whether a station fits its document.

use super::{Found, Refused, SetPoint, Settings, Unfit, request};
use crate::client::Nodes;
use crate::{Addressed, AfterSilence, Protocol, Quantities, Quantity, Replies};

/// The longest time in milliseconds that a station counts, which is six days.
pub const LONGEST: u32 = 1 << 29;

/// Tests whether a station can control the modules at these addresses, in these groups. Returns whether what it does
/// with those that it finds can wake them.
pub fn fits<P: Quantities + Addressed>(
    settings: &Settings,
    addresses: &[u8],
    groups: impl Iterator<Item = u8> + Clone,
) -> Result<bool, Unfit> {
    fits_time::<P>(settings, addresses.len(), groups.clone().count())?;
    let twice = twice(addresses.iter().copied()).or_else(|| twice(groups));
    twice.map_or(Ok(()), |number| Err(Unfit::Twice(number)))?;
    if !settings.limits.let_something_be_set() {
        return Err(Unfit::Limits);
    }
    if !request::is_read::<P>(Quantity::DELIVERING) {
        return Err(Unfit::Unread);
    }
    let mut may_wake = settings.found == Found::Watch;
    for node in addresses.iter().copied() {
        let target = P::module(node.into()).ok_or(Unfit::Address(node))?;
        let off = request::switch_off::<P>(settings, target).map_err(Unfit::Document)?;
        if off.ok_or(Unfit::Address(node))?.replies() == Replies::Nobody {
            return Err(Unfit::Unanswered);
        }
        if let Found::Adopt(point) = settings.found {
            allows::<P>(settings, target, point).map_err(Unfit::Adopt)?;
            // What cannot be set alone is read first.
            may_wake |= request::prepare::<P>(settings, target, point).iter().all(Option::is_none);
        }
    }
    Ok(may_wake && can_wake::<P>())
}

/// Tests whether a module may deliver something: within the limits, as the document allows it, and so that its answers
/// show whether it is in effect.
pub fn allows<P: Quantities + Addressed>(
    settings: &Settings,
    target: P::Target,
    point: SetPoint,
) -> Result<(), Refused> {
    if point.current_ma.is_none() && P::SETS.iter().any(|path| path.quantity == Quantity::OUTPUT_CURRENT) {
        return Err(Refused::NoCurrent);
    }
    settings.limits.allow(point).map_err(Refused::Beyond)?;
    let requests = request::deliver::<P>(settings, target, point).map_err(Refused::Output)?;
    let is_answered = requests.iter().flatten().all(|request| request.replies() != Replies::Nobody);
    if is_answered { Ok(()) } else { Err(Refused::Unanswered) }
}

/// Returns the first number that comes again.
fn twice(numbers: impl Iterator<Item = u8>) -> Option<u8> {
    let mut known = Nodes::NONE;
    numbers.into_iter().find(|number| {
        let is_known = known.contains(*number);
        known.insert(*number);
        is_known
    })
}

/// Tests whether modules can come back as they were when they hear anything, or whether the document does not say it.
pub const fn can_wake<P: Protocol>() -> bool {
    matches!(P::AFTER_SILENCE, AfterSilence::Resumes | AfterSilence::Starts | AfterSilence::Unknown)
}

/// Tests whether the times of a station fit the document.
fn fits_time<P: Quantities>(settings: &Settings, modules: usize, groups: usize) -> Result<(), Unfit> {
    let Settings { pace, round, valid, .. } = *settings;
    let watchdog = watchdog::<P>().unwrap_or(LONGEST);
    // Each group has a stop in each round, too.
    let frames = modules.saturating_mul(request::each_round::<P>()).saturating_add(groups);
    let frames = u32::try_from(frames).unwrap_or(u32::MAX);
    // A request that nobody answers ends before the next round.
    let ends = pace.wait.saturating_add(pace.late).saturating_add(1);
    let (least, most) = (frames.saturating_mul(pace.gap).max(ends), watchdog / 3);
    if round < least || round > most {
        return Err(Unfit::Round { least, most });
    }
    if valid < round || valid > watchdog {
        return Err(Unfit::Valid { least: round, most: watchdog });
    }
    Ok(())
}

/// Returns the silence after which a module acts by itself, in milliseconds.
pub fn watchdog<P: Protocol>() -> Option<u32> {
    let shortest = P::TIMING.watchdog?.shortest.as_millis();
    Some(u32::try_from(shortest).unwrap_or(LONGEST).min(LONGEST))
}
