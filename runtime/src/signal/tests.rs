use std::string::ToString;

use super::*;
use crate::{Bcd, Meaning, Text};

const CURRENT: Signal<i16, f64> = Signal::new("current", Place::bytes(7, 0).bits(23, 12)).unit("A").scale(1, 10);
const TEMPERATURE: Signal<u8, f64> = Signal::new("temperature", Place::byte(3))
    .unit("°C")
    .scale(1, 2)
    .offset(-40, 1)
    .limits(-40.0, 80.0)
    .specials(&[(255, "broken")]);
const FREQUENCY: Signal<f32, f64> = Signal::new("frequency", Place::bytes(4, 7)).unit("Hz").limits(45.0, 25.7 + 40.0);
const GROUP: Signal<u8> = Signal::new("group", Place::byte(0).bits(5, 0)).limits(1, 62);
const LIMIT: Signal<u8, f64> =
    Signal::new("limit", Place::byte(0)).unit("A").scale(1, 10).limits(0.04, 20.06).specials(&[(0, "unlimited")]);

fn reply() -> Payload {
    Payload::new("report", [0; 8])
}

fn request() -> Payload {
    Payload::within_limits("report", [0; 8])
}

fn refusal(result: Result<(), Error>) -> std::string::String {
    result.expect_err("a refusal").to_string()
}

#[test]
fn a_signed_signal_of_twelve_bits_keeps_its_sign_and_its_neighbours() {
    let mut payload = Payload::new("report", [0x73, 0x0A, 0x00, 0x6E, 0, 0, 0, 0]);
    assert_eq!(CURRENT.encode(23.4, &mut payload), Ok(()));
    assert_eq!(payload.data(), &[0x73, 0xAA, 0x0E, 0x6E, 0, 0, 0, 0]);
    assert_eq!(CURRENT.encode(-0.25, &mut payload), Ok(()));
    assert_eq!((CURRENT.get(payload.data()), CURRENT.decode(payload.data())), (-3, -0.3));
    assert_eq!(payload.data(), &[0x73, 0xDA, 0xFF, 0x6E, 0, 0, 0, 0]);
}

#[test]
fn what_the_bits_cannot_hold_is_refused_and_changes_nothing() {
    let mut payload = reply();
    let text = refusal(CURRENT.encode(204.75, &mut payload));
    assert_eq!(text, "`current` of `report` is 204.75 A, but its limits are -204.8 and 204.7 A");
    assert!(CURRENT.put(2048, &mut payload).is_err());
    assert!(CURRENT.put(-2049, &mut payload).is_err());
    assert!(TEMPERATURE.encode(-40.25, &mut payload).is_err());
    assert_eq!(payload, reply());
    assert_eq!(CURRENT.put(-2048, &mut payload), Ok(()));
    assert_eq!(TEMPERATURE.encode(-40.24, &mut payload), Ok(()));
}

#[test]
fn all_ones_or_the_greatest_signed_number_say_that_there_is_no_value() {
    const CHARGE: Signal<u8> = Signal::new("charge", Place::byte(0)).absent();
    const HEAT: Signal<i16, f64> = Signal::new("heat", Place::bytes(1, 2)).scale(1, 10).absent();
    let read = |data| (CHARGE.get_some(&data, 8), HEAT.decode_some(&data, 8));
    assert_eq!(read([0xFF, 0x7F, 0xFF, 0, 0, 0, 0, 0]), (None, None));
    assert_eq!(read([0x7F, 0xFF, 0xFF, 0, 0, 0, 0, 0]), (Some(127), Some(-0.1)));
    let mut payload = reply();
    assert_eq!([CHARGE.put_some(None, &mut payload), HEAT.encode_some(None, &mut payload)], [Ok(()); 2]);
    assert_eq!(payload.data(), &[0xFF, 0x7F, 0xFF, 0, 0, 0, 0, 0]);
    assert_eq!([CHARGE.put_some(Some(1), &mut payload), HEAT.encode_some(Some(0.2), &mut payload)], [Ok(()); 2]);
    assert_eq!(payload.data(), &[1, 0, 2, 0, 0, 0, 0, 0]);
    let text = refusal(CHARGE.put_some(Some(255), &mut payload));
    assert_eq!(text, "`charge` of `report` is 255, which would be sent as `not_available`");
    let text = refusal(HEAT.encode_some(Some(3276.7), &mut payload));
    assert_eq!(text, "`heat` of `report` is 3276.7, which would be sent as `not_available`");
    assert_eq!(payload.data(), &[1, 0, 2, 0, 0, 0, 0, 0]);
}

