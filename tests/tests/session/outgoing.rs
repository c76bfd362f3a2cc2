//! How one long message after the other is sent, with the times of J1939 that section 7.5 of the document quotes.

use canspec_runtime::Text;
use canspec_runtime::transfers::{Answer, Assembler, Next, Outgoing, Reason, Transferred};
use canspec_tests::features_transport::{Battery, Frame, Message, Tp};

/// Returns what sends 14 bytes, which are two packets.
fn begun(target: u32) -> Outgoing<Tp> {
    let mut outgoing = Outgoing::new();
    begin(&mut outgoing, target, 0);
    outgoing
}

fn begin(outgoing: &mut Outgoing<Tp>, target: u32, now: u32) {
    let maker = Text::new("ACME").expect("four letters");
    let battery =
        Battery { maker, voltage_v: 400.0, capacity_ah: 180.0, cycles: 515, year: Some(2022.0), month: Some(4) };
    let blank = Frame::new_raw(0x1C02_00F4 | target << 8, true, [0; 8], 8);
    outgoing.begin(&battery, &blank, now).expect("it has room");
}

/// Returns a control frame of the charger.
fn control(head: [u8; 5]) -> Frame {
    let [control, a, b, c, d] = head;
    Frame::new_raw(0x1CEC_F456, true, [control, a, b, c, d, 0, 2, 0], 8)
}

fn sent(outgoing: &mut Outgoing<Tp>, now: u32) -> Vec<String> {
    let frames = std::iter::from_fn(|| match outgoing.poll(now) {
        Next::Send(frame) => Some(frame.to_string()),
        Next::Lost(frame) => Some(format!("lost {frame}")),
        Next::Wait(_) => None,
    });
    frames.collect()
}

const CTS: [u8; 5] = [0x11, 2, 1, 0xFF, 0xFF];
const RTS: &str = "1CEC56F4#100E0002FF000200";
const PACKETS: [&str; 2] = ["1CEB56F4#0141434D45A00F08", "1CEB56F4#02070302002504FF"];
/// Section 7.2: reason 3 is a time-out, and 250 another one.
const ABORT: &str = "lost 1CEC56F4#FF03FFFFFF000200";

#[test]
fn a_message_is_sent_as_far_as_its_receiver_allows() {
    let mut outgoing = begun(0x56);
    assert_eq!((sent(&mut outgoing, 0), outgoing.poll(0)), (vec![RTS.to_owned()], Next::Wait(Some(1250))));
    assert_eq!(outgoing.receive(&control(CTS), 100), Answer::Allowed(2));
    assert_eq!(sent(&mut outgoing, 100), PACKETS);
    assert_eq!((outgoing.poll(100), outgoing.is_busy()), (Next::Wait(Some(1350)), true));
    // The second packet is asked for again.
    assert_eq!(outgoing.receive(&control([0x11, 1, 2, 0xFF, 0xFF]), 200), Answer::Allowed(1));
    assert_eq!(sent(&mut outgoing, 200), PACKETS[1..]);
    assert_eq!(outgoing.receive(&control([0x13, 14, 0, 2, 0xFF]), 300), Answer::Done);
    assert_eq!((outgoing.poll(300), outgoing.is_busy()), (Next::Wait(None), false));
    assert_eq!(outgoing.receive(&control(CTS), 300), Answer::Other);
}

#[test]
fn a_silent_receiver_is_given_up_after_the_times_of_the_standard() {
    let mut outgoing = begun(0x56);
    let _ = sent(&mut outgoing, 0);
    assert!(sent(&mut outgoing, 1249).is_empty());
    assert_eq!(sent(&mut outgoing, 1250), [ABORT]);
    assert!(!outgoing.is_busy());
    // T3 begins anew with the last packet, and T4 with an answer that asks to wait.
    let mut outgoing = begun(0x56);
    let _ = sent(&mut outgoing, 0);
    let _ = outgoing.receive(&control(CTS), 1000);
    assert_eq!(sent(&mut outgoing, 1200), PACKETS);
    assert!(sent(&mut outgoing, 2449).is_empty());
    assert_eq!(outgoing.receive(&control([0x11, 0, 1, 0xFF, 0xFF]), 2449), Answer::Allowed(0));
    assert_eq!(outgoing.poll(2449), Next::Wait(Some(3499)));
    assert_eq!(sent(&mut outgoing, 3499), [ABORT]);
}

