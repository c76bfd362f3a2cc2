//! A charging session by GB/T 27930 between a simulated vehicle and a simulated charger, in virtual time.
//!
//! Both are built on public interfaces: `Schedule` says what is due, `Outgoing` sends long messages, and an `Assembler`
//! takes them. Expected data are those that the document prints.

mod bus;
mod charger;
mod outgoing;
mod side;
mod vehicle;

use bus::{Session, message_of, run, run_from};
use canspec_protocols::gbt27930::Frame;
use canspec_runtime::sim::Random;
use charger::Charger;
use side::{Came, Phase};
use vehicle::Vehicle;

/// A session of 25 seconds without a lost frame.
fn undisturbed() -> Session {
    run(Vehicle::new(25_000), Charger::new(None), |_, _| false)
}

/// Returns each message that came with other data than before, in the order of both sides.
fn first(session: &Session) -> Vec<(&'static str, String)> {
    let mut came: Vec<&Came> = session.vehicle.side.came.iter().chain(&session.charger.side.came).collect();
    came.sort_by_key(|came| came.at);
    let mut first: Vec<(&str, String)> = Vec::new();
    for Came { name, data, .. } in came.into_iter().filter(|came| !came.name.starts_with("tp_")) {
        if !first.iter().any(|known| (known.0, &known.1) == (*name, data)) {
            first.push((name, data.clone()));
        }
    }
    first
}

