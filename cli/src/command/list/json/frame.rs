//! A kind of frame of a message.

use canspec_codegen::model::{Constant, FrameLayout, Protocol, Travel};
use serde::Serialize;

use super::addressing::Pattern;
use crate::command::list::{frames, words};
use crate::log;

/// A kind of frame.
#[derive(Serialize)]
pub struct Frame<'a> {
    access: &'a str,
    kind: &'static str,
    sender: &'static str,
    /// The set that it belongs to.
    set: Option<&'a str>,
    lengths: &'a [u8],
    constants: Vec<Fixed<'a>>,
    selectors: Vec<&'a str>,
    signals: Vec<&'a str>,
    /// Bits that nothing covers, as hexadecimal digits of the data.
    reserved: String,
    /// The addressing modes, and what the identifier shows in each.
    identifiers: Vec<Shown<'a>>,
}

/// A value that a selector has in each frame.
#[derive(Serialize)]
struct Fixed<'a> {
    selector: &'a str,
    values: Vec<u64>,
}

/// What the identifier shows in an addressing mode.
#[derive(Serialize)]
struct Shown<'a> {
    mode: &'a str,
    who: &'static str,
    #[serde(flatten)]
    pattern: Pattern<'a>,
}

impl<'a> Frame<'a> {
    /// Returns a frame of a protocol.
    pub fn of(protocol: &'a Protocol, frame: &'a FrameLayout) -> Self {
        let reserved = frame.uncovered().to_be_bytes();
        Self {
            access: &protocol[frame.access].name,
            kind: frame.kind.name(),
            sender: words::side(frame.sender),
            set: frame.set.map(|set| protocol[set].name.as_str()),
            lengths: &frame.lengths,
            constants: frame.constants.iter().map(|constant| Fixed::of(protocol, constant)).collect(),
            selectors: frame.selectors.iter().map(|selector| protocol[*selector].name.as_str()).collect(),
            signals: protocol.signals_of(frame).map(|(_, signal)| signal.name.as_str()).collect(),
            reserved: log::hexadecimal(reserved.get(..frame.longest().into()).unwrap_or(&reserved)),
            identifiers: frame.travels.iter().filter_map(|travel| Shown::of(protocol, frame, *travel)).collect(),
        }
    }
}

impl<'a> Fixed<'a> {
    fn of(protocol: &'a Protocol, constant: &Constant) -> Self {
        Self { selector: &protocol[constant.selector].name, values: constant.values().collect() }
    }
}

impl<'a> Shown<'a> {
    fn of(protocol: &'a Protocol, frame: &FrameLayout, Travel { mode, who, .. }: Travel) -> Option<Self> {
        let pattern = protocol[mode].pattern(frame.is_to_module(), who)?;
        let (mask, value) = frames::identifier(protocol, frame, pattern);
        let pattern = Pattern::with(protocol, pattern, mask, value);
        Some(Self { mode: &protocol[mode].name, who: words::who(who), pattern })
    }
}
