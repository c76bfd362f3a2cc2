//! The library behind the codecs that canspec generates: places, scaling, signals, frames, filters
//! and addressing.
//!
//! No allocation, no unsafe code, no dependency but [`embedded_can`](https://docs.rs/embedded-can) and its `nb`.
//!
//! # Features
//!
//! No feature is on by default. Each one implements the optional traits for the types of this
//! crate, or adds a driver. Code that was generated with the switch of the same name needs it for its own types.
//!
//! | feature | traits |
//! |---|---|
//! | `serde` | `serde::Serialize` and `serde::Deserialize`, without the standard library |
//! | `defmt` | `defmt::Format` |
//! | `arbitrary` | `arbitrary::Arbitrary` of messages and frames; the crate `arbitrary` needs the standard library |
//! | `slcan` | none: it is the [driver](slcan) of serial adapters, for Linux and macOS, and needs the standard library |
//! | `socketcan` | none: it is the [driver](socketcan) of SocketCAN, for Linux, and needs the standard library and Rust 1.89 |
#![no_std]
#![forbid(unsafe_code)]
#![warn(clippy::wildcard_enum_match_arm)]
#![allow(clippy::cast_possible_wrap, clippy::cast_sign_loss, reason = "`cast_signed` is newer than Rust 1.85")]
#![allow(clippy::inline_always, reason = "what a spec says is constant, and folds only where it is inlined")]

#[cfg(any(test, feature = "slcan", feature = "socketcan"))]
extern crate std;

mod address;
mod after_silence;
mod answer;
pub mod assembler;
mod bcd;
mod bytes;
pub mod client;
pub mod clock;
mod document;
mod entry;
mod error;
mod exchange;
mod filter;
mod frame;
mod incoming;
pub mod isotp;
mod layout;
#[cfg(any(feature = "slcan", all(feature = "socketcan", target_os = "linux")))]
mod link;
mod long;
mod number;
mod packed;
mod payload;
mod physical;
mod place;
#[doc(hidden)]
pub mod plumbing;
pub mod prelude;
mod protocol;
mod quantity;
mod raw;
mod received;
mod reply;
mod report;
mod request;
mod route;
mod scale;
pub mod schedule;
mod set;
mod signal;
pub mod sim;
#[cfg(feature = "slcan")]
pub mod slcan;
#[cfg(all(feature = "socketcan", target_os = "linux"))]
pub mod socketcan;
pub mod station;
mod status;
#[cfg(test)]
mod tests;
mod text;
mod timing;
pub mod tp;
mod way;
#[cfg(feature = "arbitrary")]
pub mod with_arbitrary;
#[cfg(feature = "defmt")]
pub mod with_defmt;
#[cfg(feature = "serde")]
pub mod with_serde;
mod word;

pub use address::{AddressType, Addressing, Kind, Mode};
pub use after_silence::AfterSilence;
pub use bcd::Bcd;
pub use bytes::Bytes;
pub use document::Document;
pub use embedded_can;
pub use entry::Entry;
pub use error::{Error, Reason, ValueError};
pub use exchange::{Access, Exchange};
pub use filter::{Filter, Selector};
pub use frame::{Frame, NotAFrame};
pub use layout::Layout;
pub use long::{Elements, LongLayout, LongSignal, LongText, parts, transfers};
pub use number::Number;
pub use packed::PackedText;
pub use payload::Payload;
pub use place::{Bits, Data, Place};
pub use protocol::{Addressed, IdentifierFields, Problem, Protocol};
pub use quantity::{OutOfRange, Quantities, Quantity, QuantityKind, ReadPath, SetPath};
pub use raw::Meaning;
pub use received::Received;
pub use reply::{Failure, Reply};
pub use request::{Replies, Request};
pub use route::{Destination, Route};
pub use set::FrameSet;
pub use signal::{AnySignal, ReadNumber, Reading, SetNumber, Signal, WriteSignal};
pub use status::{Severity, StatusBit};
pub use text::Text;
pub use timing::{Time, Timing};

/// Includes the code that a build script generated for a protocol, as the content of a module.
///
/// ```rs
/// pub mod heater {
///     canspec_runtime::include_protocol!("heater");
/// }
/// ```
///
/// The name is that of the protocol in its spec. `canspec_codegen::Builder` writes the file, here
/// `OUT_DIR/heater.rs`. Two of clippy's pedantic lints would complain about it, so they are silenced.
#[macro_export]
macro_rules! include_protocol {
    ($name:literal) => {
        #[allow(clippy::inline_always, clippy::missing_errors_doc, reason = "it is generated")]
        mod generated {
            ::core::include!(::core::concat!(::core::env!("OUT_DIR"), "/", $name, ".rs"));
        }
        pub use generated::*;
    };
}
