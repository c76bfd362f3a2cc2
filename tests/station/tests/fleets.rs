//! The simulated modules without a station, and stations of vendors whose modules have no groups.

mod bus;

use bus::fleets::{huaweis, megmeets, megmeets_at, trios};
use bus::{Bus, Charger, rules};
use canspec_protocols::{huawei, megmeet, trio};
use canspec_runtime::client::Output;
use canspec_runtime::sim::{Bench, Event};
use canspec_runtime::station::{Found, Limits, SetPoint, Settings, Station, Unfit};
use canspec_runtime::{Addressed, Quantities, Quantity, Received};
use canspec_station::{LIMITS, settings};

const VOLTAGE: Quantity = Quantity::OUTPUT_VOLTAGE;
const DELIVERING: Quantity = Quantity::DELIVERING;

/// Tells each module something and asks it. Returns what it says of its voltage, and whether it delivers.
fn told<P: Quantities + Addressed<Target: PartialEq>, const N: usize>(
    modules: [(u8, Charger<P>); N],
    values: &[(Quantity, i32)],
) -> [[Option<i32>; 2]; N] {
    let nodes = modules.map(|(node, _)| node);
    let target = |node: u8| P::module(node.into()).expect("an address");
    let set = nodes.iter().flat_map(|node| P::set(values, target(*node)).expect("the document allows it"));
    let read = nodes.iter().flat_map(|node| P::read(&[VOLTAGE, DELIVERING], target(*node)).expect("both are known"));
    let mut requests = set.chain(read);
    let mut bench = Bench::<P, Charger<P>, N, 64>::new(modules, rules::<P>(), 1);
    let mut said = [[None; 2]; N];
    for now in (0..5000).step_by(10) {
        if now % 200 == 0 {
            requests.next().into_iter().for_each(|request| bench.send(request.frame(), now));
        }
        while let Some(event) = bench.poll(now) {
            let Event::Frame { frame, .. } = event else { panic!("{event:?}") };
            let received = Received::<P>::decode(&frame).expect("a frame of the protocol");
            let place = nodes.iter().position(|node| received.node() == Some((*node).into())).expect("a module");
            for (known, quantity) in said[place].iter_mut().zip([VOLTAGE, DELIVERING]) {
                *known = received.quantity(quantity).or(*known);
            }
        }
    }
    said
}

#[test]
fn modules_of_every_vendor_do_what_they_are_told() {
    let on = [(VOLTAGE, 53_500), (DELIVERING, 1)];
    assert_eq!(told(megmeets_at([1, 2, 3, 4]), &on), [[Some(53_500), Some(1)]; 4]);
    assert_eq!(told(huaweis(), &on), [[Some(53_500), Some(1)]; 3]);
    assert_eq!(told(trios(), &[(VOLTAGE, 24_000), (DELIVERING, 1)]), [[Some(24_000), Some(1)]; 3]);
    assert_eq!(told(megmeets_at([1, 2, 3, 4]), &[(DELIVERING, 0)]), [[Some(0), Some(0)]; 4]);
    assert_eq!(told(huaweis(), &[(DELIVERING, 0)]), [[Some(0), Some(0)]; 3]);
    assert_eq!(told(trios(), &[(VOLTAGE, 24_000), (DELIVERING, 0)]), [[Some(0), Some(0)]; 3]);
}

/// Settings for modules of 48 V.
fn low<P: Quantities>() -> Settings {
    Settings { limits: Limits { least_mv: 42_000, most_mv: 58_000, ..LIMITS }, ..settings::<P>(Found::Off) }
}

#[test]
fn modules_without_groups_deliver_and_stop_in_the_group_that_the_program_chooses() {
    let mut bus = megmeets(low::<megmeet::Message>(), [1, 2, 3, 4], &[1, 2, 3], 1);
    bus.run(5000);
    bus.deliver(1, SetPoint { voltage_mv: 53_500, current_ma: None }, 20_000);
    let outputs = |bus: &mut Bus<megmeet::Message, 4, 1>| {
        [1, 2, 3, 4].map(|node| (bus.state(node).expect("it was found"), bus.device(node).is_on))
    };
    let (on, off) = ((Output::On, true), (Output::Off, false));
    assert_eq!(outputs(&mut bus), [on, on, on, off]);
    assert_eq!(bus.device(1).voltage_mv, Some(53_500));
    bus.stop(1, 40_000);
    assert_eq!(outputs(&mut bus), [off; 4]);
}

#[test]
fn vendors_whose_modules_do_not_answer_or_are_not_asked_have_no_station() {
    let silent = Station::<trio::Message, 1, 0, 5>::new(low::<trio::Message>(), [0xE0], []).err();
    let unasked = Station::<huawei::Message, 1, 0, 8>::new(low::<huawei::Message>(), [1], []).err();
    assert_eq!((silent, unasked), (Some(Unfit::Unread), Some(Unfit::Unread)));
}
