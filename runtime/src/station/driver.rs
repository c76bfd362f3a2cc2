//! What sends and receives the frames of a station, without waiting.

use embedded_can::{blocking, nb as non_blocking};

use crate::Frame;
use crate::client::Bus;
use crate::frame::classic;

/// A driver of a bus that does not block.
///
/// It must not give the frames back that it has sent itself. It should not keep frames for as long as a module takes to
/// start: one that keeps a switch-on while the bus is away hands it to a module that has started meanwhile, before its
/// set-point.
pub trait Driver {
    /// What fails.
    type Error;

    /// Sends a frame, or returns `false` if the driver does not take it now: it is full, or the bus is away.
    ///
    /// It may write a counter into the frame that no signal shows, as [`Step::Send`](crate::client::Step::Send) says.
    ///
    /// # Errors
    ///
    /// Fails if the driver is of no use any more.
    fn send(&mut self, frame: &Frame) -> Result<bool, Self::Error>;

    /// Returns the next frame that has come, if there is one.
    ///
    /// # Errors
    ///
    /// Fails if the driver is of no use any more.
    fn receive(&mut self) -> Result<Option<Frame>, Self::Error>;

    /// Returns whether the bus carries frames, as far as the driver knows. While it does not, nothing is sent, and no
    /// request is lost.
    fn bus(&self) -> Bus {
        Bus::On
    }
}

/// A driver that implements [`embedded_can::nb::Can`], as those of microcontrollers do.
#[derive(Clone, Copy, Debug)]
pub struct NonBlocking<C>(pub C);

impl<C: non_blocking::Can> Driver for NonBlocking<C> {
    type Error = C::Error;

    fn send(&mut self, frame: &Frame) -> Result<bool, C::Error> {
        // A frame type that cannot hold a classic frame carries none.
        let Some(frame) = frame.to() else { return Ok(false) };
        match self.0.transmit(&frame) {
            // What the driver drops for a frame of more weight is lost, as on the bus. It is sent again.
            Ok(_) => Ok(true),
            Err(nb::Error::WouldBlock) => Ok(false),
            Err(nb::Error::Other(error)) => Err(error),
        }
    }

    fn receive(&mut self) -> Result<Option<Frame>, C::Error> {
        loop {
            match self.0.receive().map(|frame| classic(&frame)) {
                // What is no classic data frame does not hide what has come behind it.
                Ok(None) => {}
                Ok(frame) => return Ok(frame),
                Err(nb::Error::WouldBlock) => return Ok(None),
                Err(nb::Error::Other(error)) => return Err(error),
            }
        }
    }
}

/// A driver that sends by [`embedded_can::blocking::Can`], and takes what was received elsewhere.
///
/// [`receive`](blocking::Can::receive) of such a driver waits until a frame comes, however long that takes. A station
/// that waited there could neither stop an output nor keep one on. So it is never called here. `R` is a function that
/// returns the next frame that has come, at once: from a queue that an interrupt fills, or from a channel that a thread
/// fills by [`listen`].
///
/// [`transmit`](blocking::Can::transmit) waits until there is room. While the bus is away, nothing else happens, so a
/// driver that can tell that it is full is better: see [`NonBlocking`].
#[derive(Clone, Copy, Debug)]
pub struct Blocking<C, R> {
    can: C,
    received: R,
}

impl<C, R> Blocking<C, R>
where
    C: blocking::Can,
    R: FnMut() -> Result<Option<Frame>, C::Error>,
{
    /// Returns a driver that sends by one, and takes what was received from a function that does not wait.
    pub const fn new(can: C, received: R) -> Self {
        Self { can, received }
    }
}

impl<C, R> Driver for Blocking<C, R>
where
    C: blocking::Can,
    R: FnMut() -> Result<Option<Frame>, C::Error>,
{
    type Error = C::Error;

    fn send(&mut self, frame: &Frame) -> Result<bool, C::Error> {
        let Some(frame) = frame.to() else { return Ok(false) };
        self.can.transmit(&frame).map(|()| true)
    }

    fn receive(&mut self) -> Result<Option<Frame>, C::Error> {
        (self.received)()
    }
}

/// Hands over each classic data frame that comes, until the function returns `false`.
///
/// It is for a thread or task of its own, beside one that sends by [`Blocking`]. The driver must hand out two parts for
/// that, or be opened twice.
///
/// ```
/// use std::sync::mpsc::{TryRecvError, channel};
/// use std::thread;
///
/// use canspec_runtime::embedded_can::blocking::Can;
/// use canspec_runtime::station::{Blocking, Driver, listen};
///
/// fn driver<C>(sends: C, mut receives: C) -> impl Driver<Error = C::Error>
/// where
///     C: Can + Send + 'static,
///     C::Error: Send,
/// {
///     let (frames, received) = channel();
///     thread::spawn(move || {
///         let ended = listen(&mut receives, |frame| frames.send(Ok(frame)).is_ok());
///         ended.or_else(|error| frames.send(Err(error)))
///     });
///     Blocking::new(sends, move || match received.try_recv() {
///         Ok(received) => received.map(Some),
///         // Before the thread ends, it sends why.
///         Err(TryRecvError::Empty | TryRecvError::Disconnected) => Ok(None),
///     })
/// }
/// ```
///
/// # Errors
///
/// Fails if the driver does.
pub fn listen<C: blocking::Can>(can: &mut C, mut take: impl FnMut(Frame) -> bool) -> Result<(), C::Error> {
    while classic(&can.receive()?).is_none_or(&mut take) {}
    Ok(())
}
