//! The bench itself, with heaters.

mod bus;

use std::string::{String, ToString};
use std::vec::Vec;

use super::{Answer, Bench, Complaint, Device, Event, Faults, Random, Rules, Tally};
use crate::plumbing::Who;
use crate::tests::heaters::{HEAT, Heat, Message, To, frame};
use crate::{Error, Frame, Problem, Reason, Received};

const RULES: Rules = Rules { gap: 20, watchdog: Some(1000), boot: 300 };

/// A heater, which does what it is told.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Heater {
    pub power_w: f64,
    /// The group that it belongs to.
    pub group: Option<u8>,
    /// What happened to it by itself.
    pub events: Vec<(u32, &'static str)>,
    /// How often it was told something, and when last.
    pub told: Vec<(u32, f64)>,
}

impl Device<Message> for Heater {
    fn answer(&mut self, request: &Received<Message>, now: u32) -> Answer<Message> {
        if let Message::Heat(Heat { power_w }) = *request.content() {
            self.power_w = power_w;
            self.told.push((now, power_w));
        }
        Answer::Values(Message::Heat(Heat { power_w: self.power_w }))
    }

    fn is_asked(&self, request: &Received<Message>) -> bool {
        match request.target() {
            Some(To::Group(group)) => self.group == Some(group),
            other => other == Some(To::All),
        }
    }

    fn silence(&mut self, now: u32) {
        self.power_w = 0.0;
        self.events.push((now, "alone"));
    }

    fn power_on(&mut self, now: u32) {
        self.power_w = 0.0;
        self.events.push((now, "on"));
    }

    fn drift(&self, _: Message) -> Message {
        Message::Heat(Heat { power_w: self.power_w + 10.0 })
    }
}

type Heaters = Bench<Message, Heater, 3, 16>;

/// Heaters 1 and 2 of group 2, and heater 3.
fn heaters(seed: u64) -> Heaters {
    let heater = |group| Heater { group, ..Heater::default() };
    Bench::new([(1, heater(Some(2))), (2, heater(Some(2))), (3, heater(None))], RULES, seed)
}

fn set(target: To) -> Frame {
    *HEAT.set(target).expect("a legal request").frame()
}

/// Returns all that comes until a time, as texts with their times.
fn events(bench: &mut Heaters, times: core::ops::Range<u32>) -> Vec<(u32, String)> {
    let mut events = Vec::new();
    for now in times {
        while let Some(event) = bench.poll(now) {
            events.push((
                now,
                match event {
                    Event::Frame { frame, .. } => frame.to_string(),
                    Event::Complaint(complaint) => complaint.to_string(),
                },
            ));
        }
    }
    events
}

fn texts<const M: usize>(expected: [(u32, &str); M]) -> Vec<(u32, String)> {
    expected.map(|(now, text)| (now, text.to_string())).into()
}

/// Returns the answer of heater 3 under some faults.
fn answers(faults: Faults) -> Vec<(u32, String)> {
    let mut bench = heaters(1);
    *bench.faults(3).expect("heater 3") = faults;
    bench.send(&set(To::Heater(3)), 0);
    events(&mut bench, 0..50)
}

#[test]
fn the_module_that_is_asked_answers_and_does_what_it_is_told() {
    assert_eq!(answers(Faults::NONE), texts([(1, "0107F003#02F00096")]));
    let mut bench = heaters(1);
    bench.send(&set(To::Heater(3)), 0);
    let powers = [1, 2, 3].map(|node| bench.device(node).expect("a heater").power_w);
    assert_eq!(powers.map(f64::to_bits), [0.0, 0.0, 1500.0].map(f64::to_bits));
}

#[test]
fn each_member_of_a_group_answers_and_nobody_answers_all() {
    let mut bench = heaters(1);
    bench.send(&set(To::Group(2)), 0);
    assert_eq!(events(&mut bench, 0..50), texts([(1, "0107F001#02F00096"), (1, "0107F002#02F00096")]));
    bench.send(&set(To::All), 50);
    assert_eq!(events(&mut bench, 50..100), []);
    assert!((1..=3).all(|node| bench.device(node).is_some_and(|heater| heater.power_w > 0.0)));
}

