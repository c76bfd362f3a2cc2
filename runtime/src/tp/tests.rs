//! Transfers of GB/T 27930: their frames as they are printed, and what can go wrong with them.

use std::vec::Vec;

use super::*;
use crate::Data;
use crate::tests::random::Random;

/// The battery's address, and the charger's.
const BATTERY: Link = Link { source: 0xF4, target: 0x56 };
const CHARGER: Link = Link { source: 0x56, target: 0xF4 };

type Memory = [u8; memory(1785)];

/// A frame: whether it is a packet, who sends it, and its data.
type Frame = (bool, Link, Data);

/// Reads frames such as `1CEC56F4#1031000704000200`.
fn frames(text: &str) -> Vec<Frame> {
    let byte = |text: &str, at: usize| u8::from_str_radix(&text[at..at + 2], 16).expect("two digits");
    let frame = |line: &str| {
        let (id, data) = line.split_once('#').expect("an identifier and data");
        let link = Link { source: byte(id, 6), target: byte(id, 4) };
        (&id[2..4] == "EB", link, core::array::from_fn(|index| byte(data, 2 * index)))
    };
    text.split_whitespace().map(frame).collect()
}

fn bytes(text: &str) -> Vec<u8> {
    (0..text.len() / 2).map(|at| u8::from_str_radix(&text[2 * at..2 * at + 2], 16).expect("two digits")).collect()
}

/// What became of a message: its data, or why there are none and what is missing.
type Told = Result<Vec<u8>, (Cause, Vec<u8>)>;

/// Gives frames to an assembler; returns what became of messages, and what it answers.
fn fed<const N: usize>(assembler: &mut Assembler<Memory, N>, frames: &[Frame]) -> (Vec<Told>, Vec<Data>) {
    let (mut told, mut answers) = (Vec::new(), Vec::new());
    for (is_packet, link, data) in frames {
        let event = if *is_packet { assembler.packet(*link, data, 0) } else { assembler.control(*link, data, 0) };
        told.extend(event.whole.map(|transfer| Ok(transfer.data().to_vec())));
        let broken = event.broken.into_iter().chain(event.refused);
        told.extend(broken.map(|broken| Err((broken.cause, broken.transfer.missing().collect()))));
        answers.extend(event.answer.map(|(_, data)| data));
    }
    (told, answers)
}

/// T1 of section 10: BRM, of 49 bytes in 7 packets, with at most 4 at once.
const BRM: &str = "1CEC56F4#1031000704000200 1CECF456#110401FFFF000200 1CEB56F4#01010100060D07E0
    1CEB56F4#020D41434D456745 1CEB56F4#032301250B1E7011 1CEB56F4#040101FF4C544553 1CECF456#110305FFFF000200
    1CEB56F4#055456454849434C 1CEB56F4#0645303030343210 1CEB56F4#070A08E707FFFFFF 1CECF456#13310007FF000200";
const BRM_DATA: &str =
    "010100060D07E00D41434D4567452301250B1E70110101FF4C5445535456454849434C453030303432100A08E707FFFFFF";
/// T2: BCP, of 13 bytes in 2 packets, one at a time.
const BCP: &str = "1CEC56F4#100D000201000600 1CECF456#110101FFFF000600 1CEB56F4#01A90160098102F0
    1CECF456#110102FFFF000600 1CEB56F4#020F697601BF0DFF 1CECF456#130D0002FF000600";
const BCP_DATA: &str = "A90160098102F00F697601BF0D";
/// T5: BMT, of 10 bytes in 2 packets, as many at once as the charger likes.
const BMT: &str = "1CEC56F4#100A0002FF001600 1CECF456#110201FFFF001600 1CEB56F4#014748484A2D3249
    1CEB56F4#026E004BFFFFFFFF 1CECF456#130A0002FF001600";
const BMT_DATA: &str = "4748484A2D32496E004B";

/// Each transfer of the document that is played here, with its group, its limit and its data.
const TRANSFERS: [(&str, u32, u8, &str); 3] =
    [(BRM, 0x0200, 4, BRM_DATA), (BCP, 0x0600, 1, BCP_DATA), (BMT, 0x1600, 255, BMT_DATA)];

