//! Transfers of ISO-TP, written by hand, and what can go wrong with them.

use std::string::String;
use std::vec::Vec;

use embedded_can::{ExtendedId, Id, StandardId};

use super::*;
use crate::tests::random::Random;

fn standard(id: u16) -> Id {
    Id::Standard(StandardId::new(id).expect("eleven bits"))
}

/// The first engine and a tester, as OBD numbers them.
fn engine() -> Link {
    Link { source: standard(0x7E8), target: standard(0x7E0) }
}

type Memory = [u8; memory(4095)];

fn bytes(text: &str) -> Vec<u8> {
    (0..text.len() / 2).map(|at| u8::from_str_radix(&text[2 * at..2 * at + 2], 16).expect("two digits")).collect()
}

fn hex(data: &[u8]) -> String {
    data.iter().map(|byte| std::format!("{byte:02X}")).collect::<Vec<_>>().concat()
}

/// What became of a message: its data, or why there are no more.
type Told = Result<Vec<u8>, (Cause, Vec<u8>)>;

/// Gives frames of the engine to an assembler; returns what became of messages, and what it answers.
fn fed<M: super::Memory, const N: usize>(assembler: &mut Assembler<M, N>, frames: &[&str]) -> (Vec<Told>, Vec<String>) {
    let (mut told, mut answers) = (Vec::new(), Vec::new());
    for frame in frames {
        let event = assembler.receive(engine(), &bytes(frame), 0);
        let broken = event.broken.into_iter().chain(event.refused);
        told.extend(broken.map(|broken| Err((broken.cause, broken.transfer.data().to_vec()))));
        told.extend(event.whole.map(|transfer| Ok(transfer.data().to_vec())));
        answers.extend(event.answer.map(|(link, packet)| {
            assert_eq!(link, engine().reversed());
            hex(packet.data())
        }));
    }
    (told, answers)
}

fn assembler() -> Assembler<Memory, 1> {
    Assembler::new()
}

/// Mode 9 of OBD, the number of a vehicle: a service, an item, a count and 17 letters.
const VIN: [&str; 3] = ["1014490201314434", "2147503030523535", "2242313233343536"];
const VIN_DATA: &str = "4902013144344750303052353542313233343536";

#[test]
fn a_message_of_three_frames_comes_over() {
    let (told, answers) = fed(&mut assembler(), &VIN);
    assert_eq!((told, answers), ([Ok(bytes(VIN_DATA))].into(), ["300000CCCCCCCCCC".into()].into()));
    let data = bytes(VIN_DATA);
    let mut sender = Sender::new(&data).expect("20 bytes");
    assert_eq!(sender.next().map(|packet| hex(packet.data())).as_deref(), Some(VIN[0]));
    assert!(sender.is_waiting() && !sender.is_done() && sender.next().is_none());
    assert_eq!(sender.control(&bytes("300000")), Answer::Allowed(Separation(0)));
    assert_eq!(sender.by_ref().map(|packet| hex(packet.data())).collect::<Vec<_>>(), VIN[1..]);
    assert!(sender.is_done() && !sender.is_waiting());
}

#[test]
fn up_to_seven_bytes_are_one_frame() {
    for (data, frame, padded) in [
        ("3E", "013E", "013ECCCCCCCCCCCC"),
        ("22F190", "0322F190", "0322F190CCCCCCCC"),
        ("01020304050607", "0701020304050607", "0701020304050607"),
    ] {
        let data = bytes(data);
        let sender = Sender::new(&data).expect("1 to 7 bytes");
        let sent = |padding| sender.clone().padded(padding).map(|packet| hex(packet.data())).collect::<Vec<_>>();
        assert_eq!((sent(None), sent(Some(PADDING))), ([frame.into()].into(), [padded.into()].into()));
        assert_eq!(sender.clone().map(|packet| hex(packet.data())).collect::<Vec<_>>(), [padded]);
        for frame in [frame, padded] {
            assert_eq!(fed(&mut assembler(), &[frame]), ([Ok(data.clone())].into(), Vec::new()));
        }
    }
}