#[test]
fn one_module_answers_for_all() {
    assert_eq!(Heat::READ.who(1), Some(Who::Coordinator));
    let read = Heat::READ.request_to::<To, Heat>(To::Group(2), &()).expect("a legal request");
    let mut bench = heaters(1);
    bench.send(read.frame(), 0);
    assert_eq!(events(&mut bench, 0..50), texts([(1, "0108F05D#00000000")]));
}

#[test]
fn every_fault_shows() {
    let always = |change: fn(&mut Faults)| {
        let mut faults = Faults::NONE;
        change(&mut faults);
        answers(faults)
    };
    assert_eq!(always(|faults| faults.deaf = 100), []);
    assert_eq!(always(|faults| faults.lost = 100), []);
    assert_eq!(always(|faults| faults.twice = 100), texts([(1, "0107F003#02F00096"); 2]));
    assert_eq!(always(|faults| (faults.refused, faults.code) = (100, 5)), texts([(1, "1507F003#02F00000")]));
    assert_eq!(always(|faults| faults.drifted = 100), texts([(1, "0107F003#02F00097")]));
    let broken = always(|faults| faults.broken = 100);
    assert!(broken == texts([(1, "0107F003#02F000")]) || broken == texts([(1, "0107F003#02F0009600")]));
    let disguised = always(|faults| faults.disguised = 100);
    assert!(["04", "05", "06"].iter().any(|other| disguised == [(1, std::format!("0107F0{other}#02F00096"))]));
    let slow = always(|faults| faults.slowest = 40);
    assert!(slow.len() == 1 && slow.iter().all(|(now, _)| (2..=40).contains(now)));
    assert_eq!(always(|faults| faults.dies = Some(0)), []);
}

#[test]
fn a_dead_module_neither_hears_nor_says_anything() {
    let mut bench = heaters(1);
    bench.faults(3).expect("heater 3").dies = Some(10);
    assert!(bench.is_up(3));
    assert_eq!(events(&mut bench, 0..20), []);
    bench.send(&set(To::Heater(3)), 20);
    assert_eq!((events(&mut bench, 20..100), bench.is_up(3)), (Vec::new(), false));
    assert_eq!(bench.device(3).expect("heater 3").told, []);
}

#[test]
fn a_module_that_starts_anew_refuses_until_it_has_started() {
    let mut bench = heaters(1);
    bench.send(&set(To::Heater(3)), 0);
    bench.faults(3).expect("heater 3").restarts = Some(100);
    assert_eq!(events(&mut bench, 0..101).len(), 1);
    assert!(!bench.is_up(3));
    bench.send(&set(To::Heater(3)), 101);
    assert_eq!(events(&mut bench, 101..399), texts([(102, "1D07F003#02F00000")]));
    assert_eq!(events(&mut bench, 399..401), []);
    assert!(bench.is_up(3));
    let heater = bench.device(3).expect("heater 3");
    assert_eq!((heater.power_w.to_bits(), &*heater.events), (0.0_f64.to_bits(), &[(100, "on")][..]));
}

#[test]
fn a_module_can_be_mute_while_it_starts() {
    let mut bench = heaters(1);
    bench.faults(3).expect("heater 3").is_mute_at_start = true;
    bench.restart(3, 0);
    bench.send(&set(To::Heater(3)), 1);
    assert_eq!(events(&mut bench, 1..400), []);
    bench.send(&set(To::Heater(3)), 400);
    assert_eq!(events(&mut bench, 400..402).len(), 1);
}

