//! Items that only generated code needs. They can change with every release, as generated code
//! does.

#[cfg(feature = "arbitrary")]
pub use arbitrary;
#[cfg(feature = "defmt")]
pub use defmt;
#[cfg(feature = "serde")]
pub use serde;

pub use crate::address::{Address, Pattern, Who};
pub use crate::exchange::{Particulars, Sent};
pub use crate::filter::IdFilter;
pub use crate::incoming::Incoming;
pub use crate::layout::{AnySignals, Decode, Signals, Task};
pub use crate::long::parts::Said;
pub use crate::long::{ByteRun, LongPayload};
pub use crate::packed::{Piece, left_aligned, right_aligned};
pub use crate::physical::{Physical, Scaled};
pub use crate::place::ByteOrder;
pub use crate::protocol::{Headed, Heading};
pub use crate::quantity::States;
pub use crate::raw::{Integer, Raw};
pub use crate::scale::{Scale, nearest};
pub use crate::set::Continuation;
pub use crate::signal::Lack;
pub use crate::timing::{milliseconds, nanoseconds};
pub use crate::way::{Shown, Way};
pub use crate::word::{Legend, Word};

/// Items that a generated module imports, beside those that it re-exports to its users.
pub mod prelude {
    pub use super::{
        Address, AnySignals, Continuation, Decode, Headed, Heading, IdFilter, Incoming, Lack, Legend, LongPayload,
        Particulars, Pattern, Piece, Said, Sent, Shown, States, Task, Way, Who, Word, left_aligned, milliseconds,
        nanoseconds, right_aligned,
    };
    pub use crate::{Addressed, Destination, Protocol};
}
