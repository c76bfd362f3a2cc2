//! Raw values survive the way to a physical value and back, in both engines; set-points on the grid meet their own raw value.

use canspec_codegen::interpret::{self, Input, Limits, raw_of};
use canspec_codegen::model::{Id, Message, MessageId, Protocol, Signal, SignalId};
use canspec_protocols::infy::SetModuleOutput;
use canspec_protocols::{mxr, trio};
use canspec_runtime::{Meaning, Payload, Reading, WriteSignal};
use canspec_tests::{
    Optional, Signals, SwitchedVisitor, Visitor, protocol, signals, visit, visit_in_steps, visit_switched,
};

/// How many random raw values a signal of more than 16 bits sees.
const SAMPLE: usize = 20_000;

/// Every raw value up to 16 bits; beyond, the edges and a sample.
fn raw_values(width: u8) -> Vec<u64> {
    let max = u64::MAX >> (64 - width);
    if width <= 16 {
        return (0..=max).collect();
    }
    let mut random = fastrand::Rng::with_seed(width.into());
    let mut values: Vec<_> = (0..SAMPLE).map(|_| random.u64(..) & max).collect();
    for bit in 0..width {
        let power = 1 << bit;
        values.extend([power - 1, power, power + 1, max - power, max ^ power].map(|raw| raw & max));
    }
    values
}

struct Sweep {
    signals: usize,
}

impl Visitor for Sweep {
    fn visit<P: canspec_runtime::Protocol + Signals>(&mut self, path: &str) {
        let protocol = protocol(path);
        for message in &protocol.messages {
            for signal in &message.signals {
                interpreter(&protocol, message, signal);
                self.signals += 1;
            }
        }
        generated::<P>(&protocol, |_, _| true);
    }
}

fn interpreter(protocol: &Protocol, message: &Message, signal: &Signal) {
    for bits in raw_values(signal.place.width()) {
        let reading = interpret::Reading::of(protocol, (Id::new(0), signal), bits);
        let back = raw_of(protocol, message, signal, &Input::of(protocol, signal, &reading), Limits::Bits);
        assert_eq!(back, Ok(bits), "{}.{}.{}: {:?}", protocol.name, message.name, signal.name, reading.value);
    }
}