#[test]
fn a_receiver_answers_as_the_document_prints_it() {
    for (transfer, _, _, data) in TRANSFERS {
        let (sent, answers): (Vec<_>, Vec<_>) = frames(transfer).into_iter().partition(|(_, link, _)| *link == BATTERY);
        let answers: Vec<_> = answers.into_iter().map(|(_, _, data)| data).collect();
        assert_eq!(fed(&mut Assembler::<_, 1>::new(), &sent), ([Ok(bytes(data))].into(), answers));
    }
}

#[test]
fn a_listener_gets_the_same_messages() {
    for (transfer, _, _, data) in TRANSFERS {
        assert_eq!(fed(&mut Assembler::<_, 1>::new(), &frames(transfer)).0, [Ok(bytes(data))]);
    }
}

#[test]
fn a_sender_sends_what_the_document_prints() {
    for (transfer, group, limit, data) in TRANSFERS {
        let data = bytes(data);
        let mut sender = Sender::new(group, &data, limit).expect("9 bytes or more");
        let (mut sent, mut answers) = ([(false, BATTERY, sender.rts())].to_vec(), Vec::new());
        for (_, _, answer) in frames(transfer).into_iter().filter(|(_, link, _)| *link == CHARGER) {
            answers.push(sender.control(&answer));
            sent.extend((&mut sender).map(|data| (true, BATTERY, data)));
        }
        let expected: Vec<_> = frames(transfer).into_iter().filter(|(_, link, _)| *link == BATTERY).collect();
        assert_eq!(sent, expected);
        assert_eq!(answers.last(), Some(&Answer::Done));
    }
}

#[test]
fn every_size_comes_over_to_one_and_to_all() {
    let data: Vec<_> = (0..1785_u32).map(|index| index.to_le_bytes()[0] ^ index.to_le_bytes()[1]).collect();
    for size in SIZES {
        let mut assembler = Assembler::<Memory, 1>::new();
        let mut sender = Sender::new(0xF004, &data[..size], 16).expect("a size that travels so");
        let mut event = assembler.control(BATTERY, &sender.rts(), 0);
        while let Some((_, answer)) = event.answer {
            if sender.control(&answer) == Answer::Done {
                break;
            }
            for packet in &mut sender {
                event = assembler.packet(BATTERY, &packet, 0);
            }
        }
        assert_eq!(event.whole.map(|whole| whole.data().to_vec()).as_deref(), Some(&data[..size]), "{size}");
        let to_all = Link { target: ALL, ..BATTERY };
        let begun = assembler.control(to_all, &sender.bam(), 0);
        assert!(begun.answer.is_none() && begun.broken.is_none());
        let told: Vec<_> = sender.filter_map(|packet| assembler.packet(to_all, &packet, 0).whole).collect();
        assert_eq!(told.iter().map(Transfer::data).collect::<Vec<_>>(), [&data[..size]], "{size}");
    }
    assert!(Sender::new(0, &data[..8], 255).is_none() && Sender::new(0, &[0; 1786], 255).is_none());
}

#[test]
fn a_size_that_does_not_agree_with_the_packets_is_refused() {
    // 0 bytes, 8 bytes, 2,000 bytes, and 13 bytes in one packet or in three.
    for rts in ["1000000000", "1008000201", "10D007FF01", "100D000101", "100D000301"] {
        let sent = frames(&std::format!("1CEC56F4#{rts}000600"));
        let (told, answers) = fed(&mut Assembler::<_, 1>::new(), &sent);
        assert!(matches!(told[..], [Err((Cause::Size, _))]), "{rts}: {told:?}");
        assert_eq!(answers, [Control::Abort(Reason::OTHER).encode(0x0600)], "{rts}");
    }
}

