//! What users of a generated module need to name; every such module passes it on.

pub use crate::{
    Bcd, Data, Error, Failure, Frame, IdentifierFields, Kind, Layout, Meaning, Number, PackedText, Payload, Problem,
    Reading, Replies, Route, Severity, StatusBit, Text, assembler, embedded_can,
};