#[test]
fn a_value_is_left_out_only_where_the_frame_ends_before_it() {
    const HOURS: Signal<u16> = Signal::new("hours", Place::bytes(2, 3));
    let read = |length| HOURS.get_some(&[0, 0, 1, 2, 0, 0, 0, 0], length);
    assert_eq!([2, 3, 4, 8].map(read), [None, None, Some(0x0102), Some(0x0102)]);
    let left_out = |length| {
        let mut payload = reply();
        payload.end_after(length);
        HOURS.put_some(None, &mut payload)
    };
    assert_eq!([2, 3].map(left_out), [Ok(()); 2]);
    let text = "`hours` of `report` is left out, but the frame is long enough for it";
    assert_eq!(refusal(left_out(4)), text);
    assert_eq!(refusal(HOURS.put_some(None, &mut reply())), text);
    assert!([4, 5].map(|length| reply().received_with(4).had(length)) == [true, false]);
}

#[test]
fn limits_count_in_requests_only() {
    assert_eq!(TEMPERATURE.encode(80.5, &mut reply()), Ok(()));
    let text = refusal(TEMPERATURE.encode(80.2, &mut request()));
    assert_eq!(text, "`temperature` of `report` is 80.2 °C, but its limits are -40 and 80 °C");
    let text = refusal(GROUP.put(0, &mut request()));
    assert_eq!(text, "`group` of `report` is 0, but its limits are 1 and 62");
    assert_eq!(GROUP.put(0, &mut reply()), Ok(()));
}

#[test]
fn limits_of_signed_numbers_are_signed() {
    const SLOPE: Signal<i16> = Signal::new("slope", Place::bytes(0, 1)).limits(-5, 5);
    let takes = |slope| SLOPE.put(slope, &mut request()).is_ok();
    assert_eq!([-6, -5, 0, 5, 6].map(takes), [false, true, true, true, false]);
    let text = refusal(SLOPE.put(-6, &mut request()));
    assert_eq!(text, "`slope` of `report` is -6, but its limits are -5 and 5");
}

#[test]
fn a_special_value_is_legal_outside_the_limits() {
    assert_eq!(TEMPERATURE.put(255, &mut request()), Ok(()));
    assert_eq!(TEMPERATURE.encode(87.5, &mut request()), Ok(()));
    assert!(TEMPERATURE.encode(87.4, &mut request()).is_err());
    let mut payload = request();
    assert_eq!(TEMPERATURE.write(Meaning::Name("broken"), &mut payload), Ok(()));
    TEMPERATURE.read(payload.data(), &mut |reading| assert_eq!(reading.meaning, Meaning::Name("broken")));
}

