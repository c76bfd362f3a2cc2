//! Messages that a transport carries, in generated code: what they say, and the frames of both sides.

use std::fmt::Debug;
use std::fs;
use std::path::Path;

use canspec_codegen::interpret::{Assembly, Content, Form, Frame, decode, encode_long};
use canspec_codegen::model::{FrameLayout, LongExample, LongMessage, Protocol};
use canspec_protocols::gbt27930;
use canspec_runtime::IdentifierFields;
use canspec_runtime::transfers::{Assembler, Sender, Transferred, Transport, Whole};
use canspec_tests::long::{is_same, long, member};
use canspec_tests::{Optional, TransferredVisitor, protocol, received, visit_transferred};
use fastrand::Rng;
use rayon::prelude::*;

/// How many random values of each message are sent.
const MESSAGES: usize = 300;

type MessageOf<L> = <<L as Transferred>::Transport as Transport>::Protocol;

/// Returns the identifier that a message has as one frame.
fn raw_id<T: Transport>(whole: &Whole<T>) -> u32 {
    <T::Protocol as canspec_runtime::Protocol>::Identifier::TO_RAW(whole.identifier())
}

/// Reads a log in the format of candump.
fn log(name: &str) -> Vec<Frame> {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("logs").join(name);
    let text = fs::read_to_string(path).expect("the log is there");
    let lines = text.lines().filter_map(|line| line.split_whitespace().nth(2)?.split_once('#'));
    lines.map(|(id, data)| frame(id, data)).collect()
}

/// Reads a frame of 29 bits.
fn frame(id: &str, data: &str) -> Frame {
    let bytes = data.as_bytes().chunks(2).map(|pair| std::str::from_utf8(pair).expect("it is ASCII"));
    let data = bytes.map(|byte| u8::from_str_radix(byte, 16).expect("two digits")).collect();
    Frame { id: u32::from_str_radix(id, 16).expect("eight digits"), extended: true, data, form: Form::Data }
}

/// What the interpreter says about the messages of a log that a transport can carry, whichever way they came.
struct Log {
    name: &'static str,
    spec: &'static str,
    whole: usize,
    values: usize,
}

impl TransferredVisitor for Log {
    fn visit<L: Transferred + Optional + PartialEq + Debug>(&mut self, path: &str) {
        if !path.ends_with(self.spec) {
            return;
        }
        let protocol = protocol(path);
        let (mut assembly, mut assembler) = (Assembly::default(), Assembler::<L::Transport, 4>::new());
        for frame in log(self.name) {
            let Ok(decoded) = decode(&protocol, None, &frame) else { continue };
            let ended = assembly.take(&protocol, None, (), &frame, &decoded).ended;
            let received = received::<MessageOf<L>>(None, &frame).expect("both engines know the frame");
            let whole = assembler.take(&received, 0).whole.filter(|whole| whole.values::<L>().is_some());
            let ended = ended.into_iter().filter(|message| message.data.is_some());
            let ended = ended.map(|message| (message.frame.id, message.decoded, message.data.unwrap_or_default()));
            let plain = decoded.long.is_none().then(|| (frame.id, decoded.clone(), frame.data.clone()));
            let is_meant = |decoded: &canspec_codegen::interpret::Decoded| {
                protocol[decoded.message].name == L::MESSAGE && !decoded.signals.is_empty()
            };
            let mut said = ended.chain(plain).filter(|(_, decoded, _)| is_meant(decoded));
            let (said, none) = (said.next(), said.next());
            assert!(none.is_none(), "one frame ends one message");
            assert_eq!(said.is_some(), whole.is_some(), "{frame:X?}: {said:?} and {whole:?}");
            let (Some((id, decoded, data)), Some(whole)) = (said, whole) else { continue };
            assert_eq!((id, &data[..]), (raw_id(&whole), whole.data()));
            let json = serde_json::to_value(whole.values::<L>()).expect("every value has JSON");
            let content = decoded.content(&protocol);
            for reading in &decoded.signals {
                let (signal, value) = (&content[reading.signal], &reading.value);
                let found = member(&json, content, signal);
                assert!(is_same(value, found), "{}: {found} is not {value:?}", signal.name);
                self.values += 1;
            }
            self.whole += 1;
        }
    }
}

