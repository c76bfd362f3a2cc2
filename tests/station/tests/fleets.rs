//! The simulated modules without a station: each does what it is told, and says so.

mod bus;

use bus::fleets::{huaweis, megmeets, trios};
use bus::{Charger, rules};
use canspec_runtime::sim::{Bench, Event};
use canspec_runtime::{Addressed, Quantities, Quantity, Received};

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
    assert_eq!(told(megmeets(), &on), [[Some(53_500), Some(1)]; 4]);
    assert_eq!(told(huaweis(), &on), [[Some(53_500), Some(1)]; 3]);
    assert_eq!(told(trios(), &[(VOLTAGE, 24_000), (DELIVERING, 1)]), [[Some(24_000), Some(1)]; 3]);
    assert_eq!(told(megmeets(), &[(DELIVERING, 0)]), [[Some(0), Some(0)]; 4]);
    assert_eq!(told(huaweis(), &[(DELIVERING, 0)]), [[Some(0), Some(0)]; 3]);
    assert_eq!(told(trios(), &[(VOLTAGE, 24_000), (DELIVERING, 0)]), [[Some(0), Some(0)]; 3]);
}
