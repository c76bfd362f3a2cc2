//! Messages by a transport, of device models that do not have all of their fields.

use canspec_runtime::transfers::Assembler;
use winch_driver::heater::embedded_can::{Frame as _, StandardId};
use winch_driver::heater::{Frame, Message, Model, State, Tp};

/// Puts the reply of a heater together, whose first frame has 84 % and whose second one has a heating.
fn state(model: Option<Model>, heating: u8) -> Option<State> {
    let mut assembler = Assembler::<Tp, 1>::new();
    let frames = [[0x10, 0x0A, 0x62, 0, 84, 0, 0, 0], [0x21, 0, 0, 0, heating, 0xCC, 0xCC, 0xCC]];
    let mut wholes = frames.into_iter().filter_map(|data| {
        let id = StandardId::new(0x7E8).expect("eleven bits");
        let frame = Frame::new(id, &data).expect("at most eight bytes");
        let received = match model {
            Some(model) => Message::decode_for(model, &frame),
            None => Message::decode(&frame),
        };
        assembler.take(&received.expect("a frame of the protocol"), 0).whole
    });
    wholes.next()?.values()
}

#[test]
fn a_value_that_the_device_model_does_not_have_is_there_only_if_bits_show_it() {
    let known = |heating_w| Some(State { charge_percent: 84, heating_w });
    assert_eq!(state(Some(Model::Old), 0), known(None));
    assert_eq!(state(Some(Model::Old), 96), known(Some(96)));
    assert_eq!(state(Some(Model::New), 0), known(Some(0)));
    assert_eq!(state(None, 0), known(Some(0)), "no model is chosen");
}
