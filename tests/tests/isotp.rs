//! Transfers by ISO-TP of many units at once, where frames are lost, repeated and late. Both engines report the same
//! messages, and each whole one was sent.

use std::collections::VecDeque;

use canspec_codegen::interpret::{Assembled, Assembly, Form, Frame, decode};
use canspec_codegen::model::Protocol;
use canspec_runtime::isotp;
use canspec_runtime::transfers::{Assembler, Event, Transport};
use canspec_runtime::{Exchange, Kind};
use canspec_tests::devices_units::{Calibration, IdleSpeed, Message, Refused, Tp};
use canspec_tests::{received, specs};
use fastrand::Rng;

/// Room for longer messages than the protocol has, so that a wrong size is seen.
type Room = [u8; isotp::memory(60)];

fn protocol() -> Protocol {
    let path = specs("tests/specs/devices").into_iter().find(|path| path.ends_with("units.yaml"));
    canspec_tests::protocol(path.expect("the spec of the units"))
}

/// A message between the tester and a unit.
#[derive(Clone, Debug, PartialEq)]
struct Transfer {
    unit: u32,
    is_to_unit: bool,
    data: Vec<u8>,
}

/// Frames of ISO 15765-2, written byte by byte.
impl Transfer {
    fn new(unit: u32, rng: &mut Rng) -> Self {
        let is_to_unit = rng.bool();
        // The services that carry values, and those that do not.
        let [full, bare] = if is_to_unit { [0x2E, 0x22] } else { [0x62, 0x6E] };
        let (head, count) = match rng.u8(..10) {
            0..=4 => (vec![full, 0xF1, 0x90], 11),
            5 => (vec![full, 0xF1, 0x91], 2),
            6 => (vec![bare, 0xF1, 0x90], 0),
            7 => (vec![0x7F], 2),
            // A size that the message never has.
            8 => (vec![*rng.choice(&[full, bare]).expect("there are two"), 0xF1, 0x90], rng.usize(..20)),
            // Data of no message.
            _ => (vec![full, 0xF1, 0x99], rng.usize(..12)),
        };
        let rest: Vec<u8> = (0..count).map(|_| rng.u8(..)).collect();
        Self { unit, is_to_unit, data: [head, rest].concat() }
    }

    fn frame(&self, is_to_unit: bool, data: Vec<u8>) -> Frame {
        let id = if is_to_unit { 0x7E0 } else { 0x7E8 } | self.unit;
        Frame { id, extended: false, data, form: Form::Data }
    }

    /// The frames of the sender, filled up with any bytes or not at all.
    fn packets(&self, rng: &mut Rng) -> Vec<Frame> {
        let mut filled = |mut data: Vec<u8>| {
            if rng.bool() {
                data.resize_with(8, || rng.u8(..));
            }
            self.frame(self.is_to_unit, data)
        };
        let size = byte(self.data.len());
        if size <= 7 {
            return vec![filled([&[size], &self.data[..]].concat())];
        }
        let (beginning, rest) = self.data.split_at(6);
        let first = filled([&[0x10, size], beginning].concat());
        let others = (1..).zip(rest.chunks(7));
        let others = others.map(|(number, chunk)| filled([&[0x20 | byte(number % 16)], chunk].concat()));
        std::iter::once(first).chain(others.collect::<Vec<_>>()).collect()
    }

    /// The first frame of a message whose size stands in four bytes, and others. It is too long, or a receiver ignores
    /// the first frame, and there are no others.
    fn too_long(&self, rng: &mut Rng) -> Vec<Frame> {
        let size = rng.u32(4090..4110);
        let first = [&[0x10, 0], &size.to_be_bytes()[..], &self.data[..2]].concat();
        let count = if size > 4095 { rng.u8(0..4) } else { 0 };
        let others = (1..=count).map(|number| [vec![0x20 | number], vec![number; 7]].concat());
        std::iter::once(first).chain(others).map(|data| self.frame(self.is_to_unit, data)).collect()
    }

