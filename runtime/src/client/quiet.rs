//! The time for which a client has nothing to do, so that it need not look at each of its requests to know that.

use crate::clock::has_come;

/// Until when there is nothing to do, unless something happens.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Quiet {
    /// When something is to do, if that is known.
    pub deadline: Option<u32>,
    /// When the client must look at its requests again, which is not after the deadline.
    pub until: Option<u32>,
}

impl Quiet {
    /// Tests whether the client must look at its requests again.
    pub fn is_over(&self, now: u32) -> bool {
        self.until.is_some_and(|until| has_come(until, now))
    }
}
