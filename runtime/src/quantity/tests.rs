use std::string::ToString;

use super::path::Value;
use super::single;
use crate::plumbing::{Lack, States};
use crate::tests::heaters::{Heat, Message, To};
use crate::tests::random::Random;
use crate::{
    Error, Frame, Kind, OutOfRange, Payload, Place, Quantities, Quantity, ReadNumber, ReadPath, Received, SetNumber,
    SetPath, Signal,
};

const TENTHS: Signal<u16> = Signal::new("voltage", Place::bytes(0, 1)).unit("V").scale(1, 10).limits(100, 5000);
const HALVES: Signal<i8> = Signal::new("temperature", Place::byte(2)).unit("°C").scale(-1, 2).offset(-40, 1);
const BINARY: Signal<u16, f64> = Signal::new("power", Place::bytes(4, 5)).unit("W").scale(1, 1024);
const DELAY: Signal<u8> = Signal::new("delay", Place::byte(6)).unit("s").specials(&[(0, "never")]).absent();
const COUNT: Signal<u32> = Signal::new("count", Place::bytes(0, 3));

fn set(signal: &'static dyn SetNumber, value: i32) -> Result<u64, Error> {
    let mut payload = Payload::within_limits("set", [0; 8]);
    signal.set_number(value, &mut payload)?;
    Ok(u64::from_be_bytes(*payload.data()))
}

fn read(signal: &dyn ReadNumber, data: u64) -> Option<i32> {
    signal.read_number(&data.to_be_bytes())
}

#[test]
fn a_step_is_so_many_thousandths() {
    assert_eq!(read(&TENTHS, 0x1388_0000_0000_0000), Some(500_000));
    assert_eq!(set(&TENTHS, 500_000), Ok(0x1388_0000_0000_0000));
    // 100 steps of -0.5 from -40.
    assert_eq!(read(&HALVES, 0x64 << 40), Some(-90_000));
    assert_eq!(read(&HALVES, 0x9C << 40), Some(10_000));
    assert_eq!(set(&HALVES, 10_000), Ok(0x9C << 40));
    assert_eq!(read(&COUNT, 0x8000_0000_0000_0000), None, "no i32 holds it");
    assert_eq!(read(&COUNT, 0x7FFF_FFFF_0000_0000), Some(i32::MAX));
}

#[test]
fn what_no_step_meets_is_rounded_with_ties_away_from_zero() {
    // 64/1024 is 62.5 thousandths, and 1/1024 is 0.98.
    assert_eq!([1, 2, 64, 192].map(|raw| read(&BINARY, raw << 16)), [1, 2, 63, 188].map(Some));
    assert_eq!([1, 62, 63, 188].map(|value| set(&BINARY, value)), [1, 63, 65, 193].map(|raw| Ok(raw << 16)));
    // Half a step of -0.5 from -40.
    assert_eq!(set(&HALVES, -40_250), Ok(0x01 << 40));
    assert_eq!(set(&HALVES, -39_750), Ok(0xFF << 40));
    assert_eq!(set(&HALVES, -40_249), Ok(0));
}

#[test]
fn what_lies_beyond_a_limit_is_refused_by_its_own_value() {
    assert_eq!([10_000, 10_040, 499_960].map(|value| set(&TENTHS, value).is_ok()), [true; 3]);
    let refused = |value: i32| set(&TENTHS, value).expect_err("beyond a limit").to_string();
    assert_eq!(refused(500_040), "`voltage` of `set` is 500.04 V, but its limits are 10 and 500 V");
    assert_eq!(refused(9_999), "`voltage` of `set` is 9.999 V, but its limits are 10 and 500 V");
    assert_eq!(refused(-1), "`voltage` of `set` is -0.001 V, but its limits are 0 and 6553.5 V");
    assert_eq!([-103_500, -103_501].map(|value| set(&HALVES, value).is_ok()), [true, false]);
    assert_eq!([24_000, 24_001].map(|value| set(&HALVES, value).is_ok()), [true, false]);
}

#[test]
fn a_device_model_without_the_signal_has_no_number_of_it() {
    const HEAT: Signal<u8> = Signal::new("heat", Place::byte(0)).unit("W").lacking(&[(4, Lack::Signal(0xFF, 0))]);
    let read = |model, raw, length| {
        let frame = Frame::new_raw(0x7, true, [raw, 0, 0, 0, 0, 0, 0, 0], length);
        Value::<&dyn ReadNumber>::Number(&HEAT).read(&frame, model)
    };
    assert_eq!([None, Some(3), Some(4)].map(|model| read(model, 0, 1)), [Some(0), Some(0), None]);
    assert_eq!(read(Some(4), 2, 1), Some(2000), "bits show it");
    assert_eq!(read(None, 0, 0), None);
}

/// Whether a heater is on.
const ON: States = States { place: Place::byte(0), inactive: 0, active: 1 };

impl Quantities for Message {
    const READS: &'static [ReadPath] = &[
        ReadPath::number(Quantity::OUTPUT_POWER, Some("W"), &[(Kind::Reply, &Heat::SET)], &Heat::POWER),
        ReadPath::switch(Quantity::DELIVERING, &[(Kind::Reply, &Heat::ASK)], ON),
    ];
    const SETS: &'static [SetPath] =
        &[SetPath::number(Quantity::OUTPUT_POWER, Some("W"), &Heat::SET, &Heat::POWER).echoed().limiting().kept()];
}

