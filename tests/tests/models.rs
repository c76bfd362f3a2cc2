//! Device models in the generated code: limits, layouts and messages of their own.

use canspec_protocols::{gcp, infy, megmeet, trio};
use canspec_runtime::{Addressed, Frame, Quantities, Quantity};
use canspec_tests::{
    features_model_layouts as layouts, features_model_limits as limits, features_product_limits as product,
    features_revisions as revisions, features_scales_by_model as scales, features_values_by_model as values,
};

/// The limits that the INFY document prints for its models in 3.3: voltage and current.
const PRINTED: [(infy::Model, [f64; 2], [f64; 2]); 8] = [
    (infy::Model::Reg85750, [100.0, 750.0], [0.1, 15.0]),
    (infy::Model::Reg85500, [100.0, 550.0], [0.12, 20.0]),
    (infy::Model::Reg75020, [100.0, 750.0], [0.13, 16.7]),
    (infy::Model::Reg50025, [100.0, 550.0], [0.2, 23.0]),
    (infy::Model::Reg75030, [100.0, 750.0], [0.2, 25.7]),
    (infy::Model::Reg50040, [100.0, 550.0], [0.3, 35.0]),
    (infy::Model::Reg75035, [50.0, 750.0], [0.26, 33.0]),
    (infy::Model::Reg50050, [50.0, 550.0], [0.4, 50.0]),
];

#[test]
fn each_model_takes_what_lies_within_its_printed_limits_and_no_milliampere_more() {
    assert_eq!(PRINTED.map(|(model, ..)| model), infy::Model::ALL);
    for (model, [lowest_v, highest_v], [lowest_a, highest_a]) in PRINTED {
        let takes = |voltage_v, current_a| infy::SetModuleOutput { voltage_v, current_a }.within(model).is_ok();
        let name = model.name();
        assert!(takes(lowest_v, lowest_a) && takes(highest_v, highest_a), "{name}");
        assert!(!takes(lowest_v - 0.001, highest_a) && !takes(highest_v + 0.001, lowest_a), "{name}");
        assert!(!takes(lowest_v, lowest_a - 0.001) && !takes(lowest_v, highest_a + 0.001), "{name}");
    }
}

#[test]
fn a_refusal_names_the_limits_of_the_model() {
    let output = infy::SetModuleOutput { voltage_v: 500.0, current_a: 25.8 };
    let error = output.within(infy::Model::Reg75030).expect_err("a refusal");
    assert_eq!(error.to_string(), "`current` of `set_module_output` is 25.8 A, but its limits are 0.2 and 25.7 A");
    let request = output.within(infy::Model::Reg50040).and_then(|output| output.set(infy::Target::Module(3)));
    assert_eq!(
        request.map(|request| *request.frame()),
        output.set(infy::Target::Module(3)).map(|known| *known.frame())
    );
}

#[test]
fn without_a_model_a_request_keeps_to_the_hull_of_the_printed_limits() {
    let takes =
        |voltage_v, current_a| infy::SetModuleOutput { voltage_v, current_a }.set(infy::Target::Module(3)).is_ok();
    assert!(takes(50.0, 0.1) && takes(750.0, 50.0));
    assert!(!takes(49.999, 1.0) && !takes(750.001, 1.0) && !takes(4_000_000.0, 15.0));
    assert!(!takes(500.0, 0.099) && !takes(500.0, 50.001));
    let received =
        infy::Message::decode(&Frame::new_raw(0x029C_03F0, true, [0xEE, 0x6B, 0x28, 0, 0, 0, 0x3A, 0x98], 8));
    let received = received.expect("decoding knows no limits");
    let text = received.encode().expect_err("4,000,000 V").to_string();
    assert_eq!(text, "`voltage` of `set_module_output` is 4000000 V, but its limits are 50 and 750 V");
}

