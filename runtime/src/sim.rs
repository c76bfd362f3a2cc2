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
mod others;
mod outage;
mod random;
mod tally;
#[cfg(test)]
pub(crate) mod tests;
mod wire;

pub use complaint::Complaint;
pub use device::{Answer, Device};
pub use faults::Faults;
pub use keeper::{Keeper, Tell};
pub use outage::{Driver, Outage};
pub use random::Random;
pub use tally::Tally;

use core::marker::PhantomData;

use crate::{Addressed, Frame, Received};
use complaint::Complaints;
use node::{Node, has_coordinator};
use others::Others;
use tally::count;
use wire::{Sender, UnderWay, Wire};

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
    Frame {
        /// The frame.
        frame: Frame,
        /// When the client's driver received it. It waits there while the program does something else.
        at: u32,
    },
    /// The client or a device does something wrong.
    Complaint(Complaint),
}

/// A bus with `N` devices, and with room for `W` frames under way.
///
/// It takes at most 616 bytes, 208 for each device beside what that takes itself, and 24 for each frame.
#[derive(Clone, Copy, Debug)]
pub struct Bench<P, D, const N: usize, const W: usize> {
    nodes: [Node<D>; N],
    rules: Rules,
    random: Random,
    wire: Wire<W>,
    /// When the client sent last.
    sent: Option<u32>,
    others: Others,
    outage: Option<Outage>,
    /// What happened to no single device.
    tally: Tally,
    complaints: Complaints,
    protocol: PhantomData<P>,
}

impl<P: Addressed, D: Device<P>, const N: usize, const W: usize> Bench<P, D, N, W> {
    /// Returns a bus with devices, each with its number. They have just heard something at time 0.
    ///
    /// Two devices with one number both answer, the first one first. [`devices`](Self::devices) reaches both.
    pub fn new(devices: [(u8, D); N], rules: Rules, seed: u64) -> Self {
        Self {
            nodes: devices.map(|(number, device)| Node::new(number, device)),
            rules,
            random: Random::new(seed),
            wire: Wire::EMPTY,
            sent: None,
            others: Others::NONE,
            outage: None,
            tally: Tally::NONE,
            complaints: Complaints::NONE,
            protocol: PhantomData,
        }
    }

    /// Returns all devices, each with its number and its faults.
    pub fn devices(&mut self) -> impl Iterator<Item = (u8, &mut D, &mut Faults)> {
        self.nodes.iter_mut().map(|node| (node.number, &mut node.device, &mut node.faults))
    }

    /// Returns a device, the first one of its number.
    pub fn device(&mut self, node: u8) -> Option<&mut D> {
        self.node(node).map(|node| &mut node.device)
    }

    /// Returns the faults of a device, the first one of its number.
    pub fn faults(&mut self, node: u8) -> Option<&mut Faults> {
        self.node(node).map(|node| &mut node.faults)
    }

    /// Returns how often faults happened.
    pub fn tally(&self) -> Tally {
        let mut sum = self.tally;
        self.nodes.iter().for_each(|node| sum += node.tally);
        sum
    }

    /// Tests whether a device of this number is on, and has started.
    pub fn is_up(&self, node: u8) -> bool {
        self.nodes.iter().any(|known| known.number == node && known.is_up())
    }

    /// Lets the devices of a number start anew, also those that have died.
    pub fn restart(&mut self, node: u8, now: u32) {
        let boot = self.rules.boot;
        self.nodes.iter_mut().filter(|known| known.number == node).for_each(|node| node.restart(boot, now));
    }

    /// Adds another controller, which sends a frame from a time on, with `every` milliseconds between two
    /// of them. The devices answer it, and the client hears it all.
    ///
    /// # Errors
    ///
    /// Gives the frame back if there are four already.
    pub fn another_controller(&mut self, frame: Frame, every: u32, from: u32) -> Result<(), Frame> {
        self.others.add(frame, every, from)
    }

    /// Takes all other controllers away.
    pub fn no_other_controllers(&mut self) {
        self.others = Others::NONE;
    }

    /// Lets the bus go away for a time, in place of any other one. The bench does not complain that the client feeds
    /// nobody then.
    pub fn cut(&mut self, outage: Outage) {
        self.outage = Some(outage);
    }