#[test]
fn a_packet_that_comes_again_counts_once_or_breaks_the_message() {
    let [rts, _, one, _, two, _] = frames(BCP)[..] else { panic!("six frames") };
    let (told, _) = fed(&mut Assembler::<_, 1>::new(), &[rts, one, one, two]);
    assert_eq!(told, [Ok(bytes(BCP_DATA))]);
    let mut changed = one;
    changed.2[3] ^= 1;
    let (told, answers) = fed(&mut Assembler::<_, 1>::new(), &[rts, one, changed, two]);
    assert_eq!(told, [Err((Cause::Changed(1), [2].into()))]);
    assert_eq!(answers.last(), Some(&Control::Abort(Reason::OTHER).encode(0x0600)));
}

#[test]
fn a_packet_with_a_number_that_the_message_does_not_have_breaks_it() {
    let rts = frames(BCP)[0];
    for number in [0, 3, 255] {
        let packet = (true, BATTERY, [number, 0, 0, 0, 0, 0, 0, 0]);
        let (told, _) = fed(&mut Assembler::<_, 1>::new(), &[rts, packet]);
        assert_eq!(told, [Err((Cause::Number(number), [1, 2].into()))]);
        assert_eq!(fed(&mut Assembler::<_, 1>::new(), &[packet]), (Vec::new(), Vec::new()), "nothing has begun");
    }
}

#[test]
fn a_receiver_asks_again_for_what_is_lost() {
    let all = frames(BMT);
    let (rts, one, two) = (all[0], all[2], all[3]);
    let mut assembler = Assembler::<_, 1>::new();
    let (told, answers) = fed(&mut assembler, &[rts, two]);
    assert_eq!((told, answers.last()), (Vec::new(), Some(&Control::Cts { packets: 2, next: 1 }.encode(0x1600))));
    assert_eq!(fed(&mut assembler, &[one]).0, [Ok(bytes(BMT_DATA))]);
    let (told, answers) = fed(&mut Assembler::<_, 1>::new(), &[rts, two, two, two]);
    assert_eq!((told, answers.len()), ([Err((Cause::Lost, [1].into()))].into(), 4));
    assert_eq!(answers.last(), Some(&Control::Abort(Reason::REPETITIONS).encode(0x1600)));
    // A listener that misses what the receiver gets learns it from the acknowledgement.
    let missed = [rts, all[1], one, all[4]];
    assert_eq!(fed(&mut Assembler::<_, 1>::new(), &missed).0, [Err((Cause::Lost, [2].into()))]);
}

#[test]
fn a_broadcast_with_a_lost_packet_comes_to_nothing() {
    // G7 of section 9, and the packets of T5.
    let bam = frames("1CECFFF4#200A0002FF001600 1CEBFFF4#014748484A2D3249 1CEBFFF4#026E004BFFFFFFFF");
    assert_eq!(fed(&mut Assembler::<_, 1>::new(), &bam), ([Ok(bytes(BMT_DATA))].into(), Vec::new()));
    let told = fed(&mut Assembler::<_, 1>::new(), &[bam[0], bam[2]]);
    assert_eq!(told, ([Err((Cause::Lost, [1].into()))].into(), Vec::new()));
}

#[test]
fn both_sides_can_give_up() {
    // G5 of section 9: the charger gives up BMV, of 12 bytes in 2 packets (T4).
    let [rts, abort] = frames("1CEC56F4#100C000202001500 1CECF456#FF03FFFFFF001500")[..] else { panic!("two frames") };
    let gone = [Err((Cause::Aborted(Reason::TIMEOUT), [1, 2].into()))];
    assert_eq!(fed(&mut Assembler::<_, 1>::new(), &[rts, abort]).0, gone);
    assert_eq!(fed(&mut Assembler::<_, 1>::new(), &[rts, (false, BATTERY, abort.2)]).0, gone);
    let other = (false, CHARGER, Control::Abort(Reason::TIMEOUT).encode(0x0600));
    assert_eq!(fed(&mut Assembler::<_, 1>::new(), &[rts, other]).0, []);
    let data = bytes("910192018F1190118DF193F1");
    let mut sender = Sender::new(0x1500, &data, 2).expect("twelve bytes");
    assert_eq!(sender.rts(), rts.2);
    assert_eq!(sender.control(&abort.2), Answer::Aborted(Reason::TIMEOUT));
    assert_eq!(sender.abort(Reason::TIMEOUT), abort.2);
}