#[test]
fn a_special_value_is_told_from_numbers_by_its_name() {
    const STATE: Signal<i8> = Signal::new("state", Place::byte(0)).specials(&[(-128, "open"), (127, "short")]);
    const WHOLE: Signal<u16, f64> = Signal::new("whole", Place::bytes(0, 1)).specials(&[(0xFFFE, "out_of_range")]);
    const SINGLE: Signal<u16, f32> = WHOLE.on_model().scale(1, 200);
    const DATE: Signal<Bcd<u8>> = Signal::new("date", Place::byte(0)).specials(&[(0x99, "never")]);
    // 255 / 2 - 40
    assert_eq!(
        [87.5, 87.0, 87.499_999, f64::NAN].map(|value| TEMPERATURE.special_of(value)),
        [Some("broken"), None, None, None]
    );
    assert_eq!([255, 254].map(|raw: u8| TEMPERATURE.special_of(raw)), [Some("broken"), None]);
    assert_eq!([-128, 127, 0].map(|raw: i8| STATE.special_of(raw)), [Some("open"), Some("short"), None]);
    assert_eq!([65534.0, 327.67].map(|value: f64| WHOLE.special_of(value)), [Some("out_of_range"), None]);
    assert_eq!([327.67, 65534.0].map(|value: f32| SINGLE.special_of(value)), [Some("out_of_range"), None]);
    assert_eq!([0x99, 0x98].map(|bits| DATE.special_of(Bcd::<u8>::from_bits(bits))), [Some("never"), None]);
    assert_eq!(CURRENT.special_of(0.0), None);
}

#[test]
fn what_is_sent_for_a_value_between_two_steps_lies_inside_the_limits_too() {
    const SLOPE: Signal<u8, f64> = Signal::new("slope", Place::byte(0)).limits(0.5, 9.5);
    // 20.06 A would be raw 201.
    assert_eq!(LIMIT.encode(20.04, &mut request()), Ok(()));
    let text = refusal(LIMIT.encode(20.06, &mut request()));
    assert_eq!(text, "`limit` of `report` is 20.1 A, but its limits are 0.04 and 20.06 A");
    assert_eq!(LIMIT.encode(20.06, &mut reply()), Ok(()));
    let written = |value| SLOPE.write(Meaning::Number(Number::Float(value)), &mut request()).is_ok();
    assert_eq!([0.49, 0.5, 9.49, 9.5].map(written), [false, true, true, false]);
}

#[test]
fn a_limit_of_a_device_model_counts_for_what_is_sent_too() {
    const SIGNAL: Signal<u8, f64> = LIMIT.limits(0.0, 25.0).model_limits(&[(3, Some((0.04, 20.06)))]);
    // 20.06 A would be raw 201.
    let takes = |model, current| SIGNAL.encode(current, &mut request().for_model(model)).is_ok();
    assert_eq!([20.04, 20.06].map(|current| takes(Some(3), current)), [true, false]);
    assert_eq!([25.0, 25.04].map(|current| takes(None, current)), [true, false]);
}

#[test]
fn a_number_that_would_be_sent_as_a_special_value_is_refused() {
    const UNLIMITED: Signal<u8> = Signal::new("interval", Place::byte(1)).unit("s").specials(&[(0, "never")]);
    let text = refusal(LIMIT.encode(0.04, &mut request()));
    assert_eq!(text, "`limit` of `report` is 0.04 A, which would be sent as `unlimited`");
    assert_eq!(LIMIT.encode(0.0, &mut request()), Ok(()));
    assert_eq!(LIMIT.encode(0.05, &mut request()), Ok(()));
    assert_eq!(LIMIT.encode(0.04, &mut reply()), Ok(()));
    let written = |value| UNLIMITED.write(Meaning::Number(Number::Float(value)), &mut request());
    let text = refusal(written(0.4));
    assert_eq!(text, "`interval` of `report` is 0.4 s, which would be sent as `never`");
    assert_eq!([0.0, 0.5].map(written), [Ok(()), Ok(())]);
}

#[test]
fn a_float_meets_a_limit_as_precisely_as_it_can() {
    const UPPER: Signal<f32, f64> = FREQUENCY.limits(45.0, 65.3);
    assert_eq!(FREQUENCY.put(65.7, &mut request()), Ok(()));
    assert!(FREQUENCY.put(65.700_01, &mut request()).is_err());
    // The float nearest to 65.3 lies above it.
    assert_eq!(UPPER.put(65.3, &mut request()), Ok(()));
    assert!(UPPER.put(65.300_01, &mut request()).is_err());
    // The float nearest to 65.7 lies below it, and both are legal.
    let written = |value| FREQUENCY.write(Meaning::Number(Number::Float(value)), &mut request());
    assert_eq!(written(65.7), Ok(()));
    assert!(written(65.700_01).is_err());
}