#[test]
fn both_engines_read_the_same_values_of_a_charging() {
    let mut charging = Log { name: "gbt27930-transfers.log", spec: "gbt27930.yaml", whole: 0, values: 0 };
    visit_transferred(&mut charging);
    assert!(charging.whole >= 10 && charging.values > 200, "{} messages, {} values", charging.whole, charging.values);
}

fn is_extended<L: Transferred>() -> bool {
    <MessageOf<L> as canspec_runtime::Protocol>::FRAME.is_extended()
}

/// Returns the values of the document's examples in the frames in which it prints them.
#[derive(Default)]
struct Examples {
    frames: usize,
}

impl Examples {
    fn holds<L: Transferred>(&mut self, example: &LongExample) {
        let mut assembler = Assembler::<L::Transport, 1>::new();
        let extended = is_extended::<L>();
        let decoded = |(id, data): &(u32, Vec<u8>)| {
            let frame = Frame { id: *id, extended, data: data.clone(), form: Form::Data };
            received::<MessageOf<L>>(None, &frame).expect("a frame of the protocol")
        };
        let all: Vec<_> = example.frames.iter().map(decoded).collect();
        let whole = all.iter().find_map(|received| assembler.take(received, 0).whole);
        let Some((whole, values)) = whole.and_then(|whole| Some((whole, whole.values::<L>()?))) else { return };
        let mut buffer = vec![0; L::LONGEST];
        let filter = whole.exchange().filter(whole.kind()).expect("it is carried");
        let blank = canspec_runtime::Frame::new_raw(raw_id(&whole), extended, filter.data_value(), 8);
        let mut sender = values.sender(&blank, &mut buffer).expect("the document sends it");
        let (mut sent, mut printed): (Vec<_>, _) = ((&mut sender).collect(), Vec::new());
        for received in &all {
            match format!("{:?}", sender.receive(received.frame())).as_str() {
                "Other" => printed.push(without_limit(*received.frame())),
                _ => sent.extend(&mut sender),
            }
        }
        assert_eq!(sent.into_iter().map(without_limit).collect::<Vec<_>>(), printed, "{}", example.doc.path);
        self.frames += printed.len();
    }
}

/// Returns a frame without the number of packets that a receiver may allow at once. A request to send has it.
fn without_limit(frame: canspec_runtime::Frame) -> canspec_runtime::Frame {
    let mut data = frame.bytes();
    if frame.raw_id() >> 16 & 0xFF != 0xEC || data[0] != 0x10 {
        return frame;
    }
    data[4] = 0xFF;
    canspec_runtime::Frame::new_raw(frame.raw_id(), true, data, 8)
}

impl TransferredVisitor for Examples {
    fn visit<L: Transferred + Optional + PartialEq + Debug>(&mut self, path: &str) {
        let protocol = protocol(path);
        let of_message = |example: &&LongExample| protocol[example.long].content.name == L::MESSAGE;
        protocol.long_examples.iter().filter(of_message).for_each(|example| self.holds::<L>(example));
    }
}

#[test]
fn what_documents_print_is_sent_in_the_same_frames() {
    let mut examples = Examples::default();
    visit_transferred(&mut examples);
    assert!(examples.frames > 40, "{} frames", examples.frames);
}

/// Returns a blank frame of a message, as it would be as one frame.
fn blank(protocol: &Protocol, layout: &FrameLayout) -> canspec_runtime::Frame {
    let (_, pattern) = protocol.patterns_of(layout).next().expect("it has an addressing mode");
    let id = pattern.addresses.iter().fold(protocol.base_identifier(layout, pattern), |id, address| {
        protocol[address.field].put(id, protocol[address.address_type].raw_ranges()[0].0)
    });
    let mut data = [0; 8];
    layout.payload().for_each(|(place, value)| place.put(&mut data, value));
    canspec_runtime::Frame::new_raw(id, protocol.identifier.extended, data, 8)
}