#[test]
fn every_size_comes_over_in_blocks_of_any_length() {
    let data: Vec<_> = (0..4095_u32).map(|index| index.to_le_bytes()[0] ^ index.to_le_bytes()[1]).collect();
    for size in SIZES {
        let block = [0, 1, 7, 255][size % 4];
        let mut assembler = assembler().pacing(block, Separation(5)).padded(None);
        let mut sender = Sender::new(&data[..size]).expect("a size that travels so").padded(None);
        let (mut whole, mut frames, mut answers) = (None, 0, 0);
        while let Some(packet) = sender.next() {
            frames += 1;
            let event = assembler.receive(engine(), packet.data(), 0);
            assert!(event.broken.is_none() && event.refused.is_none());
            whole = whole.or(event.whole.map(|transfer| transfer.data().to_vec()));
            if let Some((_, answer)) = event.answer {
                answers += 1;
                assert_eq!(answer.data(), [0x30, block, 5]);
                assert_eq!(sender.control(answer.data()), Answer::Allowed(Separation(5)), "{size}");
            }
        }
        assert_eq!(whole.as_deref(), Some(&data[..size]), "{size}");
        let consecutive = if size <= 7 { 0 } else { (size - 6).div_ceil(7) };
        assert_eq!(frames, 1 + consecutive, "{size}");
        let block = if block == 0 { usize::MAX } else { block.into() };
        assert_eq!(answers, if size <= 7 { 0 } else { 1 + (consecutive - 1) / block }, "{size}");
    }
    assert!(Sender::new(&[]).is_none() && Sender::new(&[0; 4096]).is_none());
}

#[test]
fn numbers_start_again_behind_fifteen() {
    let data = [0; 120];
    let mut sender = Sender::new(&data).expect("120 bytes");
    // 120 = 6 + 16 * 7 + 2.
    let first = sender.next().expect("a first frame");
    assert_eq!(first.data()[..2], [0x10, 120]);
    _ = sender.control(&[0x30, 0, 0]);
    let numbers: Vec<_> = sender.map(|packet| packet.data()[0]).collect();
    assert_eq!(hex(&numbers), "2122232425262728292A2B2C2D2E2F2021");
}

#[test]
fn what_a_receiver_has_to_ignore_changes_nothing() {
    let ignored = [
        "",                 // no data
        "00",               // a single frame without data
        "0801020304050607", // a single frame of eight bytes
        "03AABB",           // a single frame that ends too early
        "080102030405060708",
        "210102030405060708", // frames of nine bytes
        "1007010203040506",   // a message of seven bytes that is no single frame
        "10140102030405",     // a first frame of seven bytes
        "1001000100000102",   // a message of one byte that is no single frame
        "100000000FFF0102",   // 4,095 bytes, with the size of a longer message
        "2101020304050607",   // no first frame
        "30",
        "3000", // flow controls without their times
        "40",
        "FF", // kinds that do not exist
    ];
    for frame in ignored {
        assert_eq!(fed(&mut assembler(), &[frame]), (Vec::new(), Vec::new()), "{frame}");
        let among = [VIN[0], VIN[1], frame, VIN[2]];
        let lost = Err((Cause::Number(1), bytes("49020131443447503030523535")));
        let expected = if frame == "2101020304050607" { lost } else { Ok(bytes(VIN_DATA)) };
        assert_eq!(fed(&mut assembler(), &among).0, [expected], "{frame}");
    }
}

#[test]
fn a_frame_that_is_missing_late_or_repeated_breaks_the_message() {
    let came = bytes("490201314434");
    assert_eq!(fed(&mut assembler(), &[VIN[0], VIN[2]]).0, [Err((Cause::Number(2), came.clone()))]);
    assert_eq!(fed(&mut assembler(), &[VIN[0], VIN[2], VIN[1]]).0, [Err((Cause::Number(2), came))]);
    let more = bytes("49020131443447503030523535");
    assert_eq!(fed(&mut assembler(), &[VIN[0], VIN[1], VIN[1], VIN[2]]).0, [Err((Cause::Number(1), more))]);
}

#[test]
fn a_frame_that_ends_too_early_counts_as_missing() {
    let (told, _) = fed(&mut assembler(), &[VIN[0], "21475030", VIN[1], VIN[2]]);
    assert_eq!(told, [Ok(bytes(VIN_DATA))]);
    // The last frame of eight bytes has two of them.
    let (told, _) = fed(&mut assembler(), &["1008010203040506", "2107", "210708"]);
    assert_eq!(told, [Ok(bytes("0102030405060708"))]);
}

#[test]
fn a_message_that_begins_anew_ends_the_one_before() {
    let broken = Err((Cause::Restarted, bytes("490201314434")));
    let (told, answers) = fed(&mut assembler(), &[VIN[0], VIN[0], VIN[1], VIN[2]]);
    assert_eq!((told, answers.len()), ([broken.clone(), Ok(bytes(VIN_DATA))].into(), 2));
    assert_eq!(fed(&mut assembler(), &[VIN[0], "017E", VIN[1]]).0, [broken, Ok(bytes("7E"))]);
}

