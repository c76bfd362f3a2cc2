//! Scales and offsets that depend on the device model.

use winch_driver::rectifier::{Model, SetOutput, Target};

#[test]
fn a_number_is_read_and_set_in_the_steps_of_a_device_model() {
    let mut output = SetOutput { current_raw: 0, temperature_raw: 0 };
    let mut sent = |model, current, temperature| {
        output.set_current(model, current).expect("within the limits");
        output.set_temperature(model, temperature).expect("eight bits hold it");
        output.set(Target::Rectifier).expect("a legal request").frame().to_string()
    };
    // 22 A are 440 twentieths or 660 thirtieths. 25 °C and -15 °C are 50 halves, from 0 °C or -40 °C on.
    assert_eq!(sent(Model::R20, 22.0, 25.0), "004#01B83200");
    assert_eq!(sent(Model::R30, 22.0, -15.0), "004#02943200");
    assert_eq!([Model::R20, Model::R30].map(|model| output.current(model)), [Some(33.0), Some(22.0)]);
    assert_eq!([Model::R20, Model::R30].map(|model| output.temperature(model)), [Some(25.0), Some(-15.0)]);
}

#[test]
fn a_refusal_names_the_limits_of_the_device_model() {
    let mut output = SetOutput { current_raw: 7, temperature_raw: 0 };
    let refused = output.set_current(Model::R20, 50.5).expect_err("more than 50 A");
    let text = "`current` of `set_output` is 50.5 A, but its limits are 0 and 50 A";
    assert_eq!((refused.to_string().as_str(), output.current_raw), (text, 7));
    assert!(output.set_current(Model::R30, 50.5).is_ok());
}
