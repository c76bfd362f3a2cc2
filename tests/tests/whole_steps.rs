//! Whole steps: the same values are legal as in `f64`, the same frames are sent, and people read the same.

use canspec_codegen::model::{Message, ModelId, Protocol, Range, Signal};
use canspec_codegen::number::Rational;
use canspec_protocols::infy;
use canspec_runtime::{Error, Payload};
use canspec_tests::infy_in_steps as steps;
use canspec_tests::{KnownSignal, Signals, Visitor, models, number, protocol, signals, visit, visit_in_steps};

/// Compares what is legal with exact fractions.
#[derive(Default)]
struct Verdicts {
    legal: usize,
    refused: usize,
}

impl Visitor for Verdicts {
    fn visit<P: canspec_runtime::Protocol + Signals>(&mut self, path: &str) {
        let protocol = protocol(path);
        let mut random = fastrand::Rng::with_seed(0x57E9);
        for (message, signal, known) in signals::<P>(&protocol) {
            let has_it = |model: &Option<ModelId>| model.is_none_or(|model| signal.is_of(model));
            for model in models(&protocol).filter(has_it).filter(|_| signal.encoding.linear().is_some()) {
                let range = limits(&protocol, message, signal, model);
                for raw in raw_values(signal, range, &mut random) {
                    self.compare(signal, known, (model, range), raw);
                }
            }
        }
    }
}

impl Verdicts {
    fn compare(
        &mut self,
        signal: &Signal,
        known: &'static dyn KnownSignal,
        (model, range): (Option<ModelId>, Option<Range>),
        raw: i128,
    ) {
        let bits = u64::try_from(raw).unwrap_or_else(|_| i64::try_from(raw).expect("64 bits").cast_unsigned());
        let mut payload = Payload::within_limits("message", [0; 8]).for_model(model.map(number));
        let written = known.put_bits(bits, &mut payload);
        let is_legal = is_legal(signal, (model, range), raw);
        assert_eq!(written.is_ok(), is_legal, "raw {raw} of {signal:?}");
        let mut data = [0; 8];
        signal.place.put(&mut data, if is_legal { bits } else { 0 });
        assert_eq!(payload.data(), &data, "raw {raw} of {signal:?}");
        *if is_legal { &mut self.legal } else { &mut self.refused } += 1;
    }
}

/// Returns the limits of a request.
fn limits(protocol: &Protocol, message: &Message, signal: &Signal, model: Option<ModelId>) -> Option<Range> {
    match model {
        Some(_) => signal.limits_for(model),
        None => signal.hull(protocol.models_of(message)),
    }
}

/// Tests by exact fractions whether a request may carry a raw value.
fn is_legal(signal: &Signal, (model, range): (Option<ModelId>, Option<Range>), raw: i128) -> bool {
    let has = |models: &[ModelId]| models.is_empty() || model.is_none_or(|model| models.contains(&model));
    let is_special = signal.specials.iter().any(|special| special.raw == raw && has(&special.models));
    let value = signal.encoding.value_of(raw);
    is_special || value.is_some_and(|value| range.is_none_or(|range| (range.minimum..=range.maximum).contains(&value)))
}

/// Returns every raw value of few bits. Of many bits, returns those around limits and special values, and a sample.
fn raw_values(signal: &Signal, range: Option<Range>, random: &mut fastrand::Rng) -> Vec<i128> {
    let (first, last) = signal.raw_limits();
    if signal.place.width() <= 12 {
        return (first..=last).collect();
    }
    let ends = range.into_iter().flat_map(|range| [range.minimum, range.maximum]);
    let ends = ends.filter_map(|end| nearest_raw(signal, end));
    let centres: Vec<_> = ends.chain(signal.specials.iter().map(|special| special.raw)).chain([first, last]).collect();
    let near =
        centres.into_iter().flat_map(|centre| centre - 2..=centre + 2).filter(|raw| (first..=last).contains(raw));
    near.chain((0..100).map(|_| random.i128(first..=last))).collect()
}

