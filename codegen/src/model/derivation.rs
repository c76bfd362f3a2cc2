//! What a spec takes over from another one.

use serde::{Deserialize, Serialize};

use crate::model::{MessageId, Table};
use crate::words::text::Text;

/// How a spec changes the one that it is based on.
#[derive(Clone, Debug, Serialize, Deserialize)]
#[non_exhaustive]
pub struct Derivation {
    /// Name of the other spec.
    pub base: Text,
    /// What it replaces, each by the keys that lead to it, as `messages.output.title`.
    pub replaces: Vec<Text>,
    /// What it does not take over, each by the keys that lead to it.
    pub removes: Vec<Text>,
    /// Where each message comes from.
    pub descents: Table<MessageId, Descent>,
}

/// Where a message comes from.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub enum Descent {
    /// The base does not have it.
    Own,
    /// It is that of the base, with changes.
    Changed,
    /// It is that of the base.
    TakenOver,
}
