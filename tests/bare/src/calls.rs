//! Calls of what every protocol has: the traits and the types of the runtime.

use core::fmt::{self, Display, Write};
use core::hint::black_box;

use canspec_runtime::assembler::{Assembler, Partial};
use canspec_runtime::client::{self, Client, Heard, Pace, Step};
use canspec_runtime::parts::{self, Outcome, Parted};
use canspec_runtime::plumbing::{Physical, Raw};
use canspec_runtime::sim::{Answer, Bench, Device, Driver, Faults, Outage, Random, Rules};
use canspec_runtime::transfers::{self, Filled, Grouped, Transferred, Transport};
use canspec_runtime::{
    Addressed, AnySignal, Destination, Error, FrameSet, Layout, LongLayout, Meaning, Problem, Protocol, Quantities,
    Quantity, Reading, Received, Request, Route, Signal, WriteSignal, embedded_can::Frame as _, isotp, tp,
};

use crate::unknown::{Unknown, unknown};

/// Makes the compiler believe that the value is needed.
#[expect(clippy::needless_pass_by_value, reason = "callers hand over what calls return")]
pub fn sink<T>(value: T) {
    black_box(&value);
}

/// Formats a value.
pub fn text(value: &impl Display) {
    struct Sink;

    impl Write for Sink {
        fn write_str(&mut self, text: &str) -> fmt::Result {
            sink(text);
            Ok(())
        }
    }

    sink(write!(Sink, "{value}"));
}

/// Recognises a frame.
pub fn decode<P: Protocol>() {
    sink(Received::<P>::decode(&unknown_frame()));
}

/// Recognises a frame and encodes another.
pub fn echo<P: Protocol + Unknown>() {
    if let Ok(received) = Received::<P>::decode(&unknown_frame()) {
        sink(received.content());
        sink(received.with_content(unknown()).encode());
    }
}

/// Reads and sets quantities.
pub fn quantities<P: Quantities + Addressed<Target: Unknown>>() {
    if let Ok(received) = Received::<P>::decode(&unknown_frame()) {
        P::READS.iter().for_each(|path| sink(received.quantity(path.quantity)));
    }
    let values = [(Quantity::OUTPUT_VOLTAGE, unknown()), (Quantity::DELIVERING, unknown())];
    if let Ok(requests) = P::read(&values.map(|(quantity, _)| quantity), unknown::<P::Target>()) {
        requests.for_each(sink);
    }
    if let Ok(requests) = P::set(&values, unknown::<P::Target>()) {
        requests.for_each(sink);
    }
    if let Ok(requests) = P::set_within(unknown::<u8>(), &values, unknown::<P::Target>()) {
        requests.for_each(sink);
    }
}

/// Recognises a frame and shows its signals.
pub fn visit<P: Protocol>() {
    if let Ok(received) = Received::<P>::decode(&unknown_frame()) {
        received.visit(|reading| sink((reading.raw, reading.meaning)));
    }
}

/// Recognises a frame and asks for all that it says; builds it anew, and with other values and another identifier.
pub fn received<P: Protocol<Identifier: Unknown> + Unknown>() {
    let frame = unknown_frame();
    let received =
        if unknown() { Received::<P>::decode(&frame) } else { Received::decode_for(unknown::<u8>(), &frame) };
    let received = match received {
        Ok(received) => received,
        Err(problem) => return text(&problem),
    };
    sink((received.request(), received.report(), received.content()));
    match received.reply() {
        Some(Err(failure)) => text(&failure),
        reply => sink(reply),
    }
    sink((received.identifier(), received.frame(), received.kind(), received.exchange()));
    sink((received.addressing(), received.node(), received.is_error_reply(), received.reserved()));
    received.selectors().for_each(sink);
    received.conditions().chain(received.faults()).chain(received.alarms()).for_each(sink);
    received.visit(reading);
    sink(received.encode());
    sink(received.with_identifier(unknown()).encode());
    let other = received.with_content(unknown());
    sink(other.encode());
    other.visit(reading);
}

/// Goes through the list of messages.
pub fn entries<P: Protocol>() {
    for entry in P::MESSAGES {
        sink((entry.name(), entry.title, entry.constants));
        entry.exchanges.iter().for_each(|exchange| sink((exchange.access(), exchange.has_values())));
        entry.signals.iter().for_each(|signal| sink((signal.name(), signal.unit(), signal.place(), signal.limits())));
    }
}

