//! What several frames carry together, in both engines: the values that documents print, and the same bytes back.

use std::fmt::Debug;

use canspec_codegen::interpret::{self, Assembly, Form, decode};
use canspec_codegen::model::{LongExample, LongMessage, Protocol, Signal, TextForm};
use canspec_runtime::parts::{Assembler, Outcome, Parted as _};
use canspec_runtime::{Bytes, Elements, Error, Frame, Kind, LongLayout, Reason, Text};
use canspec_tests::features_long_fields::Pack;
use canspec_tests::features_parts_by_model::{self as by_model, Model};
use canspec_tests::features_parts_of_controller::{self as labels, Label};
use canspec_tests::features_parts_to_modules::{self as ovens, Program, ProgramPart, Target};
use canspec_tests::features_parts_until_marker::{self as until_marker, LabelPart};
use canspec_tests::long::{is_same, long, member};
use canspec_tests::{LongVisitor, Optional, protocol, visit_long};
use fastrand::Rng;

/// How many random data each message sees.
const DATA: usize = 2_000;

/// Returns how many elements data of some length hold whole, if that varies.
fn elements(long: &LongMessage, length: usize) -> Option<usize> {
    let most = long.varying()?.most;
    Some((0..most).take_while(|count| long.bytes_with(Some(count + 1)) <= length).count())
}

/// Returns data with the bits of signals, and elsewhere those that are sent.
fn covered(long: &LongMessage, data: &[u8], count: Option<usize>) -> Vec<u8> {
    let mut mask = vec![0; if long.lengths.is_empty() { long.bytes_with(count) } else { data.len() }];
    let is_there = |signal: &&Signal| long.is_among(count, signal) && signal.reach_with(count) <= mask.len();
    for signal in long.content.signals.iter().filter(is_there).collect::<Vec<_>>() {
        let bytes = mask.iter_mut().skip(signal.window.into());
        bytes.zip(signal.masks()).for_each(|(byte, own)| *byte |= own);
    }
    let blank = if long.content.reserved.are_ones { 0xFF } else { 0 };
    mask.iter().zip(data).map(|(mask, byte)| mask & byte | blank & !mask).collect()
}

/// Takes away the bytes that fill up a text that ends where the data end, as far as nobody needs them.
fn unfilled(long: &LongMessage, mut data: Vec<u8>) -> Vec<u8> {
    let Some((text, run)) = long.open_text() else { return data };
    let Some(TextForm::Ascii { fill }) = text.encoding.text_form() else { return data };
    data.truncate(text.reach());
    while data.len() > usize::from(text.window + run.least) && data.last() == Some(&fill) {
        data.pop();
    }
    data
}

struct Random {
    whole: usize,
}

impl LongVisitor for Random {
    fn visit<L: LongLayout + Optional + PartialEq + Debug>(&mut self, path: &str) {
        let protocol = protocol(path);
        let long = long::<L>(&protocol);
        assert_eq!((L::SHORTEST, L::LONGEST), (long.least(), long.longest()), "{path}");
        let mut rng = Rng::with_seed(0x10E6);
        for _ in 0..DATA {
            let any = rng.usize(..L::LONGEST + 8);
            let length =
                if any < L::SHORTEST { any } else { rng.choice(&long.lengths).map_or(any, |one| (*one).into()) };
            let data: Vec<_> = std::iter::repeat_with(|| rng.u8(..)).take(length).collect();
            let Some(values) = L::decode(&data) else {
                assert!(data.len() < L::SHORTEST, "{path}: {data:X?}");
                continue;
            };
            let data = unfilled(long, data);
            let count = elements(long, data.len());
            let mut buffer = vec![0xFF; L::LONGEST];
            match values.encode(&mut buffer) {
                // Values that say that they are missing need not be sent at the end.
                Ok(bytes) if bytes.len() < data.len() && !long.lengths.is_empty() => {
                    assert_eq!(L::decode(bytes).as_ref(), Some(&values), "{path}");
                }
                Ok(bytes) => assert_eq!(bytes, covered(long, &data, count), "{path}: {values:?}"),
                Err(error) => {
                    assert!(count < long.varying().map(|array| array.least), "{path}: {error}");
                    continue;
                }
            }
            self.whole += 1;
        }
    }
}

