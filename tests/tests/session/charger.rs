//! The charger. It follows what the vehicle demands.

use canspec_protocols::gbt27930::transfers::Whole;
use canspec_protocols::gbt27930::{
    Bcd, Bcl, Bcp, Bcs, Brm, Ccs, Cem, ChargerPermission, Chm, Cml, Crm, Cro, Csd, Cst, Cts, Frame, Layout, Message,
    Readiness, Recognition, StopState, TIMING, Target, Text, Tp,
};

use super::side::{GENERAL, LAST_WORDS, Phase, READY, STATISTICS, Side, Station};

pub struct Charger {
    pub side: Side,
    /// How long it charges until it has enough, in milliseconds, if it stops by itself.
    pub enough: Option<u32>,
    /// How long it takes to become ready.
    pub getting_ready: u32,
    is_recognised: bool,
    is_ready: bool,
    is_stopped_by_vehicle: bool,
    demand: Option<Bcl>,
    state: Option<Bcs>,
}

impl Charger {
    pub fn new(enough: Option<u32>) -> Self {
        Self {
            side: Side::new(),
            enough,
            getting_ready: 900,
            is_recognised: false,
            is_ready: false,
            is_stopped_by_vehicle: false,
            demand: None,
            state: None,
        }
    }

    pub fn begin(&mut self, now: u32) {
        (self.is_recognised, self.is_ready, self.is_stopped_by_vehicle) = (false, false, false);
        (self.demand, self.state) = (None, None);
        self.side.rest();
        self.side.go(Phase::Handshake);
        self.side.repeat(&["chm"], now);
        self.side.wait("bhm", GENERAL, now);
    }

    /// Begins to charge as soon as a demand and a state have come.
    fn charge(&mut self, now: u32) {
        if self.demand.is_none() || self.state.is_none() {
            return;
        }
        self.side.rest();
        self.side.go(Phase::Charging);
        self.side.repeat(&["ccs"], now);
        self.side.wait("bcl", second(), now);
        self.side.wait("bcs", GENERAL, now);
        self.side.wait("bsm", GENERAL, now);
        if let Some(enough) = self.enough {
            self.side.wait("enough", enough, now);
        }
    }

    fn stop(&mut self, is_stopped_by_vehicle: bool, now: u32) {
        self.is_stopped_by_vehicle = is_stopped_by_vehicle;
        self.side.rest();
        self.side.go(Phase::Stop);
        self.side.repeat(&["cst"], now);
        self.side.wait("bsd", STATISTICS, now);
        if !is_stopped_by_vehicle {
            self.side.wait("bst", GENERAL, now);
        }
    }

    fn fail(&mut self, missed: Option<&'static str>, now: u32) {
        self.side.fail(missed, "cem", now);
        self.side.wait(if self.side.is_last() { "failed" } else { "again" }, LAST_WORDS, now);
    }

    /// Returns what says for what it has waited in vain. Section 5.22.
    fn error(&self) -> Cem {
        let missed = |names: &[&str]| self.side.missed(names);
        Cem {
            brm: missed(&["brm"]),
            bcp: missed(&["bcp"]),
            bro: missed(&["bro", "bro_ready"]),
            bcs: missed(&["bcs"]),
            bcl: missed(&["bcl"]),
            bst: missed(&["bst"]),
            bsd: missed(&["bsd"]),
        }
    }

    fn is_ready_to_charge(&self) -> bool {
        self.side.phase == Phase::Configuration && self.is_ready
    }
}

/// Returns the wait for BCL, after which charging ends at once.
fn second() -> u32 {
    let longest = TIMING.of("bcl").watchdog.expect("section 8.3").longest;
    u32::try_from(longest.as_millis()).expect("a second")
}

impl Station for Charger {
    fn side(&mut self) -> &mut Side {
        &mut self.side
    }

    fn hear(&mut self, message: &Message, now: u32) {
        match (self.side.phase, message) {
            (Phase::Handshake, Message::Bhm(_)) => {
                self.side.go(Phase::Recognition);
                self.side.stop(&["chm"]);
                self.side.repeat(&["crm"], now);
                self.side.has(&["bhm"]);
                self.side.wait("brm", GENERAL, now);
            }
            (Phase::Handshake | Phase::Error | Phase::Failed | Phase::Done, _) => {}
            (_, Message::Bem(_)) => self.fail(None, now),
            (Phase::Configuration, Message::Bro(bro)) => {
                self.side.has(&["bro"]);
                if bro.readiness == Readiness::Ready && !self.is_ready {
                    self.side.stop(&["cts", "cml"]);
                    self.side.repeat(&["cro"], now);
                    self.side.has(&["bro_ready"]);
                    self.side.wait_first("ready", self.getting_ready, now);
                }
            }
            (Phase::Configuration, Message::Bcl(demand)) if self.is_ready => {
                self.demand = Some(*demand);
                self.side.has(&["bcl"]);
                self.charge(now);
            }
            (Phase::Charging, Message::Bcl(demand)) => {
                self.demand = Some(*demand);
                self.side.wait("bcl", second(), now);
            }
            (Phase::Charging, Message::Bsm(_)) => self.side.wait("bsm", GENERAL, now),
            (Phase::Charging, Message::Bst(_)) => self.stop(true, now),
            (Phase::Stop, Message::Bst(_)) => self.side.has(&["bst"]),
            // Section 8.1: BST and CST answer each other before the end.
            (Phase::Stop, Message::Bsd(_)) if !self.side.lacks("bst") => {
                self.side.rest();
                self.side.go(Phase::End);
                self.side.repeat(&["csd"], now);
                self.side.wait("silence", 1000, now);
            }
            (Phase::End, Message::Bsd(_)) => self.side.wait("silence", 1000, now),
            _ => {}
        }
    }