#[test]
fn a_message_without_room_is_refused() {
    let full = |data: &str| (Vec::from([Err((Cause::Full, bytes(data)))]), Vec::from(["320000".into()]));
    let unpadded = || assembler().padded(None);
    // 4,096 bytes, as edition 2016 of the standard allows them.
    assert_eq!(fed(&mut unpadded(), &["1000000010000102"]).0.len(), 1);
    assert_eq!(fed(&mut unpadded(), &["1000000010000102"]).1, ["320000"]);
    let mut small = Assembler::<[u8; memory(13)], 1>::new().padded(None);
    assert_eq!(fed(&mut small, &["100E010203040506", "2107080910111213"]), full(""));
    assert_eq!(fed(&mut small, &["100D010203040506", "2107080910111213"]).0, [Ok(bytes("01020304050607080910111213"))]);
    let mut none = Assembler::<Memory, 0>::new().padded(None);
    assert_eq!(fed(&mut none, &VIN), full("490201314434"));
    assert_eq!(fed(&mut none, &["013E"]).0, [Ok(bytes("3E"))], "a single frame needs no session");
    let mut tiny = Assembler::<[u8; memory(1) - 1], 1>::new();
    assert_eq!(fed(&mut tiny, &["013E"]), (Vec::from([Err((Cause::Full, Vec::new()))]), Vec::new()));
}

#[test]
fn a_silent_sender_is_given_up() {
    let mut assembler = assembler();
    _ = assembler.receive(engine(), &bytes(VIN[0]), 10);
    assert!(assembler.timed_out(9).is_none() && assembler.timed_out(1009).is_none());
    _ = assembler.receive(engine(), &bytes(VIN[1]), 1009);
    assert!(assembler.timed_out(2008).is_none());
    // A listener hears that the receiver asks the sender to wait.
    _ = assembler.receive(engine().reversed(), &bytes("310000"), 2008);
    assert!(assembler.timed_out(3007).is_none());
    let event = assembler.timed_out(3008).expect("N_Cr is over");
    let broken = event.broken.expect("a message");
    assert_eq!((broken.cause, broken.transfer.size(), broken.transfer.data().len()), (Cause::Silent, 20, 13));
    assert!(event.answer.is_none() && assembler.timed_out(9999).is_none());
}

#[test]
fn a_frame_that_comes_too_late_gives_its_message_up() {
    let mut assembler = assembler();
    _ = assembler.receive(engine(), &bytes(VIN[0]), 10);
    assert!(assembler.receive(engine(), &bytes(VIN[1]), 1009).broken.is_none(), "999 ms");
    let event = assembler.receive(engine(), &bytes(VIN[2]), 2009);
    let broken = event.broken.expect("a message");
    assert_eq!((broken.cause, broken.transfer.data().len()), (Cause::Silent, 13));
    assert!(event.whole.is_none() && event.answer.is_none() && assembler.timed_out(9999).is_none());
    _ = assembler.receive(engine(), &bytes(VIN[0]), 3000);
    let event = assembler.receive(engine().reversed(), &bytes("300000"), 4000);
    assert_eq!(event.broken.map(|broken| broken.cause), Some(Cause::Silent), "a flow control revives nothing");
}

#[test]
fn a_listener_hears_that_the_receiver_has_no_room() {
    let mut assembler = assembler();
    assert!(assembler.receive(engine(), &bytes(VIN[0]), 0).broken.is_none());
    let event = assembler.receive(engine().reversed(), &bytes("320000"), 0);
    assert_eq!(event.broken.map(|broken| broken.cause), Some(Cause::Overflow));
    assert_eq!(fed(&mut assembler, &VIN[1..]).0, []);
}

#[test]
fn a_sender_does_what_the_receiver_asks() {
    let data = [1; 30];
    let begun = || {
        let mut sender = Sender::new(&data).expect("30 bytes");
        assert_eq!(sender.control(&[0x30, 0, 0]), Answer::Other, "nothing is sent yet");
        assert!(sender.next().is_some());
        sender
    };
    let mut sender = begun();
    assert_eq!(sender.control(&[0x31, 0, 0]), Answer::Wait);
    assert!(sender.next().is_none() && sender.is_waiting());
    assert_eq!(sender.control(&[0x30, 2, 0xF3]), Answer::Allowed(Separation(0xF3)));
    assert_eq!(sender.control(&[0x32, 0, 0]), Answer::Other, "none is awaited");
    assert_eq!(sender.by_ref().count(), 2);
    for other in [&[0x30, 0][..], &[0x01, 0x3E], &[0x21, 1]] {
        assert_eq!(sender.control(other), Answer::Other);
    }
    // 30 = 6 + 3 * 7 + 3.
    assert_eq!((sender.control(&[0x30, 255, 0]), sender.by_ref().count()), (Answer::Allowed(Separation(0)), 2));
    assert_eq!((sender.control(&[0x30, 0, 0]), sender.is_done()), (Answer::Other, true));
    for (flow, answer) in [(0x32, Answer::Overflow), (0x33, Answer::Wrong), (0x3F, Answer::Wrong)] {
        let mut sender = begun();
        assert_eq!((sender.control(&[flow, 0, 0]), sender.next()), (answer, None));
        assert!(!sender.is_waiting() && !sender.is_done());
    }
}