#[test]
fn a_path_says_what_a_device_does_with_a_value() {
    let path = SetPath::number(Quantity::OUTPUT_POWER, Some("W"), &Heat::SET, &Heat::POWER);
    let conduct = [path, path.refusing(), path.ignoring(), path.limiting()].map(|path| path.out_of_range);
    assert_eq!(conduct, [None, Some(OutOfRange::Refused), Some(OutOfRange::Ignored), Some(OutOfRange::Limited)]);
    assert_eq!([path, path.kept(), path.lost()].map(|path| path.is_kept), [None, Some(true), Some(false)]);
    assert!(!path.is_echoed && path.echoed().is_echoed);
    // The power lies within 0 to 2000 W.
    let limited = [2_500_000, -1, 1_234_567, i32::MAX, i32::MIN].map(|value| path.limited(value, 1_000_000));
    assert_eq!(limited, [2_000_000, 0, 1_234_567, 2_000_000, 0]);
}

#[test]
fn a_request_and_its_reply_show_what_is_set() {
    let setting = |id, data: [u8; 4], quantity| {
        let [first, second, third, fourth] = data;
        let frame = Frame::new_raw(id, true, [first, second, third, fourth, 0, 0, 0, 0], 4);
        Received::<Message>::decode(&frame).expect("a frame of heaters").setting(quantity)
    };
    // 150 steps of 10 W.
    assert_eq!(setting(0x0107_03F0, [1, 0, 0, 150], Quantity::OUTPUT_POWER), Some(1_500_000));
    assert_eq!(setting(0x0107_F003, [2, 0xF0, 0, 150], Quantity::OUTPUT_POWER), Some(1_500_000));
    assert_eq!(setting(0x0107_F003, [2, 0xF0, 0, 150], Quantity::INPUT_POWER), None, "nothing sets it");
    assert_eq!(setting(0x0108_F05D, [2, 0xF0, 0, 150], Quantity::OUTPUT_POWER), None, "it is read");
    assert_eq!(setting(0x1D07_F003, [2, 0xF0, 0, 150], Quantity::OUTPUT_POWER), None, "it is an error reply");
    let data = 0x1388_0000_0000_0000_u64.to_be_bytes();
    assert_eq!([1, 2].map(|length| TENTHS.set_in(&data, length)), [None, Some(500_000)]);
}

#[test]
fn what_comes_in_reply_to_values_only_is_not_asked_for() {
    let refused =
        Message::read(&[Quantity::OUTPUT_POWER], To::Heater(3)).map(|_| ()).expect_err("a request has values");
    assert_eq!(refused, Error::NotAsked { message: "heat", quantity: "output_power" });
    assert_eq!(refused.to_string(), "a request of `heat` has values, so build it to read `output_power`");
}

#[test]
fn bits_that_mean_something_else_are_no_number() {
    assert_eq!([0, 1, 254, 255].map(|raw| read(&DELAY, raw << 8)), [None, Some(1000), Some(254_000), None]);
    assert_eq!([0, 1000, 254_000, 255_000].map(|value| set(&DELAY, value).is_ok()), [false, true, true, false]);
}

#[test]
#[expect(clippy::cast_possible_truncation, reason = "singles are compared with what doubles say")]
fn singles_are_counted_as_doubles_would_count_them() {
    let mut random = Random(0x51_4E61);
    for _ in 0..200_000 {
        let bits = u32::try_from(random.below(1 << 32)).expect("32 bits");
        let value = f32::from_bits(bits);
        // The product of 24 and 10 bits is exact in a double.
        let exact = f64::from(value) * 1000.0;
        let nearest = exact.abs().floor() + if exact.abs().fract() >= 0.5 { 1.0 } else { 0.0 };
        let expected = nearest.copysign(exact);
        let is_held = (f64::from(i32::MIN)..=f64::from(i32::MAX)).contains(&expected);
        assert_eq!(single::parts_of(value, 1000), is_held.then_some(expected as i32), "{value:e}");
        let count = bits.cast_signed();
        // A double nearest to a quotient by 1000 is never halfway between singles unless the quotient is.
        assert_eq!(single::of_parts(count, 1000).to_bits(), ((f64::from(count) / 1000.0) as f32).to_bits(), "{count}");
        assert_eq!(single::of_parts(count, 1).to_bits(), (f64::from(count) as f32).to_bits(), "{count}");
    }
}

#[test]
fn singles_at_the_edges_are_counted() {
    let cases = [
        (0.0, Some(0)),
        (-0.0, Some(0)),
        (0.000_5, Some(1)),
        (-0.000_5, Some(-1)),
        (0.000_499, Some(0)),
        (f32::MIN_POSITIVE, Some(0)),
        (f32::from_bits(1), Some(0)),
        (2_147_483.5, Some(2_147_483_500)),
        (2_147_483.8, None),
        (-2_147_483.8, None),
        (f32::MAX, None),
        (f32::INFINITY, None),
        (f32::NAN, None),
    ];
    for (value, expected) in cases {
        assert_eq!(single::parts_of(value, 1000), expected, "{value:e}");
    }
    for count in [0, 1, -1, 999, 1000, i32::MAX, i32::MIN] {
        #[expect(clippy::cast_possible_truncation, reason = "the nearest single is what is compared")]
        let expected = (f64::from(count) / 1000.0) as f32;
        assert_eq!(single::of_parts(count, 1000).to_bits(), expected.to_bits(), "{count}");
    }
}