/// Asks for every message without naming one, and whom a frame reaches.
pub fn questions<T: Destination<Protocol: Addressed + Unknown> + Unknown>() {
    if let Ok(received) = Received::<T::Protocol>::decode(&unknown_frame()) {
        sink((received.target(), received.route()));
        sink((received.answer(unknown::<i32>(), unknown()), received.refuse(unknown::<i32>(), unknown())));
    }
    for entry in T::Protocol::MESSAGES {
        entry.request(unknown(), unknown::<Route<T>>()).into_iter().for_each(request);
    }
}

/// Asks modules by a client, with every message that carries nothing.
pub fn client<T: Destination<Protocol: Addressed<Target = T> + Unknown> + Unknown>() {
    bench::<T::Protocol>();
    let pace = Pace { gap: unknown(), wait: unknown(), tries: unknown(), late: unknown() };
    let mut client = Client::<T::Protocol, 3, 2>::new(pace);
    if unknown() {
        client = client.for_model(unknown::<u8>());
    }
    for request in T::Protocol::MESSAGES.iter().filter_map(|entry| entry.request(unknown(), unknown::<Route<T>>())) {
        let Ok(request) = request else { continue };
        ticket(client.ask(request, unknown()));
        ticket(client.ask_at(pace, request, unknown()));
        ticket(client.keep_alive(request, unknown(), unknown()));
        match client.hold(request, unknown(), |_, _| unknown(), unknown()) {
            Ok(held) => {
                client.hurry(held, unknown());
                sink(client.hold_after(held, request, |_, _| unknown(), unknown()));
            }
            Err(error) => text(&error),
        }
        if let Ok(asked) = client.every(unknown(), request, unknown()) {
            client.cancel(asked);
        }
    }
    sink(client.members(unknown::<Route<T>>(), unknown::<[u8; 3]>()));
    for _ in 0..unknown::<u8>() {
        match client.poll(unknown()) {
            Step::Send { frame, .. } => sink(frame),
            step => sink(step),
        }
        match client.handle(&unknown_frame(), unknown()) {
            Heard::Answer { ticket, received } | Heard::Refusal { ticket, received } => sink((ticket, received)),
            heard => sink(heard),
        }
        client.silent().iter().for_each(sink);
    }
    sink(client);
}

/// Does what nobody foresees.
#[derive(Clone, Copy)]
struct Any;

impl<P: Addressed + Unknown> Device<P> for Any {
    fn answer(&mut self, request: &Received<P>, _now: u32) -> Answer<P> {
        sink(request);
        if unknown() { Answer::Values(unknown()) } else { Answer::Refusal(unknown()) }
    }
}

/// Simulates modules.
fn bench<P: Addressed + Unknown>() {
    let rules = Rules { gap: unknown(), watchdog: Some(unknown()), boot: unknown() };
    let mut bench = Bench::<P, Any, 2, 3>::new([(unknown(), Any), (unknown(), Any)], rules, unknown());
    sink(bench.another_controller(unknown_frame(), unknown(), unknown()));
    bench.cut(Outage {
        from: unknown(),
        until: unknown(),
        driver: if unknown() { Driver::Drops } else { Driver::Buffers },
    });
    for _ in 0..unknown::<u8>() {
        if let Some(faults) = bench.faults(unknown()) {
            *faults = Faults::random(&mut Random::new(unknown()), unknown(), unknown());
            faults.slowest = unknown();
        }
        bench.send(&unknown_frame(), unknown());
        bench.restart(unknown(), unknown());
        sink((bench.poll(unknown()), bench.is_up(unknown()), bench.device(unknown())));
    }
}

fn ticket(asked: Result<client::Ticket, impl core::fmt::Display>) {
    match asked {
        Ok(ticket) => sink(ticket),
        Err(full) => text(&full),
    }
}

/// Decodes and encodes what a message carries.
pub fn layout<T: Layout + Unknown>() {
    sink((T::decode(&unknown()), unknown::<T>().encode(&mut unknown()), T::SIGNALS));
}

/// Decodes and encodes what several frames carry together.
pub fn long_layout<L: LongLayout + Unknown>() {
    let mut data: [u8; 64] = unknown();
    sink(L::decode(&data));
    match unknown::<L>().encode(&mut data) {
        Ok(bytes) => sink(bytes),
        Err(error) => sink(error),
    }
}

