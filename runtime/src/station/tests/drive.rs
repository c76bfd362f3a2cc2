//! What carries the frames of a station.

use core::cell::{Cell, RefCell};
use core::future::{pending, ready};
use core::pin::pin;
use core::task::{Context, Poll, Waker};
use std::collections::VecDeque;
use std::vec::Vec;

use embedded_can::nb::Can;
use embedded_can::{ErrorKind, Id, blocking};

use super::bus::{Charger, reply, settings};
use super::chargers::{AtOnce, Message};
use crate::Frame;
use crate::client::{Bus, Output};
use crate::station::{Blocking, Drive, Driver, Event, Found, Known, NonBlocking, Station, listen, pump};

type Lone = Station<Message<AtOnce>, 1, 1, 6>;

fn lone(found: Found) -> Lone {
    Station::new(settings(found), [1], [(1, None)]).expect("it fits")
}

/// A bus with charger 1, and the clock.
struct Wire {
    now: Cell<u32>,
    charger: RefCell<Charger>,
    coming: RefCell<VecDeque<(u32, Frame)>>,
    sent: RefCell<Vec<u32>>,
    is_full: Cell<bool>,
    is_broken: Cell<bool>,
}

impl Wire {
    fn new() -> Self {
        let (coming, sent) = (RefCell::new(VecDeque::new()), RefCell::new(Vec::new()));
        let charger = RefCell::new(Charger::new(1));
        Self { now: Cell::new(0), charger, coming, sent, is_full: Cell::new(false), is_broken: Cell::new(false) }
    }

    /// Carries a frame to the charger, unless the driver is full.
    fn carries(&self, frame: &Frame) -> bool {
        if self.is_full.get() {
            return false;
        }
        self.sent.borrow_mut().push(self.now.get());
        let answer = self.charger.borrow_mut().hear(frame);
        self.coming.borrow_mut().extend(answer.map(|answer| (self.now.get() + 5, answer)));
        true
    }

    fn next(&self) -> Option<Frame> {
        let mut coming = self.coming.borrow_mut();
        coming.pop_front_if(|(at, _)| *at <= self.now.get()).map(|(_, frame)| frame)
    }

    /// Lets the time go on until a frame comes, or until that is over.
    fn pass(&self, until: u32) {
        let next = self.coming.borrow().front().map_or(until, |(at, _)| *at);
        self.now.set(until.min(next).max(self.now.get() + 1));
    }
}

#[derive(Debug, PartialEq)]
struct Broken;

impl embedded_can::Error for Broken {
    fn kind(&self) -> ErrorKind {
        ErrorKind::Other
    }
}

impl Can for &Wire {
    type Frame = Frame;
    type Error = Broken;

    fn transmit(&mut self, frame: &Frame) -> nb::Result<Option<Frame>, Broken> {
        if self.is_broken.get() {
            return Err(nb::Error::Other(Broken));
        }
        if self.carries(frame) { Ok(None) } else { Err(nb::Error::WouldBlock) }
    }

    fn receive(&mut self) -> nb::Result<Frame, Broken> {
        if self.is_broken.get() && self.now.get() > 500 {
            return Err(nb::Error::Other(Broken));
        }
        self.next().ok_or(nb::Error::WouldBlock)
    }
}

impl blocking::Can for &Wire {
    type Frame = Frame;
    type Error = Broken;

    fn transmit(&mut self, frame: &Frame) -> Result<(), Broken> {
        if self.is_broken.get() || !self.carries(frame) { Err(Broken) } else { Ok(()) }
    }

    fn receive(&mut self) -> Result<Frame, Broken> {
        unreachable!("it would wait for a frame")
    }
}

/// Turns until a time, and returns what has happened.
fn turned<D>(wire: &Wire, station: &mut Lone, drive: &mut Drive<D>, until: u32) -> Vec<Event>
where
    D: Driver<Error = Broken>,
{
    let mut events = Vec::new();
    while wire.now.get() < until {
        let next = drive.turn(station, || wire.now.get(), |_, event| events.push(event)).expect("the driver works");
        wire.pass(next.min(until));
    }
    events
}

const FOUND: [Event; 2] = [Event::Found { node: 1 }, Event::Output { node: 1, output: Output::Off }];

