//! What the codecs that canspec generates call: places, scaling, signals, frames, filters and addressing.
//!
//! No allocation, no unsafe code, no dependency but [`embedded_can`].
//!
//! # Features
//!
//! None is on by default. Each gives the optional traits to the types of this crate, and lets code generated with the
//! switch of the same name give them to its own.
//!
//! | feature | traits |
//! |---|---|
//! | `serde` | `serde::Serialize` and `serde::Deserialize`, without the standard library |
//! | `defmt` | `defmt::Format` |
//! | `arbitrary` | `arbitrary::Arbitrary` of messages and frames; the crate `arbitrary` needs the standard library |
#![no_std]
#![forbid(unsafe_code)]
#![warn(clippy::wildcard_enum_match_arm)]

#[cfg(test)]
extern crate std;

mod address;
pub mod assembler;
mod bcd;
mod entry;
mod error;
mod filter;
mod frame;
mod layout;
mod number;
mod packed;
mod payload;
mod physical;
mod place;
#[doc(hidden)]
pub mod plumbing;
pub mod prelude;
mod protocol;
mod raw;
mod received;
mod reply;
mod request;
mod scale;
mod set;
mod signal;
mod status;
#[cfg(test)]
mod tests;
mod text;
#[cfg(feature = "arbitrary")]
pub mod with_arbitrary;
#[cfg(feature = "defmt")]
pub mod with_defmt;
#[cfg(feature = "serde")]
pub mod with_serde;
mod word;

pub use address::{AddressType, Addressing, Kind, Mode};
pub use bcd::Bcd;
pub use embedded_can;
pub use entry::Entry;
pub use error::Error;
pub use filter::{Filter, Selector};
pub use frame::Frame;
pub use layout::Layout;
pub use number::Number;
pub use packed::PackedText;
pub use payload::Payload;
pub use place::{Bits, Data, Place};
pub use protocol::{IdentifierFields, Problem, Protocol};
pub use raw::Meaning;
pub use received::Received;
pub use reply::{Failure, Reply};
pub use request::{Destination, Exchange, Replies, Request, Route};
pub use set::FrameSet;
pub use signal::{AnySignal, Reading, Signal, WriteSignal};
pub use status::{Severity, StatusBit};
pub use text::Text;

/// Includes the code that a build script generated for a protocol, as the content of a module.
///
/// ```rs
/// pub mod heater {
///     canspec_runtime::include_protocol!("heater");
/// }
/// ```
///
/// The name is that of the protocol in its spec. The file is `OUT_DIR/heater.rs`, where `canspec_codegen::Builder` writes it.
#[macro_export]
macro_rules! include_protocol {
    ($name:literal) => {
        ::core::include!(::core::concat!(::core::env!("OUT_DIR"), "/", $name, ".rs"));
    };
}