#[test]
fn a_model_without_limits_is_not_held_to_those_of_the_others() {
    // The document prints limits for modules of 48 V alone: 41.5 to 58.5 V in 2.2.2.
    let set = |value_v| megmeet::OutputVoltageSetting { value_v };
    let target = megmeet::Target::Module(1);
    assert!(set(41.5).set(target).is_ok() && set(58.5).set(target).is_ok());
    assert!(set(27.0).set(target).is_err() && set(80.0).set(target).is_err());
    let of = |model, value_v| set(value_v).within(model).and_then(|output| output.set(target));
    assert!(of(megmeet::Model::V48, 27.0).is_err() && of(megmeet::Model::V72, 80.0).is_ok());
    // 27 V = 27648 / 1024, and 27648 = 0x6C00.
    let request = of(megmeet::Model::V24, 27.0).expect("24 V modules have no printed limits");
    assert_eq!(request.frame().bytes(), [0x01, 0x00, 0, 0, 0, 0, 0x6C, 0x00]);
}

#[test]
fn a_limit_of_the_product_narrows_what_every_model_takes_and_every_request_that_sets_it() {
    use product::{Model, SetOutput, SetTotal, Target};

    let output = |voltage_v| SetOutput { voltage_v, current_a: 10.0 };
    let target = Target::Unit(1);
    // The limit of 45.25 V lies between two steps: 45.25 V would go out as 45.3 V.
    for (voltage_v, is_taken) in [(14.9, false), (15.0, true), (45.2, true), (45.25, false), (45.3, false)] {
        assert_eq!(output(voltage_v).set(target).is_ok(), is_taken, "{voltage_v}");
        for model in Model::ALL {
            let is_taken = is_taken && (model != Model::Large || voltage_v >= 20.0);
            assert_eq!(output(voltage_v).within(model).is_ok(), is_taken, "{voltage_v} {}", model.name());
        }
    }
    let refused = output(60.0).set(target).expect_err("more than the fuse bears").to_string();
    assert_eq!(refused, "`voltage` of `set_output` is 60 V, but its limits are 15 and 45.25 V");
    let total = |voltage_v, current_a| SetTotal { voltage_v, current_a, step_v: [0, 45] }.set(target).is_ok();
    assert_eq!([total(45.0, 60.0), total(45.3, 60.0), total(45.0, 60.5)], [true, false, false]);
    let steps = |step_v| SetTotal { voltage_v: 45.0, current_a: 60.0, step_v }.set(target).is_ok();
    assert_eq!([[15, 45], [45, 46], [14, 45], [0, 45]].map(steps), [true, false, false, true]);
    let current = |current_a| SetOutput { voltage_v: 40.0, current_a }.set(target).is_ok();
    assert_eq!([0.0, 20.0, 20.1].map(current), [true, true, false]);
    let limits = |model| SetOutput::VOLTAGE.limits_for(model);
    assert_eq!(Model::ALL.map(limits), [Some((15.0, 45.25)), Some((20.0, 45.25)), Some((15.0, 45.25))]);
}

#[test]
fn a_quantity_with_a_limit_of_the_product_is_set_within_it_alone() {
    let target = <product::Message as Addressed>::module(1).expect("unit 1");
    let values = |volts| [(Quantity::OUTPUT_VOLTAGE, volts), (Quantity::OUTPUT_CURRENT, 10_000)];
    let set = |volts| product::Message::set(&values(volts), target).is_ok();
    assert_eq!([14_900, 15_000, 45_200, 45_300].map(set), [false, true, true, false]);
    let within = |volts| product::Message::set_within(product::Model::Large, &values(volts), target).is_ok();
    assert_eq!([15_000, 20_000, 45_200, 45_300].map(within), [false, true, true, false]);
}

