//! A battery of Daly, which is polled. Cells and temperatures come in several frames with numbers.

use std::collections::{BTreeMap, VecDeque};

use canspec_protocols::daly::{
    Balance, BalanceState, CellVoltageExtremes, CellVoltagesPart, ChargeState, Connection, FailureStatus, Failures,
    Frame, InputsOutputs, Message, OperatingState, PackValues, StatusInformation, Target, TemperatureExtremes,
    TemperaturesPart,
};
use canspec_runtime::client::{Client, Heard, Step};
use canspec_runtime::sim::{Answer, Bench, Device, Event, Faults, Random, Rules};
use canspec_runtime::{Protocol as _, Quantity, Received};

/// What a battery is.
#[derive(Clone, Debug, PartialEq)]
struct Battery {
    pack: PackValues,
    state: ChargeState,
    cells_v: Vec<f64>,
    temperatures_c: Vec<f64>,
    balance: Balance,
    failures: Failures,
    fault_code: u8,
}

/// A simulated battery.
struct Simulated {
    battery: Battery,
    /// Frames that it has not sent yet.
    waiting: VecDeque<Frame>,
}

/// Returns what is greatest of some values by an order, with the number of its place, which begins with 1.
fn extreme(values: &[f64], order: impl Fn(&f64, &f64) -> bool) -> (f64, u8) {
    let numbered = values.iter().copied().zip(1..);
    numbered.reduce(|best, other| if order(&other.0, &best.0) { other } else { best }).expect("there is one")
}

/// Returns some values in groups of `N`, each with the number of its frame, which begins with 0. What is left of the
/// last group is `blank`.
fn frames<const N: usize>(values: &[f64], blank: f64) -> impl Iterator<Item = (u8, [f64; N])> {
    let group = move |group: &[f64]| std::array::from_fn(|place| group.get(place).copied().unwrap_or(blank));
    (0..).zip(values.chunks(N).map(group))
}

impl Battery {
    /// Draws a battery. Numbers are whole steps of their signals.
    fn random(random: &mut Random) -> Self {
        let mut draw = |most: u32| f64::from(random.below(most + 1));
        let whole = |value: f64| format!("{value}").parse().expect("a byte");
        let pack = PackValues {
            cumulative_voltage_v: draw(6000) / 10.0,
            gathered_voltage_v: draw(6000) / 10.0,
            current_a: (draw(6000) - 3000.0) / 10.0,
            state_of_charge_percent: draw(1000) / 10.0,
        };
        let state = ChargeState {
            state: OperatingState::Discharging,
            charge_mos: whole(draw(1)),
            discharge_mos: whole(draw(1)),
            life: whole(draw(255)),
            remaining_capacity_ah: draw(300_000) / 1000.0,
        };
        let cells_v = (0..13).map(|_| (3000.0 + draw(1000)) / 1000.0).collect();
        let temperatures_c = (0..16).map(|_| draw(100) - 40.0).collect();
        let (balance, failures) = (Balance::CELL_3 | Balance::CELL_12, Failures::SOC_LOW_LEVEL_2);
        Self { pack, state, cells_v, temperatures_c, balance, failures, fault_code: whole(draw(255)) }
    }

    /// Returns what it answers to a request, in one frame or in several.
    fn says(&self, request: &Message) -> Vec<Message> {
        let byte = |count: usize| u8::try_from(count).expect("a few");
        match request {
            Message::ReadPackValues => vec![Message::PackValues(self.pack)],
            Message::ReadChargeState => vec![Message::ChargeState(self.state)],
            Message::ReadStatusInformation => vec![Message::StatusInformation(StatusInformation {
                cell_count: byte(self.cells_v.len()),
                temperature_count: byte(self.temperatures_c.len()),
                charger: Connection::Disconnected,
                load: Connection::Connected,
                inputs_outputs: InputsOutputs::DO_1,
            })],
            Message::ReadCellVoltageExtremes => {
                let (maximum_voltage_v, maximum_cell) = extreme(&self.cells_v, |one, other| one > other);
                let (minimum_voltage_v, minimum_cell) = extreme(&self.cells_v, |one, other| one < other);
                let extremes = CellVoltageExtremes { maximum_voltage_v, maximum_cell, minimum_voltage_v, minimum_cell };
                vec![Message::CellVoltageExtremes(extremes)]
            }
            Message::ReadTemperatureExtremes => {
                let (maximum_temperature_c, maximum_cell) = extreme(&self.temperatures_c, |one, other| one > other);
                let (minimum_temperature_c, minimum_cell) = extreme(&self.temperatures_c, |one, other| one < other);
                vec![Message::TemperatureExtremes(TemperatureExtremes {
                    maximum_temperature_c,
                    maximum_cell,
                    minimum_temperature_c,
                    minimum_cell,
                })]
            }
            Message::ReadCellVoltages => {
                let frames = frames(&self.cells_v, 0.0);
                frames
                    .map(|(part, voltage_v)| Message::CellVoltagesPart(CellVoltagesPart { part, voltage_v }))
                    .collect()
            }
            Message::ReadTemperatures => {
                let frames = frames(&self.temperatures_c, -40.0);
                frames
                    .map(|(part, temperature_c)| Message::TemperaturesPart(TemperaturesPart { part, temperature_c }))
                    .collect()
            }
            Message::ReadBalanceState => vec![Message::BalanceState(BalanceState { balance: self.balance })],
            Message::ReadFailureStatus => {
                let (failures, fault_code) = (self.failures, self.fault_code);
                vec![Message::FailureStatus(FailureStatus { failures, fault_code })]
            }
            _ => vec![],
        }
    }
}