#[test]
fn a_turn_sends_what_is_due_hands_over_what_has_come_and_tells_what_happens() {
    let (wire, mut station) = (Wire::new(), lone(Found::Off));
    let mut drive = Drive::new(NonBlocking(&wire));
    assert_eq!(turned(&wire, &mut station, &mut drive, 1100), FOUND);
    assert_eq!(wire.sent.borrow()[..3], [0, 20, 40], "the gap is 20 ms");
    assert!(!drive.driver().0.is_full.get());
}

#[test]
fn what_a_full_driver_does_not_take_is_sent_later() {
    let (wire, mut station) = (Wire::new(), lone(Found::Off));
    let mut drive = Drive::new(NonBlocking(&wire));
    wire.is_full.set(true);
    assert_eq!(turned(&wire, &mut station, &mut drive, 300), []);
    wire.is_full.set(false);
    assert_eq!(turned(&wire, &mut station, &mut drive, 2900), FOUND);
}

/// A driver that knows whether the bus carries frames, and counts the frames that it is asked to send.
struct Knowing<'a> {
    wire: &'a Wire,
    bus: Bus,
    asked: u32,
}

impl Driver for Knowing<'_> {
    type Error = Broken;

    fn send(&mut self, frame: &Frame) -> Result<bool, Broken> {
        self.asked += 1;
        Ok(self.wire.carries(frame))
    }

    fn receive(&mut self) -> Result<Option<Frame>, Broken> {
        Ok(self.wire.next())
    }

    fn bus(&self) -> Bus {
        self.bus
    }
}

#[test]
fn a_driver_that_knows_that_the_bus_is_off_is_asked_to_send_nothing_until_it_is_on_again() {
    let (wire, mut station) = (Wire::new(), lone(Found::Off));
    let mut drive = Drive::new(Knowing { wire: &wire, bus: Bus::Off, asked: 0 });
    assert_eq!(turned(&wire, &mut station, &mut drive, 2000), []);
    assert_eq!(drive.driver().asked, 0);
    drive.driver().bus = Bus::On;
    assert_eq!(turned(&wire, &mut station, &mut drive, 4000), FOUND);
    assert_eq!(wire.sent.borrow()[0], 2000);
}

#[test]
fn a_driver_that_is_of_no_use_ends_the_turn() {
    let (wire, mut station) = (Wire::new(), lone(Found::Off));
    let mut drive = Drive::new(NonBlocking(&wire));
    wire.is_broken.set(true);
    for now in [0, 600] {
        wire.now.set(now);
        assert_eq!(drive.turn(&mut station, || now, |_, _| {}), Err(Broken), "at {now}");
    }
    wire.is_broken.set(false);
    assert_eq!(turned(&wire, &mut station, &mut drive, 2900), FOUND);
}

#[test]
fn a_driver_that_blocks_sends_while_frames_come_from_elsewhere() {
    let (wire, mut station) = (Wire::new(), lone(Found::Off));
    let mut drive = Drive::new(Blocking::new(&wire, || Ok(wire.next())));
    assert_eq!(turned(&wire, &mut station, &mut drive, 1100), FOUND);
    assert_eq!(wire.sent.borrow()[..3], [0, 20, 40], "the gap is 20 ms");
}

#[test]
fn a_driver_that_blocks_ends_the_turn_where_either_half_fails() {
    let (wire, mut station) = (Wire::new(), lone(Found::Off));
    let mut drive = Drive::new(Blocking::new(&wire, || if wire.now.get() > 500 { Err(Broken) } else { Ok(None) }));
    wire.is_broken.set(true);
    assert_eq!(drive.turn(&mut station, || 0, |_, _| {}), Err(Broken));
    wire.is_broken.set(false);
    wire.now.set(600);
    assert_eq!(drive.turn(&mut station, || 600, |_, _| {}), Err(Broken));
    assert_eq!(*wire.sent.borrow(), []);
}

/// Frames that have come, some of which are remote frames. Then the driver fails.
struct Arrivals(VecDeque<Arrival>);

struct Arrival {
    frame: Frame,
    is_remote: bool,
}

impl embedded_can::Frame for Arrival {
    fn new(id: impl Into<Id>, data: &[u8]) -> Option<Self> {
        <Frame as embedded_can::Frame>::new(id, data).map(|frame| Self { frame, is_remote: false })
    }

    fn new_remote(_: impl Into<Id>, _: usize) -> Option<Self> {
        None
    }

    fn is_extended(&self) -> bool {
        embedded_can::Frame::is_extended(&self.frame)
    }

