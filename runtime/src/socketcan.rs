//! CAN interfaces of Linux, which are called `SocketCAN`.
//!
//! ```no_run
//! use canspec_runtime::socketcan::Port;
//! use canspec_runtime::station::Drive;
//!
//! let port = Port::open("can0")?;
//! let drive = Drive::new(port);
//! # drop(drive);
//! # Ok::<(), std::io::Error>(())
//! ```
//!
//! The bit rate is a setting of the interface: `ip link set can0 up type can bitrate 125000 restart-ms 100`. With
//! `restart-ms` the kernel starts a controller again that has gone off the bus. Without, it stays off, and only the
//! silence of the modules tells that: the port counts as off the bus for half a second, since the kernel opens an
//! interface whose controller is off.
//!
//! An interface that is down takes no frame. It is opened again as soon as it is there. Other programs on this machine
//! see what is sent, such as candump. The port itself does not get it back.

#[cfg(test)]
mod tests;

use std::io;
use std::string::String;

use ::socketcan::errors::CAN_ERR_BUSOFF;
use ::socketcan::{CanDataFrame, CanFrame, CanSocket, Socket, SocketOptions};

use crate::Frame;
use crate::client::Bus;
use crate::frame::classic;
use crate::link::Link;
use crate::station::Driver;

/// A CAN interface of Linux.
#[derive(Debug)]
pub struct Port {
    name: String,
    link: Link<CanSocket>,
}

impl Port {
    /// Opens an interface, such as `can0`.
    ///
    /// # Errors
    ///
    /// Fails if there is no such interface, if it is down, and if the kernel has no CAN.
    pub fn open(name: impl Into<String>) -> io::Result<Self> {
        let name = name.into();
        let link = Link::new(opened(&name)?);
        Ok(Self { name, link })
    }

    /// Waits until something comes, or until this time has passed.
    pub fn wait(&self, milliseconds: u32) {
        self.link.wait(milliseconds);
    }

    /// Returns the socket. One that has gone is opened again, from time to time.
    fn socket(&mut self) -> Option<&mut CanSocket> {
        self.link.reopen(|| opened(&self.name));
        self.link.open()
    }
}

impl Driver for Port {
    type Error = core::convert::Infallible;

    fn send(&mut self, frame: &Frame) -> Result<bool, Self::Error> {
        let (Some(frame), Some(socket)) = (frame.to::<CanDataFrame>(), self.socket()) else { return Ok(false) };
        match socket.write_frame(&frame) {
            Ok(()) => Ok(true),
            Err(error) => {
                self.link.failed(&error);
                Ok(false)
            }
        }
    }

    fn receive(&mut self) -> Result<Option<Frame>, Self::Error> {
        while let Some(socket) = self.socket() {
            match socket.read_frame().map(|frame| News::of(&frame)) {
                Ok(News::Data(frame)) => return Ok(Some(frame)),
                Ok(News::BusOff) => self.link.lose(),
                Ok(News::Nothing) => {}
                Err(error) => {
                    self.link.failed(&error);
                    return Ok(None);
                }
            }
        }
        Ok(None)
    }

    fn bus(&self) -> Bus {
        self.link.bus()
    }
}

/// What the kernel hands over.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum News {
    Data(Frame),
    /// The controller has gone off the bus.
    BusOff,
    /// A remote frame, or an error that the controller bears.
    Nothing,
}

impl News {
    fn of(frame: &CanFrame) -> Self {
        match frame {
            CanFrame::Data(frame) => classic(frame).map_or(Self::Nothing, Self::Data),
            CanFrame::Error(error) if error.error_bits() & CAN_ERR_BUSOFF != 0 => Self::BusOff,
            CanFrame::Error(_) | CanFrame::Remote(_) => Self::Nothing,
        }
    }
}

/// Opens an interface that is up. It reports when the controller goes off the bus.
fn opened(name: &str) -> io::Result<CanSocket> {
    let socket = CanSocket::open(name)?;
    socket.set_recv_own_msgs(false)?;
    socket.set_error_filter(CAN_ERR_BUSOFF)?;
    socket.set_nonblocking(true)?;
    // An interface that is down can be opened, and tells that it is down later.
    socket.as_raw_socket().take_error()?.map_or(Ok(socket), Err)
}
