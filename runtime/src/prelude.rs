//! What users of a generated module need to name; every such module passes it on.

pub use crate::{
    Data, Error, Failure, Frame, IdentifierFields, Kind, Layout, Meaning, Named, Number, Packed, Payload, Problem,
    Reading, Replies, Route, Severity, StatusBit, StatusWord, Text, Word, assembler, embedded_can,
};