    /// What the nodes put on the bus, and whether some of it is lost. Some frames are late or repeated. The receiver
    /// answers, or does not.
    ///
    /// Behind a message that is not whole, nobody could tell that the first frame of the next one is lost.
    fn frames(&self, is_first_safe: bool, rng: &mut Rng) -> (Vec<Frame>, bool) {
        let (mut frames, mut is_spoiled) = (Vec::new(), false);
        for (index, packet) in self.packets(rng).into_iter().enumerate() {
            match rng.u8(..16) {
                0 if index > 0 || !is_first_safe => is_spoiled = true,
                1 => frames.extend([packet.clone(), packet]),
                2 if frames.len() > 1 => frames.insert(frames.len() - 1, packet),
                _ => frames.push(packet),
            }
        }
        let status = *rng.choice(&[0x30, 0x30, 0x30, 0x30, 0x31, 0x32, 0x35]).expect("it is not empty");
        if frames.len() > 1 && rng.u8(..4) > 0 {
            frames.insert(1, self.frame(!self.is_to_unit, vec![status, 0, 0]));
        }
        (frames, is_spoiled)
    }
}

fn byte(number: usize) -> u8 {
    u8::try_from(number).expect("it is small")
}

/// Several units at once, each with its own messages in both directions.
fn log(rng: &mut Rng) -> (Vec<Frame>, Vec<Transfer>) {
    let (mut sent, mut queues, mut log) = (Vec::new(), Vec::new(), Vec::new());
    for unit in 0..rng.u32(1..=8) {
        let (mut queue, mut spoiled) = (VecDeque::new(), [false; 2]);
        for _ in 0..rng.usize(1..6) {
            let transfer = Transfer::new(unit, rng);
            let direction = usize::from(transfer.is_to_unit);
            let (frames, is_spoiled) = transfer.frames(spoiled[direction], rng);
            spoiled[direction] = is_spoiled;
            queue.extend(frames);
            if rng.u8(..8) == 0 {
                queue.extend(transfer.too_long(rng));
                spoiled[direction] = true;
            }
            sent.push(transfer);
        }
        queues.push(queue);
    }
    while let Some(index) = (!queues.is_empty()).then(|| rng.usize(..queues.len())) {
        match queues[index].pop_front() {
            Some(frame) => log.push(frame),
            None => drop(queues.swap_remove(index)),
        }
    }
    (log, sent)
}

/// What an engine says of a message: who sends it, its name and kind if it is right, and its data if all came.
type Told = (u32, Option<(String, Kind)>, Option<Vec<u8>>);

fn of_interpreter(protocol: &Protocol, ended: &Assembled<()>) -> Told {
    let name = protocol[ended.decoded.message].name.clone();
    let kind = match ended.decoded.kind {
        canspec_codegen::model::Kind::Request => Kind::Request,
        canspec_codegen::model::Kind::Reply => Kind::Reply,
        canspec_codegen::model::Kind::Report => Kind::Report,
    };
    (ended.frame.id, ended.data.is_some().then_some((name, kind)), ended.data.clone())
}

/// The exchanges of the spec that have a frame without values.
const BARE: [(&Exchange, Kind); 4] = [
    (&Calibration::READ, Kind::Request),
    (&Calibration::WRITE, Kind::Reply),
    (&IdleSpeed::READ, Kind::Request),
    (&IdleSpeed::WRITE, Kind::Reply),
];

fn of_generated(event: &Event<Tp, Room>) -> Vec<Told> {
    let Event { whole, broken, refused, .. } = event;
    assert!(refused.as_ref().is_none_or(|refused| refused.transfer.size() > 4095), "there is room for all others");
    let broken = broken.as_ref().map(|broken| (broken.transfer.link.id(), None, None));
    let whole = whole.as_ref().map(|whole| {
        let values = [
            whole.values::<Calibration>().is_some(),
            whole.values::<IdleSpeed>().is_some(),
            whole.values::<Refused>().is_some(),
            BARE.iter().any(|(exchange, kind)| whole.is_bare(exchange, *kind)),
        ];
        let known = values.iter().filter(|is_it| **is_it).count();
        assert!(known < 2, "{whole:?}");
        let message = (known > 0).then(|| (whole.exchange().message().to_owned(), whole.kind()));
        (whole.identifier().to_raw(), message, (known > 0).then(|| whole.data().to_vec()))
    });
    broken.into_iter().chain(whole).collect()
}

