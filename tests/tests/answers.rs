//! Modules answer requests: with the frames of the documents, and as the interpreter reads them.

use std::collections::HashMap;

use canspec_codegen::interpret::{self, Form, decode};
use canspec_codegen::model::Kind as ModelKind;
use canspec_protocols::infy::{self, ErrorCode, ModuleOutput, SetModuleOutput, Target};
use canspec_protocols::mxr::{self, HeaderResult, OutputVoltage};
use canspec_protocols::{gcp, megmeet};
use canspec_runtime::{
    Addressed, Destination, Error, Failure, Frame, Kind, Protocol, Received, embedded_can::Frame as _,
};
use canspec_tests::{AddressedVisitor, Frames, protocol, received, visit_addressed};

/// How many random frames each protocol sees.
const FRAMES: usize = 20_000;

fn request(id: u32, data: u64) -> infy::Received {
    infy::Message::decode(&frame(id, data)).expect("a frame of the protocol")
}

fn frame(id: u32, data: u64) -> Frame {
    Frame::new_raw(id, true, data.to_be_bytes(), 8)
}

fn output(voltage_v: f64, current_a: f64) -> infy::Message {
    infy::Message::SetModuleOutput(SetModuleOutput { voltage_v, current_a })
}

#[test]
fn a_frame_of_the_document_is_a_line_with_its_message_and_its_module() {
    // By section 2.4 of the document: module 0 says its output, and group 1 is asked for its total.
    let reply = request(0x0283_F000, 0x43FA_0000_4060_0000);
    assert_eq!(reply.to_string(), "read module_output of 0: 43FA000040600000");
    assert_eq!(request(0x0283_00F0, 0).to_string(), "read module_output to 0: 0000000000000000");
    assert_eq!(request(0x02C1_01F0, 0).to_string(), "read_total system_output to 02C101F0: 0000000000000000");
}

#[test]
fn a_module_answers_with_the_frame_that_the_document_prints() {
    let set = request(0x029C_00F0, 0x0003_0D40_0000_1388);
    assert_eq!(set.answer(0, output(199.985, 5.0)), Ok(frame(0x029C_F000, 0x0003_0D31_0000_1388)));
}

#[test]
fn a_reply_goes_to_the_controller_that_asked_from_the_module_that_answers() {
    let answer = |id, node| request(id, 0x0003_0D40_0000_1388).answer(node, output(200.0, 5.0));
    assert_eq!(answer(0x029C_05F8, 5).map(|reply| reply.raw_id()), Ok(0x029C_F805));
    assert_eq!(answer(0x02DC_02F1, 5).map(|reply| reply.raw_id()), Ok(0x02DC_F105), "one of a group");
    assert_eq!(answer(0x029C_3CF0, 0x3C).map(|reply| reply.raw_id()), Ok(0x029C_F03C), "as it was asked");
    assert_eq!(answer(0x029C_05F0, 6), Err(Error::Node { message: "set_module_output", node: 6, asked: 5 }));
    assert_eq!(answer(0x029C_3FF0, 5), Err(Error::Unanswered { message: "set_module_output", access: "set" }));
    assert_eq!(answer(0x029C_F005, 5), Err(Error::Unanswered { message: "set_module_output", access: "set" }));
    assert!(matches!(answer(0x02DC_02F0, 0x3C), Err(Error::Address { address: "module", number: 0x3C, .. })));
}

#[test]
fn one_module_answers_for_a_group_under_the_number_of_the_group() {
    let total = request(0x02C1_02F0, 0);
    let content = infy::Message::SystemOutput(infy::SystemOutput { voltage_v: 500.0, current_a: 50.0 });
    assert_eq!(total.answer(7, content), Ok(frame(0x02C1_F002, 0x43FA_0000_4248_0000)));
}

#[test]
fn only_the_reply_of_the_same_message_answers() {
    let read = request(0x0283_00F0, 0);
    assert!(matches!(read.answer(0, output(200.0, 5.0)), Err(Error::Identifier { message: "module_output", .. })));
    let asked_again = infy::Message::ReadModuleOutput;
    assert!(matches!(read.answer(0, asked_again), Err(Error::Identifier { message: "module_output", .. })));
}