#[test]
fn a_receiver_can_ask_to_wait() {
    // G6 of section 9 holds BMV.
    let (cts, hold) = (frames("1CECF456#110201FFFF001500")[0], frames("1CECF456#1100FFFFFF001500")[0]);
    let data = bytes("910192018F1190118DF193F1");
    let mut sender = Sender::new(0x1500, &data, 2).expect("twelve bytes");
    assert_eq!((sender.control(&hold.2), sender.next()), (Answer::Allowed(0), None));
    assert_eq!(sender.control(&cts.2), Answer::Allowed(2));
    assert!(sender.next().is_some());
    assert_eq!((sender.control(&hold.2), sender.next()), (Answer::Allowed(0), None));
}

#[test]
fn a_sender_takes_an_acknowledgement_only_of_all_packets() {
    let data = bytes(BCP_DATA);
    let mut sender = Sender::new(0x0600, &data, 255).expect("13 bytes");
    let ack = Control::EndOfMsgAck { size: 13, packets: 2 }.encode(0x0600);
    let cts = |packets, next| Control::Cts { packets, next }.encode(0x0600);
    assert_eq!(sender.control(&ack), Answer::Other);
    assert_eq!((sender.control(&cts(1, 2)), sender.next()), (Answer::Other, None), "packet 1 was never sent");
    assert_eq!((sender.control(&cts(2, 1)), sender.next().is_some()), (Answer::Allowed(2), true));
    assert_eq!((sender.control(&ack), sender.next().is_some()), (Answer::Other, true));
    assert_eq!((sender.control(&cts(1, 1)), sender.next().is_some()), (Answer::Allowed(1), true));
    assert_eq!(sender.control(&ack), Answer::Done, "packet 2 was sent, too");
}

#[test]
fn a_sender_refuses_to_send_a_packet_for_the_fourth_time() {
    let data = [1; 40];
    let cts = |packets, next| Control::Cts { packets, next }.encode(0x0600);
    let asked = |packets: &[u8]| {
        let mut sender = Sender::new(0x0600, &data, 255).expect("40 bytes, which are six packets");
        assert_eq!((sender.control(&cts(6, 1)), (&mut sender).count()), (Answer::Allowed(6), 6));
        let answer = |next: &u8| (sender.control(&cts(1, *next)), sender.next()).0;
        packets.iter().map(answer).position(|answer| answer == Answer::Wrong)
    };
    assert_eq!(asked(&[2, 2, 2]), Some(2));
    assert_eq!(asked(&[2, 2, 3, 3, 4, 5, 5, 6, 6]), None, "each is asked for twice again at most");
    assert_eq!(asked(&[2, 3, 2, 3]), Some(3), "packets in turn end, too");
}

#[test]
fn a_sender_refuses_what_no_receiver_may_ask() {
    let mut sender = Sender::new(0x1500, &[1; 20], 2).expect("twenty bytes");
    let wrong = [
        Control::Cts { packets: 3, next: 1 },
        Control::Cts { packets: 1, next: 0 },
        Control::Cts { packets: 2, next: 3 },
        Control::EndOfMsgAck { size: 21, packets: 3 },
    ];
    assert_eq!(wrong.map(|control| sender.control(&control.encode(0x1500))), [Answer::Wrong; 4]);
    assert_eq!(sender.control(&Control::Cts { packets: 1, next: 1 }.encode(0x1600)), Answer::Other);
    assert_eq!(sender.next(), None);
}

