//! A driver that refuses a frame, and a bus that goes away.

use super::entry::{Entry, Sent, State};
use super::{Client, Ticket};
use crate::Protocol;

/// Whether a bus carries frames.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub enum Bus {
    /// It carries frames.
    On,
    /// It carries none: the controller is off the bus, or the adapter is unplugged.
    Off,
}

/// What was sent last, as it was before that.
#[derive(Clone, Copy, Debug)]
pub struct Sending {
    pub ticket: Ticket,
    /// Since when it was to be sent.
    pub from: u32,
    /// When it had been sent before in its round.
    pub sent: Option<Sent>,
    /// Until when the bus was busy.
    pub busy: Option<u32>,
}

impl<P: Protocol, const N: usize, const G: usize> Client<P, N, G> {
    /// Takes back what [`poll`](Self::poll) said was to be sent, since the driver has refused the frame. Call it before
    /// the next `poll`; later it changes nothing. The request has lost no try, and is due again after the gap, of at
    /// least 1 ms. Then `poll` says anew what is to be sent first.
    pub fn not_sent(&mut self, ticket: Ticket, now: u32) {
        let now = self.told(now);
        let Some(last) = self.last.filter(|last| last.ticket == ticket) else { return };
        self.last = None;
        self.busy = last.busy;
        self.free = Some(now.wrapping_add(self.pace.gap.max(1)));
        let mut entries = self.entries.iter_mut().flatten();
        let Some(entry) = entries.find(|entry| entry.ticket == ticket) else { return };
        entry.take_back(last.from, last.sent);
        entry.be_led_again();
    }

    /// Returns what was told of the bus.
    pub(crate) const fn bus_told(&self) -> Bus {
        self.bus
    }

    /// Notes that the bus is on or off. It is on at first.
    ///
    /// While it is off, nothing is sent, so no request loses a try or is lost, and no module falls silent. What waits for
    /// its answer is to be sent again, and that try counts no more. An answer that comes all the same still counts.
    ///
    /// When it is on again, what was hurried goes first, then what has waited longest. Rounds that were missed are left
    /// out. What [follows](Self::hold_after) another request waits until that is in effect anew.
    pub fn bus(&mut self, bus: Bus, now: u32) {
        let now = self.told(now);
        if bus == self.bus {
            return;
        }
        (self.bus, self.last) = (bus, None);
        match bus {
            Bus::On => self.entries.iter_mut().flatten().for_each(Entry::want_leader),
            Bus::Off => {
                self.health.forget();
                self.entries.iter_mut().flatten().for_each(|entry| entry.go_off(now));
            }
        }
    }
}

impl<P: Protocol> Entry<P> {
    /// Takes a sending back. It is due since a time, and was sent before that perhaps.
    fn take_back(&mut self, from: u32, sent: Option<Sent>) {
        if !matches!(self.state, State::Waiting { .. }) {
            return;
        }
        (self.state, self.sent) = (State::Due { from }, sent);
        self.tries = self.tries.saturating_sub(1);
        self.unheard = self.unheard.saturating_sub(1);
    }

    /// Is to be sent if it is due, as it was before: what it follows is still in effect.
    fn be_led_again(&mut self) {
        if let (State::Due { .. }, Some(leader)) = (self.state, &mut self.leader) {
            leader.is_awaited = false;
        }
    }

    /// Waits for the bus. What was sent last may have come to nobody.
    fn go_off(&mut self, now: u32) {
        let since = self.sent.map_or(now, |sent| sent.first);
        self.take_back(since, self.sent);
        self.unheard = 0;
    }
}