#[test]
fn a_refusal_has_its_code_in_the_identifier_or_in_a_selector() {
    let asked = ModuleOutput::read(Target::Module(2)).expect("a documented address");
    let received = infy::Message::decode(asked.frame()).expect("a request");
    let refused = received.refuse(2, ErrorCode::DataInvalid.raw().into()).expect("a code of three bits");
    assert_eq!(refused, frame(0x0E83_F002, 0));
    assert_eq!(asked.reply(&refused).map(|reply| reply.values), Some(Err(Failure::Error)));
    for code in [0, 8] {
        assert_eq!(received.refuse(2, code), Err(Error::Code { message: "module_output", code }));
    }
    let asked = OutputVoltage::read(mxr::Target::Module(8)).expect("a documented address");
    let received = mxr::Message::decode(asked.frame()).expect("a request");
    let refused = received.refuse(8, HeaderResult::Failed.raw().into()).expect("a code of one byte");
    assert_eq!(asked.reply(&refused).map(|reply| reply.values), Some(Err(Failure::Error)));
    assert_eq!(refused.data()[1], 0xF2);
    assert_eq!(received.refuse(8, 0x1F2), Err(Error::Code { message: "output_voltage", code: 0x1F2 }));
}

#[test]
fn a_module_that_starts_says_so_by_the_code_of_its_document() {
    fn starts<P: Protocol>(id: u32, data: u64) -> (Option<u64>, bool) {
        let received = Received::<P>::decode(&frame(id, data)).expect("a reply");
        (received.error_code(), received.is_starting())
    }
    assert_eq!(starts::<infy::Message>(0x1E83_F002, 0), (Some(7), true));
    assert_eq!(starts::<infy::Message>(0x0E83_F002, 0), (Some(3), false));
    assert_eq!(starts::<infy::Message>(0x0283_F002, 0), (None, false));
    assert_eq!(starts::<gcp::Message>(0x1E83_F002, 0), (Some(7), true));
    assert_eq!(starts::<megmeet::Message>(0x1081_407E, 0x3175_0000_0000_0000), (Some(3), true));
    assert_eq!(starts::<megmeet::Message>(0x1081_407E, 0x1175_0000_0000_0000), (Some(1), false));
    // Of Maxwell the document has no such code.
    assert_eq!(starts::<mxr::Message>(0x060F_8008, 0x42F2_001E_0000_0005), (Some(0xF2), false));
}

/// Counts the answers that the interpreter reads as such.
#[derive(Default)]
struct Answers(usize);

impl AddressedVisitor for Answers {
    fn visit<P: Addressed>(&mut self, path: &str) {
        let protocol = protocol(path);
        let mut frames = Frames::new(&protocol, 0xA45E);
        let mut contents: HashMap<(&str, &str), P> = HashMap::new();
        for _ in 0..FRAMES {
            let Ok(received) = received::<P>(None, &frames.next_frame()) else { continue };
            let exchange = received.exchange();
            let key = (exchange.message(), exchange.access());
            if let Some(Ok(content)) = received.reply() {
                contents.insert(key, *content);
            } else if let Some(content) = contents.get(&key) {
                self.0 += usize::from(is_answered(&protocol, &received, *content));
            }
        }
    }
}

#[test]
fn the_interpreter_reads_each_answer_as_the_reply_to_the_request() {
    let mut answers = Answers::default();
    visit_addressed(&mut answers);
    assert!(answers.0 > 5_000, "{} are few", answers.0);
}

/// Lets the module that is asked, or module 3, answer. Tests what the interpreter reads.
fn is_answered<P: Addressed>(protocol: &canspec_codegen::model::Protocol, request: &Received<P>, content: P) -> bool {
    let node = request.node().unwrap_or(3);
    let Ok(reply) = request.answer(node, content) else { return false };
    let data = reply.data().to_vec();
    let frame = interpret::Frame { id: reply.raw_id(), extended: reply.is_extended(), data, form: Form::Data };
    let read = decode(protocol, None, &frame).expect("an answer is of the protocol");
    let exchange = request.exchange();
    assert_eq!(read.kind, ModelKind::Reply, "{reply}");
    assert_eq!(protocol[read.message].name, exchange.message(), "{reply}");
    assert_eq!(protocol[read.access].name, exchange.access(), "{reply}");
    assert!(!read.is_error_reply(), "{reply}");
    let mode = request.target().map(|target| P::MODES[target.mode()].name);
    assert_eq!(read.addressing.map(|way| protocol[way.mode].name.as_str()), mode, "{reply}");
    let again = Received::<P>::decode(&reply).expect("both engines agree");
    assert_eq!((again.kind(), again.route().and_then(|route| route.sender())), (Kind::Reply, sender(request, &again)));
    assert!(again.node().is_none_or(|answering| answering == node), "{reply}");
    true
}

/// Returns the controller that asked, if the reply shows the whole route.
fn sender<P: Addressed>(request: &Received<P>, reply: &Received<P>) -> Option<i32> {
    reply.route().and_then(|_| request.route()).and_then(|route| route.sender())
}
