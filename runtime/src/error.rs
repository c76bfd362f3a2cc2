//! Why a frame is not built.

mod value;

use core::fmt;

pub(crate) use value::{Fault, Refusable, Value};
pub use value::{Reason, ValueError};

use crate::Number;

/// Why a frame is not built.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub enum Error {
    /// A value is refused.
    Value(ValueError),
    /// An array of a long message has too few elements or too many, or not as many as the others
    /// that vary with it.
    Elements {
        /// Name of the message.
        message: &'static str,
        /// Name of the array.
        signal: &'static str,
        /// The number of its elements.
        count: usize,
        /// The least number of elements.
        minimum: usize,
        /// The greatest number of elements.
        maximum: usize,
    },
    /// The buffer has too few bytes for a long message.
    Room {
        /// Name of the message.
        message: &'static str,
        /// The number of data bytes.
        length: usize,
        /// The number of bytes in the buffer.
        room: usize,
    },
    /// The device model does not have the message.
    Model {
        /// Name of the message.
        message: &'static str,
    },
    /// The message does not travel in this addressing mode, or the mode is unknown.
    Mode {
        /// Name of the message.
        message: &'static str,
        /// Name of the access.
        access: &'static str,
        /// Name of the addressing mode, if the identifier shows one.
        mode: Option<&'static str>,
    },
    /// The frame is no request, or nobody answers it in this addressing mode.
    Unanswered {
        /// Name of the message.
        message: &'static str,
        /// Name of the access.
        access: &'static str,
    },
    /// The module that should answer was not asked.
    Node {
        /// Name of the message.
        message: &'static str,
        /// Number of the module.
        node: i32,
        /// Number of the module that was asked.
        asked: i32,
    },
    /// Replies of the message have no such error code. They have no field for it or none with room for
    /// it, or the code says that there is no error.
    Code {
        /// Name of the message.
        message: &'static str,
        /// The refused code.
        code: u64,
    },
    /// The address lies outside the documented range.
    Address {
        /// Name of the kind of address.
        address: &'static str,
        /// The refused address.
        number: i32,
        /// The first address.
        first: i32,
        /// The last address.
        last: i32,
    },
    /// The document names other addresses only.
    UnnamedAddress {
        /// Name of the kind of address.
        address: &'static str,
        /// The refused address.
        number: i32,
    },
    /// The identifier belongs to another message, kind of frame or protocol.
    Identifier {
        /// Name of the message.
        message: &'static str,
        /// The refused identifier.
        id: u32,
    },
    /// The protocol has no message from which the quantity is read.
    NotRead {
        /// Name of the quantity.
        quantity: &'static str,
    },
    /// The quantity comes in a reply to requests with values only. The program builds such a request itself.
    NotAsked {
        /// Name of the message.
        message: &'static str,
        /// Name of the quantity.
        quantity: &'static str,
    },
    /// The protocol has no message that sets the quantity.
    NotSet {
        /// Name of the quantity.
        quantity: &'static str,
    },
    /// A message that sets several quantities lacks the value of one.
    NotGiven {
        /// Name of the message.
        message: &'static str,
        /// Name of the quantity.
        quantity: &'static str,
    },
    /// The quantity has two values.
    SetTwice {
        /// Name of the quantity.
        quantity: &'static str,
    },
    /// The output is switched on before another message sets the rest.
    TooEarly {
        /// Name of the quantity.
        quantity: &'static str,
    },
    /// The quantity is a switch, and the value is neither 0 nor 1.
    State {
        /// Name of the quantity.
        quantity: &'static str,
        /// The refused value.
        value: i32,
    },
}

impl Error {
    /// Says that a number was asked for, where limits or the width of the bits refuse its raw value.
    pub(crate) fn of_asked(self, number: Number) -> Self {
        if let Self::Value(error) = self { Self::Value(error.asked(number)) } else { self }
    }

    /// Returns why a value is refused, if this is what is wrong.
    #[must_use]
    pub fn reason(&self) -> Option<Reason> {
        if let Self::Value(error) = self { Some(error.reason()) } else { None }
    }
}

impl fmt::Display for Error {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        match *self {
            Self::Value(error) => error.fmt(formatter),
            Self::Elements { message, signal, count, minimum, maximum } => {
                write!(
                    formatter,
                    "`{signal}` of `{message}` has {count} elements, but its limits are {minimum} and {maximum}"
                )
            }
            Self::Room { message, length, room } => {
                write!(formatter, "`{message}` has {length} data bytes, and the buffer has room for {room}")
            }
            Self::Model { message } => write!(formatter, "the device model has no `{message}`"),
            Self::Mode { message, access, mode: Some(mode) } => {
                write!(formatter, "`{message}` has no `{access}` with the addressing mode `{mode}`")
            }
            Self::Mode { message, access, mode: None } => {
                write!(formatter, "the identifier shows no addressing mode for `{access}` of `{message}`")
            }
            Self::Unanswered { message, access } => {
                write!(
                    formatter,
                    "this `{access}` of `{message}` gets no reply: nobody answers it, or it is no request"
                )
            }
            Self::Node { message, node, asked } => {
                let [node, asked] = [node, asked].map(Hexadecimal);
                write!(formatter, "{node} cannot answer the request of `{message}`, which went to {asked}")
            }
            Self::Code { message, code } => write!(formatter, "replies of `{message}` have no error code {code}"),
            Self::Address { address, number, first, last } => {
                let [number, first, last] = [number, first, last].map(Hexadecimal);
                write!(formatter, "`{address}` is {number}, but its limits are {first}..={last}")
            }
            Self::UnnamedAddress { address, number } => {
                write!(formatter, "`{address}` is {}, which has no name", Hexadecimal(number))
            }
            Self::Identifier { message, id } => write!(formatter, "the identifier 0x{id:X} is none of `{message}`"),
            Self::NotRead { quantity } => write!(formatter, "no message reads `{quantity}`"),
            Self::NotAsked { message, quantity } => {
                write!(formatter, "a request of `{message}` has values, so build it to read `{quantity}`")
            }
            Self::NotSet { quantity } => write!(formatter, "no message sets `{quantity}`"),
            Self::NotGiven { message, quantity } => {
                write!(formatter, "`{message}` sets `{quantity}` too, which has no value")
            }
            Self::SetTwice { quantity } => write!(formatter, "`{quantity}` has two values"),
            Self::TooEarly { quantity } => write!(formatter, "`{quantity}` comes before what it needs; give it last"),
            Self::State { quantity, value } => write!(formatter, "`{quantity}` is 0 or 1, and not {value}"),
        }
    }
}

impl core::error::Error for Error {}

/// An address as documents print it: `0x0A`.
struct Hexadecimal(i32);

impl fmt::Display for Hexadecimal {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        let sign = if self.0 < 0 { "-" } else { "" };
        write!(formatter, "{sign}0x{:02X}", self.0.unsigned_abs())
    }
}
