//! What becomes of a frame of a log: every output shows the same.

use canspec_codegen::interpret::{Decoded, Frame, Unrecognised};
use canspec_codegen::model::Protocol;

/// A frame of a log, and what a protocol makes of it.
pub struct Outcome<'a> {
    pub line: usize,
    /// The text of a number of JSON.
    pub time: Option<&'a str>,
    pub channel: Option<&'a str>,
    pub frame: &'a Frame,
    pub protocol: &'a Protocol,
    pub decoded: &'a Result<Decoded, Unrecognised>,
    /// What several frames say together; `None` for a frame.
    pub whole: Option<Whole<'a>>,
}

/// What a long message has besides its values.
pub struct Whole<'a> {
    /// The lines of its frames.
    pub lines: &'a [usize],
    /// The joined data, if no part is missing.
    pub data: Option<&'a [u8]>,
    /// Bits that no signal covers.
    pub reserved: &'a [u8],
    /// The name of what tells it from the next message, and its value.
    pub counter: Option<(&'a str, u64)>,
    /// Which parts are missing.
    pub incomplete: Option<&'a str>,
}
