//! A bus with charging modules, a station, and a clock that only goes on when nothing is left to do.

use std::format;
use std::string::String;
use std::vec::Vec;

use super::chargers::{Apart, AtOnce, InGroups, Make, Message, group};
use crate::client::Pace;
use crate::station::{Event, Found, Limits, SetPoint, Settings, Station, Step, Unfit};
use crate::{Frame, Protocol};

pub const PACE: Pace = Pace { gap: 20, wait: 100, tries: 2, late: 100 };
pub const ROUND: u32 = 1000;

/// How long a module takes to answer.
pub const DELAY: u32 = 5;

pub const LIMITS: Limits = Limits {
    least_mv: 60_000,
    most_mv: 800_000,
    most_ma: 40_000,
    most_mw: 20_000_000,
    group_ma: 60_000,
    rise_ma: 10_000,
    open_mv: 60_000,
};

/// Returns settings with values that count for 3000 ms.
pub const fn settings(found: Found) -> Settings {
    Settings::new(PACE, ROUND, found, LIMITS)
}

pub const fn volts(voltage: i32, current: i32) -> SetPoint {
    SetPoint { voltage_mv: voltage * 1000, current_ma: Some(current * 1000) }
}

/// A charging module on the bus.
#[derive(Clone, Copy, Debug)]
pub struct Charger {
    pub node: u8,
    pub group: u8,
    pub is_there: bool,
    pub is_on: bool,
    /// What it was told to deliver, in tenths of V and A.
    pub set: [u16; 2],
    /// What it measures instead.
    pub measures: Option<[u16; 2]>,
    /// How much more it measures each time.
    pub drift: u16,
    pub status: u8,
    /// The command that it refuses, and the error code. 0 is all of them.
    pub refuses: Option<(u8, u8)>,
    /// The command to which it answers with one byte. 0 is all of them.
    pub is_short: Option<u8>,
    /// The command that it confirms, and does not do.
    pub ignores: Option<u8>,
    /// The command to which it says zeros.
    pub denies: Option<u8>,
    /// How long it takes to answer.
    pub delay: u32,
}

impl Charger {
    pub const fn new(node: u8) -> Self {
        Self {
            node,
            group: 1,
            is_there: true,
            is_on: false,
            set: [0, 0],
            measures: None,
            drift: 0,
            status: 0,
            refuses: None,
            is_short: None,
            ignores: None,
            denies: None,
            delay: DELAY,
        }
    }

    /// Does what a frame says, and answers.
    pub fn hear(&mut self, frame: &Frame) -> Option<Frame> {
        let [_, command, target, _] = frame.raw_id().to_be_bytes();
        let is_asked = target == self.node || (0x50..0x60).contains(&target) && 0x5F - target == self.group;
        if !self.is_there || !is_asked {
            return None;
        }
        let id = 0x0100_F000 | u32::from(command) << 16 | u32::from(self.node);
        if let Some((_, code)) = self.refuses.filter(|(refused, _)| [command, 0].contains(refused)) {
            return Some(Frame::new_raw(id | u32::from(code) << 26, true, [0; 8], 4));
        }
        if self.is_short.is_some_and(|short| [command, 0].contains(&short)) {
            return Some(Frame::new_raw(id, true, [0; 8], 1));
        }
        let [a, b, c, d, ..] = frame.bytes();
        let is_done = self.ignores != Some(command);
        match command {
            1 if is_done => self.set = [u16::from_be_bytes([a, b]), u16::from_be_bytes([c, d])],
            2 if is_done => self.is_on = a == 1,
            3 if is_done => (self.set[0], self.is_on) = (u16::from_be_bytes([a, b]), c == 1),
            4 if is_done => self.set[0] = u16::from_be_bytes([a, b]),
            5 if is_done => self.set[1] = u16::from_be_bytes([c, d]),
            _ => {}
        }
        let said = match command {
            _ if self.denies == Some(command) => [0; 4],
            7 => [0, self.group, 0, 0],
            8 => [self.is_on.into(), self.group, self.status, 0],
            9 => {
                let [[a, b], [c, d]] = self.measured().map(u16::to_be_bytes);
                self.measures = self.measures.map(|[voltage, current]| [voltage + self.drift, current]);
                [a, b, c, d]
            }
            _ => [a, b, c, d],
        };
        Some(reply(command, self.node, said))
    }

    fn measured(&self) -> [u16; 2] {
        self.measures.unwrap_or(if self.is_on { self.set } else { [0; 2] })
    }
}

/// Returns what a module sends.
pub fn reply(command: u8, node: u8, [a, b, c, d]: [u8; 4]) -> Frame {
    let id = 0x0100_F000 | u32::from(command) << 16 | u32::from(node);
    Frame::new_raw(id, true, [a, b, c, d, 0, 0, 0, 0], 4)
}

/// Returns what another controller sends.
pub fn foreign(command: u8, target: u8, [a, b, c, d]: [u8; 4]) -> Frame {
    let id = 0x0100_00F1 | u32::from(command) << 16 | u32::from(target) << 8;
    Frame::new_raw(id, true, [a, b, c, d, 0, 0, 0, 0], 4)
}

/// Returns what a frame asks for, in words.
fn shown(frame: &Frame) -> String {
    let [_, command, target, _] = frame.raw_id().to_be_bytes();
    let [a, b, c, d, ..] = frame.bytes();
    let whom = if target < 0x50 { format!("{target}") } else { format!("all of {}", 0x5F - target) };
    let tenths = |high, low| f32::from(u16::from_be_bytes([high, low])) / 10.0;
    let state = |is_on| if is_on == 1 { "on" } else { "off" };
    let what = match command {
        1 => format!("{} V {} A", tenths(a, b), tenths(c, d)),
        2 => state(a).into(),
        3 => format!("{} V {}", tenths(a, b), state(c)),
        4 => format!("{} V", tenths(a, b)),
        5 => format!("{} A", tenths(c, d)),
        7 => "group?".into(),
        8 => "state?".into(),
        9 => "measured?".into(),
        _ => format!("{frame}"),
    };
    format!("{whom} {what}")
}