/// Tests that an answer lets all frames come unless they are too many, and comes from the receiver.
fn check_answer(frame: &Frame, answer: Option<canspec_runtime::Frame>) {
    let is_announced = frame.data[0] >> 4 == 1;
    let Some(answer) = answer else { return };
    assert!(is_announced, "only a first frame is answered: {frame:X?}");
    let status = if frame.data[..2] == [0x10, 0] { 0x32 } else { 0x30 };
    assert_eq!(answer, canspec_runtime::Frame::new_raw(frame.id ^ 8, false, [status, 0, 0, 0, 0, 0, 0, 0], 8));
}

#[test]
fn both_engines_report_the_same_messages_and_each_whole_one_was_sent() {
    let protocol = protocol();
    let (mut whole, mut others, mut answers) = (0, 0, 0);
    for seed in 0..3_000 {
        let mut rng = Rng::with_seed(seed);
        let (log, sent) = log(&mut rng);
        let (mut assembly, mut assembler) = (Assembly::default(), Assembler::<Tp, 16, Room>::new());
        for frame in &log {
            let Ok(decoded) = decode(&protocol, None, frame) else {
                assert!(received::<Message>(None, frame).is_err(), "{frame:X?}");
                continue;
            };
            let ended = assembly.take(&protocol, None, (), frame, &decoded).ended;
            let received = received::<Message>(None, frame).expect("both engines know the frame");
            let event = assembler.take(&received, 0);
            check_answer(frame, event.answer);
            answers += usize::from(event.answer.is_some());
            let expected: Vec<_> = ended.iter().map(|ended| of_interpreter(&protocol, ended)).collect();
            let told = of_generated(&event);
            assert_eq!(told, expected, "seed {seed}: {frame:X?}");
            for (id, _, data) in told {
                let Some(data) = data else {
                    others += 1;
                    continue;
                };
                let transfer = Transfer { unit: id & 7, is_to_unit: id & 8 == 0, data };
                assert!(sent.contains(&transfer), "seed {seed}: nobody sent {transfer:X?}");
                whole += 1;
            }
        }
        let mut left: Vec<_> = assembly.finish(&protocol, None).iter().map(|ended| ended.frame.id).collect();
        let silent = std::iter::from_fn(|| assembler.timed_out(1_000)?.broken);
        let mut silent: Vec<_> = silent.map(|broken| broken.transfer.link.id()).collect();
        left.sort_unstable();
        silent.sort_unstable();
        assert_eq!(silent, left, "seed {seed}: what is open is the same");
    }
    assert!(whole > 15_000 && others > 5_000 && answers > 10_000, "{whole} whole, {others} others, {answers} answers");
}

/// 43 data bytes come in a first frame with 6 of them and in 6 others. Seven bytes are kept of each, and a bit.
#[test]
fn there_is_memory_for_the_longest_message() {
    assert_eq!(size_of::<<Tp as Transport>::Memory>(), 7 * 7 + 1);
}

mod by_hand {
    use canspec_runtime::isotp::{Answer, Cause, Separation};
    use canspec_runtime::transfers::{Assembler, Sender, Transferred};
    use canspec_runtime::{Elements, Frame, Kind, LongLayout, Text};
    use canspec_tests::devices_units::{
        self as units, Calibration, Counters, Identifier, IdleSpeed, Limits, Refused, Service, Target, Tp,
    };
    use canspec_tests::features_isotp::{self as functional, Maker, Restart};

    /// Reads a frame as logs write it.
    fn frame(text: &str) -> Frame {
        let (id, digits) = text.split_once('#').expect("an identifier and data");
        let pairs = digits.as_bytes().chunks(2).map(|pair| std::str::from_utf8(pair).expect("it is ASCII"));
        let bytes: Vec<_> = pairs.map(|pair| u8::from_str_radix(pair, 16).expect("two digits")).collect();
        let mut data = [0; 8];
        data[..bytes.len()].copy_from_slice(&bytes);
        let length = u8::try_from(bytes.len()).expect("up to eight");
        Frame::new_raw(u32::from_str_radix(id, 16).expect("hexadecimal"), id.len() == 8, data, length)
    }

    fn texts(frames: impl Iterator<Item = Frame>) -> Vec<String> {
        frames.map(|frame| frame.to_string()).collect()
    }