/// Lets a receiver answer a sender. Returns the message that the receiver has at the end, and the frames of the sender.
fn exchange<T: Transport>(mut sender: Sender<'_, T>) -> Option<(Whole<T>, Vec<Frame>)> {
    let (mut assembler, mut frames) = (Assembler::<T, 1>::new(), Vec::new());
    while let Some(frame) = sender.next() {
        let data = embedded_can::Frame::data(&frame).to_vec();
        let extended = embedded_can::Frame::is_extended(&frame);
        frames.push(Frame { id: frame.raw_id(), extended, data, form: Form::Data });
        let event = assembler.receive(&frame, 0);
        if let Some(answer) = event.answer {
            let answered = format!("{:?}", sender.receive(&answer));
            assert!(answered.starts_with("Allowed") || answered == "Done", "{answered}");
        }
        if let Some(whole) = event.whole {
            assert!(sender.next().is_none(), "nothing is left to send");
            return Some((whole, frames));
        }
    }
    None
}

/// Tests that packets say the same to the interpreter, and that it sends the same frames.
fn agrees(protocol: &Protocol, id: u32, data: &[u8], frames: &[Frame]) {
    let mut assembly = Assembly::default();
    let taken = frames.iter().flat_map(|frame| {
        let decoded = decode(protocol, None, frame).expect("a frame of the protocol");
        assembly.take(protocol, None, (), frame, &decoded).ended
    });
    let taken: Vec<_> = taken.collect();
    let [whole] = taken.as_slice() else { panic!("{} messages", taken.len()) };
    assert_eq!((whole.frame.id, whole.data.as_deref()), (id, Some(data)));
    let again = encode_long(protocol, None, &Content::of_long(protocol, whole)).expect("what came can be sent");
    assert_eq!(again, frames);
}

#[derive(Default)]
struct Random {
    whole: usize,
    in_packets: usize,
}

impl Random {
    /// Sends random values as a kind of frame.
    fn send<L: Transferred + PartialEq + Debug>(&mut self, protocol: &Protocol, layout: &FrameLayout) {
        let (extent, blank) = (long::<L>(protocol).extent(layout), blank(protocol, layout));
        let sizes: Vec<_> = (1..=extent.longest()).filter(|size| extent.has_length(*size)).collect();
        let mut rng = Rng::with_seed(0x7247);
        let mut data = || {
            let size = *rng.choice(&sizes).expect("it has some size");
            std::iter::repeat_with(|| rng.u8(..)).take(size).collect::<Vec<_>>()
        };
        let all: Vec<_> = std::iter::repeat_with(&mut data).take(MESSAGES).collect();
        let sent: Vec<_> = all.par_iter().filter_map(|data| sent::<L>(protocol, layout, &blank, data)).collect();
        self.whole += sent.len();
        self.in_packets += sent.into_iter().filter(|is_in_packets| *is_in_packets).count();
    }
}

/// Sends values, and tells whether they went in packets. Those outside the limits of the charger are refused.
fn sent<L: Transferred + PartialEq + Debug>(
    protocol: &Protocol,
    layout: &FrameLayout,
    blank: &canspec_runtime::Frame,
    data: &[u8],
) -> Option<bool> {
    let values = L::decode(data).expect("it is long enough");
    let mut buffer = vec![0; L::LONGEST];
    let sender = values.sender(blank, &mut buffer).ok()?;
    let (whole, frames) = exchange(sender).expect("every packet came");
    // Frames of ISO-TP have the identifier of their message, with what the transport sends in it.
    let id = if is_joined(protocol, layout) { frames[0].id } else { blank.raw_id() };
    assert_eq!((whole.values(), raw_id(&whole)), (Some(values), id), "{}", L::MESSAGE);
    assert_eq!(whole.data().len(), data.len(), "{}", L::MESSAGE);
    let is_in_packets = frames.len() > 1 || is_joined(protocol, layout);
    if is_in_packets {
        agrees(protocol, id, whole.data(), &frames);
    }
    Some(is_in_packets)
}