#[test]
fn sessions_of_several_nodes_are_kept_apart_and_bounded() {
    let other = |frame: &Frame| (frame.0, Link { source: 0xF5, ..frame.1 }, frame.2);
    let [rts, _, one, _, two, _] = frames(BCP)[..] else { panic!("six frames") };
    let (rts_5, one_5) = (frames(BMT)[0], frames(BMT)[2]);
    let mixed = [rts, other(&rts_5), one, other(&one_5), two, other(&frames(BMT)[3])];
    assert_eq!(fed(&mut Assembler::<_, 2>::new(), &mixed).0, [Ok(bytes(BCP_DATA)), Ok(bytes(BMT_DATA))]);
    let (told, answers) = fed(&mut Assembler::<_, 1>::new(), &mixed);
    assert_eq!(told, [Err((Cause::Full, [1, 2].into())), Ok(bytes(BCP_DATA))]);
    assert!(answers.contains(&Control::Abort(Reason::RESOURCES).encode(0x1600)));
    let mut small = Assembler::<[u8; memory(13)], 1>::new();
    let causes = [BCP, BRM].map(|transfer| small.control(BATTERY, &frames(transfer)[0].2, 0).refused);
    assert_eq!(causes.map(|refused| refused.map(|refused| refused.cause)), [None, Some(Cause::Full)]);
}

#[test]
fn a_message_that_begins_anew_ends_the_one_before() {
    let [rts, _, one, _, two, _] = frames(BCP)[..] else { panic!("six frames") };
    let (told, _) = fed(&mut Assembler::<_, 1>::new(), &[rts, one, rts, one, two]);
    assert_eq!(told, [Err((Cause::Restarted, [2].into())), Ok(bytes(BCP_DATA))]);
}

#[test]
fn a_silent_sender_is_given_up() {
    let [rts, _, one, ..] = frames(BMT)[..] else { panic!("five frames") };
    let mut assembler = Assembler::<Memory, 1>::new();
    _ = assembler.control(BATTERY, &rts.2, 10);
    assert!(assembler.timed_out(1259).is_none());
    _ = assembler.packet(BATTERY, &one.2, 1259);
    assert!(assembler.timed_out(2008).is_none());
    let event = assembler.timed_out(2009).expect("T1 is over");
    assert_eq!(event.broken.map(|broken| broken.cause), Some(Cause::Silent));
    assert_eq!(event.answer, Some((CHARGER, Control::Abort(Reason::TIMEOUT).encode(0x1600))));
    assert!(assembler.timed_out(9999).is_none());
}

/// Returns a broadcast of 9 to 40 bytes as the bus spoils it: packets are lost, repeated, late or changed.
fn spoilt(link: Link, data: &[u8], random: &mut Random) -> Vec<Frame> {
    let mut sender = Sender::new(0xF004, data, 255).expect("9 bytes or more");
    let mut frames = [(false, link, sender.bam())].to_vec();
    for packet in sender {
        let packet = (true, link, packet);
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
        let mut queues = Vec::new();
        let mut sent = Vec::new();
        for source in 0..8 {
            let link = Link { source, target: ALL };
            let mut queue = Vec::new();
            for _ in 0..3 {
                let size = 9 + random.below(32);
                let data: Vec<u8> = (0..size).map(|_| random.below(256).to_le_bytes()[0]).collect();
                queue.extend(spoilt(link, &data, &mut random));
                sent.push((link, data));
            }
            queues.push(queue.into_iter());
        }
        let mut assembler = Assembler::<[u8; memory(40)], 8>::new();
        let mut told = Vec::new();
        while !queues.is_empty() {
            let at = usize::try_from(random.below(8)).expect("a small number") % queues.len();
            let Some((is_packet, link, data)) = queues[at].next() else {
                drop(queues.swap_remove(at));
                continue;
            };
            let event = if is_packet { assembler.packet(link, &data, 0) } else { assembler.control(link, &data, 0) };
            assert!(event.refused.is_none() && event.answer.is_none(), "there is room, and nobody answers a broadcast");
            told.extend(event.whole.map(|transfer| Some((transfer.link, transfer.data().to_vec()))));
            told.extend(event.broken.map(|_| None));
        }
        told.extend(core::iter::from_fn(|| assembler.timed_out(5000)).map(|_| None));
        assert_eq!(told.len(), sent.len(), "each message is reported once");
        assert!(told.iter().flatten().all(|message| sent.contains(message)), "nobody sent {told:?}");
        whole += told.iter().flatten().count();
        broken += told.iter().filter(|message| message.is_none()).count();
    }
    assert!(whole > 2_000 && broken > 2_000, "{whole} whole and {broken} broken messages");
}
