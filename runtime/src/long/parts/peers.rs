//! Who sends a frame, and to whom.

use crate::plumbing::Address;
use crate::{AddressType, Protocol, Received};

/// The addresses that an identifier shows, of one side or of both, and where its frame goes.
#[derive(Clone, Copy, Debug)]
pub struct Peers {
    id: u32,
    addresses: &'static [Address],
    is_to_module: bool,
}

impl Peers {
    /// Returns those of a frame, if its identifier shows an addressing mode.
    pub fn of<P: Protocol>(received: &Received<P>) -> Option<Self> {
        let addresses = received.addressing()?.addresses();
        Some(Self { id: received.frame().raw_id(), addresses, is_to_module: received.is_to_module() })
    }

    /// Tests whether the frame goes to a module.
    pub fn is_to_module(&self) -> bool {
        self.is_to_module
    }

    /// Tests whether both go the same way and show the same addresses, wherever in the identifier.
    pub fn are(&self, other: &Self) -> bool {
        self.is_to_module == other.is_to_module && are_same(&self.numbers(), &other.numbers())
    }

    /// Tests whether a module answers to a request by these frames.
    pub fn answer(&self, request: &Self) -> bool {
        self.are(&Self { is_to_module: false, ..*request })
    }

    /// Tests whether both show the same module. Addresses that are sent unless somebody says otherwise are not its own.
    pub fn are_of_module(&self, other: &Self) -> bool {
        let of_module = |(kind, _): &(&AddressType, i32)| !kind.is_sent();
        are_same(&self.numbers().filter(of_module), &other.numbers().filter(of_module))
    }

    fn numbers(&self) -> impl Iterator<Item = (&'static AddressType, i32)> + Clone {
        let id = self.id;
        self.addresses.iter().map(move |address| (address.kind(), address.number(id)))
    }
}

/// Tests whether both have the same addresses, each as often.
fn are_same<'a>(
    one: &(impl Iterator<Item = (&'a AddressType, i32)> + Clone),
    other: &(impl Iterator<Item = (&'a AddressType, i32)> + Clone),
) -> bool {
    let is_one = |(kind, number): (&AddressType, i32), (known, of_known): (&AddressType, i32)| {
        number == of_known && kind.is(known)
    };
    let has_as_many = |wanted| {
        let count = one.clone().filter(|known| is_one(wanted, *known)).count();
        count == other.clone().filter(|known| is_one(wanted, *known)).count()
    };
    one.clone().count() == other.clone().count() && one.clone().all(has_as_many)
}