    fn is_remote_frame(&self) -> bool {
        self.is_remote
    }

    fn id(&self) -> Id {
        embedded_can::Frame::id(&self.frame)
    }

    fn dlc(&self) -> usize {
        embedded_can::Frame::dlc(&self.frame)
    }

    fn data(&self) -> &[u8] {
        embedded_can::Frame::data(&self.frame)
    }
}

impl Can for Arrivals {
    type Frame = Arrival;
    type Error = Broken;

    fn transmit(&mut self, _: &Arrival) -> nb::Result<Option<Arrival>, Broken> {
        Err(nb::Error::WouldBlock)
    }

    fn receive(&mut self) -> nb::Result<Arrival, Broken> {
        self.0.pop_front().ok_or(nb::Error::WouldBlock)
    }
}

impl blocking::Can for Arrivals {
    type Frame = Arrival;
    type Error = Broken;

    fn transmit(&mut self, _: &Arrival) -> Result<(), Broken> {
        Err(Broken)
    }

    fn receive(&mut self) -> Result<Arrival, Broken> {
        self.0.pop_front().ok_or(Broken)
    }
}

/// Returns two reports, each behind a remote frame, and what carries them.
fn arrivals() -> ([Frame; 2], Arrivals) {
    let reports = [0, 1].map(|node| reply(10, node, [0x0F, 0xA0, 0, 0]));
    let both = |frame| [true, false].map(|is_remote| Arrival { frame, is_remote });
    (reports, Arrivals(reports.into_iter().flat_map(both).collect()))
}

#[test]
fn a_remote_frame_does_not_hide_what_has_come_behind_it() {
    let (reports, arrivals) = arrivals();
    let mut driver = NonBlocking(arrivals);
    let received: [_; 3] = core::array::from_fn(|_| driver.receive());
    assert_eq!(received, [Ok(Some(reports[0])), Ok(Some(reports[1])), Ok(None)]);
}

#[test]
fn a_listener_hands_over_data_frames_until_it_is_told_to_end_or_the_driver_fails() {
    let mut heard = Vec::new();
    let (reports, mut all) = arrivals();
    let ended = listen(&mut all, |frame| {
        heard.push(frame);
        true
    });
    assert_eq!((ended, heard), (Err(Broken), reports.to_vec()));
    let (_, mut rest) = arrivals();
    assert_eq!((listen(&mut rest, |_| false), rest.0.len()), (Ok(()), 2));
}

/// A frame type that holds no frame.
struct Never;

impl embedded_can::Frame for Never {
    fn new(_: impl Into<Id>, _: &[u8]) -> Option<Self> {
        None
    }

    fn new_remote(_: impl Into<Id>, _: usize) -> Option<Self> {
        None
    }

    fn is_extended(&self) -> bool {
        true
    }

    fn is_remote_frame(&self) -> bool {
        false
    }

    fn id(&self) -> Id {
        unreachable!("there is no such frame")
    }

    fn dlc(&self) -> usize {
        0
    }

    fn data(&self) -> &[u8] {
        &[]
    }
}

/// A driver of such frames.
struct Useless;

impl Can for Useless {
    type Frame = Never;
    type Error = Broken;

    fn transmit(&mut self, _: &Never) -> nb::Result<Option<Never>, Broken> {
        Ok(None)
    }

    fn receive(&mut self) -> nb::Result<Never, Broken> {
        Err(nb::Error::WouldBlock)
    }
}

impl blocking::Can for Useless {
    type Frame = Never;
    type Error = Broken;

    fn transmit(&mut self, _: &Never) -> Result<(), Broken> {
        Ok(())
    }

    fn receive(&mut self) -> Result<Never, Broken> {
        Err(Broken)
    }
}

#[test]
fn a_driver_of_frames_that_hold_none_takes_none() {
    assert_eq!(NonBlocking(Useless).send(&reply(9, 1, [0; 4])), Ok(false));
    assert_eq!(Blocking::new(Useless, || Ok(None)).send(&reply(9, 1, [0; 4])), Ok(false));
}