#[test]
fn a_message_ends_where_its_receiver_gives_up_or_asks_for_too_much() {
    let mut outgoing = begun(0x56);
    let _ = sent(&mut outgoing, 0);
    assert_eq!(outgoing.receive(&control([0xFF, 2, 0xFF, 0xFF, 0xFF]), 10), Answer::Aborted(Reason::RESOURCES));
    assert_eq!((outgoing.is_busy(), outgoing.poll(10)), (false, Next::Wait(None)));
    let mut outgoing = begun(0x56);
    let _ = sent(&mut outgoing, 0);
    assert_eq!(outgoing.receive(&control([0x11, 3, 1, 0xFF, 0xFF]), 10), Answer::Wrong);
    assert_eq!(sent(&mut outgoing, 10), ["lost 1CEC56F4#FFFAFFFFFF000200"]);
}

#[test]
fn what_was_not_sent_yet_is_neither_acknowledged_nor_asked_for_again() {
    const ACK: [u8; 5] = [0x13, 14, 0, 2, 0xFF];
    let mut outgoing = begun(0x56);
    for head in [ACK, CTS, [0x11, 3, 1, 0xFF, 0xFF], [0xFF, 2, 0xFF, 0xFF, 0xFF]] {
        assert_eq!(outgoing.receive(&control(head), 0), Answer::Other, "{head:02X?} before the announcement");
    }
    assert_eq!(sent(&mut outgoing, 0), [RTS]);
    assert_eq!(outgoing.receive(&control(ACK), 10), Answer::Other);
    assert_eq!(outgoing.receive(&control([0x11, 1, 2, 0xFF, 0xFF]), 10), Answer::Other, "the first is left out");
    assert_eq!(outgoing.poll(10), Next::Wait(Some(1250)));
    assert_eq!(outgoing.receive(&control([0x11, 1, 1, 0xFF, 0xFF]), 20), Answer::Allowed(1));
    assert_eq!(sent(&mut outgoing, 20), PACKETS[..1]);
    assert_eq!((outgoing.receive(&control(ACK), 30), outgoing.is_busy()), (Answer::Other, true));
    assert_eq!(outgoing.receive(&control([0x11, 1, 2, 0xFF, 0xFF]), 40), Answer::Allowed(1));
    assert_eq!(sent(&mut outgoing, 40), PACKETS[1..]);
    assert_eq!((outgoing.receive(&control(ACK), 50), outgoing.is_busy()), (Answer::Done, false));
}

#[test]
fn a_message_that_begins_while_another_is_on_its_way_is_sent_from_its_beginning() {
    let mut outgoing = begun(0x56);
    let _ = sent(&mut outgoing, 0);
    let _ = outgoing.receive(&control([0x11, 1, 1, 0xFF, 0xFF]), 10);
    assert_eq!(sent(&mut outgoing, 10), PACKETS[..1]);
    begin(&mut outgoing, 0x56, 20);
    assert_eq!(outgoing.receive(&control([0x11, 1, 2, 0xFF, 0xFF]), 20), Answer::Other, "it is about the first");
    assert_eq!((sent(&mut outgoing, 20), outgoing.poll(20)), (vec![RTS.to_owned()], Next::Wait(Some(1270))));
    assert_eq!(outgoing.receive(&control(CTS), 30), Answer::Allowed(2));
    assert_eq!(sent(&mut outgoing, 30), PACKETS);
}