/// Tests whether no frame is the message itself, however short it is.
fn is_joined(protocol: &Protocol, layout: &FrameLayout) -> bool {
    protocol.carried(layout).is_some_and(|(transport, _)| !transport.standard.has_plain_frames())
}

impl TransferredVisitor for Random {
    fn visit<L: Transferred + Optional + PartialEq + Debug>(&mut self, path: &str) {
        let protocol = protocol(path);
        let long = long::<L>(&protocol);
        let layouts = || long.frames.iter().filter(|layout| !layout.signals.is_empty());
        for layout in layouts() {
            let (extent, head) = (long.extent(layout), layout.head());
            let has_size = |size| L::has_size_with(head, size) == extent.has_length(size);
            assert!((0..=2 * L::LONGEST).all(has_size), "{path}");
            self.send::<L>(&protocol, layout);
        }
        assert!(layouts().all(|layout| long.extent(layout).longest() <= L::LONGEST), "{path}");
    }
}

#[test]
fn what_is_sent_is_received_by_both_engines_with_the_same_values() {
    let mut random = Random::default();
    visit_transferred(&mut random);
    let Random { whole, in_packets } = random;
    assert!(whole > 2_000 && in_packets > 1_500, "{whole} messages, {in_packets} in packets");
}

mod by_hand {
    use canspec_runtime::transfers::{Answer, Assembler, Cause, Reason, Transferred};
    use canspec_runtime::{Elements, Frame, Kind, LongLayout, Text};
    use canspec_tests::features_transport::{Battery, Profile, Target, Tp};
    use canspec_tests::features_transport_or_frame::{self as or_frame, Cells};

    /// Returns a frame of the vehicle to the charger.
    fn from_vehicle(format: u8, data: [u8; 8]) -> Frame {
        Frame::new_raw(0x1C00_56F4 | u32::from(format) << 16, true, data, 8)
    }

    /// 400 V, 180 Ah and 515 cycles, as the feature's spec works them out.
    fn battery() -> Battery {
        let maker = Text::new("ACME").expect("four letters");
        Battery { maker, voltage_v: 400.0, capacity_ah: 180.0, cycles: 515, year: None, month: None }
    }

    fn texts(frames: impl Iterator<Item = Frame>) -> Vec<String> {
        frames.map(|frame| frame.to_string()).collect()
    }

    #[test]
    fn a_receiver_answers_in_frames_with_the_priority_of_the_transport() {
        let mut assembler = Assembler::<Tp, 1>::new();
        let [begin, first, last] = [
            from_vehicle(0xEC, [0x10, 11, 0, 2, 1, 0, 2, 0]),
            from_vehicle(0xEB, [1, b'A', b'C', b'M', b'E', 0xA0, 0x0F, 0x08]),
            from_vehicle(0xEB, [2, 0x07, 3, 2, 0, 0xFF, 0xFF, 0xFF]),
        ];
        let events = [begin, first, last].map(|frame| assembler.receive(&frame, 0));
        let answers = events.map(|event| event.answer.map(|answer| answer.to_string()));
        let expected = ["1CECF456#110101FFFF000200", "1CECF456#110102FFFF000200", "1CECF456#130B0002FF000200"];
        assert_eq!(answers, expected.map(|answer| Some(answer.to_owned())));
        let whole = events[2].whole.expect("all packets came");
        assert_eq!((whole.values::<Battery>(), whole.values::<Profile>()), (Some(battery()), None));
        assert_eq!((whole.exchange().message(), whole.kind(), whole.data().len()), ("battery", Kind::Report, 11));
        // Its priority as one frame is that of the protocol.
        assert_eq!(whole.identifier().to_raw(), 0x1802_56F4);
    }

