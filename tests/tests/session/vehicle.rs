//! The vehicle. It leads: it says what it demands, and when it has enough.

use canspec_protocols::gbt27930::{
    BatteryType, Bcl, Bcp, Bcs, Bem, Bhm, Bmt, Bmv, Brm, Bro, Bsd, Bsm, Bsp, Bst, ChargingMode, Elements, Exchange,
    Frame, Layout, Message, Ownership, ReachedState, Readiness, Recognition, StopState, TIMING, Text,
};
use canspec_runtime::Bytes;

use super::side::{GENERAL, LAST_WORDS, Phase, READY, STATISTICS, Side, Station};

/// Section 8.3: the wait for CRM after CHM, and after BEM.
const RECOGNITION: u32 = 30_000;

pub struct Vehicle {
    pub side: Side,
    /// How long it charges until it has enough, in milliseconds.
    pub enough: u32,
    /// How long it takes to become ready.
    pub getting_ready: u32,
    is_ready: bool,
    is_stopped_by_charger: bool,
}

impl Vehicle {
    pub fn new(enough: u32) -> Self {
        Self { side: Side::new(), enough, getting_ready: 600, is_ready: false, is_stopped_by_charger: false }
    }

    /// Starts with the plug of the connector.
    pub fn plug(&mut self, now: u32) {
        self.side.wait("start", READY, now);
    }

    fn begin(&mut self, now: u32) {
        (self.is_ready, self.is_stopped_by_charger) = (false, false);
        self.side.rest();
        self.side.go(Phase::Handshake);
        self.side.repeat(&["bhm"], now);
        self.side.wait("crm", RECOGNITION, now);
    }

    fn recognise(&mut self, result: Recognition, now: u32) {
        match (self.side.phase, result) {
            (Phase::Handshake, Recognition::NotRecognised) => {
                self.side.go(Phase::Recognition);
                self.side.stop(&["bhm"]);
                self.side.repeat(&["brm"], now);
                self.side.has(&["crm"]);
                self.side.wait("crm_recognised", GENERAL, now);
            }
            (Phase::Recognition, Recognition::Recognised) => {
                self.side.go(Phase::Configuration);
                self.side.stop(&["brm"]);
                self.side.repeat(&["bcp"], now);
                self.side.has(&["crm_recognised"]);
                self.side.wait("cml", GENERAL, now);
            }
            _ => {}
        }
    }

    fn charge(&mut self, now: u32) {
        self.side.rest();
        self.side.go(Phase::Charging);
        self.side.repeat(&["bcl", "bcs", "bsm", "bmv", "bmt", "bsp"], now);
        self.side.wait("ccs", GENERAL, now);
        self.side.wait("enough", self.enough, now);
    }

    /// Stops. A charger that has stopped by itself is answered, and told the statistics at once.
    fn stop(&mut self, is_stopped_by_charger: bool, now: u32) {
        self.is_stopped_by_charger = is_stopped_by_charger;
        self.side.rest();
        self.side.go(if is_stopped_by_charger { Phase::End } else { Phase::Stop });
        self.side.repeat(if is_stopped_by_charger { &["bst", "bsd"] } else { &["bst"] }, now);
        self.side.wait("csd", STATISTICS, now);
        if !is_stopped_by_charger {
            self.side.wait("cst", GENERAL, now);
        }
    }

    fn fail(&mut self, missed: Option<&'static str>, now: u32) {
        self.side.fail(missed, "bem", now);
        self.side.wait("failed", if self.side.is_last() { LAST_WORDS } else { RECOGNITION }, now);
    }

    /// Returns what says for what it has waited in vain. Section 5.21.
    fn error(&self) -> Bem {
        let missed = |names: &[&str]| self.side.missed(names);
        Bem {
            crm_not_recognised: missed(&["crm", "start"]),
            crm_recognised: missed(&["crm_recognised"]),
            cts_and_cml: missed(&["cml"]),
            cro: missed(&["cro", "cro_ready"]),
            ccs: missed(&["ccs"]),
            cst: missed(&["cst"]),
            csd: missed(&["csd"]),
        }
    }
}

impl Station for Vehicle {
    fn side(&mut self) -> &mut Side {
        &mut self.side
    }

    fn hear(&mut self, message: &Message, now: u32) {
        let is_over = matches!(self.side.phase, Phase::Done | Phase::Failed) || self.side.is_last();
        match (self.side.phase, message) {
            _ if is_over => {}
            (phase, Message::Chm(_)) if phase != Phase::Handshake => self.begin(now),
            (phase, Message::Cem(_)) if phase != Phase::Error => self.fail(None, now),
            (_, Message::Crm(crm)) => self.recognise(crm.result, now),
            (Phase::Configuration, Message::Cml(_)) => {
                self.side.stop(&["bcp"]);
                self.side.repeat(&["bro"], now);
                self.side.has(&["cml"]);
                if !self.is_ready {
                    self.side.wait_first("ready", self.getting_ready, now);
                }
            }
            (Phase::Configuration, Message::Cro(cro)) => {
                self.side.has(&["cro"]);
                if cro.readiness == Readiness::Ready {
                    self.charge(now);
                }
            }
            (Phase::Charging, Message::Ccs(_)) => {
                let longest = TIMING.of("ccs").watchdog.expect("section 8.3").longest;
                self.side.wait("ccs", u32::try_from(longest.as_millis()).expect("a second"), now);
            }
            (Phase::Charging, Message::Cst(_)) => self.stop(true, now),
            (Phase::Stop, Message::Cst(_)) => {
                self.side.go(Phase::End);
                self.side.stop(&["bst"]);
                self.side.repeat(&["bsd"], now);
                self.side.has(&["cst"]);
            }
            (Phase::Stop | Phase::End, Message::Csd(_)) => {
                self.side.rest();
                self.side.go(Phase::Done);
            }
            _ => {}
        }
    }