/// Puts parts together, takes a message apart, and asks for all that is known of it.
pub fn parted<L: Parted<Protocol: Protocol<Identifier: Unknown> + Unknown> + Unknown>() {
    let mut assembler = parts::Assembler::<L, 3>::new(unknown());
    if unknown() {
        assembler = assembler.for_model(unknown::<u8>());
    }
    for _ in 0..unknown::<u8>() {
        assembler.receive(&unknown_frame(), unknown()).for_each(outcome);
    }
    assembler.timed_out(unknown()).into_iter().for_each(outcome);
    assembler.finish().into_iter().for_each(outcome);
    sink(assembler);
    match unknown::<L>().frames(&unknown_frame()) {
        Ok(frames) => frames.for_each(sink),
        Err(error) => sink(error),
    }
    if let Ok(frames) = unknown::<L>().frames_for(unknown::<u8>(), &unknown_frame()) {
        frames.for_each(sink);
    }
    if let Ok(parts) = unknown::<L>().parts() {
        parts.for_each(sink);
    }
}

fn outcome<L: Parted>(outcome: Outcome<L>) {
    match outcome {
        Outcome::Whole(whole) => {
            sink((whole.values, whole.is_counted, whole.identifier(), whole.frame(), whole.is_to_module()));
        }
        Outcome::Incomplete(partial) => {
            partial.missing().for_each(sink);
            sink((partial.part(unknown()), partial.data(), partial.identifier(), partial.frame()));
            sink(partial.is_to_module());
        }
        Outcome::Full(frame) => sink(frame),
    }
}

/// Puts packets of J1939 together, and takes a message apart.
pub fn transport() {
    let mut assembler = tp::Assembler::<[u8; tp::memory(40)], 3>::new();
    for _ in 0..unknown::<u8>() {
        let link = tp::Link { source: unknown(), target: unknown() };
        packets(&assembler.control(link, &unknown(), unknown()));
        packets(&assembler.packet(link, &unknown(), unknown()));
        assembler.timed_out(unknown()).iter().for_each(packets);
    }
    let data: [u8; 40] = unknown();
    let Some(mut sender) = data.get(..unknown()).and_then(|data| tp::Sender::new(unknown(), data, unknown())) else {
        return;
    };
    sink((sender.rts(), sender.abort(tp::Reason::OTHER)));
    for _ in 0..unknown::<u8>() {
        sink(sender.control(&unknown()));
        (&mut sender).for_each(sink);
    }
    sink(sender.bam());
    sender.for_each(sink);
}

/// Puts the messages of a transport together, and asks for all that is known of them.
pub fn transfers<T: Transport>() {
    let mut assembler = transfers::Assembler::<T, 3>::new();
    for _ in 0..unknown::<u8>() {
        event(assembler.receive(&unknown_frame(), unknown()));
        assembler.timed_out(unknown()).into_iter().for_each(event);
    }
}

fn event<T: Transport>(event: transfers::Event<T>) {
    if let Some(whole) = &event.whole {
        sink((whole.data(), whole.exchange(), whole.kind()));
        sink(whole.identifier());
    }
    sink((event.broken, event.refused, event.answer));
}

/// Puts a message together that a transport carries, and makes its frames.
pub fn transferred<L: Transferred + Unknown>() {
    let mut assembler = transfers::Assembler::<L::Transport, 1>::new();
    if let Some(whole) = assembler.receive(&unknown_frame(), unknown()).whole {
        sink(whole.values::<L>());
    }
    let mut data: [u8; 2048] = unknown();
    let (values, blank): (L, _) = (unknown(), unknown_frame());
    let sender = if unknown() {
        values.sender(&blank, &mut data)
    } else {
        values.sender_for(unknown::<u8>(), &blank, &mut data)
    };
    let Ok(mut sender) = sender else { return };
    for _ in 0..unknown::<u8>() {
        (&mut sender).for_each(sink);
        sink(sender.receive(&unknown_frame()));
    }
}

/// Gives up a message by J1939.
pub fn aborted<T: Grouped>() {
    if let Some(sender) = black_box(None::<transfers::Sender<'static, T>>) {
        sink(sender.abort(transfers::Reason::OTHER));
    }
}

/// Does what only ISO-TP does: puts messages without values together and makes them.
pub fn bare<T: Filled>() {
    let mut assembler = transfers::Assembler::<T, 3>::new().pacing(unknown(), isotp::Separation(unknown()));
    let event = assembler.receive(&unknown_frame(), unknown());
    if let (Some(whole), Some((exchange, kind))) = (&event.whole, T::CARRIES.first()) {
        sink((whole.is_bare(exchange, *kind), whole.is_error_reply()));
    }
    let broken = event.broken.iter().chain(&event.refused).map(|broken| &broken.transfer);
    for transfer in broken {
        sink((transfer.data(), transfer.link.id(), transfer.link.is_to_module(), transfer.size()));
    }
    if let Some(sender) = transfers::Sender::<T>::bare(&unknown_frame()) {
        sender.for_each(sink);
    }
}

