//! A received frame shows whom it reaches and which module it is about, as the interpreter reads it.

use canspec_codegen::interpret::{Decoded, Frame, decode};
use canspec_codegen::model::{AddressTypeId, ModeId, Protocol, Travel};
use canspec_protocols::{gbt27930, gcp, infy};
use canspec_runtime::{Addressed, Destination, Error, Route};
use canspec_tests::features_peers::{self as peers, Limits, Target};
use canspec_tests::{AddressedVisitor, Frames, protocol, received, visit_addressed};

/// How many random frames each protocol sees.
const FRAMES: usize = 20_000;

#[derive(Default)]
struct Ends {
    targets: usize,
    nodes: usize,
}

impl AddressedVisitor for Ends {
    fn visit<P: Addressed>(&mut self, path: &str) {
        let protocol = protocol(path);
        let nodes = nodes(&protocol);
        let mut frames = Frames::new(&protocol, 0x7A46);
        for _ in 0..FRAMES {
            let frame = frames.next_frame();
            let (Ok(received), Ok(decoded)) = (received::<P>(None, &frame), decode(&protocol, None, &frame)) else {
                continue;
            };
            let target = received.target().map(|target| P::MODES[target.mode()].name);
            assert_eq!(target, target_of(&protocol, &decoded, &frame), "{path}: {frame:X?}");
            let node = node_of(&protocol, &nodes, &decoded, &frame);
            assert_eq!(received.node().map(i64::from), node, "{path}: {frame:X?}");
            self.targets += usize::from(target.is_some());
            self.nodes += usize::from(node.is_some());
        }
    }
}

#[test]
fn random_frames_show_the_target_and_the_node_that_the_interpreter_reads() {
    let mut ends = Ends::default();
    visit_addressed(&mut ends);
    assert!(ends.targets > FRAMES && ends.nodes > FRAMES, "{} and {} are few", ends.targets, ends.nodes);
}

/// Returns the kinds of addresses by which modules answer for themselves.
fn nodes(protocol: &Protocol) -> Vec<AddressTypeId> {
    let patterns = protocol.modes.iter().flat_map(|mode| [&mode.one, &mode.each]).flatten();
    let kinds = patterns.flat_map(|pattern| &pattern.addresses).map(|address| address.address_type);
    kinds.filter(|kind| protocol[*kind].send.is_none()).collect()
}

/// Returns the address of a module, if the message has the mode.
fn node_of(protocol: &Protocol, nodes: &[AddressTypeId], decoded: &Decoded, frame: &Frame) -> Option<i64> {
    offered(protocol, decoded)?;
    let mut addresses = decoded.addresses(protocol, frame.id);
    addresses.find(|(kind, _)| nodes.contains(kind)).map(|(_, number)| number)
}

/// Returns the mode of a request, if the identifier shows all of its target.
fn target_of<'a>(protocol: &'a Protocol, decoded: &Decoded, frame: &Frame) -> Option<&'a str> {
    let mode = &protocol[offered(protocol, decoded)?];
    mode.request.as_ref()?;
    let mut addresses = decoded.addresses(protocol, frame.id);
    let is_shown = mode.target.is_none_or(|target| addresses.any(|(kind, _)| kind == target));
    is_shown.then_some(mode.name.as_str())
}

/// Returns the addressing mode that an identifier shows, if the message has it.
fn offered(protocol: &Protocol, decoded: &Decoded) -> Option<ModeId> {
    let shown = decoded.addressing?;
    let layout = &protocol[decoded.frame];
    let is_its = |own: &Travel| own.mode == shown.mode && (layout.is_to_module() || own.who == shown.who);
    layout.travels.iter().any(is_its).then_some(shown.mode)
}

/// Returns what a frame of eight zeros shows.
macro_rules! shown {
    ($protocol:ident, $id:expr) => {{
        let frame = $protocol::Frame::new_raw($id, true, [0; 8], 8);
        let received = $protocol::Message::decode(&frame).expect("a frame of the protocol");
        (received.target(), received.route().and_then(|route| route.sender()), received.node())
    }};
}

#[test]
fn a_reply_shows_whom_its_request_addressed() {
    use infy::Target;
    assert_eq!(shown!(infy, 0x0283_05F1), (Some(Target::Module(5)), Some(0xF1), Some(5)));
    assert_eq!(shown!(infy, 0x0283_F105), (Some(Target::Module(5)), Some(0xF1), Some(5)));
    assert_eq!(shown!(infy, 0x02C3_02F0), (Some(Target::Group(2)), Some(0xF0), None));
    assert_eq!(shown!(infy, 0x02C3_F005), (None, None, Some(5)), "each module of some group answers");
    assert_eq!(shown!(infy, 0x02C1_F002), (Some(Target::Group(2)), Some(0xF0), None), "one answers for the group");
    assert_eq!(shown!(infy, 0x0281_F03F), (Some(Target::Broadcast), Some(0xF0), None));
    assert_eq!(shown!(infy, 0x0283_3FF0), (None, None, None), "nobody reads a module's output by broadcast");
}

#[test]
fn addresses_are_those_that_the_document_counts() {
    assert_eq!(shown!(gcp, 0x0283_85F0), (Some(gcp::Target::MpptModule(5)), Some(0xF0), Some(5)));
    assert_eq!(shown!(gcp, 0x0283_F005), (Some(gcp::Target::Module(5)), Some(0xF0), Some(5)));
}

#[test]
fn of_two_peers_the_controller_is_the_one_that_requests_come_from() {
    use gbt27930::Target;
    assert_eq!(shown!(gbt27930, 0x1CEB_F456), (Some(Target::Peer), Some(0x56), None));
    assert_eq!(shown!(gbt27930, 0x1CEB_56F4), (Some(Target::Peer), Some(0x56), None));
    assert_eq!(shown!(gbt27930, 0x1CEB_FF56), (Some(Target::Everybody), Some(0x56), None));
    assert_eq!(shown!(gbt27930, 0x1CEB_FFF4), (Some(Target::Everybody), None, None), "the BMS tells all");
}

#[test]
fn another_sender_changes_its_own_address_and_not_that_of_its_peer() {
    let sent = |route: Route<Target>| Limits { current_a: 125.0 }.offer(route).map(|sent| sent.frame().raw_id());
    assert_eq!(sent(Target::Peer.sent_by(0x57)), Ok(0x0001_F457));
    assert_eq!(sent(Target::Everybody.sent_by(0x57)), Ok(0x0001_FF57));
    assert_eq!(sent(Target::Service.sent_by(0x22)), Ok(0x0001_FE22));
    for stranger in [Target::Peer.sent_by(0xF5), Target::Service.sent_by(0x57)] {
        assert!(matches!(sent(stranger), Err(Error::Address { .. })));
    }
    let request = Limits { current_a: 125.0 }.offer(Target::Peer.sent_by(0x57)).expect("a charger");
    let reply = |id| request.is_reply(&peers::Frame::new_raw(id, true, [0; 8], 2));
    assert_eq!([0x0001_57F4, 0x0001_56F4, 0x0001_57F5].map(reply), [true, false, false]);
}
