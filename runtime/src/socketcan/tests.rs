//! A port whose kernel is played: the other end of a pair of sockets reads and writes frames as <linux/can.h> has them.

use std::os::fd::OwnedFd;
use std::os::unix::net::{UnixDatagram, UnixStream};
use std::string::ToString;
use std::vec::Vec;

use super::*;

/// The flags of an identifier.
const EXTENDED: u32 = 0x8000_0000;
const REMOTE: u32 = 0x4000_0000;
const ERROR: u32 = 0x2000_0000;

/// Returns a frame as the kernel has it: the identifier, the length, three bytes without a meaning, the data.
fn raw(id: u32, data: &[u8]) -> Vec<u8> {
    let padding = [0; 8];
    let length = u8::try_from(data.len()).expect("it is short");
    [&id.to_ne_bytes()[..], &[length, 0, 0, 0], data, &padding[data.len()..]].concat()
}

/// Returns a port, and its kernel.
fn port() -> (Port, UnixDatagram) {
    let (kernel, socket) = UnixDatagram::pair().expect("a pair of sockets");
    kernel.set_nonblocking(true).expect("it is open");
    socket.set_nonblocking(true).expect("it is open");
    (port_at(socket), kernel)
}

fn port_at(socket: impl Into<OwnedFd>) -> Port {
    Port { name: "no interface".to_string(), link: Link::new(CanSocket::from(socket.into())) }
}

fn told(kernel: &UnixDatagram) -> Option<Vec<u8>> {
    let mut bytes = [0; 32];
    kernel.recv(&mut bytes).ok().map(|count| bytes[..count].to_vec())
}

fn frame() -> Frame {
    Frame::new_raw(0x0284_F003, true, [0xAB, 0, 2, 0, 0x16, 0, 0x40, 0xFF], 8)
}

#[test]
fn a_port_carries_data_frames_both_ways() {
    let (mut port, kernel) = port();
    assert_eq!(port.send(&frame()), Ok(true));
    assert_eq!(told(&kernel), Some(raw(0x8284_F003, &[0xAB, 0, 2, 0, 0x16, 0, 0x40, 0xFF])));
    assert_eq!(port.send(&Frame::new_raw(0x7FF, false, [1, 2, 0, 0, 0, 0, 0, 0], 2)), Ok(true));
    assert_eq!((told(&kernel), told(&kernel)), (Some(raw(0x7FF, &[1, 2])), None));
    assert_eq!(port.receive(), Ok(None));
    for frame in [raw(0x8284_F003, &[9; 8]), raw(0x123 | REMOTE, &[0]), raw(EXTENDED, &[]), raw(0x123, &[0xA5])] {
        kernel.send(&frame).expect("there is room");
    }
    let received: [_; 4] = core::array::from_fn(|_| port.receive().map(|frame| frame.map(|frame| frame.to_string())));
    let expected = [Some("0284F003#0909090909090909"), Some("00000000#"), Some("123#A5"), None];
    assert_eq!(received, expected.map(|text| Ok(text.map(str::to_string))));
    assert_eq!(port.bus(), Bus::On);
}

#[test]
fn a_controller_that_goes_off_the_bus_takes_nothing() {
    let (mut port, kernel) = port();
    kernel.send(&raw(ERROR | 0x40, &[0; 8])).expect("there is room");
    kernel.send(&raw(0x123, &[0xA5])).expect("there is room");
    assert_eq!(port.receive(), Ok(None));
    assert_eq!(port.bus(), Bus::Off);
    assert_eq!((port.send(&frame()), told(&kernel)), (Ok(false), None));
}

#[test]
fn errors_that_a_controller_bears_leave_it_on_the_bus() {
    let (mut port, kernel) = port();
    // By the classes of <linux/can/error.h>: a lost arbitration, a state of the controller with counters, no
    // acknowledgement, a bus error, a start after the controller was off.
    for class in [0x2, 0x204, 0x20, 0x80, 0x100] {
        kernel.send(&raw(ERROR | class, &[0; 8])).expect("there is room");
    }
    kernel.send(&raw(0x123, &[0xA5])).expect("there is room");
    assert_eq!(port.receive(), Ok(Some(Frame::new_raw(0x123, false, [0xA5; 8], 1))));
    assert_eq!(port.bus(), Bus::On);
}

#[test]
fn an_interface_without_room_takes_nothing_and_stays() {
    let (mut port, _kernel) = port();
    let taken = (0..100_000).take_while(|_| port.send(&frame()) == Ok(true)).count();
    assert!(taken < 100_000, "the queue is never full");
    assert_eq!(port.bus(), Bus::On);
    // 105 is ENOBUFS, by which the kernel says that the queue of the interface is full.
    port.link.failed(&io::Error::from_raw_os_error(105));
    assert_eq!(port.bus(), Bus::On);
}

#[test]
fn an_interface_that_goes_down_or_away_takes_nothing() {
    // 100 is ENETDOWN, 6 is ENXIO, and 19 is ENODEV.
    for error in [100, 6, 19] {
        let (mut port, kernel) = port();
        port.link.failed(&io::Error::from_raw_os_error(error));
        assert_eq!(port.bus(), Bus::Off, "{error}");
        assert_eq!((port.send(&frame()), port.receive(), told(&kernel)), (Ok(false), Ok(None), None));
    }
    let (mut gone, kernel) = port();
    drop(kernel);
    assert_eq!((gone.send(&frame()), gone.bus()), (Ok(false), Bus::Off));
    // Nothing comes any more from the other end of a stream that has gone.
    let (_, socket) = UnixStream::pair().expect("a pair of sockets");
    let mut ended = port_at(socket);
    assert_eq!((ended.receive(), ended.bus()), (Ok(None), Bus::Off));
}

#[test]
fn a_port_waits_until_a_frame_comes() {
    let (port, kernel) = port();
    kernel.send(&raw(0x123, &[])).expect("there is room");
    port.wait(u32::MAX);
}

#[test]
fn an_interface_that_is_not_there_is_refused_and_looked_for_later() {
    // 19 is ENODEV.
    assert_eq!(Port::open("canspec99").err().and_then(|error| error.raw_os_error()), Some(19));
    let (mut port, _kernel) = port();
    port.link.lose();
    port.wait(10_000);
    assert_eq!((port.receive(), port.bus()), (Ok(None), Bus::Off));
}

#[test]
fn two_ports_of_a_virtual_interface_hear_each_other_and_not_themselves() {
    let Ok(ports) = ["vcan0"; 2].map(Port::open).into_iter().collect::<io::Result<Vec<_>>>() else {
        std::eprintln!("SKIPPED: the kernel has no CAN, or no interface `vcan0` that is up");
        return;
    };
    let [mut one, mut other] = <[Port; 2]>::try_from(ports).expect("two were opened");
    assert_eq!(one.send(&frame()), Ok(true));
    other.wait(10_000);
    assert_eq!((other.receive(), one.receive()), (Ok(Some(frame())), Ok(None)));
}