    fn hear_long(&mut self, whole: &Whole<Tp>, now: u32) {
        if self.side.phase == Phase::Recognition && !self.is_recognised && whole.values::<Brm>().is_some() {
            self.is_recognised = true;
            self.side.has(&["brm"]);
            self.side.wait("bcp", GENERAL, now);
        } else if self.side.phase == Phase::Recognition && whole.values::<Bcp>().is_some() {
            self.side.rest();
            self.side.go(Phase::Configuration);
            self.side.repeat(&["cts", "cml"], now);
            self.side.wait("bro", GENERAL, now);
            self.side.wait("bro_ready", READY, now);
        } else if whole.values::<Bcs>().is_some() && self.is_ready_to_charge() {
            self.state = whole.values();
            self.side.has(&["bcs"]);
            self.charge(now);
        } else if whole.values::<Bcs>().is_some() && self.side.phase == Phase::Charging {
            self.side.wait("bcs", GENERAL, now);
        }
    }

    fn send(&mut self, name: &'static str, _now: u32) -> Option<Frame> {
        let text = |text| Text::new(text).expect("three letters");
        let request = match name {
            "chm" => Chm { version_minor: 1, version_major: 1 }.charger_cycle(Target::Peer),
            "crm" => {
                let result = if self.is_recognised { Recognition::Recognised } else { Recognition::NotRecognised };
                Crm { result, charger_number: NUMBER, area_code: text("B07") }.charger_cycle(Target::Peer)
            }
            "cts" => clock().charger_cycle(Target::Peer),
            "cml" => CAPABILITY.charger_cycle(Target::Peer),
            "cro" => {
                let readiness = if self.is_ready { Readiness::Ready } else { Readiness::NotReady };
                Cro { readiness }.charger_cycle(Target::Peer)
            }
            "ccs" => delivered(&self.demand?).charger_cycle(Target::Peer),
            "cst" => {
                let normal = Cst::decode(&[0, 0, 0xF0, 0xF0, 0, 0, 0, 0]);
                let cst = if self.is_stopped_by_vehicle {
                    Cst { bms_stopped: StopState::Stopped, ..normal }
                } else {
                    Cst { condition_reached: StopState::Stopped, ..normal }
                };
                cst.charger_cycle(Target::Peer)
            }
            "csd" => Csd { charging_time_min: Some(73), output_energy_wh: Some(41_700.0), charger_number: NUMBER }
                .charger_cycle(Target::Peer),
            "cem" => self.error().charger_cycle(Target::Peer),
            _ => panic!("the charger sends no {name}"),
        };
        Some(*request.expect("the document allows it").frame())
    }

    fn time_out(&mut self, wait: &'static str, now: u32) {
        match wait {
            "ready" => {
                self.is_ready = true;
                self.side.wait("bcl", GENERAL, now);
                self.side.wait("bcs", GENERAL, now);
            }
            "enough" => self.stop(false, now),
            "again" => self.begin(now),
            "silence" => {
                self.side.rest();
                self.side.go(Phase::Done);
            }
            "failed" => {
                self.side.rest();
                self.side.go(Phase::Failed);
            }
            _ => self.fail(Some(wait), now),
        }
    }
}

const NUMBER: u32 = 4711;

/// Section 9, S06.
fn clock() -> Cts {
    let two = |number: u64| Bcd::new(number);
    Cts { second: two(58), minute: two(59), hour: two(23), day: two(29), month: two(2), year: Bcd::new(2024) }
}

/// Section 9, S08.
const CAPABILITY: Cml = Cml {
    maximum_voltage_v: Some(750.0),
    minimum_voltage_v: Some(200.0),
    maximum_current_a: Some(-125.0),
    minimum_current_a: Some(-2.5),
};

/// Returns what it delivers: a little less than what the vehicle demands. With S12 of section 9, it is S15.
fn delivered(demand: &Bcl) -> Ccs {
    Ccs {
        output_voltage_v: demand.voltage_v.map(|voltage_v| voltage_v - 0.9),
        output_current_a: demand.current_a.map(|current_a| current_a + 0.7),
        charging_time_min: Some(17),
        permission: ChargerPermission::Allowed,
        byte_8: None,
    }
}
