//! A bus between two sides, in virtual time. Each frame takes a millisecond, and some get lost.

use canspec_protocols::gbt27930::Frame;

use super::charger::Charger;
use super::side::{Phase, Station};
use super::vehicle::Vehicle;

/// The longest time until both sides have ended, whatever happens: four times each wait of section 8.3.
const LONGEST: u32 = 4 * (5 + 30 + 60 + 60 + 120) * 1000;

/// A session that has ended.
pub struct Session {
    pub vehicle: Vehicle,
    pub charger: Charger,
    /// The frames of both sides, those included that got lost.
    pub frames: Vec<(u32, Frame)>,
}

impl Session {
    pub fn phases(&self) -> [Phase; 2] {
        [self.vehicle.side.phase, self.charger.side.phase]
    }

    /// Returns when frames with an identifier were sent.
    pub fn times(&self, id: u32) -> Vec<u32> {
        self.frames.iter().filter(|(_, frame)| frame.raw_id() == id).map(|(at, _)| *at).collect()
    }

    /// Returns the times between frames that follow each other in one attempt. Error messages end an attempt, and CHM
    /// those.
    pub fn gaps(&self, is_meant: impl Fn(&Frame) -> bool) -> Vec<u32> {
        let (mut gaps, mut before) = (Vec::new(), None);
        for (at, frame) in &self.frames {
            if is_meant(frame) {
                gaps.extend(before.map(|before: (u32, bool)| at - before.0));
                before = Some((*at, is_error(frame)));
            } else {
                let is_end = |before: &(u32, bool)| if before.1 { message_of(frame) == 0x26 } else { is_error(frame) };
                before = before.filter(|before| !is_end(before));
            }
        }
        gaps
    }
}

/// Runs a session until both sides have ended. Some frames get lost.
pub fn run(vehicle: Vehicle, charger: Charger, is_lost: impl FnMut(&Frame, u32) -> bool) -> Session {
    run_from(0, vehicle, charger, is_lost)
}

/// The same with clocks of both sides that begin at some time. All others count from 0.
pub fn run_from(
    start: u32,
    mut vehicle: Vehicle,
    mut charger: Charger,
    mut is_lost: impl FnMut(&Frame, u32) -> bool,
) -> Session {
    vehicle.plug(start);
    charger.begin(start);
    let mut frames = Vec::new();
    for passed in 0..LONGEST {
        let now = start.wrapping_add(passed);
        let of_vehicle: Vec<_> = std::iter::from_fn(|| vehicle.poll(now)).collect();
        let of_charger: Vec<_> = std::iter::from_fn(|| charger.poll(now)).collect();
        frames.extend(of_vehicle.iter().chain(&of_charger).map(|frame| (passed, *frame)));
        let mut arrives = |frame: &&Frame| !is_lost(frame, passed);
        of_vehicle.iter().filter(&mut arrives).for_each(|frame| charger.handle(frame, now.wrapping_add(1)));
        of_charger.iter().filter(&mut arrives).for_each(|frame| vehicle.handle(frame, now.wrapping_add(1)));
        let is_over = |phase| matches!(phase, Phase::Done | Phase::Failed);
        if of_vehicle.is_empty() && of_charger.is_empty() && is_over(vehicle.side.phase) && is_over(charger.side.phase)
        {
            return Session { vehicle, charger, frames };
        }
    }
    panic!("after {LONGEST} ms: {:?} and {:?}", vehicle.side.phases, charger.side.phases);
}

/// Tests whether a frame is BEM or CEM.
fn is_error(frame: &Frame) -> bool {
    matches!(message_of(frame), 0x1E | 0x1F)
}

/// Returns the format byte of the message that a frame belongs to. A packet has none.
pub fn message_of(frame: &Frame) -> u32 {
    match frame.raw_id() >> 16 & 0xFF {
        0xEC => frame.bytes()[6].into(),
        format => format,
    }
}

pub fn hex(data: &[u8]) -> String {
    data.iter().map(|byte| format!("{byte:02X}")).collect::<Vec<_>>().concat()
}