    /// 1000 rpm, 10, 30, 50 and 0 A, day 9, as the feature's spec has them.
    fn calibration() -> Calibration {
        Calibration { speed_rpm: 1000, current_a: [10.0, 30.0, 50.0, 0.0], day: 9 }
    }

    #[test]
    fn a_tester_writes_values_and_the_unit_answers_without_any() {
        let mut buffer = [0; Calibration::LONGEST];
        let mut tester = calibration().write(Target::Unit(0), &mut buffer).expect("all is allowed");
        let mut unit = Assembler::<Tp, 1>::new();
        assert_eq!(texts(&mut tester), ["7E0#100E2EF19003E800"], "then it waits");
        let answer = unit.receive(&frame("7E0#100E2EF19003E800"), 0).answer.expect("there is room");
        assert_eq!(answer.to_string(), "7E8#3000000000000000");
        assert_eq!(tester.receive(&frame("7E9#3000000000000000")), Answer::Other, "another unit");
        assert_eq!(tester.receive(&frame("7E0#3000000000000000")), Answer::Other, "another tester");
        assert_eq!(tester.receive(&answer), Answer::Allowed(Separation(0)));
        let rest: Vec<_> = tester.collect();
        assert_eq!(texts(rest.iter().copied()), ["7E0#2164012C01F40000", "7E0#2209000000000000"]);
        let whole = rest.iter().find_map(|frame| unit.receive(frame, 0).whole).expect("all came");
        assert_eq!((whole.values(), whole.values::<IdleSpeed>()), (Some(calibration()), None));
        assert_eq!((whole.exchange().access(), whole.kind()), ("write", Kind::Request));
        let blank = Calibration::WRITE.filter(Kind::Reply).expect("it is answered");
        let blank = blank.id(Identifier::DIRECTION, 0xFD).id(Identifier::UNIT, 3).frame(8);
        let answer = Sender::<Tp>::bare(&blank).expect("the answer has no values");
        assert_eq!(texts(answer), ["7EB#036EF19000000000"]);
        assert!(calibration().sender(&blank, &mut buffer).is_err(), "the answer has no values");
    }

    #[test]
    fn a_sender_says_whether_it_waits_or_is_done() {
        let mut buffer = [0; Calibration::LONGEST];
        let mut tester = calibration().write(Target::Unit(0), &mut buffer).expect("all is allowed");
        assert_eq!((tester.is_waiting(), tester.is_done()), (false, false), "it has not begun");
        assert_eq!((&mut tester).count(), 1);
        assert_eq!((tester.is_waiting(), tester.is_done()), (true, false));
        let mut refused = tester.clone();
        assert_eq!(refused.receive(&frame("7E8#3200000000000000")), Answer::Overflow);
        assert_eq!((refused.next(), refused.is_waiting(), refused.is_done()), (None, false, false), "it is refused");
        let _ = tester.receive(&frame("7E8#3001000000000000"));
        assert_eq!((tester.is_waiting(), tester.is_done()), (false, false), "a block of one frame");
        assert_eq!((&mut tester).count(), 1);
        assert_eq!((tester.is_waiting(), tester.is_done()), (true, false), "it asks for the next block");
        let _ = tester.receive(&frame("7E8#3000000000000000"));
        assert_eq!((&mut tester).count(), 1);
        assert_eq!((tester.is_waiting(), tester.is_done()), (false, true));
        let mut bare = Calibration::read(Target::Unit(2)).expect("it is allowed");
        assert_eq!((bare.is_waiting(), bare.is_done()), (false, false));
        assert_eq!((bare.next().is_some(), bare.is_waiting(), bare.is_done()), (true, false, true));
    }

    #[test]
    fn what_is_asked_is_told_from_what_is_answered_by_its_constants() {
        let asked = texts(Calibration::read(Target::Unit(2)).expect("it is allowed"));
        assert_eq!(asked, ["7E2#0322F19000000000"]);
        let mut unit = Assembler::<Tp, 1>::new();
        let whole = unit.receive(&frame(&asked[0]), 0).whole.expect("it is one frame");
        assert!(whole.is_bare(&Calibration::READ, Kind::Request) && whole.values::<Calibration>().is_none());
        assert!(!whole.is_bare(&Calibration::READ, Kind::Reply) && !whole.is_bare(&IdleSpeed::READ, Kind::Request));
        let longer = unit.receive(&frame("7E2#0422F19000000000"), 0).whole.expect("it is one frame");
        assert!(!longer.is_bare(&Calibration::READ, Kind::Request), "it does not end with its constants");
        let refused = unit.receive(&frame("7EA#037F2231CCCCCCCC"), 0).whole.expect("it is one frame");
        let reason = units::Reason::OutOfRange;
        assert_eq!(refused.values(), Some(Refused { refused: Service::Read, reason }));
    }

