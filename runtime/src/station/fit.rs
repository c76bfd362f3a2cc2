//! Whether a station fits its document.

use super::{Found, Settings, Unfit, request};
use crate::{Addressed, AfterSilence, Protocol, Quantities, Quantity, Replies};

/// The longest time in milliseconds that a station counts, which is six days.
pub const LONGEST: u32 = 1 << 29;

/// Tests whether a station can control the modules at these addresses. Returns whether what it does with those that it
/// finds can wake them.
pub fn fits<P: Quantities + Addressed>(settings: &Settings, addresses: &[u8]) -> Result<bool, Unfit> {
    fits_time::<P>(settings, addresses.len())?;
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
            settings.limits.allow(point).map_err(Unfit::Beyond)?;
            request::deliver::<P>(settings, target, point).map_err(Unfit::Document)?;
            // What cannot be set alone is read first.
            may_wake |= request::prepare::<P>(settings, target, point).iter().all(Option::is_none);
        }
    }
    Ok(may_wake && can_wake::<P>())
}

/// Tests whether modules can come back as they were when they hear anything, or whether the document does not say it.
pub const fn can_wake<P: Protocol>() -> bool {
    matches!(P::AFTER_SILENCE, AfterSilence::Resumes | AfterSilence::Starts | AfterSilence::Unknown)
}

/// Tests whether the times of a station fit the document.
fn fits_time<P: Quantities>(settings: &Settings, modules: usize) -> Result<(), Unfit> {
    let Settings { pace, round, valid, .. } = *settings;
    let watchdog = watchdog::<P>().unwrap_or(LONGEST);
    let frames = u32::try_from(modules.saturating_mul(request::each_round::<P>())).unwrap_or(u32::MAX);
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
