//! Serial adapters that speak SLCAN, on Linux and macOS.
//!
//! ```no_run
//! use canspec_runtime::slcan::{BitRate, Port};
//! use canspec_runtime::station::Drive;
//!
//! let port = Port::open("/dev/ttyACM0", BitRate::Kbit125)?;
//! let drive = Drive::new(port);
//! # drop(drive);
//! # Ok::<(), std::io::Error>(())
//! ```
//!
//! An adapter that is unplugged takes no frame, and is opened again as soon as it is there. It gives no frame back that
//! it was given.

mod line;
#[cfg(test)]
mod tests;

use std::fs::{File, OpenOptions};
use std::io::{self, Read, Write};
use std::os::unix::fs::OpenOptionsExt;
use std::path::PathBuf;

use rustix::termios::{OptionalActions, isatty, tcgetattr, tcsetattr};

use crate::Frame;
use crate::client::Bus;
use crate::link::Link;
use crate::station::Driver;
use line::{Line, Lines};

/// The bit rate of the bus.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum BitRate {
    /// 10 kbit/s.
    Kbit10,
    /// 20 kbit/s.
    Kbit20,
    /// 50 kbit/s.
    Kbit50,
    /// 100 kbit/s.
    Kbit100,
    /// 125 kbit/s.
    Kbit125,
    /// 250 kbit/s.
    Kbit250,
    /// 500 kbit/s.
    Kbit500,
    /// 800 kbit/s.
    Kbit800,
    /// 1 Mbit/s.
    Mbit1,
}

impl BitRate {
    /// Returns the command that sets it.
    const fn command(self) -> &'static [u8] {
        match self {
            Self::Kbit10 => b"S0\r",
            Self::Kbit20 => b"S1\r",
            Self::Kbit50 => b"S2\r",
            Self::Kbit100 => b"S3\r",
            Self::Kbit125 => b"S4\r",
            Self::Kbit250 => b"S5\r",
            Self::Kbit500 => b"S6\r",
            Self::Kbit800 => b"S7\r",
            Self::Mbit1 => b"S8\r",
        }
    }
}

/// A serial port with an adapter.
#[derive(Debug)]
pub struct Port {
    path: PathBuf,
    rate: BitRate,
    link: Link<File>,
    lines: Lines,
    /// The line that is sent, of which the port has not taken all.
    sent: Line,
}

impl Port {
    /// Opens a serial port, sets the bit rate, and opens the channel of the adapter.
    ///
    /// # Errors
    ///
    /// Fails if the port cannot be opened.
    pub fn open(path: impl Into<PathBuf>, rate: BitRate) -> io::Result<Self> {
        let path = path.into();
        let link = Link::new(opened(&path, rate)?);
        Ok(Self { path, rate, link, lines: Lines::NEW, sent: Line::NONE })
    }

    /// Waits until something comes, or until this time has passed.
    pub fn wait(&self, milliseconds: u32) {
        self.link.wait(milliseconds);
    }

    /// Opens the port again if it has gone, from time to time. Sends what is left of a line.
    fn go_on(&mut self) {
        if self.link.reopen(|| opened(&self.path, self.rate)) {
            (self.lines, self.sent) = (Lines::NEW, Line::NONE);
        }
        if !self.sent.rest().is_empty() {
            self.write();
        }
    }

    /// Sends as much of a line as the port takes.
    fn write(&mut self) {
        let Some(port) = self.link.open() else { return };
        match port.write(self.sent.rest()) {
            Ok(count) => self.sent.took(count),
            Err(error) => self.link.failed(&error),
        }
    }
}

impl Driver for Port {
    type Error = core::convert::Infallible;

    fn send(&mut self, frame: &Frame) -> Result<bool, Self::Error> {
        self.go_on();
        if !self.sent.rest().is_empty() {
            return Ok(false);
        }
        self.sent = Line::of(frame);
        self.write();
        // A line that has begun is ended later, so no other one joins it.
        let has_begun = self.sent.has_begun();
        if !has_begun {
            self.sent = Line::NONE;
        }
        Ok(has_begun)
    }

    fn receive(&mut self) -> Result<Option<Frame>, Self::Error> {
        self.go_on();
        loop {
            if let Some(frame) = self.lines.frame() {
                return Ok(Some(frame));
            }
            let Some(port) = self.link.open() else { return Ok(None) };
            match port.read(self.lines.room()) {
                Ok(0) => self.link.lose(),
                Ok(count) => self.lines.took(count),
                Err(error) => {
                    self.link.failed(&error);
                    return Ok(None);
                }
            }
        }
    }

    fn bus(&self) -> Bus {
        self.link.bus()
    }
}

/// Opens a port without echo and line editing.
fn opened(path: &PathBuf, rate: BitRate) -> io::Result<File> {
    let flags = rustix::fs::OFlags::NOCTTY | rustix::fs::OFlags::NONBLOCK;
    let flags = i32::try_from(flags.bits()).map_err(io::Error::other)?;
    let mut port = OpenOptions::new().read(true).write(true).custom_flags(flags).open(path)?;
    if isatty(&port) {
        let mut settings = tcgetattr(&port)?;
        settings.make_raw();
        tcsetattr(&port, OptionalActions::Now, &settings)?;
    }
    // The first carriage return ends what another program has left. A channel that is open takes no bit rate.
    for command in [b"\rC\r", rate.command(), b"O\r"] {
        port.write_all(command)?;
    }
    Ok(port)
}
