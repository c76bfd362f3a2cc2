//! Calls of a station, and of what carries its frames.

use core::future::poll_fn;
use core::pin::pin;
use core::task::{Context, Poll, Waker};

use canspec_runtime::client::{Bus, Pace};
use canspec_runtime::embedded_can::{self, ErrorKind, blocking, nb as non_blocking};
use canspec_runtime::station::{
    Blocking, Drive, Driver, Event, Found, Limits, NonBlocking, Rivals, SetPoint, Settings, Station, Step, listen, pump,
};
use canspec_runtime::{Addressed, Frame, Quantities};

use crate::calls::sink;
use crate::unknown::{Unknown, unknown};

/// A driver that does what nobody foresees.
struct Wire;

#[derive(Debug)]
struct Broken;

impl embedded_can::Error for Broken {
    fn kind(&self) -> ErrorKind {
        ErrorKind::Other
    }
}

impl non_blocking::Can for Wire {
    type Frame = Frame;
    type Error = Broken;

    fn transmit(&mut self, frame: &Frame) -> nb::Result<Option<Frame>, Broken> {
        sink(frame);
        if unknown() { Ok(unknown()) } else { Err(error()) }
    }

    fn receive(&mut self) -> nb::Result<Frame, Broken> {
        if unknown() { Ok(unknown()) } else { Err(error()) }
    }
}

impl blocking::Can for Wire {
    type Frame = Frame;
    type Error = Broken;

    fn transmit(&mut self, frame: &Frame) -> Result<(), Broken> {
        sink(frame);
        if unknown() { Ok(()) } else { Err(Broken) }
    }

    fn receive(&mut self) -> Result<Frame, Broken> {
        if unknown() { Ok(unknown()) } else { Err(Broken) }
    }
}

fn error() -> nb::Error<Broken> {
    if unknown() { nb::Error::WouldBlock } else { nb::Error::Other(Broken) }
}

/// Controls modules by a station, by each of its functions and each carrier.
pub fn station<P: Quantities + Addressed<Target: Unknown>>() {
    let groups = [(unknown(), unknown::<Option<P::Target>>()), (unknown(), unknown())];
    let mut station = match Station::<P, 3, 2, 96>::new(settings(), unknown(), groups) {
        Ok(station) => station,
        Err(unfit) => return sink(unfit),
    };
    for _ in 0..unknown::<u8>() {
        tasks(&mut station);
        known(&station);
        station.handle(&unknown::<Frame>(), unknown());
        match station.poll(unknown()) {
            Step::Send { ticket, frame } => {
                sink(frame);
                station.not_sent(ticket, unknown());
            }
            step => sink(step),
        }
    }
    carried(&mut station, NonBlocking(Wire));
    carried(&mut station, Blocking::new(Wire, || if unknown() { Ok(unknown()) } else { Err(Broken) }));
    sink(listen(&mut Wire, |frame| {
        sink(frame);
        unknown()
    }));
    let send = |frame: &Frame| {
        sink(frame);
        later()
    };
    let pumped = pump(&mut station, unknown, send, |_| later(), tell);
    sink(pin!(pumped).poll(&mut Context::from_waker(Waker::noop())));
}

/// Returns a value that comes at once or later. What `async` makes can panic, since it could be asked again afterwards.
fn later<T: Unknown>() -> impl Future<Output = T> {
    poll_fn(|_| if unknown() { Poll::Ready(unknown()) } else { Poll::Pending })
}

fn settings() -> Settings {
    let pace = Pace { gap: unknown(), wait: unknown(), tries: unknown(), late: unknown() };
    let limits = Limits {
        least_mv: unknown(),
        most_mv: unknown(),
        most_ma: unknown(),
        most_mw: unknown(),
        group_ma: unknown(),
        rise_ma: unknown(),
        open_mv: unknown(),
    };
    let found = match unknown::<u8>() {
        0 => Found::Off,
        1 => Found::Watch,
        _ => Found::Adopt(point()),
    };
    let rivals = if unknown() { Rivals::Leave } else { Rivals::Watch };
    Settings { valid: unknown(), rivals, model: unknown(), ..Settings::new(pace, unknown(), found, limits) }
}

fn point() -> SetPoint {
    SetPoint { voltage_mv: unknown(), current_ma: unknown() }
}

fn tasks<P: Quantities + Addressed>(station: &mut Station<P, 3, 2, 96>) {
    sink(station.deliver(unknown(), point(), unknown()));
    sink((station.stop(unknown(), unknown()), station.watch(unknown(), unknown())));
    sink(station.assign(unknown(), unknown(), unknown()));
    if unknown() {
        station.emergency(unknown());
    } else {
        station.end_emergency();
    }
    station.bus(if unknown() { Bus::On } else { Bus::Off }, unknown());
}

fn known<P: Quantities + Addressed>(station: &Station<P, 3, 2, 96>) {
    station.modules().for_each(sink);
    sink((station.group(unknown()), station.output(unknown(), unknown()), station.told(unknown())));
    sink((station.voltage_mv(unknown(), unknown()), station.current_ma(unknown(), unknown())));
    sink((station.severity(unknown(), unknown()), station.status(unknown())));
    sink((station.is_off(unknown(), unknown()), station.is_safe_to_open(unknown(), unknown())));
}

fn carried<P: Quantities + Addressed>(station: &mut Station<P, 3, 2, 96>, driver: impl Driver<Error = Broken>) {
    let mut drive = Drive::new(driver);
    for _ in 0..unknown::<u8>() {
        sink(drive.turn(station, unknown, tell));
    }
}

fn tell<P: Quantities + Addressed>(station: &mut Station<P, 3, 2, 96>, event: Event) {
    sink(event);
    sink(station.stop(unknown(), unknown()));
}