    #[test]
    fn a_message_is_the_same_struct_in_one_frame_and_in_packets() {
        let mut assembler = Assembler::<or_frame::Tp, 1>::new();
        let plain = Frame::new_raw(0x1815_56F4, true, [0x91, 0x01, 0x92, 0x11, 0, 0, 0, 0], 4);
        let whole = assembler.receive(&plain, 0).whole.expect("one frame is enough");
        let cells = whole.values::<Cells>().expect("two of them");
        assert_eq!((&*cells.voltage_v, &*cells.group), (&[4.01, 4.02][..], &[0, 1][..]));
        assert_eq!((whole.data(), whole.identifier().to_raw()), (&[0x91, 0x01, 0x92, 0x11][..], 0x1815_56F4));
        let mut buffer = [0; Cells::LONGEST];
        assert_eq!(texts(cells.sender(&plain, &mut buffer).expect("they fit")), ["181556F4#91019211"]);
        let five = Elements::from_slice(&[4.01, 4.02, 4.01, 4.01, 4.01]).expect("five of six");
        let group = Elements::from_slice(&[0, 1, 0, 0, 0]).expect("five of six");
        let mut sender = Cells { voltage_v: five, group }.sender(&plain, &mut buffer).expect("they fit");
        assert_eq!(texts(&mut sender), ["1CEC56F4#100A0002FF001500"], "then it waits for the receiver");
    }

    #[test]
    fn a_broadcast_is_sent_at_once_and_is_not_answered() {
        let blank = Frame::new_raw(0x1802_FFF4, true, [0; 8], 8);
        let values = Battery { year: Some(2022.0), month: Some(4), ..battery() };
        let mut buffer = [0; Battery::LONGEST];
        let sender = values.sender(&blank, &mut buffer).expect("it fits");
        assert_eq!(sender.abort(Reason::OTHER), None);
        let frames: Vec<_> = sender.collect();
        let expected = ["1CECFFF4#200E0002FF000200", "1CEBFFF4#0141434D45A00F08", "1CEBFFF4#02070302002504FF"];
        assert_eq!(texts(frames.iter().copied()), expected);
        let mut assembler = Assembler::<Tp, 1>::new();
        let events = frames.iter().map(|frame| assembler.receive(frame, 0)).collect::<Vec<_>>();
        assert!(events.iter().all(|event| event.answer.is_none()));
        assert_eq!(events[2].whole.and_then(|whole| whole.values()), Some(values));
    }

    #[test]
    fn the_charger_keeps_to_limits_and_to_modes() {
        let mut buffer = [0; Profile::LONGEST];
        let profile = Profile { current_a: [10.0, 20.0, 250.0, 0.0, 0.1] };
        let mut sender = profile.of_charger(Target::Peer, &mut buffer).expect("all is allowed");
        assert_eq!(texts(&mut sender), ["1CECF456#100A0002FF001600"]);
        let abort = sender.abort(Reason::RESOURCES).map(|frame| frame.to_string());
        assert_eq!(abort.as_deref(), Some("1CECF456#FF02FFFFFF001600"));
        let permission = |group| from_vehicle(0xEC, [0x11, 2, 1, 0xFF, 0xFF, 0, group, 0]);
        assert_eq!(sender.receive(&permission(2)), Answer::Other, "it is about another message");
        assert_eq!(sender.receive(&Frame::new_raw(0x1CEC_56F5, true, permission(0x16).bytes(), 8)), Answer::Other);
        assert_eq!(sender.receive(&permission(0x16)), Answer::Allowed(2));
        assert_eq!(texts(&mut sender), ["1CEBF456#016400C800C40900", "1CEBF456#02000100FFFFFFFF"]);
        let refused = |profile: &Profile, target| {
            let mut buffer = [0; Profile::LONGEST];
            profile.of_charger(target, &mut buffer).expect_err("a refusal").to_string()
        };
        let beyond = Profile { current_a: [0.0, 0.0, 250.1, 0.0, 0.0] };
        assert_eq!(refused(&beyond, Target::Peer), "`current` of `profile` is 250.1 A, but its limits are 0 and 250 A");
        assert_eq!(
            refused(&profile, Target::Everybody),
            "`profile` has no `of_charger` with the addressing mode `everybody`"
        );
        let blank = Frame::new_raw(0x1816_F456, true, [0; 8], 8);
        assert!(beyond.sender(&blank, &mut [0; Profile::LONGEST]).is_err(), "the identifier shows the charger");
        let short = profile.of_charger(Target::Peer, &mut [0; 9]).expect_err("ten bytes").to_string();
        assert_eq!(short, "`profile` has 10 data bytes, and the buffer has room for 9");
    }

