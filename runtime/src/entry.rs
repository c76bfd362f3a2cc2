//! The list of a protocol's messages, for programs that treat all messages alike.

use core::fmt;
use core::marker::PhantomData;

use crate::{AnySignal, Destination, Error, Exchange, Layout, Protocol, Request, Route};

/// An entry of the list of messages.
pub struct Entry<P: 'static> {
    /// What it is, in a few words.
    pub title: &'static str,
    /// Names and values of the fields in identifier or data that choose the message, such as a
    /// register number.
    pub constants: &'static [(&'static str, u64)],
    /// The signals, by first byte.
    pub signals: &'static [&'static dyn AnySignal],
    /// How the message travels, by each of its accesses.
    pub exchanges: &'static [&'static Exchange],
    protocol: PhantomData<fn() -> P>,
}

impl<P: Protocol> Entry<P> {
    /// Returns an entry.
    pub const fn new(
        title: &'static str,
        constants: &'static [(&'static str, u64)],
        signals: &'static [&'static dyn AnySignal],
        exchanges: &'static [&'static Exchange],
    ) -> Self {
        Self { title, constants, signals, exchanges, protocol: PhantomData }
    }

    /// Returns the entry of a message that has all of its signals in one struct.
    pub const fn of<L: Layout>(
        title: &'static str,
        constants: &'static [(&'static str, u64)],
        exchanges: &'static [&'static Exchange],
    ) -> Self {
        Self::new(title, constants, L::SIGNALS, exchanges)
    }

    /// Returns the name of the message.
    pub const fn name(&self) -> &'static str {
        match self.exchanges {
            [exchange, ..] => exchange.message(),
            [] => "",
        }
    }

    /// Builds a request without values, such as a read. Returns `None` if the message has no such
    /// request by this access.
    ///
    /// The request knows which frames answer it. [`Received::decode`](crate::Received::decode)
    /// reads their values.
    ///
    /// # Errors
    ///
    /// Refuses other addressing modes, and undocumented addresses.
    pub fn request<T>(&self, access: &str, route: impl Into<Route<T>>) -> Option<Result<Request<P, ()>, Error>>
    where
        T: Destination<Protocol = P>,
    {
        let exchange = self.exchanges.iter().find(|exchange| exchange.asks_by(access))?;
        Some(exchange.request_to(route, &()))
    }
}

impl<P: Protocol> fmt::Debug for Entry<P> {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        formatter.debug_struct("Entry").field("name", &self.name()).finish_non_exhaustive()
    }
}