    /// Takes a frame of the client.
    pub fn send(&mut self, frame: &Frame, now: u32) {
        let after = self.sent.map(|sent| now.wrapping_sub(sent)).filter(|after| *after < self.rules.gap);
        if let Some(after) = after {
            self.complaints.add(Complaint::Gap { frame: *frame, after });
        }
        self.sent = Some(now);
        match Received::<P>::decode(frame) {
            Err(problem) => self.complaints.add(Complaint::Unrecognised { frame: *frame, problem }),
            Ok(received) if !received.is_to_module() => self.complaints.add(Complaint::Direction(*frame)),
            Ok(received) => {
                if let Err(error) = received.encode() {
                    self.complaints.add(Complaint::Illegal { frame: *frame, error });
                }
                self.put(frame, &received, now);
            }
        }
    }

    /// Puts a request of the client on the bus, if that is there.
    fn put(&mut self, frame: &Frame, request: &Received<P>, now: u32) {
        match self.outage.filter(|outage| outage.covers(now)) {
            // It does not overtake what waits.
            None if self.wire.has(Sender::Client) => {
                self.wire.send(now, Sender::Client, *frame);
            }
            None => self.deliver(request, now),
            Some(Outage { driver: Driver::Drops, .. }) => count(&mut self.tally.blocked, true),
            Some(Outage { driver: Driver::Buffers, until, .. }) => {
                count(&mut self.tally.delayed, true);
                self.wire.send(until, Sender::Client, *frame);
            }
        }
    }

    /// Lets time pass, and returns what comes next. Call it until nothing comes.
    pub fn poll(&mut self, now: u32) -> Option<Event> {
        self.hear_others(now);
        self.tick(now);
        if let Some(complaint) = self.complaints.take() {
            return Some(Event::Complaint(complaint));
        }
        while let Some(UnderWay { at, from, frame }) = self.wire.arrived(now) {
            let is_lost = self.outage.is_some_and(|outage| outage.covers(at));
            count(&mut self.tally.blocked, is_lost);
            match from {
                _ if is_lost => {}
                Sender::Client => self.deliver_frame(&frame, at),
                Sender::Device(_) | Sender::Other => return Some(Event::Frame { frame, at }),
            }
        }
        self.outage = self.outage.filter(|outage| !outage.is_over(now));
        None
    }

    /// Lets other controllers send what is due.
    fn hear_others(&mut self, now: u32) {
        while let Some((frame, due)) = self.others.due(now) {
            count(&mut self.tally.others, true);
            self.wire.send(due, Sender::Other, frame);
            if !self.outage.is_some_and(|outage| outage.covers(due)) {
                self.deliver_frame(&frame, due);
            }
        }
    }

    /// Lets devices do what they do by themselves.
    fn tick(&mut self, now: u32) {
        let is_cut = self.outage.is_some_and(|outage| outage.has_begun(now));
        for node in &mut self.nodes {
            if node.tick(&self.rules, is_cut, now) {
                self.complaints.add(Complaint::Unfed { node: node.number });
            }
            while let Some(report) = node.report(now) {
                node.carry(report, &mut self.random, &mut self.wire, now);
            }
        }
    }

    /// Lets the devices hear a frame, if it is a request.
    fn deliver_frame(&mut self, frame: &Frame, now: u32) {
        if let Ok(request) = Received::decode(frame) {
            self.deliver(&request, now);
        }
    }

    /// Lets the devices that a request addresses hear and answer it.
    fn deliver(&mut self, request: &Received<P>, now: u32) {
        let Self { nodes, random, wire, complaints, tally, .. } = self;
        let (mut speaks, mut has_answered) = (true, false);
        let asked = request.node();
        for node in nodes.iter_mut().filter(|node| node.is_asked(request, asked)) {
            let reply = node.answer(request, random, now).unwrap_or_else(|error| {
                complaints.add(Complaint::Answer { node: node.number, error });
                None
            });
            let Some(reply) = reply.filter(|_| speaks) else { continue };
            speaks = !has_coordinator(request);
            count(&mut tally.doubles, has_answered && asked.is_some());
            has_answered = true;
            node.spoil(request, reply, random, wire, now);
        }
    }

    fn node(&mut self, node: u8) -> Option<&mut Node<D>> {
        self.nodes.iter_mut().find(|known| known.number == node)
    }
}