#[test]
fn a_reply_beyond_a_limit_of_the_product_is_read_and_made() {
    // 60 V are 600 = 0x258, and 30 A are 41F00000.
    let frame = Frame::new_raw(0x411, false, [0x02, 0x58, 0, 0, 0x41, 0xF0, 0, 0], 8);
    let received = product::Message::decode(&frame).expect("a reply");
    let output = product::SetOutput { voltage_v: 60.0, current_a: 30.0 };
    assert_eq!(received.content(), &product::Message::SetOutput(output));
    assert_eq!(received.encode(), Ok(frame));
}

#[test]
fn limits_can_be_asked_for() {
    let speed = limits::SetSpeed::SPEED;
    assert_eq!(speed.limits_for(limits::Model::P10a), Some((300, 3000)));
    assert_eq!(speed.limits_for(limits::Model::P20a), Some((0, 6000)));
    assert_eq!(limits::SetSpeed::FLOW.limits_for(limits::Model::P20a), None);
    // Only P10a and P48vDc have the message.
    assert_eq!(speed.documented_limits(), Some((0, 3000)));
    assert_eq!(limits::SetSpeed::FLOW.documented_limits(), Some((-30.0, 30.5)));
}

#[test]
fn a_message_that_a_model_does_not_have_is_refused() {
    let speed = limits::SetSpeed { speed_rpm: 1000, flow_percent: 0.0 };
    assert!(speed.within(limits::Model::P48vDc).is_ok());
    let error = speed.within(limits::Model::P20a).expect_err("a refusal");
    assert_eq!(error.to_string(), "the device model has no `set_speed`");
}

#[test]
fn a_frame_is_decoded_by_the_layout_of_its_model() {
    let frame = Frame::new_raw(3, false, [0x12, 0xC0, 0, 0, 0, 0, 0, 0], 2);
    let said = |received: layouts::Received| *received.report().expect("a report");
    let ac = layouts::Message::SupplyAc(layouts::SupplyAc { voltage_v: 480.0 });
    let dc = layouts::Message::SupplyDc(layouts::SupplyDc { voltage_v: 48.0 });
    assert_eq!(layouts::Message::decode(&frame).map(said), Ok(ac));
    assert_eq!(layouts::Message::decode_for(layouts::Model::P10a, &frame).map(said), Ok(ac));
    assert_eq!(layouts::Message::decode_for(layouts::Model::P48vDc, &frame).map(said), Ok(dc));
}

#[test]
fn a_number_is_read_and_set_by_the_scale_of_the_model() {
    use scales::{Model, SetOutput};
    // 440 / 20, 440 / 1250, and 22 x 30.
    let mut set = SetOutput { current_raw: 440, temperature_raw: 0 };
    assert_eq!([Model::R4850X20, Model::R4830].map(|model| set.current(model)), [Some(22.0), Some(0.352)]);
    assert_eq!(set.set_current(Model::R4850X30, 22.0), Ok(()));
    assert_eq!(set, SetOutput { current_raw: 660, temperature_raw: 0 });
    let error = set.set_current(Model::R4850X20, 50.05).expect_err("more than the model can give");
    assert_eq!(error.to_string(), "`current` of `set_output` is 50.05 A, but its limits are 0 and 50 A");
    assert_eq!(set, SetOutput { current_raw: 660, temperature_raw: 0 });
    let unlimited = SetOutput { current_raw: 0xFFFF, temperature_raw: 0 };
    assert_eq!(unlimited.current(Model::R4850X20), None, "unlimited is no number");
}

#[test]
fn models_without_a_scale_of_their_own_have_that_of_the_type() {
    // 50 / 2, and 50 / 2 - 40.
    let set = scales::SetOutput { current_raw: 0, temperature_raw: 50 };
    assert_eq!(scales::Model::ALL.map(|model| set.temperature(model)), [Some(25.0), Some(25.0), Some(-15.0)]);
}

