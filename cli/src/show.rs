//! What people and programs see of a frame.
//!
//! An `outcome` is a frame and what a protocol makes of it; every output shows the same of it. `line`
//! writes it as JSON and reads that back, `table` writes columns for people, and `value` a value in
//! them. `kept` remembers what frames have in common, and texts made of it. `columns` aligns any
//! table.

pub mod columns;
pub mod fields;
pub mod kept;
pub mod line;
pub mod outcome;
pub mod severity;
pub mod table;
pub mod value;