#[test]
fn flow_controls_have_three_bytes_and_are_filled_up() {
    let flows = [
        (Flow::Continue { block: 8, separation: Separation(0xF1) }, "3008F1"),
        (Flow::Wait, "310000"),
        (Flow::Overflow, "320000"),
        (Flow::Reserved(12), "3C0000"),
    ];
    for (flow, text) in flows {
        assert_eq!(hex(flow.encode(None).data()), text);
        assert_eq!(hex(flow.encode(Some(0x55)).data()), std::format!("{text}5555555555"));
        assert_eq!(Pdu::decode(&bytes(text)), Some(Pdu::Flow(flow)));
    }
}

#[test]
fn codes_of_separation_are_milliseconds_or_tenths_of_them() {
    let codes = [
        (0, 0),
        (1, 1_000),
        (0x7F, 127_000),
        (0x80, 127_000),
        (0xF0, 127_000),
        (0xF1, 100),
        (0xF9, 900),
        (0xFA, 127_000),
        (0xFF, 127_000),
    ];
    assert_eq!(codes.map(|(code, _)| Separation(code).micros()), codes.map(|(_, micros)| micros));
}

#[test]
fn both_directions_and_several_nodes_are_kept_apart() {
    let mut assembler = Assembler::<Memory, 3>::new();
    let extended = |id| Id::Extended(ExtendedId::new(id).expect("29 bits"));
    let links = [engine(), engine().reversed(), Link { source: extended(0x7E8), target: extended(0x7E0) }];
    let mut told = Vec::new();
    for frame in VIN {
        for link in links {
            told.extend(assembler.receive(link, &bytes(frame), 0).whole.map(|transfer| transfer.link));
        }
    }
    assert_eq!(told, links);
}

/// Returns the frames of a message as the bus spoils them: consecutive frames are lost, repeated, late or changed.
fn spoilt(data: &[u8], random: &mut Random) -> Vec<Packet> {
    let mut sender = Sender::new(data).expect("1 byte or more");
    let mut frames: Vec<_> = sender.next().into_iter().collect();
    _ = sender.control(&[0x30, 0, 0]);
    for packet in sender {
        match random.below(12) {
            0 => {}
            1 => frames.extend([packet, packet]),
            2 if frames.len() > 1 => frames.insert(frames.len() - 1, packet),
            _ => frames.push(packet),
        }
    }
    frames
}

#[test]
fn each_message_that_is_reported_was_sent_and_each_one_lost_is_reported() {
    let mut random = Random(0x9E37_79B9_7F4A_7C15);
    let (mut whole, mut broken) = (0, 0);
    for _ in 0..400 {
        let (mut queues, mut sent) = (Vec::new(), Vec::new());
        for node in 0..8 {
            let link = Link { source: standard(0x7E8 + node), target: standard(0x7E0 + node) };
            let mut queue = Vec::new();
            for _ in 0..3 {
                let data: Vec<u8> = (0..=random.below(60)).map(|_| random.below(256).to_le_bytes()[0]).collect();
                queue.extend(spoilt(&data, &mut random).into_iter().map(|packet| (link, packet)));
                sent.push((link, data));
            }
            queues.push(queue.into_iter());
        }
        let mut assembler = Assembler::<[u8; memory(61)], 8>::new();
        let mut told = Vec::new();
        while !queues.is_empty() {
            let at = usize::try_from(random.below(8)).expect("a small number") % queues.len();
            let Some((link, packet)) = queues[at].next() else {
                drop(queues.swap_remove(at));
                continue;
            };
            let event = assembler.receive(link, packet.data(), 0);
            assert!(event.refused.is_none(), "there is room");
            told.extend(event.broken.map(|_| None));
            told.extend(event.whole.map(|transfer| Some((transfer.link, transfer.data().to_vec()))));
        }
        told.extend(core::iter::from_fn(|| assembler.timed_out(5000)).map(|_| None));
        assert_eq!(told.len(), sent.len(), "each message is reported once");
        assert!(told.iter().flatten().all(|message| sent.contains(message)), "nobody sent {told:?}");
        whole += told.iter().flatten().count();
        broken += told.iter().filter(|message| message.is_none()).count();
    }
    assert!(whole > 2_000 && broken > 2_000, "{whole} whole and {broken} broken messages");
}
