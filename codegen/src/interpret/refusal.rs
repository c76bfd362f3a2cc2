//! Why a message is refused.

use std::collections::HashSet;

use super::Refusal;
use crate::model::{Message, ModelId, Protocol};

/// Refuses a message.
pub fn refuse(message: &Message, why: &str) -> Refusal {
    Refusal(format!("{}: {why}", message.name))
}

/// Refuses a message that a device model does not have.
pub fn not_of(protocol: &Protocol, message: &Message, model: ModelId) -> Refusal {
    refuse(message, &format!("{} has no such message", protocol[model].name))
}

/// Returns a name that is given twice.
pub fn twice<T>(given: &[(String, T)]) -> Option<&str> {
    let mut known = HashSet::new();
    given.iter().map(|(name, _)| name.as_str()).find(|name| !known.insert(*name))
}
