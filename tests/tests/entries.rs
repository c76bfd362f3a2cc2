//! The list of messages in generated code.

use canspec_codegen::model::{Id, Kind};
use canspec_codegen::number::Rational;
use canspec_protocols::mxr::{self, Message, ModuleStatus, OutputVoltage, Target};
use canspec_runtime::{Frame, Number, Protocol};
use canspec_tests::{Visitor, protocol, visit};

/// The registers that the MXR document lets one read, in 3.1.
const READABLE: [u64; 23] = [
    0x01, 0x02, 0x03, 0x04, 0x05, 0x08, 0x0A, 0x0B, 0x0C, 0x0D, 0x0E, 0x10, 0x11, 0x12, 0x40, 0x43, 0x48, 0x4A, 0x4B,
    0x54, 0x55, 0x56, 0x57,
];

struct Listed {
    messages: usize,
}

impl Visitor for Listed {
    fn visit<P: Protocol>(&mut self, path: &str) {
        let protocol = protocol(path);
        assert_eq!(P::MESSAGES.len(), protocol.messages.len(), "{path}");
        for (entry, message) in P::MESSAGES.iter().zip(&protocol.messages) {
            let name = format!("{path}: {}", message.name);
            assert_eq!(entry.name(), message.name, "{path}");
            assert_eq!(
                entry.title,
                message
                    .doc
                    .title
                    .as_ref()
                    .map_or(message.name.replace('_', " "), |title| title.as_rust_str().to_owned()),
                "{name}"
            );
            for known in &message.constants {
                assert!(entry.constants.contains(&(&protocol[known.selector].name, known.value)), "{name}");
            }
            assert_eq!(entry.constants.len(), message.constants.len(), "{name}");
            for (exchange, access) in entry.exchanges.iter().zip(&message.exchanges) {
                assert_eq!(exchange.access(), protocol[access.access].name, "{name}");
            }
            assert_eq!(entry.exchanges.len(), message.exchanges.len(), "{name}");
            for frame in protocol.frames_of(message) {
                let exchange = entry.exchanges[frame.exchange.place()];
                assert!(exchange.filter(kind(frame.kind)).is_some(), "{name}");
                let carries = frame.is_to_module() && !frame.signals.is_empty();
                assert!(!frame.is_to_module() || exchange.has_values() == carries, "{name}");
            }
            for (listed, signal) in entry.signals.iter().zip(&message.signals) {
                assert_eq!(listed.name(), signal.name, "{name}");
                assert_eq!(listed.unit(), signal.unit.as_ref().map(|unit| &*unit.symbol), "{name}");
                assert_eq!(listed.place().mask(), signal.place.mask(), "{name}");
                let range = signal.hull(protocol.models_of(message));
                let range = range.map(|range| [range.minimum, range.maximum].map(Rational::to_f64));
                let limits = listed.limits().map(|(minimum, maximum)| [minimum, maximum]);
                let limits = limits.map(|limits| limits.map(Number::to_f64));
                let is_same = limits == range || limits.zip(range).is_some_and(|(own, spec)| is_next_inside(own, spec));
                assert!(is_same, "{name}: {limits:?}, not {range:?}");
            }
            assert_eq!(entry.signals.len(), message.signals.len(), "{name}");
            self.messages += 1;
        }
    }
}

/// Tests whether limits are those of a range, or the next doubles inside. A step beyond a limit may have its double.
fn is_next_inside(limits: [f64; 2], range: [f64; 2]) -> bool {
    let [minimum, maximum] = range;
    let is_least = [minimum, minimum.next_up()].contains(&limits[0]);
    is_least && [maximum, maximum.next_down()].contains(&limits[1])
}

fn kind(kind: Kind) -> canspec_runtime::Kind {
    match kind {
        Kind::Request => canspec_runtime::Kind::Request,
        Kind::Reply => canspec_runtime::Kind::Reply,
        Kind::Report => canspec_runtime::Kind::Report,
    }
}

#[test]
fn every_message_of_every_protocol_is_in_the_list_as_the_spec_has_it() {
    let mut listed = Listed { messages: 0 };
    visit(&mut listed);
    assert!(listed.messages > 80, "{}", listed.messages);
}

#[test]
fn a_whole_table_is_read_in_a_loop() {
    let mut numbers = Vec::new();
    for entry in mxr::MESSAGES {
        let Some(request) = entry.request("read", Target::Module(1)) else { continue };
        let [("register", number)] = entry.constants else { panic!("{}", entry.name()) };
        // The document prints 06080F80#1000000100000000 for register 1, and 060F8008#41F00001442F0000 as the reply.
        let request = request.expect("the module is in range");
        assert_eq!(request.frame(), &frame(0x0608_0F80, 0x1000_0000_0000_0000 | number << 32), "{}", entry.name());
        let reply = [0x41F0, 0x42F0].map(|start: u64| frame(0x060F_8008, start << 48 | number << 32));
        let reply = reply.iter().find(|reply| request.is_reply(*reply)).expect("a value of one of the two types");
        let received = Message::decode(reply).expect("a reply of the table");
        assert_eq!(received.exchange().message(), entry.name());
        numbers.push(*number);
    }
    assert_eq!(numbers, READABLE);
}

#[test]
fn the_list_builds_the_requests_that_types_build() {
    let listed = |name| {
        let entry = mxr::MESSAGES.iter().find(|entry| entry.name() == name).expect("it is in the list");
        let request = entry.request("read", Target::Module(1)).expect("it can be read").expect("in range");
        (*request.frame(), request.replies())
    };
    let voltage = OutputVoltage::read(Target::Module(1)).expect("in range");
    let status = ModuleStatus::read(Target::Module(1)).expect("in range");
    assert_eq!(listed("output_voltage"), (*voltage.frame(), voltage.replies()));
    assert_eq!(listed("module_status"), (*status.frame(), status.replies()));
}

#[test]
fn a_request_that_carries_values_is_not_built_without_them() {
    let set = mxr::MESSAGES.iter().find(|entry| entry.name() == "switch_modules").expect("it is in the list");
    assert!(set.request("set", Target::Module(1)).is_none());
}

fn frame(id: u32, data: u64) -> Frame {
    Frame::new_raw(id, true, data.to_be_bytes(), 8)
}

#[test]
fn a_blank_reply_is_none_that_refuses() {
    let request = OutputVoltage::read(Target::Module(1)).expect("the module is in range");
    let blank = request.replies().filter().expect("the module answers").frame(8);
    // The document prints 060F8008#41F00001442F0000 for 700 V, where F0 says that the request was carried out.
    assert_eq!(blank, frame(0x060F_8008, 0x41F0_0001_0000_0000));
    let blank = Message::decode(&blank).expect("it is a frame of the protocol");
    let full = Message::OutputVoltage(OutputVoltage { value_v: 700.0 });
    assert_eq!(blank.reply(), Some(Ok(&Message::OutputVoltage(OutputVoltage { value_v: 0.0 }))));
    assert_eq!(blank.with_content(full).encode(), Ok(frame(0x060F_8008, 0x41F0_0001_442F_0000)));
}
