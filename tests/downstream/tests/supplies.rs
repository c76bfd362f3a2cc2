//! Limits of a product that is narrower than its devices.

use winch_driver::supply::{Model, Quantities, Quantity, SetOutput, SetTrim, SetTrimBatch, Target};

#[test]
fn no_model_takes_more_than_the_product() {
    let output = |voltage_v| SetOutput { voltage_v, current_a: 10.0, fuse_a: 10 };
    for (model, lowest) in [(Model::S50, 15.0), (Model::S80, 20.0), (Model::Sx, 15.0)] {
        let takes = |voltage_v| output(voltage_v).within(model).is_ok();
        assert_eq!([lowest - 0.1, lowest, 45.0, 45.1].map(takes), [false, true, true, false], "{}", model.name());
    }
    let takes = |voltage_v| output(voltage_v).set(Target::Supply).is_ok();
    assert_eq!([14.9, 15.0, 45.0, 45.1].map(takes), [false, true, true, false]);
    assert_eq!(SetOutput::VOLTAGE.limits_for(Model::Sx), Some((15.0, 45.0)));
}

#[test]
fn a_number_without_a_range_keeps_to_the_limit_of_the_product() {
    let takes = |current_a, fuse_a| SetOutput { voltage_v: 40.0, current_a, fuse_a }.set(Target::Supply).is_ok();
    assert_eq!([takes(20.0, 30), takes(20.1, 30), takes(20.0, 31), takes(-0.1, 30)], [true, false, false, false]);
    // 29.6 A go out as 30 A. 30.4 A would, too, and lie outside themselves.
    let set = |fuse| {
        let values = [
            (Quantity::OUTPUT_VOLTAGE, 40_000),
            (Quantity::OUTPUT_CURRENT, 10_000),
            (Quantity::new("fuse_current"), fuse),
        ];
        winch_driver::supply::Message::set(&values, Target::Supply).is_ok()
    };
    assert_eq!([30_000, 29_600, 30_400, 30_600].map(set), [true, true, false, false]);
}

#[test]
fn a_step_beyond_a_limit_is_refused_though_both_are_the_same_double() {
    let batch = SetTrimBatch { number: 7 };
    let takes = |gain| SetTrim { gain, drift: 1.0, batch }.set(Target::Supply).is_ok();
    assert_eq!([0.0, 0.125, 0.25, 0.875, 1.0].map(takes), [false, false, true, true, false]);
}

#[test]
fn a_float_may_be_as_near_to_a_limit_as_it_can() {
    let batch = SetTrimBatch { number: 7 };
    let takes = |drift: f32| SetTrim { gain: 0.25, drift, batch }.set(Target::Supply).is_ok();
    assert_eq!([0.7_f32.next_down(), 0.7, 1.1, 1.1_f32.next_up()].map(takes), [false, true, true, false]);
    assert_eq!([f32::NAN, f32::INFINITY].map(takes), [false; 2]);
}

#[test]
fn a_part_of_a_text_keeps_to_the_numbers_between_its_limits() {
    let text = |number| SetTrimBatch { number }.text().map(|text| text.to_string());
    assert_eq!([0, 1, 99, 100].map(text), [None, Some("B1".to_owned()), Some("B99".to_owned()), None]);
    let read = |text| SetTrimBatch::parse(text).map(|batch| batch.number);
    assert_eq!(["B0", "B1", "B99", "B100"].map(read), [None, Some(1), Some(99), None]);
}
