//! Items that users of a generated module need to name. Every such module re-exports them.

pub use crate::{
    Bcd, Data, Error, Failure, Filter, Frame, IdentifierFields, Kind, Layout, Meaning, Number, PackedText, Payload,
    Problem, Reading, Replies, Route, Severity, StatusBit, Text, assembler, embedded_can,
};