#[test]
fn random_data_are_read_and_come_back_where_the_spec_says() {
    let mut random = Random { whole: 0 };
    visit_long(&mut random);
    assert!(random.whole > 2_000, "{} messages", random.whole);
}

struct Examples {
    values: usize,
}

impl Examples {
    fn holds<L: LongLayout + Optional>(&mut self, protocol: &Protocol, example: &LongExample) {
        let content = &protocol[example.long].content;
        let mut assembly = Assembly::default();
        assembly.count_as(example.count.map(usize::from));
        let mut ended = Vec::new();
        for (id, data) in &example.frames {
            let extended = protocol.identifier.extended;
            let frame = interpret::Frame { id: *id, extended, data: data.clone(), form: Form::Data };
            let decoded = decode(protocol, example.model, &frame).expect("a frame of the protocol");
            ended.extend(assembly.take(protocol, example.model, (), &frame, &decoded).ended);
        }
        ended.extend(assembly.fall_silent(protocol, example.model));
        ended.extend(assembly.finish(protocol, example.model));
        let [message] = ended.as_slice() else { panic!("{}: {} messages", example.doc.path, ended.len()) };
        // A kind of frame without values has nothing to compare.
        let Some(mut data) = message.data.clone().filter(|_| !message.decoded.signals.is_empty()) else { return };
        let count = example.count.map(usize::from);
        if protocol[example.long].parts().is_some() {
            data.truncate(protocol[example.long].bytes_with(count));
        }
        let values = serde_json::to_value(L::decode(&data).expect("whole data")).expect("every value has JSON");
        for reading in &message.decoded.signals {
            let signal = &content[reading.signal];
            let json = member(&values, content, signal);
            assert!(is_same(&reading.value, json), "{}: {json} is not {:?}", signal.name, reading.value);
            self.values += 1;
        }
    }
}

impl LongVisitor for Examples {
    fn visit<L: LongLayout + Optional + PartialEq + Debug>(&mut self, path: &str) {
        let protocol = protocol(path);
        let of_message = |example: &&LongExample| protocol[example.long].content.name == L::MESSAGE;
        protocol.long_examples.iter().filter(of_message).for_each(|example| self.holds::<L>(&protocol, example));
    }
}

#[test]
fn what_documents_print_in_several_frames_means_the_same_to_both_engines() {
    let mut examples = Examples { values: 0 };
    visit_long(&mut examples);
    assert!(examples.values > 70, "{} values", examples.values);
}

#[test]
fn a_message_is_sent_in_the_frames_that_the_document_prints() {
    let reply = LabelPart::READ.filter(Kind::Reply).expect("it is a reply");
    let blank = reply.id(until_marker::Identifier::TO_HOST, 1).id(until_marker::Identifier::DEVICE, 1).frame(8);
    let texts = ["BOARD=", "7"].map(|text| Text::new(text).expect("six letters"));
    let text = Elements::from_slice(&texts).expect("two of 64");
    let frames: Vec<_> = until_marker::Label { text }.frames(&blank).expect("it fits").collect();
    assert_eq!(
        frames.iter().map(Frame::to_string).collect::<Vec<_>>(),
        ["059#0001424F4152443D", "051#0002370000000000"]
    );
    let mut assembler = Assembler::<until_marker::Label, 1>::new(100);
    let ended: Vec<_> = frames.iter().flat_map(|frame| assembler.receive(frame, 0)).collect();
    let [Outcome::Whole(whole)] = ended.as_slice() else { panic!("{ended:?}") };
    assert_eq!((&*whole.values.text, whole.is_counted), (&texts[..], true));
}