#[test]
fn what_has_come_since_the_last_turn_is_as_old_as_it_can_be() {
    let report = reply(10, 1, [0x0F, 0xA0, 0, 0]);
    let (wire, mut station) = (Wire::new(), lone(Found::Off));
    wire.charger.borrow_mut().is_there = false;
    let mut drive = Drive::new(NonBlocking(&wire));
    turned(&wire, &mut station, &mut drive, 101);
    drive.turn(&mut station, || 110, |_, _| {}).expect("the driver works");
    wire.coming.borrow_mut().push_back((0, report));
    drive.turn(&mut station, || 3500, |_, _| {}).expect("the driver works");
    assert_eq!(station.voltage_mv(1, 3500), Known::Stale { value: 400_000, since: 110 });
}

/// Pumps until the clock has come to a time, and returns what has happened.
fn pumped(wire: &Wire, station: &mut Lone, until: u32) -> Vec<Event> {
    let mut events = Vec::new();
    let receive = async |wait: u32| {
        let next = wire.next();
        if next.is_none() && wait > 0 {
            if wire.now.get() >= until {
                pending::<()>().await;
            }
            wire.pass(wire.now.get() + wait);
            return wire.next();
        }
        next
    };
    let send = async |frame: &Frame| ready(wire.carries(frame)).await;
    let future = pump(station, || wire.now.get(), send, receive, |_, event| events.push(event));
    assert_eq!(pin!(future).poll(&mut Context::from_waker(Waker::noop())), Poll::Pending);
    events
}

#[test]
fn asynchronous_functions_carry_the_frames_of_a_station() {
    let (wire, mut station) = (Wire::new(), lone(Found::Off));
    assert_eq!(pumped(&wire, &mut station, 1100), FOUND);
    assert_eq!(wire.sent.borrow()[..3], [0, 20, 40], "the gap is 20 ms");
    wire.is_full.set(true);
    let sent = wire.sent.borrow().len();
    let lost = [Event::Output { node: 1, output: Output::Unknown }, Event::Lost { node: 1 }];
    let events = pumped(&wire, &mut station, 6000);
    assert!(lost.iter().all(|event| events.contains(event)) && wire.sent.borrow().len() == sent, "{events:?}");
    wire.is_full.set(false);
    assert_eq!(pumped(&wire, &mut station, 9000), FOUND);
}

#[test]
fn what_comes_while_the_pump_waits_is_as_old_as_it_can_be() {
    let report = reply(10, 1, [0x0F, 0xA0, 0, 0]);
    let (wire, mut station) = (Wire::new(), lone(Found::Off));
    wire.charger.borrow_mut().is_there = false;
    wire.coming.borrow_mut().push_back((250, report));
    pumped(&wire, &mut station, 3900);
    // The switch-off of charger 1 is lost at 100 ms.
    assert_eq!(station.voltage_mv(1, 3900), Known::Stale { value: 400_000, since: 200 });
}

#[test]
fn what_came_before_the_first_turn_says_nothing_of_a_module() {
    let report = reply(10, 1, [0x0F, 0xA0, 0, 0]);
    let (wire, mut station) = (Wire::new(), lone(Found::Off));
    wire.charger.borrow_mut().is_there = false;
    wire.coming.borrow_mut().push_back((0, report));
    let mut drive = Drive::new(NonBlocking(&wire));
    assert_eq!(turned(&wire, &mut station, &mut drive, 10), []);
    assert_eq!((wire.coming.borrow().len(), station.voltage_mv(1, 10)), (0, Known::Unknown));
    wire.coming.borrow_mut().push_back((10, report));
    turned(&wire, &mut station, &mut drive, 20);
    assert_eq!(station.voltage_mv(1, 20), Known::Fresh(400_000));
}

#[test]
fn another_drive_tells_that_the_bus_is_on_again() {
    let (wire, mut station) = (Wire::new(), lone(Found::Off));
    let mut lost = Drive::new(Knowing { wire: &wire, bus: Bus::Off, asked: 0 });
    assert_eq!(turned(&wire, &mut station, &mut lost, 2000), []);
    let mut opened = Drive::new(NonBlocking(&wire));
    assert_eq!(turned(&wire, &mut station, &mut opened, 4000), FOUND);
}

#[test]
fn what_came_before_the_pump_begins_says_nothing_of_a_module() {
    let (wire, mut station) = (Wire::new(), lone(Found::Off));
    wire.charger.borrow_mut().is_there = false;
    wire.coming.borrow_mut().push_back((0, reply(10, 1, [0x0F, 0xA0, 0, 0])));
    pumped(&wire, &mut station, 20);
    assert_eq!(station.voltage_mv(1, 20), Known::Unknown);
}
