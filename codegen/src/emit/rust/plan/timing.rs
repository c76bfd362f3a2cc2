//! Times by their roles.

use std::time::Duration;

use proc_macro2::TokenStream;
use quote::quote;

use super::literal;
use crate::model::{MessageId, Protocol, TimeRole, Timing as Stated};

/// The nanoseconds of a millisecond.
const NANOSECONDS: u64 = 1_000_000;

/// The times that have a role.
pub struct Timing {
    /// Those that are about every message.
    pub general: Times,
    /// Those that are about one message, with its name.
    pub of_messages: Vec<(String, Times)>,
}

/// What is stated, each with its value.
pub type Times = Vec<(&'static str, TokenStream)>;

impl Timing {
    /// Plans the times, if one of them has a role.
    pub fn new(protocol: &Protocol) -> Option<Self> {
        let of = |message| times(protocol, message);
        let own = protocol.messages.entries().map(|(id, message)| (message.name.clone(), of(Some(id))));
        let timing = Self { general: of(None), of_messages: own.filter(|(_, own)| !own.is_empty()).collect() };
        (!timing.general.is_empty() || !timing.of_messages.is_empty()).then_some(timing)
    }
}

/// Returns the times that are about one message, or about every message.
fn times(protocol: &Protocol, message: Option<MessageId>) -> Times {
    let is_about = |timing: &&Stated| match message {
        Some(id) => timing.messages.contains(&id),
        None => timing.messages.is_empty(),
    };
    let times: Vec<&Stated> = protocol.timing.iter().filter(is_about).collect();
    let of_role = |role: TimeRole| times.iter().find(move |timing| timing.role == Some(role));
    TimeRole::ALL.into_iter().filter_map(of_role).flat_map(|timing| members(timing)).collect()
}

fn members(timing: &Stated) -> impl Iterator<Item = (&'static str, TokenStream)> {
    let time = time(timing);
    let time = timing.role.map(|role| (role.name(), time));
    time.into_iter().chain(timing.tries.map(|tries| ("tries", literal::decimal(tries))))
}

fn time(timing: &Stated) -> TokenStream {
    let [shortest, longest] = timing.ends();
    let least = timing.least().map(duration).map(|least| quote!(.at_least(#least)));
    let ends = [shortest, longest].map(duration);
    match ends {
        [only, _] if shortest == longest => quote!(Time::of(#only)#least),
        [shortest, longest] => quote!(Time::between(#shortest, #longest)#least),
    }
}

/// Writes a time in milliseconds, or in nanoseconds if they are not whole.
fn duration(time: Duration) -> TokenStream {
    let nanoseconds = u64::try_from(time.as_nanos()).unwrap_or(u64::MAX);
    if nanoseconds.is_multiple_of(NANOSECONDS) {
        let count = literal::decimal(nanoseconds / NANOSECONDS);
        return quote!(milliseconds(#count));
    }
    let count = literal::decimal(nanoseconds);
    quote!(nanoseconds(#count))
}