    #[test]
    fn a_field_is_not_left_out_before_one_that_is_there() {
        let blank = Frame::new_raw(0x1802_56F4, true, [0; 8], 8);
        let values = Battery { month: Some(4), ..battery() };
        let mut buffer = [0; Battery::LONGEST];
        let error = values.sender(&blank, &mut buffer).expect_err("the year is missing").to_string();
        assert!(error.contains("`year` of `battery`"), "{error}");
    }

    #[test]
    fn a_message_that_the_transport_does_not_carry_ends_the_one_before() {
        let mut assembler = Assembler::<Tp, 1>::new();
        let begin = |group| from_vehicle(0xEC, [0x10, 11, 0, 2, 0xFF, 0, group, 0]);
        assert!(assembler.receive(&begin(2), 0).answer.is_some());
        let event = assembler.receive(&begin(0x77), 0);
        assert_eq!(event.broken.map(|broken| broken.cause), Some(Cause::Restarted));
        assert_eq!((event.answer, event.refused.is_none()), (None, true));
        // The charger's own message is none of the vehicle's.
        assert!(assembler.receive(&begin(0x16), 0).answer.is_none());
    }

    #[test]
    fn a_size_that_the_message_never_has_gives_no_values() {
        let mut assembler = Assembler::<Tp, 1>::new();
        let begin = from_vehicle(0xEC, [0x10, 12, 0, 2, 0xFF, 0, 2, 0]);
        let packets = [1, 2].map(|number| from_vehicle(0xEB, [number, 0, 0, 0, 0, 0, 0, 0]));
        let whole = [begin, packets[0], packets[1]].into_iter().find_map(|frame| assembler.receive(&frame, 0).whole);
        let whole = whole.expect("all packets came");
        assert_eq!((whole.values::<Battery>(), whole.data().len()), (None, 12));
    }

    #[test]
    fn a_silent_sender_is_given_up_in_a_frame() {
        let mut assembler = Assembler::<Tp, 1>::new();
        let _ = assembler.receive(&from_vehicle(0xEC, [0x10, 11, 0, 2, 0xFF, 0, 2, 0]), 1_000);
        assert!(assembler.timed_out(2_249).is_none());
        let event = assembler.timed_out(2_250).expect("it waits 1.25 s for the first packet");
        assert_eq!(event.broken.map(|broken| broken.cause), Some(Cause::Silent));
        assert_eq!(event.answer.map(|answer| answer.to_string()).as_deref(), Some("1CECF456#FF03FFFFFF000200"));
    }
}

/// The greatest message of a charging is that of 256 cells: 512 bytes in 74 packets, and a bit for each packet.
#[test]
fn there_is_memory_for_the_longest_message() {
    let longest = protocol(specs_of("gbt27930.yaml")).long_messages.iter().map(LongMessage::longest).max();
    let packets = longest.expect("it has long messages").div_ceil(7);
    assert_eq!(size_of::<<gbt27930::Tp as Transport>::Memory>(), packets * 7 + packets.div_ceil(8));
}

fn specs_of(name: &str) -> std::path::PathBuf {
    canspec_tests::specs("specs").into_iter().find(|path| path.ends_with(name)).expect("it ships")
}
