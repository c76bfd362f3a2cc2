//! Scales and offsets that depend on the device model.

use canspec_runtime::{AfterSilence, Protocol};
use winch_driver::rectifier::embedded_can::{Frame as _, StandardId};
use winch_driver::rectifier::parts::{Assembler, Outcome};
use winch_driver::rectifier::{
    Bytes, Error, Frame, LongLayout, Message, Model, Parted, Received, SetCharge, SetHeating, SetHeatingPart,
    SetOutput, SetService, Target,
};
use winch_driver::winch;

fn received(id: u16, data: &[u8], model: Model) -> Received {
    let id = StandardId::new(id).expect("eleven bits");
    let frame = Frame::new(id, data).expect("at most eight bytes");
    Message::decode_for(model, &frame).expect("a frame of the protocol")
}

fn shown(received: &Received) -> Vec<String> {
    let mut shown = Vec::new();
    received.visit(|reading| shown.push(reading.to_string()));
    shown
}

#[test]
fn a_protocol_says_what_devices_do_after_silence() {
    assert_eq!(Message::AFTER_SILENCE, AfterSilence::Starts);
    assert_eq!(winch::Message::AFTER_SILENCE, AfterSilence::Unknown, "its spec does not say it");
}

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

#[test]
fn a_request_has_what_only_its_device_model_has() {
    let charge = |warmth_w| SetCharge { charge_percent: 84, warmth_w };
    let sent = |model, warmth_w| {
        let within = charge(warmth_w).within(model)?;
        within.set(Target::Rectifier).map(|request| request.frame().to_string())
    };
    assert_eq!(sent(Model::R20, None).as_deref(), Ok("006#54"));
    assert_eq!(sent(Model::R30, Some(96)).as_deref(), Ok("006#540060"));
    let refused = |sent: Result<String, Error>| sent.expect_err("a refusal").to_string();
    let text = "`warmth` of `set_charge` is left out, but the frame is long enough for it";
    assert_eq!(refused(sent(Model::R30, None)), text);
    assert_eq!(refused(sent(Model::R20, Some(96))), "`warmth` of `set_charge` has no such value");
    let request = charge(None).set(Target::Rectifier).map(|request| request.frame().to_string());
    assert_eq!(request.as_deref(), Ok("006#54"), "no model is chosen");
}

#[test]
fn a_value_that_the_device_model_does_not_have_is_there_only_if_bits_show_it() {
    for (model, data, warmth_w, readings) in [
        (Model::R20, &[84, 0, 0][..], None, &["charge 84 %"][..]),
        (Model::R20, &[84, 0, 96], Some(96), &["charge 84 %", "warmth 96 W"]),
        (Model::R20, &[84], None, &["charge 84 %"]),
        (Model::R30, &[84, 0, 0], Some(0), &["charge 84 %", "warmth 0 W"]),
        (Model::R30, &[84], None, &["charge 84 %"]),
    ] {
        let reply = received(0x007, data, model);
        assert_eq!(reply.content(), &Message::SetCharge(SetCharge { charge_percent: 84, warmth_w }), "{data:?}");
        assert_eq!(shown(&reply), readings, "{data:?}");
        for id in [0x006, 0x007] {
            let again = received(id, data, model);
            let is_taken = id == 0x007 || model == Model::R30 || warmth_w.is_none();
            assert_eq!(again.encode().ok(), is_taken.then(|| *again.frame()), "{data:?}");
        }
    }
}

#[test]
fn a_value_is_absent_only_on_a_device_model_that_has_it() {
    let sent = |model, hours_h| {
        let within = SetService { hours_h }.within(model).expect("it is legal");
        within.set(Target::Rectifier).expect("it is legal").frame().to_string()
    };
    assert_eq!([Model::R20, Model::R30].map(|model| sent(model, None)), ["008#00000000", "008#FFFF0000"]);
    let hours = |model, high| match received(0x009, &[high, high, 0, 0], model).content() {
        Message::SetService(service) => service.hours_h,
        _ => panic!("it is the service"),
    };
    assert_eq!([0, 0xFF, 1].map(|high| hours(Model::R30, high)), [Some(0), None, Some(0x0101)]);
    assert_eq!([0, 1].map(|high| hours(Model::R20, high)), [None, Some(0x0101)]);
    assert_eq!(shown(&received(0x009, &[0; 4], Model::R20)), [""; 0]);
}

