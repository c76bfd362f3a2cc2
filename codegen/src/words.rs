//! Numbers and texts, before anything is known of protocols.
//!
//! Everything else in the compiler stands on this layer, and it stands on nothing. A [`text::Text`]
//! is what somebody else wrote; each output has its own method to write it. A
//! [`number::Rational`] is exact from the spec to the constants of a codec. `hex` reads and writes
//! bytes as documents print them, `nearest` finds the name that somebody meant, and `visible` keeps out
//! what nobody sees.

pub mod hex;
pub mod nearest;
pub mod number;
pub mod text;
pub mod visible;