fn packets<M: tp::Memory>(event: &tp::Event<M>) {
    let broken = event.broken.iter().chain(&event.refused).map(|broken| &broken.transfer);
    for transfer in broken.chain(&event.whole) {
        sink((transfer.data(), transfer.link, transfer.group));
        transfer.missing().for_each(sink);
    }
    sink(event.answer);
}

/// Puts frames of ISO-TP together, and takes a message apart.
pub fn isotp() {
    let separation = isotp::Separation(unknown());
    let mut assembler = isotp::Assembler::<[u8; isotp::memory(40)], 3>::new().pacing(unknown(), separation);
    for _ in 0..unknown::<u8>() {
        let link = isotp::Link { source: unknown_frame().id(), target: unknown_frame().id() };
        let data: [u8; 8] = unknown();
        pdus(&assembler.receive(link, data.get(..unknown()).unwrap_or_default(), unknown()));
        if let Some(isotp::Pdu::Flow(flow)) = isotp::Pdu::decode(&data) {
            sink(flow.encode(unknown::<bool>().then(unknown)));
        }
        assembler.timed_out(unknown()).iter().for_each(pdus);
    }
    let data: [u8; 40] = unknown();
    let Some(mut sender) = data.get(..unknown()).and_then(isotp::Sender::new) else { return };
    sender = sender.padded(unknown::<bool>().then(unknown));
    for _ in 0..unknown::<u8>() {
        sink((sender.is_waiting(), sender.is_done()));
        if let isotp::Answer::Allowed(separation) = sender.control(&unknown::<[u8; 8]>()) {
            sink(separation.micros());
        }
        sender.by_ref().for_each(|packet| sink(packet.data()));
    }
}

fn pdus<M: isotp::Memory>(event: &isotp::Event<M>) {
    let broken = event.broken.iter().chain(&event.refused).map(|broken| &broken.transfer);
    for transfer in broken.chain(&event.whole) {
        sink((transfer.data(), transfer.link, transfer.size()));
    }
    sink(event.answer.as_ref().map(|(link, packet)| (*link, packet.data())));
}

fn unknown_frame() -> canspec_runtime::Frame {
    unknown()
}

fn reading(reading: Reading<'_>) {
    sink((reading.name, reading.unit, reading.raw, reading.meaning));
}

/// Looks at a request, and at a frame that may answer it.
pub fn request<P: Protocol, R: Layout>(request: Result<Request<P, R>, Error>) {
    match request {
        Ok(request) => {
            sink((request.frame(), request.replies(), request.is_reply(&unknown_frame())));
            if let Some(reply) = request.reply(&unknown_frame()) {
                reply.selectors().for_each(sink);
                sink((reply.identifier(), reply.values));
            }
        }
        Err(error) => sink(error),
    }
}

/// Looks at the requests of a set, one for each member.
pub fn requests<P: Protocol, R: Layout, const N: usize>(requests: Result<[Request<P, R>; N], Error>) {
    match requests {
        Ok(requests) => requests.into_iter().for_each(|built| request(Ok(built))),
        Err(error) => sink(error),
    }
}

/// Puts frames of a set together, and asks for all that is known of them.
pub fn assembler<S: FrameSet>() {
    let mut assembler = Assembler::<S, 3>::listening(unknown());
    if unknown() {
        assembler = Assembler::new(unknown()).for_model(unknown::<u8>());
    }
    if let Err(full) = assembler.ask(unknown::<i32>(), unknown()) {
        text(&full);
    }
    for _ in 0..unknown::<u8>() {
        sink(assembler.receive(&unknown_frame(), unknown()));
    }
    assembler.partial(unknown::<i32>()).into_iter().for_each(partial);
    assembler.timed_out(unknown()).into_iter().for_each(partial);
    assembler.forget(unknown::<i32>());
    sink(assembler);
}

fn partial<S>(partial: Partial<S>) {
    sink((partial.missing.is_empty(), partial.node));
    partial.missing.names().chain(partial.failed.names()).for_each(sink);
    sink(partial.set);
}

/// Builds a request and no more.
pub fn encode<P, R>(request: Result<Request<P, R>, Error>) {
    sink(request);
}

/// Reads and writes a signal, as its own type and as any signal.
pub fn signal<R: Raw + Unknown, F: Physical<R>>(signal: &'static Signal<R, F>) {
    sink((signal.get(&unknown()), signal.documented_limits()));
    let mut payload = unknown();
    sink(signal.put(unknown(), &mut payload));
    sink(signal.write(unknown(), &mut payload));
    sink(payload);
    signal.read(&unknown(), &mut reading);
    let signal: &dyn WriteSignal = signal;
    sink(signal);
}