/// Returns the data of a message of several frames to a device model.
fn heated(model: Option<Model>, values: SetHeating) -> Result<Vec<u8>, String> {
    let blank = SetHeatingPart::SET.blank_request(Target::Rectifier).expect("it has this target");
    let frames = match model {
        Some(model) => values.frames_for(model, &blank),
        None => values.frames(&blank),
    };
    let parts = frames.map_err(|refused| refused.to_string())?;
    let data: Vec<u8> = parts.flat_map(|frame| frame.data()[1..].to_vec()).collect();
    let length = usize::from(data[0]);
    Ok(data[1..=length].to_vec())
}

const BARE: SetHeating = SetHeating { charge_percent: 84, fan: 0, code: None, heater_w: [None; 2], power_w: None };

#[test]
fn a_request_of_several_frames_has_what_only_its_device_model_has() {
    let cooled = SetHeating { fan: 3, ..BARE };
    let whole =
        SetHeating { code: Some(Bytes::new([7; 9])), heater_w: [Some(5), Some(6)], power_w: Some(258), ..cooled };
    assert_eq!(heated(Some(Model::R20), BARE).as_deref(), Ok(&[84, 0][..]));
    assert_eq!(heated(None, cooled).as_deref(), Ok(&[84, 3][..]), "no model is chosen");
    let sent = [84, 3, 7, 7, 7, 7, 7, 7, 7, 7, 7, 5, 6, 1, 2];
    assert_eq!(heated(Some(Model::R30), whole).as_deref(), Ok(&sent[..]));
    let missing = |signal| Err(format!("`{signal}` of `set_heating` is left out, but the frame is long enough for it"));
    assert_eq!(heated(Some(Model::R30), cooled), missing("code"));
    assert_eq!(heated(Some(Model::R30), SetHeating { power_w: None, ..whole }), missing("power"));
    let lacking = |signal| Err(format!("`{signal}` of `set_heating` has no such value"));
    assert_eq!(heated(Some(Model::R20), cooled), lacking("fan"));
    assert_eq!(heated(Some(Model::R20), SetHeating { fan: 0, ..whole }), lacking("code"));
}

/// Returns the reply in six parts that carries data.
fn confirmed(data: [u8; 15]) -> impl Iterator<Item = Frame> {
    let mut carried = vec![15];
    carried.extend(data);
    carried.resize(18, 0);
    let parts: Vec<_> = carried.chunks(3).map(<[u8]>::to_vec).collect();
    parts.into_iter().zip(0..).map(|(part, number)| {
        let id = StandardId::new(0x00B).expect("eleven bits");
        Frame::new(id, &[number, part[0], part[1], part[2]]).expect("at most eight bytes")
    })
}

#[test]
fn a_value_of_several_frames_that_the_device_model_does_not_have_is_there_only_if_bits_show_it() {
    for (place, byte, shown) in [
        (0, 84, BARE),
        (1, 9, SetHeating { fan: 9, ..BARE }),
        (10, 1, SetHeating { code: Some(Bytes::new([0, 0, 0, 0, 0, 0, 0, 0, 1])), ..BARE }),
        (12, 5, SetHeating { heater_w: [None, Some(5)], ..BARE }),
        (14, 2, SetHeating { power_w: Some(2), ..BARE }),
    ] {
        let mut data = [0; 15];
        (data[0], data[place]) = (84, byte);
        assert_eq!(SetHeating::decode_for(Model::R20, &data), Some(shown), "{place}");
        let mut assembler = Assembler::<SetHeating, 1>::new(500).for_model(Model::R20);
        let ended: Vec<_> = confirmed(data).flat_map(|frame| assembler.receive(&frame, 0)).collect();
        let [Outcome::Whole(whole)] = ended.as_slice() else { panic!("{ended:?}") };
        assert_eq!(whole.values, shown);
        let of_r30 = SetHeating::decode_for(Model::R30, &data).expect("all bytes");
        assert!(of_r30.code.is_some() && of_r30.power_w.is_some() && of_r30.heater_w.iter().all(Option::is_some));
    }
}