#[test]
fn bits_without_a_field_are_sent_as_the_spec_says_also_behind_the_message() {
    let protocol = protocol("specs/features/long_fields.yaml");
    let [example] = protocol.long_examples.as_slice() else { panic!("one example") };
    let frames: Vec<_> = example.frames.iter().map(|(_, data)| data.clone()).collect();
    let data: Vec<_> = frames.iter().flat_map(|frame| &frame[1..]).copied().collect();
    let pack = Pack::decode(&data).expect("whole data");
    let made = pack.frames(&Frame::new_raw(0x611, false, [0; 8], 8)).expect("it fits");
    assert_eq!(made.map(|frame| frame.bytes().to_vec()).collect::<Vec<_>>(), frames);
}

#[test]
fn each_model_numbers_the_parts_in_its_own_way() {
    let serial = Text::new("AB123456").expect("eight letters");
    let label = by_model::Label { serial, hours_h: 1000 };
    let blank = Frame::new_raw(0x071, false, [0; 8], 4);
    let frames = |model| label.frames_for(model, &blank).expect("it fits").map(|frame| frame.to_string());
    let of_a = ["071#00414231", "071#01323334", "071#02353600", "071#030003E8"];
    let of_b = ["071#01414231", "071#02323334", "071#03353600", "071#040003E8"];
    assert_eq!(frames(Model::A).collect::<Vec<_>>(), of_a);
    assert_eq!(frames(Model::B).collect::<Vec<_>>(), of_b);
    assert!(label.frames(&blank).is_err() && label.parts().is_err(), "the first number is not known");
}

/// Returns a program of three temperatures, the last one of some value.
fn program(last: f64) -> Program {
    Program { hold_min: 10, temperature_c: Elements::from_slice(&[180.0, 200.0, last]).expect("three of six") }
}

#[test]
fn a_controller_sends_a_module_the_frames_that_the_document_prints() {
    let frames = program(210.0).set(Target::Oven(3)).expect("it fits").map(|frame| frame.to_string());
    assert_eq!(frames.collect::<Vec<_>>(), ["0A3#010A070807D00800", "0A3#0234000000000000"]);
    let label = Label { part: 1, data_c: 22.0, text: Text::new("Oven ready").expect("ten letters") };
    let frames = label.tell(labels::Target::All).expect("it fits").with_counter(2).map(|frame| frame.to_string());
    assert_eq!(frames.collect::<Vec<_>>(), ["0EF#400D0100DC4F7665", "0EF#416E207265616479"]);
}

#[test]
fn no_part_of_values_outside_their_limits_is_built_for_a_module() {
    let blank = ProgramPart::SET.blank_request(Target::Oven(3)).expect("a documented address");
    assert_eq!(blank.to_string(), "0A3#0000000000000000");
    for (last, is_within, is_of_ov1) in [(210.0, true, true), (250.1, true, false), (300.1, false, false)] {
        let program = program(last);
        assert_eq!(program.set(Target::Oven(3)).is_ok(), is_within, "{last}");
        assert_eq!(program.frames(&blank).is_ok(), is_within, "{last}");
        assert_eq!(program.frames_for(ovens::Model::Ov1, &blank).is_ok(), is_of_ov1, "{last}");
        assert_eq!(program.parts().is_ok(), is_within, "{last}");
        // What a module says of itself is sent as it is.
        let reply = Frame::new_raw(0x0B3, false, [0; 8], 8);
        assert!(program.frames(&reply).is_ok() && program.frames_for(ovens::Model::Ov1, &reply).is_ok(), "{last}");
    }
    assert!(program(210.0).set(Target::Oven(10)).is_err(), "there are nine ovens");
}