    fn send(&mut self, name: &'static str, now: u32) -> Option<Frame> {
        let report = |exchange: Exchange, content| exchange.report_from(0xF4, content).ok();
        match name {
            "bhm" => report(Bhm::BMS_CYCLE, Message::Bhm(Bhm { maximum_voltage_v: Some(741.4) })),
            "bro" => {
                let readiness = if self.is_ready { Readiness::Ready } else { Readiness::NotReady };
                report(Bro::BMS_CYCLE, Message::Bro(Bro { readiness }))
            }
            "bcl" => report(Bcl::BMS_CYCLE, Message::Bcl(DEMAND)),
            "bsm" => report(Bsm::BMS_CYCLE, Message::Bsm(Bsm::decode(&[0x00, 0x51, 0x0F, 0x2B, 0x7F, 0x00, 0xD0, 0]))),
            "bst" => {
                let normal = Bst::decode(&[0, 0, 0, 0xF0, 0, 0, 0, 0]);
                let bst = if self.is_stopped_by_charger {
                    Bst { charger_stopped: StopState::Stopped, ..normal }
                } else {
                    Bst { target_soc: ReachedState::Reached, ..normal }
                };
                report(Bst::BMS_CYCLE, Message::Bst(bst))
            }
            "bsd" => report(Bsd::BMS_CYCLE, Message::Bsd(STATISTICS_OF_BATTERY)),
            "bem" => report(Bem::BMS_CYCLE, Message::Bem(self.error())),
            _ => {
                begin(&mut self.side, name, now);
                None
            }
        }
    }

    fn time_out(&mut self, wait: &'static str, now: u32) {
        match wait {
            "ready" => {
                self.is_ready = true;
                self.side.wait("cro", GENERAL, now);
                self.side.wait("cro_ready", READY, now);
            }
            "enough" => self.stop(false, now),
            "failed" => {
                self.side.rest();
                self.side.go(Phase::Failed);
            }
            _ => self.fail(Some(wait), now),
        }
    }
}

/// Section 9, S12.
const DEMAND: Bcl = Bcl { voltage_v: Some(388.8), current_a: Some(-80.5), mode: ChargingMode::ConstantCurrent };

/// Section 9, S28.
const STATISTICS_OF_BATTERY: Bsd = Bsd {
    state_of_charge_percent: Some(96),
    lowest_cell_voltage_v: Some(4.08),
    highest_cell_voltage_v: Some(4.15),
    lowest_temperature_c: Some(-3.0),
    highest_temperature_c: Some(38.0),
};

/// Begins a long message, with the values of section 10.
fn begin(side: &mut Side, name: &str, now: u32) {
    match name {
        "brm" => side.begin(&Brm::BMS_CYCLE, &recognition(), now),
        "bcp" => side.begin(&Bcp::BMS_CYCLE, &PARAMETERS, now),
        "bcs" => side.begin(&Bcs::BMS_CYCLE, &STATE, now),
        "bmv" => {
            let cell_voltage_v = [4.01, 4.02, 3.99, 4.0, 3.97, 4.03].map(Some);
            let (cell_voltage_v, cell_group) = (elements(&cell_voltage_v), elements(&[0, 0, 1, 1, 15, 15]));
            side.begin(&Bmv::BMS_CYCLE, &Bmv { cell_voltage_v, cell_group }, now);
        }
        "bmt" => {
            let points = [21.0, 22.0, 22.0, 24.0, -5.0, 0.0, 23.0, 60.0, -50.0, 25.0].map(Some);
            side.begin(&Bmt::BMS_CYCLE, &Bmt { temperature_c: elements(&points) }, now);
        }
        "bsp" => {
            let reserved: Vec<_> = (1..=10).map(|byte| Bytes::new([byte])).collect();
            side.begin(&Bsp::BMS_CYCLE, &Bsp { reserved: elements(&reserved) }, now);
        }
        _ => panic!("the vehicle sends no {name}"),
    }
}

fn elements<T: Copy + Default, const N: usize>(values: &[T]) -> Elements<T, N> {
    Elements::from_slice(values).expect("a few elements")
}

fn recognition() -> Brm {
    Brm {
        version_minor: 1,
        version_major: 1,
        battery_type: BatteryType::Ternary,
        rated_capacity_ah: 180.5,
        rated_voltage_v: 355.2,
        manufacturer: Text::new("ACME").expect("four letters"),
        pack_number: Some(19_088_743),
        production_year: Some(2022.0),
        production_month: Some(11),
        production_day: Some(30),
        charge_count: Some(70_000),
        ownership: Ownership::Owned,
        vin: Text::new("LTESTVEHICLE00042").expect("17 letters"),
        software_number: Some(16),
        software_day: Some(10),
        software_month: Some(8),
        software_year: Some(2023),
    }
}

const PARAMETERS: Bcp = Bcp {
    maximum_cell_voltage_v: Some(4.25),
    maximum_current_a: Some(-160.0),
    nominal_energy_wh: Some(64_100.0),
    maximum_voltage_v: Some(408.0),
    maximum_temperature_c: Some(55.0),
    state_of_charge_percent: Some(37.4),
    battery_voltage_v: Some(351.9),
};

const STATE: Bcs = Bcs {
    voltage_v: Some(388.2),
    current_a: Some(-80.1),
    highest_cell_voltage_v: Some(4.07),
    highest_cell_group: 5,
    state_of_charge_percent: Some(63),
    remaining_time_min: Some(46),
};