#[test]
fn raw_limits_are_those_of_the_model_or_the_widest() {
    use scales::{Model, SetOutput, Target};
    // 50 A x 20, and 53.5 A x 30.
    let output = |current_raw| SetOutput { current_raw, temperature_raw: 0 };
    let takes = |current_raw, model| output(current_raw).within(model).is_ok();
    assert!(takes(1000, Model::R4850X20) && !takes(1001, Model::R4850X20) && takes(1605, Model::R4850X30));
    let sends = |current_raw| output(current_raw).set(Target::Rectifier).is_ok();
    assert!(sends(1605) && !sends(1606) && sends(0xFFFF));
}

#[test]
fn without_a_model_such_a_number_has_no_meaning() {
    let received = scales::Message::decode(&Frame::new_raw(0x004, false, [0x01, 0xB8, 0x32, 0, 0, 0, 0, 0], 4));
    let mut shown = Vec::new();
    received.expect("it is a request").visit(|reading| shown.push(reading.to_string()));
    assert_eq!(shown, ["current ?", "temperature ?"]);
}

#[test]
fn a_model_refuses_fields_and_bits_that_it_does_not_have() {
    use revisions::{Model, SetLimits, SetLimitsAlarms as Alarms, Target};
    let takes = |heating, alarms, model| SetLimits { current_a: 50, heating, alarms }.within(model).is_ok();
    assert!(takes(0, Alarms::HOT, Model::V1_2) && takes(100, Alarms::COLD, Model::V1_3));
    assert!(!takes(100, Alarms::HOT, Model::V1_2) && !takes(0, Alarms::COLD, Model::V1_2));
    assert!(!takes(0, Alarms::HOT, Model::V1_3), "its least value is 10");
    let set = SetLimits { current_a: 50, heating: 100, alarms: Alarms::COLD };
    let frame = set.set(Target::Battery).map(|request| request.frame().to_string());
    assert_eq!(frame.as_deref(), Ok("004#32640200"), "without a model everything counts");
    let error = set.within(Model::V1_2).expect_err("a field too much");
    assert_eq!(error.to_string(), "`heating` of `set_limits` has no such value");
}

#[test]
fn a_model_refuses_named_values_that_it_does_not_have() {
    use values::{Model, SetMode, SetModeMode as Mode, Target};
    let takes = |mode, delay_s, model| SetMode { mode, delay_s }.within(model).is_ok();
    assert!(takes(Mode::Idle, SetMode::DELAY_NEVER, Model::V1_2) && takes(Mode::Boost, 5, Model::V1_3));
    assert!(!takes(Mode::Boost, 5, Model::V1_2) && !takes(Mode::Idle, SetMode::DELAY_AT_ONCE, Model::V1_2));
    assert!(!takes(Mode::Idle, 101, Model::V1_2), "its limits count all the same");
    assert!(takes(Mode::Unknown(7), 100, Model::V1_2), "a value without a name is sent as it is");
    let set = SetMode { mode: Mode::Boost, delay_s: SetMode::DELAY_AT_ONCE };
    let frame = set.set(Target::Battery).map(|request| request.frame().to_string());
    assert_eq!(frame.as_deref(), Ok("006#02FE0000"), "without a model everything counts");
    let error = set.within(Model::V1_2).expect_err("a value too much");
    assert_eq!(error.to_string(), "`mode` of `set_mode` has no such value");
}

#[test]
fn a_program_learns_what_the_document_says_of_bus_and_models() {
    assert_eq!((infy::BIT_RATES, trio::BIT_RATES), (&[125_000][..], &[250_000][..]));
    assert_eq!(infy::DOCUMENTS.iter().map(|document| document.version).collect::<Vec<_>>(), ["V1.08"]);
    // Section 2.1 of GCP: only the module with a DC input takes 500 kbit/s, too.
    let speeds = [gcp::Model::PsM2_3ac1000dc30kw, gcp::Model::PsM2_825dc1000dc30kw].map(gcp::Model::bit_rates);
    assert_eq!(speeds, [&[125_000][..], &[125_000, 500_000][..]]);
}