/// The same signals as `LIMIT` and `TEMPERATURE`, in whole steps.
const STEPS: Signal<u8> =
    Signal::new("limit", Place::byte(0)).unit("A").scale(1, 10).limits(1, 200).specials(&[(0, "unlimited")]);
const HALVES: Signal<u8> =
    Signal::new("temperature", Place::byte(3)).unit("°C").scale(1, 2).offset(-40, 1).limits(0, 240);

#[test]
fn whole_steps_meet_limits_as_integers_and_are_told_in_the_unit() {
    const NARROW: Signal<i16> = Signal::new("slope", Place::bytes(0, 1).bits(11, 0)).unit("V").scale(1, 4);
    assert_eq!([0, 1, 200].map(|raw| STEPS.put(raw, &mut request())), [Ok(()); 3]);
    let text = refusal(STEPS.put(201, &mut request()));
    assert_eq!(text, "`limit` of `report` is 20.1 A, but its limits are 0.1 and 20 A");
    let text = refusal(HALVES.put(241, &mut request()));
    assert_eq!(text, "`temperature` of `report` is 80.5 °C, but its limits are -40 and 80 °C");
    let text = refusal(NARROW.put(2048, &mut reply()));
    assert_eq!(text, "`slope` of `report` is 512 V, but its limits are -512 and 511.75 V");
}

#[test]
fn limits_of_steps_that_count_down_are_told_from_the_lower_one_on() {
    const FALLING: Signal<u8> = Signal::new("depth", Place::byte(0)).unit("m").scale(-1, 2).limits(3, 10);
    assert_eq!([3, 10].map(|raw| FALLING.put(raw, &mut request())), [Ok(()); 2]);
    let text = refusal(FALLING.put(11, &mut request()));
    assert_eq!(text, "`depth` of `report` is -5.5 m, but its limits are -5 and -1.5 m");
    assert_eq!(AnySignal::limits(&FALLING).map(|(lower, upper)| (lower.to_f64(), upper.to_f64())), Some((-5.0, -1.5)));
    let text = refusal(FALLING.write(Meaning::Number(Number::Float(0.5)), &mut reply()));
    assert_eq!(text, "`depth` of `report` is 0.5 m, but its limits are -127.5 and 0 m");
}

#[test]
fn a_number_of_the_unit_is_written_as_the_nearest_step() {
    let sent = |value| {
        let mut payload = request();
        STEPS.write(Meaning::Number(Number::Float(value)), &mut payload).map(|()| payload.data()[0])
    };
    assert_eq!([19.96, 20.0, 0.14, 0.15].map(sent), [200, 200, 1, 2].map(Ok));
    assert_eq!(refusal(sent(20.04).map(drop)), "`limit` of `report` is 20.04 A, but its limits are 0.1 and 20 A");
    assert!(sent(0.0).is_ok() && sent(f64::NAN).is_err() && sent(0.04).is_err());
}

#[test]
fn steps_are_read_as_an_exact_fraction_and_come_back() {
    let data = [0, 0, 0, 111, 0, 0, 0, 0];
    HALVES.read(&data, &mut |reading| {
        // 111/2 - 40 = 31/2
        let fraction = Number::Fraction { numerator: 31, denominator: 2 };
        assert_eq!((reading.raw, reading.meaning), (Number::Unsigned(111), Meaning::Number(fraction)));
        assert_eq!((fraction.to_f64(), fraction.to_f32()), (15.5, 15.5));
        let mut payload = reply();
        assert_eq!(HALVES.write(reading.meaning, &mut payload), Ok(()));
        assert_eq!(payload.data(), &data);
    });
}