/// A station with its modules, and what has happened.
pub struct Bus<K: Make, const M: usize, const G: usize, const R: usize> {
    pub station: Station<Message<K>, M, G, R>,
    pub chargers: Vec<Charger>,
    pub now: u32,
    /// The time of the program's clock when `now` was 0.
    pub start: u32,
    /// When frames come to the station.
    pub coming: Vec<(u32, Frame)>,
    /// Whether the driver takes frames.
    pub is_taken: bool,
    sent: Vec<(u32, Frame)>,
    events: Vec<(u32, Event)>,
}

pub type Grouped = Bus<InGroups, 2, 2, 14>;
pub type Lone = Bus<AtOnce, 1, 2, 7>;
pub type Separate = Bus<Apart, 1, 1, 8>;

/// Returns a bus with chargers 1 and 2, which are in group 1, and group 2.
pub fn grouped(settings: Settings) -> Grouped {
    let groups = [(1, Some(group(1))), (2, Some(group(2)))];
    Bus::of(Station::new(settings, [1, 2], groups), [1, 2])
}

/// Returns a bus with charger 1, which is in group 1.
pub fn separate(settings: Settings) -> Separate {
    Bus::of(Station::new(settings, [1], [(1, Some(group(1)))]), [1])
}

/// Returns a bus with charger 1, and the groups 1 and 2, which nothing addresses.
pub fn lone(settings: Settings) -> Lone {
    Bus::of(Station::new(settings, [1], [(1, None), (2, None)]), [1])
}

impl<K: Make, const M: usize, const G: usize, const R: usize> Bus<K, M, G, R> {
    pub fn of<const N: usize>(station: Result<Station<Message<K>, M, G, R>, Unfit>, nodes: [u8; N]) -> Self
    where
        Message<K>: Protocol,
    {
        let station = station.expect("it fits");
        let chargers = nodes.map(Charger::new).into();
        let (coming, sent, events) = (Vec::new(), Vec::new(), Vec::new());
        Self { station, chargers, now: 0, start: 0, coming, is_taken: true, sent, events }
    }

    /// Lets the program's clock begin at another time.
    pub fn from(mut self, start: u32) -> Self {
        self.start = start;
        self
    }

    /// The time of the program's clock.
    pub const fn clock(&self) -> u32 {
        self.start.wrapping_add(self.now)
    }

    /// Runs until a time, and does all that is to be done before it.
    pub fn run(&mut self, until: u32) {
        while self.now < until {
            self.turn();
            let wait = self.wait();
            let next = self.coming.iter().map(|(at, _)| *at).min().unwrap_or(until);
            self.now = until.min(next).min(self.now.saturating_add(wait));
        }
    }

    /// Gives the station the frames that have come.
    fn turn(&mut self) {
        let (come, coming) = self.coming.drain(..).partition::<Vec<_>, _>(|(at, _)| *at <= self.now);
        self.coming = coming;
        for (at, frame) in come {
            self.station.handle(&frame, self.start.wrapping_add(at));
        }
    }

    /// Polls until the station waits. Returns for how long.
    fn wait(&mut self) -> u32 {
        loop {
            match self.station.poll(self.clock()) {
                Step::Event(event) => self.events.push((self.now, event)),
                Step::Send { ticket, .. } if !self.is_taken => self.station.not_sent(ticket, self.clock()),
                Step::Send { frame, .. } => self.send(frame),
                Step::Wait(until) => {
                    let wait = until.wrapping_sub(self.clock());
                    assert!((1..1 << 30).contains(&wait), "it waits for {wait} ms at {}", self.now);
                    assert_eq!(self.station.poll(self.clock()), Step::Wait(until), "nothing was left to do");
                    return wait;
                }
            }
        }
    }

    fn send(&mut self, frame: Frame) {
        self.sent.push((self.now, frame));
        for charger in &mut self.chargers {
            let answer = charger.hear(&frame);
            self.coming.extend(answer.map(|answer| (self.now + charger.delay, answer)));
        }
    }

    /// Lets the station hear a frame now.
    pub fn hear(&mut self, frame: Frame) {
        self.coming.push((self.now, frame));
    }

    pub fn charger(&mut self, node: u8) -> &mut Charger {
        self.chargers.iter_mut().find(|charger| charger.node == node).expect("there is such a charger")
    }

    /// Returns what was sent since this was last asked, each with its time.
    pub fn sent(&mut self) -> Vec<String> {
        self.sent.drain(..).map(|(at, frame)| format!("{at}: {}", shown(&frame))).collect()
    }

    /// Returns what was sent to one module or group since this was last asked, but for reads.
    pub fn told(&mut self, whom: &str) -> Vec<String> {
        let sent = self.sent();
        let is_told = |text: &String| text.contains(&format!(": {whom} ")) && !text.ends_with('?');
        sent.into_iter().filter(is_told).collect()
    }

    /// Returns what has happened since this was last asked.
    pub fn events(&mut self) -> Vec<(u32, Event)> {
        core::mem::take(&mut self.events)
    }

    /// Forgets what was sent and what has happened.
    pub fn forget(&mut self) {
        (self.sent, self.events) = (Vec::new(), Vec::new());
    }
}