#[test]
fn a_receiver_may_ask_for_a_packet_twice_again_and_may_ask_to_wait_for_as_long_as_it_likes() {
    let mut outgoing = begun(0x56);
    let _ = sent(&mut outgoing, 0);
    for now in (1000..100_000).step_by(1000) {
        assert_eq!(outgoing.receive(&control([0x11, 0, 1, 0xFF, 0xFF]), now), Answer::Allowed(0));
        assert_eq!(outgoing.poll(now), Next::Wait(Some(now + 1050)));
    }
    assert_eq!(outgoing.receive(&control(CTS), 100_000), Answer::Allowed(2));
    assert_eq!(sent(&mut outgoing, 100_000), PACKETS);
    for now in [100_100, 100_200] {
        assert_eq!(outgoing.receive(&control([0x11, 1, 2, 0xFF, 0xFF]), now), Answer::Allowed(1));
        assert_eq!(sent(&mut outgoing, now), PACKETS[1..]);
    }
    assert_eq!(outgoing.receive(&control([0x11, 1, 2, 0xFF, 0xFF]), 100_300), Answer::Wrong);
    // Reason 5 of J1939-21 is too many requests.
    assert_eq!(sent(&mut outgoing, 100_300), ["lost 1CEC56F4#FF05FFFFFF000200"]);
    assert!(!outgoing.is_busy());
}

#[test]
fn nobody_answers_frames_to_all() {
    for head in
        [CTS, [0x11, 0, 1, 0xFF, 0xFF], [0x11, 9, 1, 0xFF, 0xFF], [0xFF, 1, 0xFF, 0xFF, 0xFF], [0x13, 14, 0, 2, 0xFF]]
    {
        let mut outgoing = begun(0xFF);
        let _ = sent(&mut outgoing, 0);
        let [control, a, b, c, d] = head;
        let answer = Frame::new_raw(0x1CEC_F4FF, true, [control, a, b, c, d, 0, 2, 0], 8);
        assert_eq!(outgoing.receive(&answer, 10), Answer::Other, "{head:02X?}");
        assert_eq!((outgoing.poll(10), sent(&mut outgoing, 50).len()), (Next::Wait(Some(50)), 1), "{head:02X?}");
        assert_eq!((sent(&mut outgoing, 100).len(), outgoing.is_busy()), (1, false), "{head:02X?}");
    }
}

#[test]
fn frames_to_all_have_50_ms_between_them() {
    let mut outgoing = begun(0xFF);
    let mut times = Vec::new();
    for now in 0..200 {
        times.extend(sent(&mut outgoing, now).into_iter().map(|frame| (now, frame)));
    }
    let of_all = |frame: &str| frame.replace("1CEB56F4", "1CEBFFF4");
    let bam = "1CECFFF4#200E0002FF000200".to_owned();
    assert_eq!(times, [(0, bam), (50, of_all(PACKETS[0])), (100, of_all(PACKETS[1]))]);
    assert!(!outgoing.is_busy());
}

#[test]
fn another_message_takes_the_place_of_the_first_and_none_comes_of_too_little_memory() {
    let mut outgoing = begun(0x56);
    let _ = sent(&mut outgoing, 0);
    outgoing.cancel();
    assert_eq!((outgoing.is_busy(), outgoing.poll(5000)), (false, Next::Wait(None)));
    let whole = {
        let (mut outgoing, mut charger) = (begun(0x56), Assembler::<Tp, 1>::new());
        let mut whole = None;
        while let Next::Send(frame) = outgoing.poll(7) {
            let event = charger.receive(&frame, 7);
            if let Some(answer) = event.answer {
                assert_ne!(outgoing.receive(&answer, 7), Answer::Other);
            }
            whole = event.whole.or(whole);
        }
        whole.and_then(|whole| whole.values::<Battery>()).expect("every packet came")
    };
    let blank = Battery::OF_VEHICLE.blank_report::<Message>(0xF4).expect("the vehicle reports it");
    let mut small = Outgoing::<Tp, [u8; 13]>::new();
    assert!(small.begin(&whole, &blank, 0).is_err() && !small.is_busy());
    let mut buffer = [0; 14];
    assert!(whole.sender(&blank, &mut buffer).is_ok(), "14 bytes are enough");
}