#[test]
fn a_watchdog_runs_out_once_until_the_module_hears_something() {
    let mut bench = heaters(1);
    bench.send(&set(To::Heater(3)), 500);
    let unfed = |node| std::format!("module {node} has heard nothing until its watchdog ran out");
    let told = events(&mut bench, 501..4000);
    let complaints: Vec<_> = told.into_iter().filter(|(_, text)| text.starts_with("module")).collect();
    assert_eq!(complaints, [(1001, unfed(1)), (1001, unfed(2)), (1501, unfed(3))]);
    assert_eq!(bench.device(3).expect("heater 3").events, [(1501, "alone")]);
    bench.send(&set(To::Heater(3)), 4000);
    assert_eq!(events(&mut bench, 4001..5001).len(), 1);
    assert_eq!(events(&mut bench, 5001..5002), [(5001, unfed(3))]);
}

#[test]
fn a_client_must_keep_the_gap_and_send_what_the_document_allows() {
    let mut bench = heaters(1);
    let mut complaints = |request: Frame, now| {
        bench.send(&request, now);
        let events = core::iter::from_fn(|| bench.poll(now)).collect::<Vec<_>>();
        events.into_iter().filter(|event| matches!(event, Event::Complaint(_))).collect::<Vec<_>>()
    };
    let legal = set(To::Heater(3));
    assert_eq!([complaints(legal, 0), complaints(legal, 20)], [[], []]);
    let soon = Event::Complaint(Complaint::Gap { frame: legal, after: 19 });
    assert_eq!(complaints(legal, 39), [soon]);
    let foreign = frame(0x0455_0000, [0; 4]);
    let unrecognised = Complaint::Unrecognised { frame: foreign, problem: Problem::Identifier };
    assert_eq!(complaints(foreign, 100), [Event::Complaint(unrecognised)]);
    let reply = frame(0x0107_F003, [2, 0xF0, 0, 150]);
    assert_eq!(complaints(reply, 200), [Event::Complaint(Complaint::Direction(reply))]);
    let hot = frame(0x0107_03F0, [1, 0, 0, 201]);
    assert!(matches!(&*complaints(hot, 300), [Event::Complaint(Complaint::Illegal { frame, .. })] if *frame == hot));
}

/// A heater that answers everything with the same.
struct Stubborn(Answer<Message>);

impl Device<Message> for Stubborn {
    fn answer(&mut self, _: &Received<Message>, _: u32) -> Answer<Message> {
        self.0
    }
}

#[test]
fn a_device_must_answer_with_a_reply_to_the_request() {
    let complaints = |answer, target| {
        let mut bench = Bench::<Message, Stubborn, 1, 4>::new([(3, Stubborn(answer))], RULES, 1);
        bench.send(&set(target), 0);
        (0..9).filter_map(|now| bench.poll(now)).collect::<Vec<_>>()
    };
    let error = |answer| match *complaints(answer, To::Heater(3)) {
        [Event::Complaint(Complaint::Answer { node: 3, error })] => error,
        ref other => panic!("{other:?}"),
    };
    let hot = Answer::Values(Message::Heat(Heat { power_w: 1e6 }));
    assert!(matches!(error(hot).reason(), Some(Reason::Limits { .. })));
    assert!(matches!(error(Answer::Values(Message::ReadHeat)), Error::Identifier { message: "heat", .. }));
    assert_eq!(error(Answer::Refusal(0)), Error::Code { message: "heat", code: 0 });
    assert_eq!(complaints(hot, To::All), [], "nobody answers all heaters");
}

#[test]
fn one_message_can_be_refused_or_cut_for_ever() {
    let run = |refused, short| {
        let mut bench = heaters(1);
        let faults = Faults { always_refused: refused, always_short: short, code: 5, ..Faults::NONE };
        *bench.faults(3).expect("heater 3") = faults;
        let mut all = Vec::new();
        for now in [0, 50, 100] {
            bench.send(&set(To::Heater(3)), now);
            all.extend(events(&mut bench, now..now + 50).into_iter().map(|(_, text)| text));
        }
        let Tally { refused, broken, .. } = bench.tally();
        (all, refused, broken)
    };
    let thrice = |text: &str| std::vec![text.to_string(); 3];
    assert_eq!(run(Some("heat"), None), (thrice("1507F003#02F00000"), 3, 0));
    assert_eq!(run(None, Some("heat")), (thrice("0107F003#02F000"), 0, 3));
    assert_eq!(run(Some("cold"), Some("cold")), (thrice("0107F003#02F00096"), 0, 0));
}

