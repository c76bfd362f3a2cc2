//! What can go and come back: an adapter that is unplugged, an interface that is down.

use std::io;
use std::os::fd::AsFd;
use std::time::{Duration, Instant};

use rustix::event::{PollFd, PollFlags, Timespec, poll};
use rustix::io::Errno;

use crate::client::Bus;

/// How long to wait until what has gone is looked for again.
pub const PATIENCE: Duration = Duration::from_millis(500);

/// What is open, if it is there.
#[derive(Debug)]
pub struct Link<T> {
    open: Option<T>,
    /// When it was opened, looked for last, or lost.
    tried: Instant,
}

impl<T: AsFd> Link<T> {
    /// Returns a link that is there.
    pub fn new(open: T) -> Self {
        Self { open: Some(open), tried: Instant::now() }
    }

    /// Returns what it tells of the bus: an open one carries frames.
    pub const fn bus(&self) -> Bus {
        if self.open.is_some() { Bus::On } else { Bus::Off }
    }

    pub const fn open(&mut self) -> Option<&mut T> {
        self.open.as_mut()
    }

    /// Notes that it has gone.
    pub fn lose(&mut self) {
        *self = Self { open: None, tried: Instant::now() };
    }

    /// Takes an error. It has gone, unless there is only no room or nothing to read now.
    pub fn failed(&mut self, error: &io::Error) {
        let is_full = error.raw_os_error() == Some(Errno::NOBUFS.raw_os_error());
        if !is_full && !matches!(error.kind(), io::ErrorKind::WouldBlock | io::ErrorKind::Interrupted) {
            self.lose();
        }
    }

    /// Opens it again if it has gone, from time to time. Returns whether it has come back.
    pub fn reopen(&mut self, open: impl FnOnce() -> io::Result<T>) -> bool {
        if self.open.is_some() || self.tried.elapsed() < PATIENCE {
            return false;
        }
        *self = Self { open: open().ok(), tried: Instant::now() };
        self.open.is_some()
    }

    /// Waits until something comes, or until this time has passed.
    pub fn wait(&self, milliseconds: u32) {
        let Some(open) = &self.open else {
            std::thread::sleep(Duration::from_millis(milliseconds.into()).min(PATIENCE));
            return;
        };
        let time = Timespec { tv_sec: (milliseconds / 1000).into(), tv_nsec: (milliseconds % 1000 * 1_000_000).into() };
        // A wait that is interrupted is only shorter.
        let _ = poll(&mut [PollFd::new(open, PollFlags::IN)], Some(&time));
    }
}
