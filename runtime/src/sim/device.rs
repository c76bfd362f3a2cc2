//! What a simulated device does.

use crate::{Frame, Protocol, Received};

/// What a device answers. It goes to whom asked, if anybody answers in the addressing mode. The bench
/// [complains](super::Complaint::Answer) about what is no reply to the request.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Answer<P> {
    /// The reply that carries this.
    Values(P),
    /// A reply with this error code.
    Refusal(u64),
    /// A reply with the error code of the document for a device that [starts](Protocol::STARTING), or nothing if there
    /// is none.
    Starting,
    /// Nothing.
    Silence,
}

/// The behaviour of a device. The bench knows its number, its watchdog and its faults.
pub trait Device<P: Protocol> {
    /// Takes a request, and answers it.
    fn answer(&mut self, request: &Received<P>, now: u32) -> Answer<P>;

    /// Tests whether it belongs to those that a request to many addresses. By default it does.
    fn is_asked(&self, _request: &Received<P>) -> bool {
        true
    }

    /// Returns a frame that it sends by itself, from the module of this number. It is asked again as long as it
    /// returns one. By default it sends nothing.
    fn report(&mut self, _node: u8, _now: u32) -> Option<Frame> {
        None
    }

    /// Lets time pass.
    fn tick(&mut self, _now: u32) {}

    /// Acts by itself, since its watchdog has run out. The document may say [what it
    /// does](crate::Protocol::AFTER_SILENCE).
    fn silence(&mut self, _now: u32) {}

    /// Hears a request again after its watchdog has run out. It answers the request after that.
    fn wake(&mut self, _now: u32) {}

    /// Starts anew, without what it was told.
    fn power_on(&mut self, _now: u32) {}

    /// Changes the values of a reply, for the fault of a wrong echo. By default it changes nothing.
    fn drift(&self, values: P) -> P {
        values
    }
}
