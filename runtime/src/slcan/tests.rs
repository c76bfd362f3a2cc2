//! A port at a pty, whose other end is the adapter.

use std::fs::File;
use std::io::{ErrorKind, Read, Write};
use std::string::{String, ToString};
use std::time::{Duration, Instant};
use std::vec;

use rustix::event::{PollFd, PollFlags, Timespec, poll};
use rustix::fs::{OFlags, fcntl_setfl};
use rustix::pty::{OpenptFlags, grantpt, openpt, ptsname, unlockpt};

use super::{BitRate, Port};
use crate::Frame;
use crate::client::Bus;
use crate::station::Driver;

/// Returns an adapter that does not block, and the path of its port.
fn adapter() -> (File, String) {
    let adapter = openpt(OpenptFlags::RDWR | OpenptFlags::NOCTTY).expect("a pty");
    fcntl_setfl(&adapter, OFlags::NONBLOCK).expect("it is open");
    grantpt(&adapter).expect("it is ours");
    unlockpt(&adapter).expect("it is ours");
    let path = ptsname(&adapter, vec![]).expect("it has a port");
    (File::from(adapter), path.to_str().expect("a path of ASCII").to_string())
}

/// Tests what the adapter is told. The kernel may hand it over bit by bit.
fn is_told(adapter: &mut File, expected: &str) {
    let (mut told, mut count) = (vec![0; expected.len()], 0);
    while count < told.len() {
        count += read(adapter, &mut told[count..]);
    }
    assert_eq!(String::from_utf8_lossy(&told), expected);
    let more = adapter.read(&mut [0]).map_err(|error| error.kind());
    assert_eq!(more, Err(ErrorKind::WouldBlock), "it is told more");
}

/// Reads what the adapter is told next, some seconds from now at most. Returns how many bytes it is.
fn read(adapter: &mut File, bytes: &mut [u8]) -> usize {
    let seconds = Timespec { tv_sec: 10, tv_nsec: 0 };
    poll(&mut [PollFd::new(&*adapter, PollFlags::IN)], Some(&seconds)).expect("it is open");
    adapter.read(bytes).expect("it is told something")
}

/// Waits for the next frame, some seconds at most, and returns it as a text.
fn received(port: &mut Port) -> String {
    let next = (0..20).find_map(|_| {
        let frame = port.receive().ok().flatten();
        if frame.is_none() {
            port.wait(1000);
        }
        frame
    });
    next.expect("a frame comes").to_string()
}

fn frame() -> Frame {
    Frame::new_raw(0x0284_F003, true, [0xAB, 0, 2, 0, 0x16, 0, 0x40, 0xFF], 8)
}

#[test]
fn a_port_opens_the_channel_and_carries_frames_both_ways() {
    let (mut adapter, path) = adapter();
    let mut port = Port::open(path, BitRate::Kbit125).expect("the pty is there");
    is_told(&mut adapter, "\rC\rS4\rO\r");
    assert_eq!(port.bus(), Bus::On);
    assert_eq!(port.send(&frame()), Ok(true));
    is_told(&mut adapter, "T0284F0038AB000200160040FF\r");
    assert_eq!(port.receive(), Ok(None));
    // What the adapter says is not given back to it, and two frames may come at once.
    adapter.write_all(b"z\rt10021133\rT0284F0038AB000200160040FF\r").expect("there is room");
    assert_eq!([received(&mut port), received(&mut port)], ["100#1133", "0284F003#AB000200160040FF"]);
    assert_eq!(port.receive(), Ok(None));
    is_told(&mut adapter, "");
}

#[test]
fn each_bit_rate_has_its_number() {
    use BitRate::{Kbit10, Kbit20, Kbit50, Kbit100, Kbit125, Kbit250, Kbit500, Kbit800, Mbit1};
    for (number, rate) in
        [Kbit10, Kbit20, Kbit50, Kbit100, Kbit125, Kbit250, Kbit500, Kbit800, Mbit1].into_iter().enumerate()
    {
        let (mut adapter, path) = adapter();
        let port = Port::open(path, rate).expect("the pty is there");
        is_told(&mut adapter, &std::format!("\rC\rS{number}\rO\r"));
        drop(port);
    }
}

#[test]
fn a_port_waits_until_something_comes_or_the_time_has_passed() {
    let (mut adapter, path) = adapter();
    let port = Port::open(path, BitRate::Mbit1).expect("the pty is there");
    let start = Instant::now();
    port.wait(1050);
    assert!(start.elapsed() >= Duration::from_millis(1050));
    adapter.write_all(b"t1000\r").expect("there is room");
    port.wait(u32::MAX);
}

#[test]
fn an_adapter_that_has_gone_takes_nothing_until_it_is_back() {
    let (adapter, path) = adapter();
    let link = std::env::temp_dir().join(std::format!("canspec-slcan-{}", std::process::id()));
    let _ = std::fs::remove_file(&link);
    std::os::unix::fs::symlink(&path, &link).expect("the folder can be written");
    let mut port = Port::open(&link, BitRate::Kbit500).expect("the pty is there");
    drop(adapter);
    assert_eq!(port.receive(), Ok(None));
    assert_eq!((port.bus(), port.send(&frame())), (Bus::Off, Ok(false)));
    let (mut back, path) = self::adapter();
    std::fs::remove_file(&link).expect("it is there");
    std::os::unix::fs::symlink(&path, &link).expect("the folder can be written");
    // It is not looked for again at once.
    assert_eq!((port.send(&frame()), port.bus()), (Ok(false), Bus::Off));
    port.wait(10_000);
    assert_eq!(port.send(&frame()), Ok(true));
    assert_eq!(port.bus(), Bus::On);
    is_told(&mut back, "\rC\rS6\rO\rT0284F0038AB000200160040FF\r");
    std::fs::remove_file(&link).expect("it is there");
}

#[test]
fn a_line_that_the_port_takes_in_part_is_ended_before_the_next_one() {
    let (mut adapter, path) = adapter();
    let mut port = Port::open(path, BitRate::Kbit500).expect("the pty is there");
    is_told(&mut adapter, "\rC\rS6\rO\r");
    let line = "T0284F0038AB000200160040FF\r";
    let (mut bytes, mut taken) = (vec![], 0);
    // The pty takes some thousand bytes, of which five are read in each turn, so lines are cut at any place.
    for _ in 0..2000 {
        taken += usize::from(port.send(&frame()) == Ok(true));
        if taken > 100 && bytes.len() < 20_000 {
            let from = bytes.len();
            bytes.resize(from + 5, 0);
            let count = read(&mut adapter, &mut bytes[from..]);
            bytes.truncate(from + count);
        }
    }
    assert!((101..2000).contains(&taken), "{taken}");
    while bytes.len() < line.len() * taken {
        assert_eq!(port.receive(), Ok(None));
        let from = bytes.len();
        bytes.resize(from + 4096, 0);
        let count = read(&mut adapter, &mut bytes[from..]);
        bytes.truncate(from + count);
    }
    assert_eq!(String::from_utf8_lossy(&bytes), line.repeat(taken));
}

#[test]
fn what_is_no_port_is_refused() {
    assert_eq!(
        Port::open("/nowhere/at/all", BitRate::Kbit10).map_err(|error| error.kind()).err(),
        Some(ErrorKind::NotFound)
    );
}