    #[test]
    fn the_tester_keeps_to_limits_and_the_blank_frame_shows_the_message() {
        let mut buffer = [0; Calibration::LONGEST];
        let beyond = Calibration { speed_rpm: 2001, ..calibration() };
        let error = beyond.write(Target::Unit(0), &mut buffer).expect_err("too fast").to_string();
        assert_eq!(error, "`speed` of `calibration` is 2001 rpm, but its limits are 500 and 2000 rpm");
        let reply = frame("7E8#62F190");
        assert!(beyond.sender(&reply, &mut buffer).is_ok(), "a unit says what it has");
        let error = calibration().sender(&frame("7E8#62F191"), &mut buffer).expect_err("idle speed").to_string();
        assert_eq!(error, "the identifier 0x7E8 is none of `calibration`");
        assert!(calibration().sender(&frame("7E0#62F190"), &mut buffer).is_err(), "a unit does not write");
        let short = calibration().sender(&reply, &mut [0; 13]).expect_err("14 bytes").to_string();
        assert_eq!(short, "`calibration` has 14 data bytes, and the buffer has room for 13");
    }

    #[test]
    fn a_receiver_without_room_says_so_and_a_silent_sender_is_given_up() {
        let mut units = Assembler::<Tp, 1>::new();
        assert!(units.receive(&frame("7E8#100E62F19003E800"), 1_000).answer.is_some());
        let event = units.receive(&frame("7E9#100E62F19003E800"), 1_000);
        assert_eq!(event.refused.map(|refused| refused.cause), Some(Cause::Full));
        assert_eq!(event.answer.map(|answer| answer.to_string()).as_deref(), Some("7E1#3200000000000000"));
        assert!(units.timed_out(1_999).is_none());
        let silent = units.timed_out(2_000).and_then(|event| event.broken).expect("it waits a second");
        assert_eq!((silent.cause, silent.transfer.link.id()), (Cause::Silent, 0x7E8));
        assert_eq!(silent.transfer.data(), [0x62, 0xF1, 0x90, 0x03, 0xE8, 0x00]);
    }

    #[test]
    fn a_receiver_can_ask_for_blocks_with_time_between_the_frames() {
        let mut units = Assembler::<Tp, 1>::new().pacing(1, Separation(10));
        let frames = ["7E8#100E62F19003E800", "7E8#2164012C01F40000", "7E8#2209000000000000"].map(frame);
        let events = frames.map(|frame| units.receive(&frame, 0));
        let answers = events.map(|event| event.answer.map(|answer| answer.to_string()));
        let answer = Some("7E0#30010A0000000000".to_owned());
        assert_eq!(answers, [answer.clone(), answer, None]);
    }

    /// A size of more than twelve bits stands in four bytes of its own; here 0x1000.
    #[test]
    fn a_message_that_is_too_long_ends_the_one_before_it_and_overflows() {
        let mut units = Assembler::<Tp, 1>::new();
        let _ = units.receive(&frame("7E8#100E62F19003E800"), 0);
        let event = units.receive(&frame("7E8#10000000100062F1"), 0);
        assert_eq!(event.broken.map(|broken| broken.cause), Some(Cause::Restarted));
        assert_eq!(event.refused.map(|refused| (refused.cause, refused.transfer.size())), Some((Cause::Full, 0x1000)));
        assert_eq!(event.answer.map(|answer| answer.to_string()).as_deref(), Some("7E0#3200000000000000"));
        let event = units.receive(&frame("7E8#2164012C01F40000"), 0);
        assert!(event.whole.is_none() && event.broken.is_none(), "nothing is on its way");
    }