#[test]
fn a_float_without_doubles_tells_limits_as_precisely_as_it_has_them() {
    const SINGLE: Signal<f32> = Signal::new("frequency", Place::bytes(4, 7)).unit("Hz").limits(45.0, 65.7);
    assert_eq!(SINGLE.put(65.7, &mut request()), Ok(()));
    let text = refusal(SINGLE.put(65.8, &mut request()));
    assert_eq!(text, "`frequency` of `report` is 65.8 Hz, but its limits are 45 and 65.7 Hz");
}

#[test]
fn a_number_is_refused_where_a_text_is_meant() {
    const NAME: Signal<Text<2>> = Signal::new("name", Place::bytes(0, 1));
    let mut payload = reply();
    for number in [Number::Float(65.0), Number::Single(65.0), Number::Unsigned(65), Number::Signed(65)] {
        assert!(NAME.write(Meaning::Number(number), &mut payload).is_err());
    }
    assert_eq!(payload, reply());
    assert_eq!(NAME.write(Meaning::Text("A"), &mut payload), Ok(()));
    assert_eq!(payload.data(), &[b'A', 0, 0, 0, 0, 0, 0, 0]);
}

#[test]
fn a_device_model_can_have_limits_of_its_own() {
    const SPEED: Signal<u16> =
        Signal::new("speed", Place::bytes(0, 1)).limits(0, 6000).model_limits(&[(3, Some((300, 3000))), (4, None)]);
    let takes = |model, speed| SPEED.put(speed, &mut request().for_model(model)).is_ok();
    assert_eq!([299, 300, 3000, 3001].map(|speed| takes(Some(3), speed)), [false, true, true, false]);
    assert!(takes(Some(4), 6001) && takes(Some(4), u16::MAX));
    assert_eq!([0, 6000, 6001].map(|speed| takes(Some(1), speed)), [true, true, false]);
    assert_eq!([0, 6000, 6001].map(|speed| takes(None, speed)), [true, true, false]);
}

#[test]
fn a_value_that_depends_on_the_device_model_has_no_meaning_without_one() {
    const SHARE: Signal<u16> = Signal::new("share", Place::bytes(0, 1)).by_model().specials(&[(0xFFFF, "all")]);
    let mut shown = None;
    SHARE.read(&[0x01, 0xF4, 0, 0, 0, 0, 0, 0], &mut |reading| {
        shown = Some((reading.raw, reading.meaning == Meaning::None));
    });
    assert_eq!(shown, Some((Number::Unsigned(500), true)));
    let mut payload = request();
    assert!(SHARE.write(Meaning::Number(Number::Unsigned(500)), &mut payload).is_err());
    assert_eq!(payload, request());
    assert_eq!(SHARE.write(Meaning::Name("all"), &mut payload), Ok(()));
    assert_eq!(payload.data(), &[0xFF, 0xFF, 0, 0, 0, 0, 0, 0]);
}

#[test]
fn what_is_not_finite_is_refused_in_requests() {
    assert_eq!(refusal(FREQUENCY.put(f32::NAN, &mut request())), "`frequency` of `report` is no finite number");
    assert_eq!(FREQUENCY.put(f32::INFINITY, &mut reply()), Ok(()));
    assert_eq!(refusal(CURRENT.encode(f64::NAN, &mut reply())), "`current` of `report` is no finite number");
    assert!(CURRENT.encode(f64::INFINITY, &mut reply()).is_err());
}

#[test]
fn a_float_keeps_the_bits_of_a_nan() {
    let data = [0, 0, 0, 0, 0x7F, 0xC0, 0x12, 0x34];
    FREQUENCY.read(&data, &mut |reading| {
        assert_eq!((reading.raw, reading.meaning), (Number::Unsigned(0x7FC0_1234), Meaning::None));
        assert!(!reading.is_of_error_reply);
    });
    let mut payload = reply();
    assert_eq!(FREQUENCY.put(FREQUENCY.get(&data), &mut payload), Ok(()));
    assert_eq!(payload.data(), &data);
}

