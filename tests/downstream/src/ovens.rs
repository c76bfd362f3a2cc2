//! A driver for ovens, which answer with several frames each.

use crate::oven::assembler::{Assembler, Full, Progress};
use crate::oven::{Error, Frame, Identity, Measured, Target, embedded_can};

/// What eight ovens are measuring.
pub struct Ovens(Assembler<Measured, 8>);

impl Default for Ovens {
    /// Waits 100 ms for each frame.
    fn default() -> Self {
        Self(Assembler::new(100))
    }
}

impl Ovens {
    /// Returns the request to an oven, whose answer is awaited from now on.
    ///
    /// # Errors
    ///
    /// There is no such oven.
    pub fn ask(&mut self, oven: u8, now: u32) -> Result<Result<Frame, Full>, Error> {
        let request = Measured::scan(Target::Oven(oven))?;
        Ok(self.0.ask(oven, now).map(|()| *request.frame()))
    }

    /// Returns the temperature of an oven when all is known of it.
    pub fn temperature_c(&mut self, frame: &impl embedded_can::Frame, now: u32) -> Option<(i32, f64)> {
        match self.0.receive(frame, now)? {
            Progress::Complete { node, set, .. } => Some((node, set.temperature?.value_c)),
            _ => None,
        }
    }

    /// Returns an oven that has been silent for too long, and how many of its frames are missing.
    pub fn silent(&mut self, now: u32) -> Option<(i32, usize)> {
        let partial = self.0.timed_out(now)?;
        Some((partial.node, partial.missing.names().count()))
    }
}

/// Returns the frames that ask an oven who it is.
///
/// # Errors
///
/// There is no such oven.
pub fn who_is(oven: u8) -> Result<[Frame; 2], Error> {
    Identity::scan(Target::Oven(oven)).map(|requests| requests.map(|request| *request.frame()))
}