    #[test]
    fn what_is_too_long_and_of_no_message_ends_the_one_before_it_without_an_answer() {
        let mut units = Assembler::<Tp, 1>::new();
        let _ = units.receive(&frame("7E8#100E62F19003E800"), 0);
        let event = units.receive(&frame("7E8#100000001000AABB"), 0);
        assert_eq!(event.broken.map(|broken| broken.cause), Some(Cause::Restarted));
        assert!(event.refused.is_none() && event.answer.is_none());
    }

    #[test]
    fn a_size_that_twelve_bits_have_room_for_changes_nothing_in_four_bytes() {
        let mut units = Assembler::<Tp, 1>::new();
        let _ = units.receive(&frame("7E8#100E62F19003E800"), 0);
        let event = units.receive(&frame("7E8#100000000FFF62F1"), 0);
        assert!(event.broken.is_none() && event.refused.is_none() && event.answer.is_none());
        assert!(units.receive(&frame("7E8#2164012C01F40000"), 0).broken.is_none(), "it goes on");
    }

    /// A unit's answer to a request to all shows only the unit. It is allowed in the mode that goes to one.
    #[test]
    fn the_answer_of_one_unit_to_a_request_to_all_is_allowed_to_that_unit() {
        let mut tester = Assembler::<functional::Tp, 4>::new();
        let event = tester.receive(&frame("1CDA0005#100C61001041434D"), 0);
        let allowed = event.answer.expect("it is a message of the protocol");
        assert_eq!(allowed.to_string(), "1CDA05F1#300000");
        let event = tester.receive(&frame("1CDA0005#214520434F5250"), 0);
        let name = event.whole.and_then(|whole| whole.values::<Maker>()).expect("it is whole").name;
        assert_eq!(Some(name), Text::new("ACME CORP"));
        let mut buffer = [0; Maker::LONGEST];
        let mut unit = Maker { name }.sender(&frame("1CDA0005#610010"), &mut buffer).expect("it fits");
        assert_eq!(texts(&mut unit), ["1CDA0005#100C61001041434D"]);
        assert_eq!(unit.receive(&allowed), Answer::Allowed(Separation(0)));
        assert_eq!(texts(&mut unit), ["1CDA0005#214520434F5250"]);
    }

    #[test]
    fn an_error_reply_has_no_values() {
        let mut tester = Assembler::<functional::Tp, 1>::new();
        let whole = |text: &str, tester: &mut Assembler<functional::Tp, 1>| tester.receive(&frame(text), 0).whole;
        let good = whole("1CDA0005#056100104143", &mut tester).expect("one frame");
        assert!(!good.is_error_reply() && good.values::<Maker>().is_some());
        let bad = whole("1CDA0005#056103104143", &mut tester).expect("one frame");
        assert!(bad.is_error_reply() && bad.values::<Maker>().is_none());
    }

    #[test]
    fn lengths_and_elements_vary() {
        let mut buffer = [0; Limits::LONGEST];
        assert_eq!([Limits::LONGEST, Counters::LONGEST, Maker::LONGEST], [43, 9, 24]);
        let current_a = Elements::from_slice(&[100, 300]).expect("two of twenty");
        let sender = Limits { current_a }.write(Target::Unit(5), &mut buffer).expect("it is allowed");
        assert_eq!(texts(sender), ["7E5#072EF1920064012C"]);
        let starts = Counters { starts: 7, hours: None };
        let sender = starts.sender(&frame("7E8#62F193"), &mut buffer).expect("it fits");
        assert_eq!(texts(sender), ["7E8#0562F19300070000"]);
        let mut tester = Assembler::<Tp, 1>::new();
        let none = tester.receive(&frame("7E8#0362F19200000000"), 0).whole.expect("it is one frame");
        assert_eq!(none.values::<Limits>(), None, "there is one limit at least");
    }

    #[test]
    fn a_message_can_have_no_fields() {
        assert_eq!(texts(Restart::reset(functional::Target::All).expect("to all")), ["1CDB33F1#021100"]);
        let mut tester = Assembler::<functional::Tp, 1>::new();
        let restarted = tester.receive(&frame("1CDA0005#025100"), 0).whole.expect("one frame");
        assert!(restarted.is_bare(&Restart::RESET, Kind::Reply));
    }
}