impl Device<Message> for Simulated {
    fn answer(&mut self, request: &Received<Message>, _now: u32) -> Answer<Message> {
        let answer = |content| request.answer(request.node()?, content).ok();
        self.waiting.extend(self.battery.says(request.content()).into_iter().filter_map(answer));
        Answer::Silence
    }

    fn report(&mut self, _node: u8, _now: u32) -> Option<Frame> {
        self.waiting.pop_front()
    }
}

/// What the program knows of a battery. Frames of several have their numbers.
#[derive(Default)]
struct Known {
    pack: Option<PackValues>,
    state: Option<ChargeState>,
    status: Option<StatusInformation>,
    cells: Option<CellVoltageExtremes>,
    temperatures: Option<TemperatureExtremes>,
    balance: Option<Balance>,
    failures: Option<FailureStatus>,
    cells_v: BTreeMap<u8, [f64; 3]>,
    temperatures_c: BTreeMap<u8, [f64; 7]>,
    /// The state of charge in thousandths of a per cent, as any program reads it.
    state_of_charge: Option<i32>,
}

impl Known {
    fn hear(&mut self, received: &Received<Message>) {
        self.state_of_charge = received.quantity(Quantity::STATE_OF_CHARGE).or(self.state_of_charge);
        match *received.content() {
            Message::PackValues(pack) => self.pack = Some(pack),
            Message::ChargeState(state) => self.state = Some(state),
            Message::StatusInformation(status) => self.status = Some(status),
            Message::CellVoltageExtremes(extremes) => self.cells = Some(extremes),
            Message::TemperatureExtremes(extremes) => self.temperatures = Some(extremes),
            Message::BalanceState(BalanceState { balance }) => self.balance = Some(balance),
            Message::FailureStatus(status) => self.failures = Some(status),
            Message::CellVoltagesPart(CellVoltagesPart { part, voltage_v }) => {
                self.cells_v.insert(part, voltage_v);
            }
            Message::TemperaturesPart(TemperaturesPart { part, temperature_c }) => {
                self.temperatures_c.insert(part, temperature_c);
            }
            _ => panic!("batteries send no {received:?}"),
        }
    }

    /// Returns the battery, as soon as each frame of it has come.
    fn battery(&self) -> Option<Battery> {
        let status = self.status?;
        let (cells, temperatures) = (usize::from(status.cell_count), usize::from(status.temperature_count));
        let is_whole = self.cells_v.len() == cells.div_ceil(3) && self.temperatures_c.len() == temperatures.div_ceil(7);
        Some(Battery {
            pack: self.pack?,
            state: self.state?,
            cells_v: is_whole.then(|| self.cells_v.values().flatten().copied().take(cells).collect())?,
            temperatures_c: self.temperatures_c.values().flatten().copied().take(temperatures).collect(),
            balance: self.balance?,
            failures: self.failures?.failures,
            fault_code: self.failures?.fault_code,
        })
    }
}

/// Polls two batteries that restart, until each is known.
fn poll(seed: u64) {
    let mut random = Random::new(seed);
    let batteries = [1, 0x1F].map(|node| (node, Battery::random(&mut random)));
    let simulated = |(node, battery): (u8, Battery)| (node, Simulated { battery, waiting: VecDeque::new() });
    let pace = super::pace::<Message>();
    let rules = Rules { gap: pace.gap, boot: 1000, ..Rules::default() };
    let mut bench = Bench::<Message, Simulated, 2, 64>::new(batteries.clone().map(simulated), rules, seed);
    let mut client = Client::<Message, 32>::new(pace);
    for (node, _) in &batteries {
        *bench.faults(*node).expect("a battery") =
            Faults { deaf: 10, lost: 10, twice: 10, broken: 10, restarts: Some(1000), ..Faults::NONE };
        let request = |entry: &canspec_runtime::Entry<Message>| entry.request("read", Target::Battery(*node));
        for request in Message::MESSAGES.iter().filter_map(request) {
            client.every(1500, request.expect("a battery"), 0).expect("room");
        }
    }
    let mut known = BTreeMap::<i32, Known>::new();
    for now in 0..30_000 {
        while let Some(event) = bench.poll(now) {
            let Event::Frame { frame, at } = event else { panic!("seed {seed}: {event:?}") };
            match client.handle(&frame, at) {
                Heard::Answer { received, .. } | Heard::Twice { received, .. } | Heard::Late { received, .. } => {
                    known.entry(received.node().expect("a battery")).or_default().hear(&received);
                }
                _ => {}
            }
        }
        loop {
            match client.poll(now) {
                Step::Send { frame, .. } => bench.send(&frame, now),
                Step::Wait(_) => break,
                _ => {}
            }
        }
    }
    for (node, battery) in batteries {
        let known = &known[&i32::from(node)];
        assert_eq!(known.battery().as_ref(), Some(&battery), "seed {seed}: battery {node}");
        let cells = known.cells.expect("it was asked");
        let highest = battery.cells_v.iter().copied().fold(f64::MIN, f64::max);
        let at = battery.cells_v.iter().position(|cell| *cell >= highest).expect("it is one of them");
        assert_eq!((cells.maximum_voltage_v, usize::from(cells.maximum_cell)), (highest, at + 1), "seed {seed}");
        let lowest = battery.temperatures_c.iter().copied().fold(f64::MAX, f64::min);
        assert_eq!(known.temperatures.map(|known| known.minimum_temperature_c), Some(lowest), "seed {seed}");
        let thousandths = battery.pack.state_of_charge_percent * 1000.0;
        assert_eq!(known.state_of_charge.map(f64::from), Some(thousandths.round()), "seed {seed}");
    }
    assert_eq!(bench.tally().restarts, 2, "seed {seed}");
}

#[test]
fn batteries_are_polled_until_each_value_is_known() {
    (0..10).for_each(poll);
}