/// Returns a raw value that is at most a step away from a physical value.
fn nearest_raw(signal: &Signal, value: Rational) -> Option<i128> {
    let linear = signal.encoding.linear()?;
    let steps = value.minus(linear.offset)?.over(linear.scale)?;
    linear.numeral.raw(steps.numerator() / steps.denominator())
}

#[test]
fn a_raw_value_is_legal_if_its_exact_physical_value_lies_within_the_limits() {
    let mut verdicts = Verdicts::default();
    visit_in_steps(&mut verdicts);
    assert!(verdicts.legal > 1000 && verdicts.refused > 1000, "{} and {}", verdicts.legal, verdicts.refused);
}

#[test]
fn the_same_raw_values_are_legal_in_doubles() {
    visit(&mut Verdicts::default());
}

/// Returns the bytes of a request, or what people read.
fn told(bytes: Result<[u8; 8], Error>) -> Result<[u8; 8], String> {
    bytes.map_err(|error| error.to_string())
}

/// Sets the output in volts and amperes.
fn in_doubles(millivolts: u32, milliamperes: u32, model: Option<infy::Model>) -> Result<[u8; 8], String> {
    let [voltage_v, current_a] = [millivolts, milliamperes].map(|thousandths| f64::from(thousandths) / 1000.0);
    let (output, target) = (infy::SetModuleOutput { voltage_v, current_a }, infy::Target::Module(3));
    let request = match model {
        None => output.set(target),
        Some(model) => output.within(model).and_then(|output| output.set(target)),
    };
    told(request.map(|request| request.frame().bytes()))
}

/// Sets the same output in whole steps.
fn in_steps(voltage_mv: u32, current_ma: u32, model: Option<steps::Model>) -> Result<[u8; 8], String> {
    let (output, target) = (steps::SetModuleOutput { voltage_mv, current_ma }, steps::Target::Module(3));
    let request = match model {
        None => output.set(target),
        Some(model) => output.within(model).and_then(|output| output.set(target)),
    };
    told(request.map(|request| request.frame().bytes()))
}

#[test]
fn set_points_give_the_same_frames_and_the_same_refusals() {
    // Limits that the document prints in 3.3, in thousandths.
    let (volts, amperes) = ([50, 100, 550, 750], [100, 120, 130, 200, 15_000, 20_000, 25_700, 50_000]);
    let models = infy::Model::ALL.map(Some).into_iter().zip(steps::Model::ALL.map(Some)).chain([(None, None)]);
    for (double, step) in models {
        for millivolts in volts.into_iter().flat_map(|volts| volts * 1000 - 1..=volts * 1000 + 1) {
            for milliamperes in amperes.into_iter().flat_map(|limit| limit - 1..=limit + 1) {
                let sent = in_steps(millivolts, milliamperes, step);
                assert_eq!(sent, in_doubles(millivolts, milliamperes, double), "{millivolts} mV, {milliamperes} mA");
            }
        }
    }
    assert_eq!(in_steps(500_000, 10_000, None), Ok([0x00, 0x07, 0xA1, 0x20, 0x00, 0x00, 0x27, 0x10]));
    let refusal = "`voltage` of `set_module_output` is 750.001 V, but its limits are 50 and 750 V";
    assert_eq!(in_steps(750_001, 10_000, None), Err(refusal.to_owned()));
}

#[test]
fn readings_and_limits_are_physical_values() {
    let frame = canspec_runtime::Frame::new_raw(0x029C_03F0, true, [0, 7, 0xA1, 0x20, 0, 0, 0x3A, 0x98], 8);
    let received = steps::Message::decode(&frame).expect("a request of the document");
    let mut shown = Vec::new();
    received.visit(|reading| shown.push(reading.to_string()));
    assert_eq!(shown, ["voltage 500 V", "current 15 A"]);
    let signal: &dyn canspec_runtime::AnySignal = &steps::SetModuleOutput::CURRENT;
    let limits = signal.limits().map(|(minimum, maximum)| [minimum, maximum].map(canspec_runtime::Number::to_f64));
    assert_eq!(limits, Some([0.1, 50.0]));
    assert_eq!(steps::SetModuleOutput::CURRENT.documented_limits(), Some((100, 50_000)));
}