#[test]
fn a_session_goes_through_each_phase_with_the_data_of_the_document() {
    use Phase::{Charging, Configuration, Done, End, Handshake, Recognition, Stop};
    let session = undisturbed();
    let phases = [Handshake, Recognition, Configuration, Charging, Stop, End, Done];
    assert_eq!([&session.vehicle.side.phases, &session.charger.side.phases], [&phases, &phases]);
    // Sections 8.1, 9 and 10. Of CST, 5.18: byte 1 has the vehicle in bits 8 and 7, and 3.5 has ones elsewhere.
    let expected = [
        ("chm", "010100"),
        ("bhm", "F61C"),
        ("crm", "0067120000423037"),
        ("brm", "010100060D07E00D41434D4567452301250B1E70110101FF4C5445535456454849434C453030303432100A08E707FFFFFF"),
        ("crm", "AA67120000423037"),
        ("bcp", "A90160098102F00F697601BF0D"),
        ("cts", "58592329022420"),
        ("cml", "4C1DD007BE0A870F"),
        ("bro", "00"),
        ("bro", "AA"),
        ("cro", "00"),
        ("cro", "AA"),
        ("bcl", "300F7B0C02"),
        ("bsm", "00510F2B7F00D0"),
        ("bcs", "2A0F7F0C97513F2E00"),
        ("ccs", "270F820C1100FD"),
        ("bmv", "910192018F1190118DF193F1"),
        ("bmt", "4748484A2D32496E004B"),
        ("bsp", "0102030405060708090A"),
        ("bst", "010000F0"),
        ("cst", "4000F0F0"),
        ("bsd", "6098019F012F58"),
        ("csd", "4900A10167120000"),
    ];
    let came = first(&session);
    let mut sorted = [came.clone(), expected.map(|(name, data)| (name, data.to_owned())).into()];
    for list in &mut sorted {
        list.sort();
    }
    assert_eq!(sorted[0], sorted[1]);
    // Long messages of one cycle follow each other, and charging begins between them.
    let is_led = |name: &&str| !["bcs", "ccs", "bmv", "bmt", "bsp"].contains(name);
    let names = |list: &[(&'static str, String)]| list.iter().map(|one| one.0).filter(is_led).collect::<Vec<_>>();
    assert_eq!(names(&came), names(&expected.map(|(name, data)| (name, data.to_owned()))));
}

#[test]
fn messages_come_in_the_cycles_of_the_document() {
    // Section 8.4. A message is repeated as long as the one gets lost that answers it.
    let cycles = [
        (0x27, 0x1826_F456, 250),
        (0x01, 0x1827_56F4, 250),
        (0x02, 0x1801_F456, 250),
        (0x09, 0x1807_F456, 500),
        (0x09, 0x1808_F456, 250),
        (0x0A, 0x1009_56F4, 250),
        (0x10, 0x100A_F456, 250),
        (0x00, 0x1810_56F4, 50),
        (0x00, 0x1812_F456, 50),
        (0x00, 0x1813_56F4, 250),
        (0x1A, 0x1019_56F4, 10),
        (0x1C, 0x101A_F456, 10),
        (0x1D, 0x181C_56F4, 250),
        (0x1D, 0x181D_F456, 250),
        (0x08, 0x081E_56F4, 250),
        (0x02, 0x081F_F456, 250),
    ];
    for (lost, id, cycle) in cycles {
        let session = run(Vehicle::new(25_000), Charger::new(None), |frame, _| message_of(frame) == lost);
        let gaps = session.gaps(|frame| frame.raw_id() == id);
        assert!(gaps.len() > 3 && gaps.iter().all(|gap| *gap == cycle), "{id:08X}: {gaps:?}");
    }
    let session = undisturbed();
    // Of messages by the transport, the announcements. Others can be on their way.
    for (data, cycle, count) in [("1009000202001100", 250, 100), ("100C000202001500", 10_000, 3)] {
        let announced = |frame: &Frame| frame.raw_id() == 0x1CEC_56F4 && bus::hex(&without_limit(frame)) == data;
        let times: Vec<_> = session.frames.iter().filter(|(_, frame)| announced(frame)).map(|(at, _)| *at).collect();
        assert_eq!(times.len(), count, "{data}");
        let is_kept = |pair: &[u32]| (pair[1] - pair[0]).abs_diff(cycle) <= 50;
        assert!(times.windows(2).all(is_kept), "{data}: {times:?}");
    }
}

#[test]
fn a_long_message_is_repeated_in_its_cycle_and_one_without_an_answer_after_a_time_of_the_transport() {
    // Section 8.4, of BRM without CRM (0xAA) and BCP without CML. T3 of section 7.5, of a BRM that gets lost.
    let losses: [(&'static [u32], _, _, _); 3] =
        [(&[0x01], Some(0xAA), 0x02, 250), (&[0x08], None, 0x06, 500), (&[0x02], None, 0x02, 1250)];
    for (formats, first, format, cycle) in losses {
        let session = run_with(&Loss { formats, first, ..LOST }, Charger::new(None));
        let is_announced =
            |frame: &Frame| frame.raw_id() == 0x1CEC_56F4 && frame.bytes()[0] == 0x10 && message_of(frame) == format;
        let gaps = session.gaps(is_announced);
        assert!(gaps.len() > 3 && gaps.iter().all(|gap| *gap == cycle), "{format:02X} without {formats:X?}: {gaps:?}");
    }
}

#[test]
fn a_message_is_not_sent_after_the_one_that_ends_it() {
    // Section 8.1. BST and CST answer each other, and go on in some time if CSD gets lost.
    let ends = [
        (("chm", ""), ("bhm", "")),
        (("bhm", ""), ("crm", "00")),
        (("crm", "00"), ("brm", "")),
        (("brm", ""), ("crm", "AA")),
        (("crm", "AA"), ("bcp", "")),
        (("bcp", ""), ("cml", "")),
        (("cts", ""), ("bro", "AA")),
        (("cml", ""), ("bro", "AA")),
        (("bro", ""), ("cro", "AA")),
        (("cro", ""), ("bcl", "")),
        (("bcl", ""), ("cst", "")),
        (("ccs", ""), ("bst", "")),
        (("bst", ""), ("cst", "")),
        (("cst", ""), ("bsd", "")),
    ];
    let (came, _) = until_error(&run_with(&Loss { formats: &[0x1D], ..LOST }, Charger::new(None)));
    let times = |(name, data): (&str, &str)| -> Vec<u32> {
        came.iter().filter(|came| came.name == name && came.data.starts_with(data)).map(|came| came.at).collect()
    };
    for (message, end) in ends {
        let last = times(message).last().copied().zip(times(end).first().copied());
        // One can be on its way when the other comes.
        assert!(last.is_some_and(|(last, end)| last <= end + 1), "{message:?} until {end:?}: {last:?}");
    }
}

#[test]
fn a_clock_that_wraps_around_changes_nothing() {
    let wrapped = run_from(u32::MAX - 12_000, Vehicle::new(25_000), Charger::new(None), |_, _| false);
    assert_eq!(wrapped.phases(), [Phase::Done; 2]);
    assert!(wrapped.frames == undisturbed().frames);
}

/// Returns the data of an announcement with 2 packets at once, as the document prints them.
fn without_limit(frame: &Frame) -> [u8; 8] {
    let mut data = frame.bytes();
    data[4] = 2;
    data
}

#[test]
fn the_charger_can_stop_and_the_vehicle_answers() {
    let session = run(Vehicle::new(60_000), Charger::new(Some(12_000)), |_, _| false);
    assert_eq!(session.phases(), [Phase::Done; 2]);
    let came = first(&session);
    // 5.17: byte 1 has the charger in bits 8 and 7. S25 is the other one.
    let position = |name, data: &str| came.iter().position(|one| (one.0, one.1.as_str()) == (name, data));
    let [cst, bst] = [("cst", "0100F0F0"), ("bst", "400000F0")].map(|(name, data)| position(name, data));
    assert!(cst.is_some() && cst < bst, "{came:?}");
    let at = |side: &side::Side, name| side.came.iter().find(|came| came.name == name).map(|came| came.at);
    let charged = at(&session.vehicle.side, "ccs").zip(at(&session.vehicle.side, "cst"));
    assert_eq!(charged.map(|(ccs, cst)| cst - ccs), Some(12_000));
}

#[test]
fn lost_frames_are_repeated_until_the_session_has_ended() {
    let mut attempts = 0;
    for seed in 0..60 {
        let mut random = Random::new(seed);
        let session = run(Vehicle::new(15_000), Charger::new(None), |_, _| random.chance(5));
        assert_eq!(session.phases(), [Phase::Done; 2], "seed {seed}");
        let (clean, came) = (first(&undisturbed()), first(&session));
        let is_known =
            |(name, data): &&(&str, String)| ["bem", "cem"].contains(name) || clean.contains(&(*name, data.clone()));
        assert_eq!(came.iter().find(|one| !is_known(one)), None, "seed {seed}: nothing comes that was not sent");
        attempts += session.vehicle.side.attempts + session.charger.side.attempts;
    }
    assert!(attempts < 20, "{attempts} attempts failed");
}

#[test]
fn a_session_ends_whatever_gets_lost() {
    let mut ended = [0; 2];
    for seed in 0..40 {
        let mut random = Random::new(seed);
        let percent = 10 + u8::try_from(random.below(60)).expect("a percentage");
        let session = run(Vehicle::new(15_000), Charger::new(None), |_, _| random.chance(percent));
        ended[usize::from(session.phases() == [Phase::Done; 2])] += 1;
    }
    assert!(ended.iter().all(|count| *count > 0), "{ended:?}");
}

/// Messages that get lost, and what must follow.
struct Loss {
    /// The format bytes of the messages.
    formats: &'static [u32],
    /// The first byte of their data, if others of them come.
    first: Option<u8>,
    /// From when on they get lost.
    from: u32,
    /// The first error message and its data.
    error: (&'static str, &'static str),
    /// The message with which the wait begins, by the beginning of its data, and the milliseconds from when it came.
    since: (&'static str, &'static str),
    wait: u32,
}

const LOST: Loss = Loss { formats: &[], first: None, from: 0, error: ("", ""), since: ("", ""), wait: 0 };

/// The data of errors are those of 5.21 and 5.22, with ones by 3.5. S33 and S35 are among them.
const LOSSES: [Loss; 12] = [
    Loss { formats: &[0x02], error: ("cem", "FDF0C0FC"), since: ("bhm", "F61C"), wait: 5000, ..LOST },
    Loss { formats: &[0x01], first: Some(0xAA), error: ("bem", "F4F0F0FC"), since: ("crm", "00"), wait: 5000, ..LOST },
    Loss { formats: &[0x06], error: ("cem", "FCF1C0FC"), since: ("brm", ""), wait: 5000, ..LOST },
    Loss { formats: &[0x08], error: ("bem", "F0F1F0FC"), since: ("crm", "AA"), wait: 5000, ..LOST },
    Loss { formats: &[0x09], error: ("cem", "FCF4C0FC"), since: ("bcp", ""), wait: 5000, ..LOST },
    // It is ready 600 ms after CML, and the charger 900 ms after BRO.
    Loss { formats: &[0x0A], error: ("bem", "F0F4F0FC"), since: ("cml", ""), wait: 5600, ..LOST },
    Loss { formats: &[0x10], error: ("cem", "FCF0C4FC"), since: ("bro", "AA"), wait: 5900, ..LOST },
    Loss { formats: &[0x11], error: ("cem", "FCF0C1FC"), since: ("bro", "AA"), wait: 5900, ..LOST },
    // Without CRM the charger gives up first. If nobody hears that, the vehicle waits on.
    Loss { formats: &[0x01, 0x1F], error: ("bem", "F1F0F0FC"), since: ("chm", ""), wait: 30_000, ..LOST },
    Loss { formats: &[0x10], from: 9000, error: ("cem", "FCF0C4FC"), since: ("bcl", ""), wait: 1000, ..LOST },
    Loss { formats: &[0x12], from: 9000, error: ("bem", "F0F0F1FC"), since: ("ccs", ""), wait: 1000, ..LOST },
    Loss { formats: &[0x11], from: 9000, error: ("cem", "FCF0C1FC"), since: ("bcs", ""), wait: 5000, ..LOST },
];

/// The waits of a side that stops begin when it sends, which is a millisecond before that comes.
const STOPS: [(Option<u32>, Loss); 5] = [
    (None, Loss { formats: &[0x1A], error: ("bem", "F0F0F4FC"), since: ("bst", ""), wait: 4999, ..LOST }),
    (None, Loss { formats: &[0x1D], error: ("bem", "F0F0F0FD"), since: ("bst", ""), wait: 9999, ..LOST }),
    (Some(5000), Loss { formats: &[0x19, 0x1C], error: ("cem", "FCF0D0FC"), since: ("cst", ""), wait: 4999, ..LOST }),
    (Some(5000), Loss { formats: &[0x19], error: ("cem", "FCF0D0FC"), since: ("cst", ""), wait: 4999, ..LOST }),
    (Some(5000), Loss { formats: &[0x1C], error: ("cem", "FCF0C0FD"), since: ("cst", ""), wait: 9999, ..LOST }),
];

/// Returns the first error message of a session, and what came before it, in order.
fn until_error(session: &Session) -> (Vec<Came>, Came) {
    let mut came = [&session.vehicle.side.came[..], &session.charger.side.came].concat();
    came.sort_by_key(|came| came.at);
    let place = came.iter().position(|came| ["bem", "cem"].contains(&came.name)).expect("there is an error");
    let error = came[place].clone();
    (came.drain(..place).collect(), error)
}

/// Tests that a session ends by the error message that a loss must cause, at its time.
fn notices(loss: &Loss, session: &Session) {
    let (before, error) = until_error(session);
    assert_eq!((error.name, error.data.as_str()), loss.error, "after {} ms", error.at);
    let is_since = |came: &&Came| came.name == loss.since.0 && came.data.starts_with(loss.since.1);
    let mut begins = before.iter().filter(is_since);
    let begin = if loss.from == 0 { begins.next() } else { begins.next_back() };
    assert_eq!(
        begin.map(|begin| error.at - 1 - begin.at),
        Some(loss.wait),
        "{:?} without {:X?}",
        loss.error,
        loss.formats
    );
    assert_eq!(session.phases(), [Phase::Failed; 2], "{:?}", loss.error);
}

fn run_with(loss: &Loss, charger: Charger) -> Session {
    run(Vehicle::new(25_000), charger, |frame, now| {
        let is_meant = loss.formats.contains(&message_of(frame));
        now >= loss.from && is_meant && loss.first.is_none_or(|first| frame.bytes()[0] == first)
    })
}

#[test]
fn a_message_that_never_comes_leads_to_the_error_message_of_the_document() {
    for loss in &LOSSES {
        notices(loss, &run_with(loss, Charger::new(None)));
    }
    for (enough, loss) in &STOPS {
        notices(loss, &run_with(loss, Charger::new(*enough)));
    }
}

#[test]
fn the_connector_has_to_be_plugged_after_three_attempts_to_connect_again() {
    // Section 8.3.
    let session = run(Vehicle::new(25_000), Charger::new(None), |frame, _| message_of(frame) == 0x02);
    for side in [&session.vehicle.side, &session.charger.side] {
        let count = |wanted| side.phases.iter().filter(|phase| **phase == wanted).count();
        assert_eq!([Phase::Handshake, Phase::Error, Phase::Failed].map(count), [4, 4, 1], "{:?}", side.phases);
    }
}

#[test]
fn a_side_that_does_not_become_ready_is_given_up_after_a_minute() {
    // Section 8.3.
    let mut vehicle = Vehicle::new(25_000);
    vehicle.getting_ready = 100_000;
    let loss = Loss { error: ("cem", "FCF4C0FC"), since: ("bcp", ""), wait: 60_000, ..LOST };
    notices(&loss, &run(vehicle, Charger::new(None), |_, _| false));
    let mut charger = Charger::new(None);
    charger.getting_ready = 100_000;
    let loss = Loss { error: ("bem", "F0F4F0FC"), since: ("cml", ""), wait: 60_600, ..LOST };
    notices(&loss, &run(Vehicle::new(25_000), charger, |_, _| false));
}

#[test]
fn a_session_begins_anew_after_a_time_out() {
    let session = run(Vehicle::new(15_000), Charger::new(None), |frame, now| now < 6000 && message_of(frame) == 0x06);
    assert_eq!(session.phases(), [Phase::Done; 2]);
    let [vehicle, charger] = [&session.vehicle.side, &session.charger.side];
    assert_eq!((charger.attempts, charger.missed, vehicle.attempts, vehicle.missed), (1, Some("bcp"), 1, None));
    let (before, error) = until_error(&session);
    assert_eq!((error.name, error.data.as_str()), ("cem", "FCF1C0FC"));
    assert!(before.iter().all(|came| came.name != "bcp"), "it was lost");
    assert_eq!(charger.phases.iter().filter(|phase| **phase == Phase::Handshake).count(), 2);
}

#[test]
fn a_vehicle_without_a_charger_gives_up_and_so_does_a_charger_without_a_vehicle() {
    let session = run(Vehicle::new(15_000), Charger::new(None), |_, _| true);
    assert_eq!(session.phases(), [Phase::Failed; 2]);
    // Section 8.3: no CRM after the start of the system, 60 s.
    assert_eq!(session.times(0x081E_56F4).first(), Some(&60_000));
    assert!(session.frames.iter().all(|(_, frame)| [0x26, 0x1E, 0x1F].contains(&message_of(frame))));
}