/// A device that notes what happens to it.
#[derive(Default)]
struct Diary(Vec<&'static str>);

impl Device<Message> for Diary {
    fn answer(&mut self, _: &Received<Message>, _: u32) -> Answer<Message> {
        self.0.push("answers");
        Answer::Silence
    }

    fn silence(&mut self, _: u32) {
        self.0.push("is alone");
    }

    fn wake(&mut self, _: u32) {
        self.0.push("wakes");
    }
}

#[test]
fn a_module_that_was_alone_wakes_before_it_answers() {
    let mut bench = Bench::<Message, Diary, 1, 4>::new([(3, Diary::default())], RULES, 1);
    for now in [900, 2000, 2020] {
        let _ = bench.poll(now);
        bench.send(&set(To::Heater(3)), now);
    }
    assert_eq!(bench.device(3).expect("a device").0, ["answers", "is alone", "wakes", "answers", "answers"]);
    assert_eq!(bench.tally().wakes, 1);
}

#[test]
fn tallies_add_up() {
    let mut sum = Tally {
        lost: 1,
        twice: 2,
        broken: 3,
        disguised: 4,
        refused: 5,
        drifted: 6,
        delay: 7,
        restarts: 8,
        deaths: 9,
        wakes: 10,
        doubles: 11,
        others: 12,
        blocked: 13,
        delayed: 14,
    };
    sum += sum;
    let Tally { lost, twice, broken, disguised, refused, drifted, delay, .. } = sum;
    assert_eq!([lost, twice, broken, disguised, refused, drifted, delay], [2, 4, 6, 8, 10, 12, 14]);
    let Tally { restarts, deaths, wakes, doubles, others, blocked, delayed, .. } = sum;
    assert_eq!([restarts, deaths, wakes, doubles, others, blocked, delayed], [16, 18, 20, 22, 24, 26, 28]);
}

#[test]
fn a_seed_decides_everything_and_another_one_decides_otherwise() {
    let run = |seed| {
        let mut bench = heaters(seed);
        let mut random = Random::new(seed);
        for node in 1..=3 {
            *bench.faults(node).expect("a heater") = Faults { slowest: 50, ..Faults::random(&mut random, 30, 2000) };
        }
        let mut all = Vec::new();
        for now in (0..4000).step_by(40) {
            bench.send(&set(To::Group(2)), now);
            all.extend(events(&mut bench, now..now + 40));
        }
        all
    };
    assert!(run(1) == run(1) && run(1) != run(2));
}

#[test]
fn random_numbers_reach_every_value_below_their_limit() {
    let mut random = Random::new(3);
    let mut counts = [0; 10];
    for _ in 0..10_000 {
        let number = usize::try_from(random.below(10)).expect("it is below 10");
        counts[number] += 1;
    }
    // 1000 each are expected, with a deviation of 30.
    assert!(counts.iter().all(|count| (850..1150).contains(count)), "{counts:?}");
    assert_eq!((random.below(0), random.chance(0), random.chance(100)), (0, false, true));
}

/// A device that reports its number each 10 ms.
struct Reporter(u32);

impl Device<Message> for Reporter {
    fn answer(&mut self, _: &Received<Message>, _: u32) -> Answer<Message> {
        Answer::Silence
    }

    fn report(&mut self, node: u8, now: u32) -> Option<Frame> {
        if now < self.0 {
            return None;
        }
        self.0 = now + 10;
        Some(frame(0x010A_F000 | u32::from(node), [0; 4]))
    }
}

#[test]
fn a_device_that_is_up_reports_by_itself() {
    let reports = |faults: Faults| -> Vec<usize> {
        let mut bench: Bench<Message, Reporter, 1, 4> = Bench::new([(3, Reporter(0))], RULES, 1);
        *bench.faults(3).expect("a device") = faults;
        let is_report =
            |event: Event| matches!(event, Event::Frame { frame: report, .. } if report == frame(0x010A_F003, [0; 4]));
        (0..25).map(|now| core::iter::from_fn(|| bench.poll(now)).filter(|event| is_report(*event)).count()).collect()
    };
    let when = |times: &[usize], count| (0..25).map(|now| if times.contains(&now) { count } else { 0 }).collect();
    let expected: [Vec<usize>; 4] = [when(&[1, 11, 21], 1), when(&[1, 11, 21], 2), when(&[], 0), when(&[1], 1)];
    let faults = [
        Faults::NONE,
        Faults { twice: 100, ..Faults::NONE },
        Faults { lost: 100, ..Faults::NONE },
        Faults { dies: Some(5), ..Faults::NONE },
    ];
    assert_eq!(faults.map(reports), expected);
}

/// A device that reports three times at once, each 10 ms.
struct Burst {
    due: u32,
    said: u8,
}

impl Device<Message> for Burst {
    fn answer(&mut self, _: &Received<Message>, _: u32) -> Answer<Message> {
        Answer::Silence
    }

    fn report(&mut self, node: u8, now: u32) -> Option<Frame> {
        if now < self.due {
            return None;
        }
        self.said += 1;
        if self.said > 3 {
            (self.due, self.said) = (now + 10, 0);
            return None;
        }
        Some(frame(0x010A_F000 | u32::from(node), [self.said; 4]))
    }
}

#[test]
fn a_device_is_asked_for_reports_until_it_has_none() {
    let mut bench: Bench<Message, Burst, 1, 4> = Bench::new([(3, Burst { due: 0, said: 0 })], RULES, 1);
    let mut reports = |now| core::iter::from_fn(|| bench.poll(now)).count();
    let counts: Vec<usize> = (0..15).map(&mut reports).collect();
    assert_eq!(counts, [0, 3, 0, 0, 0, 0, 0, 0, 0, 0, 0, 3, 0, 0, 0]);
}

/// A device that counts its reports, one each 7 ms.
struct Counting(u8);

impl Device<Message> for Counting {
    fn answer(&mut self, _: &Received<Message>, _: u32) -> Answer<Message> {
        Answer::Silence
    }

    fn report(&mut self, node: u8, now: u32) -> Option<Frame> {
        if now < 7 * u32::from(self.0) {
            return None;
        }
        self.0 += 1;
        Some(frame(0x010A_F000 | u32::from(node), [self.0; 4]))
    }
}

#[test]
fn slow_frames_overtake_those_of_other_devices_and_never_their_own() {
    let mut are_mixed = false;
    for seed in 0..20 {
        let mut bench: Bench<Message, Counting, 2, 32> = Bench::new([(1, Counting(0)), (2, Counting(0))], RULES, seed);
        for node in [1, 2] {
            bench.faults(node).expect("a device").slowest = 50;
        }
        let mut heard: [Vec<u8>; 2] = [Vec::new(), Vec::new()];
        for now in 0..300 {
            for event in core::iter::from_fn(|| bench.poll(now)) {
                let Event::Frame { frame, .. } = event else { continue };
                heard[usize::from(frame.raw_id() & 0xFF == 2)].push(frame.bytes()[0]);
            }
            are_mixed |= heard[0].len() > heard[1].len() + 1;
        }
        let sent: Vec<u8> = (1..=u8::MAX).take(heard[0].len().max(heard[1].len())).collect();
        assert!(sent.len() > 30 && heard.iter().all(|heard| sent.starts_with(heard)), "seed {seed}: {heard:?}");
    }
    assert!(are_mixed);
}

#[test]
fn a_bench_takes_no_more_memory_than_its_documentation_says() {
    type Sized<const N: usize, const W: usize> = Bench<Message, [u8; 0], N, W>;
    let sizes = [size_of::<Sized<0, 0>>(), size_of::<Sized<1, 0>>(), size_of::<Sized<0, 1>>()];
    let [none, device, frame] = sizes;
    assert!(none <= 616 && device - none <= 208 && frame - none <= 24, "{sizes:?}");
}