#[test]
fn limits_of_64_bits_are_exact() {
    const COUNTER: Signal<u64> = Signal::new("counter", Place::bytes(0, 7)).limits(1, LIMIT);
    // 2^53 + 3 is no double; the nearest one is 2^53 + 4.
    const LIMIT: u64 = (1 << 53) + 3;
    assert_eq!([1, LIMIT].map(|count| COUNTER.put(count, &mut request())), [Ok(()), Ok(())]);
    assert!(COUNTER.put(LIMIT + 1, &mut request()).is_err());
    let written = |number| COUNTER.write(Meaning::Number(number), &mut request()).is_ok();
    assert_eq!([Number::Unsigned(LIMIT), Number::Unsigned(LIMIT + 1)].map(written), [true, false]);
    assert_eq!([9_007_199_254_740_994.0, 9_007_199_254_740_996.0].map(Number::Float).map(written), [true, false]);
}

#[test]
fn every_number_of_64_bits_is_exact() {
    const COUNTER: Signal<u64> = Signal::new("counter", Place::bytes(0, 7));
    let mut payload = reply();
    assert_eq!(COUNTER.put(u64::MAX, &mut payload), Ok(()));
    assert_eq!(COUNTER.get(payload.data()), u64::MAX);
    let written = |number| COUNTER.write(Meaning::Number(number), &mut payload.clone()).is_ok();
    assert_eq!([Number::Float(-1.0), Number::Signed(-1)].map(written), [false; 2]);
}

#[test]
fn what_a_device_model_lacks_is_blank_and_hidden_and_left_out() {
    const HEAT: Signal<i16> = Signal::new("heat", Place::bytes(0, 1))
        .lacking(&[(3, Lack::Value(5)), (4, Lack::Signal(0xFFFF, 0xFF00))])
        .absent();
    let hidden = |model, bits: u16| {
        let [high, low] = bits.to_be_bytes();
        HEAT.is_hidden(&[high, low, 0, 0, 0, 0, 0, 0], model)
    };
    assert_eq!([None, Some(3), Some(4)].map(|model| hidden(model, 0xFF00)), [false, false, true]);
    assert_eq!([0xFF01, 0x0000].map(|bits| hidden(Some(4), bits)), [false; 2]);
    let left_out = |model| {
        let mut payload = request().for_model(model);
        HEAT.put_some(None, &mut payload).map(|()| u16::from_be_bytes([payload.data()[0], payload.data()[1]]))
    };
    assert_eq!([None, Some(3), Some(4)].map(left_out), [Ok(0x7FFF), Ok(0x7FFF), Ok(0xFF00)]);
    assert_eq!([-256, 0].map(|heat| HEAT.put(heat, &mut request().for_model(Some(4))).is_ok()), [true, false]);
}

#[test]
fn only_a_new_request_to_a_model_with_the_signal_or_a_frame_of_one_without_it_reaches_it() {
    const HEAT: Signal<u8> = Signal::new("heat", Place::byte(2)).lacking(&[(4, Lack::Signal(0xFF, 0))]);
    let models = [None, Some(3), Some(4)];
    assert_eq!(models.map(|model| request().for_model(model).reaches(&HEAT, 3)), [false, true, false]);
    assert_eq!(models.map(|model| reply().for_model(model).reaches(&HEAT, 3)), [false; 3]);
    let received = |model, length| request().received_with(length).for_model(model).reaches(&HEAT, 3);
    assert_eq!(models.map(|model| received(model, 0)), [false; 3]);
    assert_eq!(models.map(|model| received(model, 2)), [false; 3]);
    assert_eq!(models.map(|model| received(model, 3)), [false, false, true]);
}