#[test]
fn a_part_to_a_module_is_built_again_only_as_it_was() {
    let frames: Vec<_> = program(210.0).set(Target::Oven(3)).expect("it fits").collect();
    let received = ovens::Message::decode(&frames[0]).expect("one of its frames");
    assert_eq!(received.encode(), Ok(frames[0]));
    let ovens::Message::ProgramPart(part) = *received.content() else { panic!("it carries a part") };
    // Byte 0 is the time: 255 min, where 60 min are the most.
    let long = ProgramPart { data: Bytes::new([0xFF, 0x07, 0x08, 0x07, 0xD0, 0x08]), ..part };
    let later = ProgramPart { part: 2, ..part };
    for (other, signal) in [(long, "data"), (later, "part")] {
        let built = received.with_content(ovens::Message::ProgramPart(other)).encode();
        let Err(Error::Value(refused)) = built else { panic!("{built:?}") };
        assert_eq!((refused.message(), refused.signal(), refused.reason()), ("program", signal, Reason::Part));
        // A module says what it has.
        let reply = Frame::new_raw(0x0B3, false, frames[0].bytes(), 8);
        let reply = ovens::Message::decode(&reply).expect("it confirms the frame");
        assert!(reply.with_content(ovens::Message::ProgramPart(other)).encode().is_ok());
    }
}

#[test]
fn what_a_module_said_before_does_not_count_what_it_confirms() {
    let state = Frame::new_raw(0x053, false, [1, 0, 0, 0, 0, 0, 0, 0], 8);
    let sent = program(210.0).set(Target::Oven(3)).expect("it fits");
    let answers = sent.map(|frame| Frame::new_raw(0x0B3, false, frame.bytes(), 8));
    let mut assembler = Assembler::<Program, 4>::new(100);
    assert_eq!([state].into_iter().chain(answers).flat_map(|frame| assembler.receive(&frame, 0)).count(), 0);
    let Some(Outcome::Whole(whole)) = assembler.finish() else { panic!("both parts came") };
    assert_eq!(&whole.values.temperature_c[..3], &*program(210.0).temperature_c);
    assert!(!whole.is_counted);
}

#[test]
fn what_goes_to_a_module_is_not_mixed_with_what_comes_from_it() {
    let sent = program(210.0).set(Target::Oven(3)).expect("it fits");
    let answer = |frame: &Frame| Frame::new_raw(0x093, false, frame.bytes(), 8);
    let mut assembler = Assembler::<Program, 4>::new(100);
    let frames = sent.flat_map(|frame| [frame, answer(&frame)]).collect::<Vec<_>>();
    // Byte 0 has the number of steps of what the module says. What it is sent may have another one.
    let state = Frame::new_raw(0x053, false, [3, 0, 0, 0, 0, 0, 0, 0], 8);
    let ended: Vec<_> = [state].iter().chain(&frames).flat_map(|frame| assembler.receive(frame, 0)).collect();
    let whole = ended.iter().map(|outcome| match outcome {
        Outcome::Whole(whole) => (whole.values, whole.is_to_module()),
        other => panic!("{other:?}"),
    });
    assert_eq!(whole.collect::<Vec<_>>(), [(program(210.0), false)]);
    // The next message ends what the module was sent. A bare request begins anew what the module sends, and leaves
    // alone what it is sent.
    let [first, answered, last, _] = frames[..] else { panic!("four frames") };
    let bare = Frame::new_raw(0x083, false, [0; 8], 8);
    let ended: Vec<_> = [first, answered, bare, last].iter().flat_map(|frame| assembler.receive(frame, 0)).collect();
    let is_whole = ended.iter().map(|outcome| match outcome {
        Outcome::Whole(whole) => (true, whole.is_to_module()),
        Outcome::Incomplete(partial) => (false, partial.is_to_module()),
        Outcome::Full(frame) => panic!("no room for {frame}"),
    });
    assert_eq!(is_whole.collect::<Vec<_>>(), [(true, true), (false, false)]);
}