/// Which raw values of a signal must survive.
type Survives = fn(&'static dyn WriteSignal, &Reading) -> bool;

/// Sweeps the signals of the generated code.
fn generated<P: Signals>(protocol: &Protocol, survives: Survives) {
    signals::<P>(protocol).for_each(|(_, _, signal)| sweep(signal, survives));
}

fn sweep(signal: &'static dyn WriteSignal, survives: Survives) {
    let place = signal.place();
    for bits in raw_values(place.width()) {
        let mut data = [0; 8];
        place.put(&mut data, bits);
        signal.read(&data, &mut |reading: Reading| {
            if !survives(signal, &reading) {
                return;
            }
            let mut payload = Payload::new("message", [0; 8]);
            let text = if let Meaning::Packed(text) = reading.meaning { text.to_string() } else { String::new() };
            let meaning = match reading.meaning {
                Meaning::None => return,
                Meaning::Packed(_) => Meaning::Text(&text),
                meaning => meaning,
            };
            let written = signal.write(meaning, &mut payload);
            assert_eq!(written.map(|()| *payload.data()), Ok(data), "{}: {:?}", signal.name(), reading.meaning);
        });
    }
}

#[test]
fn every_raw_value_survives_the_way_to_its_physical_value_and_back() {
    let mut sweep = Sweep { signals: 0 };
    visit(&mut sweep);
    assert!(sweep.signals >= 34, "{} signals", sweep.signals);
}

struct SinglePrecision;

impl SwitchedVisitor for SinglePrecision {
    fn visit<P>(&mut self, path: &str)
    where
        P: canspec_runtime::Protocol<Identifier: Optional> + Signals + Optional + PartialEq,
    {
        generated::<P>(&protocol(path), is_documented);
    }
}

/// Tests whether a value is inside its limits, if it has any. Single precision need not tell others apart.
fn is_documented(signal: &'static dyn WriteSignal, reading: &Reading) -> bool {
    let Meaning::Number(value) = reading.meaning else { return true };
    let limits = signal.limits().map(|(minimum, maximum)| minimum.to_f64()..=maximum.to_f64());
    limits.is_none_or(|limits| limits.contains(&value.to_f64()))
}

#[test]
fn every_raw_value_survives_in_single_precision_too() {
    visit_switched(&mut SinglePrecision);
}

struct WholeSteps;

impl Visitor for WholeSteps {
    fn visit<P: canspec_runtime::Protocol + Signals>(&mut self, path: &str) {
        generated::<P>(&protocol(path), |_, _| true);
    }
}

#[test]
fn every_raw_value_survives_the_way_to_what_a_reading_in_whole_steps_says_and_back() {
    visit_in_steps(&mut WholeSteps);
}

/// Returns `millivolts` as a person writes them in volts: the text decides the double, not an operation of ours.
fn volts(millivolts: u32) -> f64 {
    let text = format!("{}.{:03}", millivolts / 1000, millivolts % 1000);
    text.parse().expect("a decimal number")
}

#[test]
fn every_set_point_in_steps_of_a_millivolt_meets_its_own_raw_value_in_generated_code() {
    for millivolts in 0..=1_000_000 {
        let mut payload = Payload::new("message", [0; 8]);
        SetModuleOutput::VOLTAGE.encode(volts(millivolts), &mut payload).expect("the value fits 32 bits");
        assert_eq!(payload.data()[..4], millivolts.to_be_bytes());
    }
}

/// A scaled signal of a shipped protocol, for the interpreter.
struct SetPoint {
    protocol: Protocol,
    message: MessageId,
    signal: SignalId,
}

impl SetPoint {
    fn of(spec: &str, message: &str, signal: &str) -> Self {
        let protocol = protocol(format!("{}/../specs/{spec}.yaml", env!("CARGO_MANIFEST_DIR")));
        let message = protocol.messages.position(|known| known.name == message).expect("a message");
        let signal = protocol[message].signals.position(|known| known.name == signal);
        Self { protocol, message, signal: signal.expect("a signal") }
    }

    fn raw(&self, value: f64, limits: Limits) -> Option<u64> {
        let message = &self.protocol[self.message];
        raw_of(&self.protocol, message, &message[self.signal], &Input::Number(value), limits).ok()
    }
}

#[test]
fn every_set_point_in_steps_of_a_millivolt_meets_its_own_raw_value_in_the_interpreter() {
    let voltage = SetPoint::of("infy", "set_module_output", "voltage");
    for millivolts in 0..=1_000_000 {
        assert_eq!(voltage.raw(volts(millivolts), Limits::Bits), Some(millivolts.into()));
    }
}

#[test]
fn every_set_point_in_steps_of_1_1024_meets_its_own_raw_value_and_a_milliampere_the_nearest() {
    let current = SetPoint::of("mxr", "set_output_current", "value");
    let meets = |amperes: f64, raw: u32| {
        let mut payload = Payload::new("message", [0; 8]);
        mxr::SetOutputCurrent::VALUE.encode(amperes, &mut payload).expect("the value fits 32 bits");
        assert_eq!(payload.data()[4..], raw.to_be_bytes(), "{amperes} A");
        assert_eq!(current.raw(amperes, Limits::Range(None)), Some(raw.into()), "{amperes} A");
    };
    (0..=1_u32 << 20).for_each(|raw| meets(f64::from(raw) / 1024.0, raw));
    (0..=1_000_000).for_each(|milliamperes| meets(volts(milliamperes), (milliamperes * 256 + 125) / 250));
}

/// The voltages that the TRIO document prints for its models in 3.3, in tenths of a volt.
const PRINTED: [(trio::Model, u32, u32); 5] = [
    (trio::Model::Pm1ac24dc1500wPt, 185, 295),
    (trio::Model::Pm1ac24dc2500w, 235, 298),
    (trio::Model::Pm1ac24dc2500wPt, 235, 298),
    (trio::Model::Pm1ac48dc1500wPt, 380, 580),
    (trio::Model::Pm1ac48dc2500wPt, 450, 590),
];

#[test]
fn every_set_point_of_a_model_meets_its_own_raw_value_and_no_other_is_taken() {
    assert_eq!(PRINTED.map(|(model, ..)| model), trio::Model::ALL);
    let voltage = SetPoint::of("trio", "control", "voltage");
    for (id, (model, lowest, highest)) in voltage.protocol.models.ids().zip(PRINTED) {
        for tenths in 0..=1000 {
            let name = format!("{}, {tenths} tenths of a volt", model.name());
            let raw = (lowest..=highest).contains(&tenths).then_some(tenths);
            assert_eq!(voltage.raw(volts(tenths * 100), Limits::Range(Some(id))), raw.map(u64::from), "{name}");
            let control = trio::Control {
                mode: trio::ControlMode::Remote,
                operation: trio::Operation::On,
                voltage_v: volts(tenths * 100),
            };
            let request = control.within(model).and_then(|control| control.set(trio::Target::Module(0xE6)));
            let sent = request.ok().map(|request| request.frame().bytes());
            // The document's frame for module 7: remote, on, and the voltage in two bytes.
            let printed = raw.map(|raw| (0x0180_0000_0000_0000 | u64::from(raw) << 32).to_be_bytes());
            assert_eq!(sent, printed, "{name}");
        }
    }
}

#[test]
fn a_value_between_two_steps_goes_to_the_nearer_one_and_a_tie_away_from_zero() {
    // Halves of a step that a double holds exactly: 1/16 V is 62.5 mV.
    for (volts, millivolts) in [(0.0625, 63), (0.1875, 188), (0.0624, 62), (0.000_4, 0), (0.000_6, 1), (1.0625, 1063)] {
        let mut payload = Payload::new("message", [0; 8]);
        SetModuleOutput::VOLTAGE.encode(volts, &mut payload).expect("the value fits");
        assert_eq!(SetModuleOutput::VOLTAGE.get(payload.data()), millivolts, "{volts} V");
    }
}
