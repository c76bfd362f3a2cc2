//! A bus with simulated devices, for tests of programs that talk to them.
//!
//! A program says what a device does, by [`Device`]. A [`Bench`] has some of them, each with its number
//! and its [`Faults`]. It takes the frames of a client, and gives back what the devices answer. It
//! complains about a client that asks too fast, sends what the document forbids, or lets a watchdog run
//! out. It also complains about a device whose answer is no reply to the request. Time is a number of
//! milliseconds, and may wrap around. The seed decides everything.
//!
//! ```
//! use canspec_runtime::sim::{Answer, Bench, Device, Event, Rules};
//! use canspec_runtime::{Addressed, Frame, Received};
//!
//! /// A device that does what it is told, and says so.
//! struct Obedient;
//!
//! impl<P: Addressed> Device<P> for Obedient {
//!     fn answer(&mut self, request: &Received<P>, _now: u32) -> Answer<P> {
//!         Answer::Values(*request.content())
//!     }
//! }
//!
//! fn answers<P: Addressed>(request: &Frame) -> Vec<Event> {
//!     let rules = Rules { gap: 20, watchdog: Some(10_000), ..Rules::default() };
//!     let mut bench = Bench::<P, Obedient, 2, 16>::new([(1, Obedient), (2, Obedient)], rules, 7);
//!     bench.send(request, 0);
//!     (0..100).flat_map(|now| std::iter::from_fn(|| bench.poll(now)).collect::<Vec<_>>()).collect()
//! }
//! ```

mod complaint;
mod device;
mod faults;
mod keeper;
mod node;
mod random;
mod tally;
#[cfg(test)]
pub(crate) mod tests;
mod wire;

pub use complaint::Complaint;
pub use device::{Answer, Device};
pub use faults::Faults;
pub use keeper::{Keeper, Tell};
pub use random::Random;
pub use tally::Tally;

use core::marker::PhantomData;

use crate::clock::has_come;
use crate::{Addressed, Frame, Received};
use complaint::Complaints;
use node::{Node, has_coordinator};
use wire::Wire;

/// What the devices of a bus expect, in milliseconds.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Rules {
    /// The shortest time from one frame of the client to the next.
    pub gap: u32,
    /// The silence after which a device acts by itself.
    pub watchdog: Option<u32>,
    /// How long a device takes to start. Until then it answers with the code of the document [for
    /// that](crate::Protocol::STARTING), or not at all.
    pub boot: u32,
}

/// What comes from the bus.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Event {
    /// A frame for the client.
    Frame(Frame),
    /// The client or a device does something wrong.
    Complaint(Complaint),
}

/// A bus with `N` devices, and with room for `W` frames under way to the client.
///
/// It takes at most 616 bytes, 128 for each device beside what that takes itself, and 24 for each frame.
#[derive(Clone, Copy, Debug)]
pub struct Bench<P, D, const N: usize, const W: usize> {
    nodes: [Node<D>; N],
    rules: Rules,
    random: Random,
    wire: Wire<W>,
    /// When the client sent last.
    sent: Option<u32>,
    /// Another controller: its frame, the time between two of them, and when the next one is due.
    other: Option<(Frame, u32, u32)>,
    complaints: Complaints,
    protocol: PhantomData<P>,
}

impl<P: Addressed, D: Device<P>, const N: usize, const W: usize> Bench<P, D, N, W> {
    /// Returns a bus with devices, each with its number. They have just heard something at time 0.
    pub fn new(devices: [(u8, D); N], rules: Rules, seed: u64) -> Self {
        Self {
            nodes: devices.map(|(number, device)| Node::new(number, device)),
            rules,
            random: Random::new(seed),
            wire: Wire::EMPTY,
            sent: None,
            other: None,
            complaints: Complaints::NONE,
            protocol: PhantomData,
        }
    }

    /// Returns a device.
    pub fn device(&mut self, node: u8) -> Option<&mut D> {
        self.node(node).map(|node| &mut node.device)
    }

    /// Returns the faults of a device.
    pub fn faults(&mut self, node: u8) -> Option<&mut Faults> {
        self.node(node).map(|node| &mut node.faults)
    }

    /// Returns how often faults happened.
    pub fn tally(&self) -> Tally {
        let mut sum = Tally::NONE;
        self.nodes.iter().for_each(|node| sum += node.tally);
        sum
    }

    /// Tests whether a device is on, and has started.
    pub fn is_up(&self, node: u8) -> bool {
        self.nodes.iter().any(|known| known.number == node && known.is_up())
    }

    /// Lets a device start anew, also one that has died.
    pub fn restart(&mut self, node: u8, now: u32) {
        let boot = self.rules.boot;
        if let Some(node) = self.node(node) {
            node.restart(boot, now);
        }
    }

    /// Adds another controller, which sends a frame from a time on, with `every` milliseconds between two
    /// of them. The devices answer it, and the client hears it all.
    pub fn another_controller(&mut self, frame: Frame, every: u32, from: u32) {
        self.other = Some((frame, every.max(1), from));
    }

    /// Takes a frame of the client.
    pub fn send(&mut self, frame: &Frame, now: u32) {
        let after = self.sent.map(|sent| now.wrapping_sub(sent)).filter(|after| *after < self.rules.gap);
        if let Some(after) = after {
            self.complaints.add(Complaint::Gap { frame: *frame, after });
        }
        self.sent = Some(now);
        match Received::decode(frame) {
            Err(problem) => self.complaints.add(Complaint::Unrecognised { frame: *frame, problem }),
            Ok(received) if !received.is_to_module() => self.complaints.add(Complaint::Direction(*frame)),
            Ok(received) => {
                if let Err(error) = received.encode() {
                    self.complaints.add(Complaint::Illegal { frame: *frame, error });
                }
                self.deliver(&received, now);
            }
        }
    }

    /// Lets time pass, and returns what comes next. Call it until nothing comes.
    pub fn poll(&mut self, now: u32) -> Option<Event> {
        for place in 0..N {
            let Some(node) = self.nodes.get_mut(place) else { continue };
            if node.tick(&self.rules, now) {
                self.complaints.add(Complaint::Unfed { node: node.number });
            }
            while let Some(report) = node.report(now) {
                node.carry(report, &mut self.random, &mut self.wire, now);
            }
        }
        if let Some((frame, every, due)) = self.other.filter(|(_, _, due)| has_come(*due, now)) {
            self.other = Some((frame, every, due.wrapping_add(every)));
            self.wire.send(now, None, frame);
            if let Ok(received) = Received::decode(&frame) {
                self.deliver(&received, now);
            }
        }
        let complaint = self.complaints.take().map(Event::Complaint);
        complaint.or_else(|| self.wire.arrived(now).map(Event::Frame))
    }

    /// Lets the devices that a request addresses hear and answer it.
    fn deliver(&mut self, request: &Received<P>, now: u32) {
        let Self { nodes, random, wire, complaints, .. } = self;
        let mut speaks = true;
        let asked = request.node();
        for node in nodes.iter_mut().filter(|node| node.is_asked(request, asked)) {
            let reply = node.answer(request, random, now).unwrap_or_else(|error| {
                complaints.add(Complaint::Answer { node: node.number, error });
                None
            });
            let Some(reply) = reply.filter(|_| speaks) else { continue };
            speaks = !has_coordinator(request);
            node.spoil(request, reply, random, wire, now);
        }
    }

    fn node(&mut self, node: u8) -> Option<&mut Node<D>> {
        self.nodes.iter_mut().find(|known| known.number == node)
    }
}
