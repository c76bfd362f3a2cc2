//! What the codecs that canspec generates call: places, scaling, signals, frames, filters and addressing.
//!
//! No allocation, no unsafe code, no dependency but [`embedded_can`].
#![no_std]

#[cfg(test)]
extern crate std;

mod address;
mod error;
mod filter;
mod frame;
mod layout;
mod number;
mod packed;
mod payload;
mod place;
pub mod prelude;
mod protocol;
mod raw;
mod reply;
mod request;
mod scale;
mod signal;
mod status;
#[cfg(test)]
mod tests;
mod text;
mod word;

pub use address::{Address, AddressType, Addressing, Kind, Mode, Pattern, Who};
pub use embedded_can;
pub use error::Error;
pub use filter::{Filter, Selector};
pub use frame::Frame;
pub use layout::Layout;
pub use number::Number;
pub use packed::{Packed, PackedText, Piece, left_aligned, right_aligned};
pub use payload::Payload;
pub use place::{Bits, ByteOrder, Data, Place};
pub use protocol::{IdentifierFields, Problem, Protocol, Received, Recognised};
pub use raw::{Integer, Meaning, Raw};
pub use reply::{Failure, Reply};
pub use request::{Destination, Exchange, Replies, Request, Route};
pub use scale::{Scale, nearest};
pub use signal::{AnySignal, Reading, Signal};
pub use status::{Severity, StatusBit};
pub use text::Text;
pub use word::{Legend, Named, StatusWord, Word};
