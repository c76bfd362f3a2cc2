//! Items that users of a generated module need to name. Every such module re-exports them.

pub use crate::{
    Access, AddressType, AfterSilence, AnySignal, Bcd, Bits, Bytes, Data, Document, Elements, Entry, Error, Exchange,
    Failure, Filter, Frame, FrameSet, IdentifierFields, Kind, Layout, LongLayout, LongSignal, LongText, Meaning, Mode,
    Number, PackedText, Payload, Place, Problem, Quantities, Quantity, ReadPath, Reading, Replies, Route, Selector,
    SetPath, Severity, Signal, StatusBit, Text, Time, Timing, assembler, embedded_can, parts, parts::Parted, transfers,
    transfers::Transferred,
};
