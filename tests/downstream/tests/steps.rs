//! The same devices in whole steps: every number is an integer, and people still read the unit.

use winch_in_steps::fan::{self, AnySignal, Frame, Model, Power, SetSpeed, Target};
use winch_in_steps::infy::{ModuleLimits, SetModuleOutput};
use winch_in_steps::{infy, meter, winch};

/// -1501 halves of a rotation a minute, and 25 times 2 s after 8 s.
const SLOWLY: SetSpeed = SetSpeed { speed_raw: -1501, delay_raw: 25, power: Power::Off };

#[test]
fn a_voltage_in_thousandths_of_a_volt_is_in_millivolts() {
    let output = SetModuleOutput { voltage_mv: 500_000, current_ma: 15_000 };
    let request = output.set(infy::Target::Module(3)).expect("it is within the limits");
    assert_eq!(request.frame().to_string(), "029C03F0#0007A12000003A98");
    let too_high = SetModuleOutput { voltage_mv: 750_001, ..output }.set(infy::Target::Module(3));
    assert_eq!(
        too_high.expect_err("it is above the limits").to_string(),
        "`voltage` of `set_module_output` is 750.001 V, but its limits are 50 and 750 V"
    );
}

#[test]
fn integers_stand_in_the_frame_as_they_are() {
    let sent = *SLOWLY.set(Target::Fan(1)).expect("it is within the limits").frame();
    assert_eq!(sent, Frame::new_raw(0x0191_01E1, true, [1, 0x23, 0xFA, 25, 1, 0, 0, 0], 5));
    let received = fan::Message::decode(&sent).expect("it is a request");
    assert_eq!(received.request(), Some(&fan::Message::SetSpeed(SLOWLY)));
}

#[test]
fn a_step_beyond_a_limit_is_refused() {
    let speed = |speed_raw| SetSpeed { speed_raw, ..SLOWLY }.set(Target::Fan(1)).is_ok();
    assert_eq!([-3002, -3001, 3001, 3002].map(speed), [false, true, true, false]);
    let delay = |delay_raw| SetSpeed { delay_raw, ..SLOWLY }.set(Target::Fan(1)).is_ok();
    // 10 s is raw 1, 200 s is raw 96, and raw 0 is special.
    assert_eq!([0, 1, 96, 97].map(delay), [true, true, true, false]);
    assert_eq!(SetSpeed::DELAY_NEVER, 0);
    assert_eq!([0, 1].map(|raw: u8| SetSpeed::DELAY.special_of(raw)), [Some("never"), None]);
}

#[test]
fn a_step_beyond_the_limit_of_a_model_is_refused() {
    let speed = |model, speed_raw| SetSpeed { speed_raw, ..SLOWLY }.within(model).is_ok();
    assert_eq!([-1802, -1801, 1801, 1802].map(|raw| speed(Model::F200, raw)), [false, true, true, false]);
    assert_eq!([-1802, 1802].map(|raw| speed(Model::F400, raw)), [true; 2]);
    let error = SetSpeed { speed_raw: 1802, ..SLOWLY }.within(Model::F200).expect_err("it is too fast");
    assert_eq!(error.to_string(), "`speed` of `set_speed` is 901 rpm, but its limits are -900.5 and 900.5 rpm");
}

#[test]
fn readings_and_limits_are_in_the_unit() {
    let frame = Frame::new_raw(0x0192_E101, true, [1, 0x6E, 0, 0, 0x42, 0x48, 0, 0], 8);
    let received = fan::Message::decode(&frame).expect("it is printed");
    let mut shown = Vec::new();
    received.visit(|reading| shown.push(reading.to_string()));
    assert_eq!(shown, ["temperature 15 °C", "humidity 50 %"]);
    let Some(Ok(fan::Message::Air(air))) = received.reply() else { panic!("{received:?} is no reply") };
    assert_eq!((air.temperature_raw, air.humidity_percent), (110, 50.0));
    let limits = AnySignal::limits(&SetSpeed::SPEED).map(|(least, most)| (least.to_f64(), most.to_f64()));
    assert_eq!(limits, Some((-1500.5, 1500.5)));
    assert_eq!(SetSpeed::SPEED.documented_limits(), Some((-3001, 3001)));
}

#[test]
fn a_name_ends_in_a_unit_if_the_step_is_one() {
    // 750 V, 100 V, 256 tenths of an ampere, 1500 tens of watts.
    let printed = Frame::new_raw(0x028A_F000, true, [0x02, 0xEE, 0x00, 0x64, 0x01, 0x00, 0x05, 0xDC], 8);
    let limits = ModuleLimits {
        maximum_voltage_v: 750,
        minimum_voltage_v: 100,
        maximum_current_raw: 256,
        rated_power_raw: 1500,
    };
    let received = infy::Message::decode(&printed).expect("it is printed");
    assert_eq!(received.reply(), Some(Ok(&infy::Message::ModuleLimits(limits))));
    // 1234 hundredths of a metre, and 65 steps of 1 °C from -40 °C.
    let printed = Frame::new_raw(0x0B21_0112, true, [0x04, 0xD2, 0x41, 0x81, 0, 0, 0, 0], 4);
    let status = winch::Status { rope_raw: 1234, temperature_raw: 65, state: winch::State(0x81) };
    let received = winch::Message::decode(&printed).expect("it is printed");
    assert_eq!(received.reply(), Some(Ok(&winch::Message::Status(status))));
    // 230,000 thousandths of a volt.
    let printed = Frame::new_raw(0x547, false, [0x81, 0x01, 0, 0x03, 0x82, 0x70, 0, 0], 6);
    let received = meter::Message::decode(&printed).expect("it is printed");
    assert_eq!(received.reply(), Some(Ok(&meter::Message::Voltage(meter::Voltage { value_mv: 230_000 }))));
}
