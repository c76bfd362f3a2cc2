//! What one module is to do, against what it says of its output.

use super::{Agrees, Client, NotHeld, Ticket};
use crate::{Protocol, Quantities, Quantity, Received, Request};

/// What is known of the output of a module.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub enum Output {
    /// Nothing: the module is silent, or has not said anything since it was told something else.
    Unknown,
    /// The module has said that it is off, and has confirmed before what it was told.
    Off,
    /// The module has said that it is on.
    On,
}

/// What one module is to do, and what it says of its output.
///
/// A module that was told to switch off is only off if it says so afterwards. The echo of the switch-off does not show
/// it, and neither does what was said before that echo. So a program goes on until the [`output`](Self::output) is as it
/// should be. It [holds](Self::hold) what the module must do, and gives each answer to [`answered`](Self::answered).
///
/// It takes 24 bytes.
#[derive(Clone, Copy, Debug)]
pub struct Duty {
    node: u8,
    first: Option<Ticket>,
    last: Option<Ticket>,
    /// Whether the last request was in effect since the duty began, or there is none.
    is_confirmed: bool,
    output: Output,
}

impl Duty {
    /// Returns the duty of a module, by its number. Nothing is to be done, and nothing is known.
    pub const fn new(node: u8) -> Self {
        Self { node, first: None, last: None, is_confirmed: true, output: Output::Unknown }
    }

    /// Returns the number of the module.
    pub const fn node(&self) -> u8 {
        self.node
    }

    /// Returns what is known of the output.
    pub const fn output(&self) -> Output {
        self.output
    }

    /// Ends what the module was to do, which is [cancelled](Client::cancel). Nothing is known of its output until it
    /// says something.
    pub fn end<P: Protocol, const N: usize, const G: usize>(&mut self, client: &mut Client<P, N, G>) {
        self.first.into_iter().for_each(|ticket| client.cancel(ticket));
        *self = Self { is_confirmed: false, ..Self::new(self.node) };
    }

    /// [Holds](Client::hold) requests, each [after](Client::hold_after) the one before, and renews them every `refresh`
    /// milliseconds. Call it again and again: what is held already goes on, and other values replace it. If the last
    /// request changes, nothing is known of the output until the module says something. Without a request the module
    /// may do what it does, so nothing needs to be confirmed.
    ///
    /// # Errors
    ///
    /// Refuses what the client refuses to hold. The requests before that are held.
    pub fn hold<P: Protocol, const N: usize, const G: usize>(
        &mut self,
        client: &mut Client<P, N, G>,
        requests: impl IntoIterator<Item = Request<P, ()>>,
        refresh: u32,
        agrees: Agrees<P>,
        now: u32,
    ) -> Result<(), NotHeld> {
        let mut last = None;
        for request in requests {
            let held = match last {
                None => client.hold(request, refresh, agrees, now)?,
                Some(last) => client.hold_after(last, request, agrees, now)?,
            };
            self.first = if last.is_none() { Some(held) } else { self.first };
            last = Some(held);
        }
        if last != self.last {
            self.forget();
        }
        self.is_confirmed |= last.is_none();
        self.last = last;
        Ok(())
    }

    /// Takes an [answer](super::Heard::Answer). Returns whether it confirms the last of the requests. An answer of
    /// another module, or of nobody knows which, says nothing of this one.
    pub fn answered<P: Quantities>(&mut self, ticket: Ticket, received: &Received<P>) -> bool {
        if received.node() != Some(self.node.into()) {
            return false;
        }
        let confirms = self.last == Some(ticket);
        self.is_confirmed |= confirms;
        match received.quantity(Quantity::DELIVERING) {
            Some(0) => self.output = if self.is_confirmed { Output::Off } else { Output::Unknown },
            Some(_) => self.output = Output::On,
            None => {}
        }
        confirms
    }

    /// Returns the last of the requests, if there is one.
    pub(crate) const fn last(&self) -> Option<Ticket> {
        self.last
    }

    /// Knows nothing of the module any more, since it is silent or starts. What is held goes on, and is to be confirmed
    /// anew.
    pub const fn forget(&mut self) {
        (self.is_confirmed, self.output) = (false, Output::Unknown);
    }
}
