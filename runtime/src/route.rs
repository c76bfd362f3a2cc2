//! Whom a request addresses, and who sends it.

use crate::address::Who;
use crate::filter::IdFilter;
use crate::plumbing::Way;
use crate::{Error, Protocol};

/// A target that a request of a protocol can address. Generated code implements it.
pub trait Destination: Copy {
    /// The messages of the protocol.
    type Protocol: Protocol;

    /// Returns the mode as an index into [`Protocol::MODES`].
    fn mode(self) -> usize;

    /// Returns what the identifier of a request shows. `sender` is the sender's own address, unless it is the
    /// usual one.
    ///
    /// # Errors
    ///
    /// Refuses addresses that the document does not name.
    fn request(self, sender: Option<i32>) -> Result<IdFilter, Error>;

    /// Returns what the identifiers of replies to this request show, if `who` answers in this mode.
    fn replies(self, who: Who, sender: Option<i32>) -> Option<IdFilter>;

    /// Returns the route of a request, as its identifier or that of a reply shows it.
    #[doc(hidden)]
    fn shown(way: &Way) -> Option<Route<Self>>;
}

/// A target, and the sender's own address.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub struct Route<T> {
    pub(crate) target: T,
    pub(crate) sender: Option<i32>,
}

impl<T: Destination> From<T> for Route<T> {
    #[inline(always)]
    fn from(target: T) -> Self {
        Self { target, sender: None }
    }
}

impl<T: Destination> Route<T> {
    /// Returns the route from a sender's own address.
    #[inline(always)]
    pub const fn new(target: T, sender: i32) -> Self {
        Self { target, sender: Some(sender) }
    }

    /// Returns the target.
    pub const fn target(&self) -> T {
        self.target
    }

    /// Returns the sender's own address, unless it is the usual one.
    pub const fn sender(&self) -> Option<i32> {
        self.sender
    }
}
