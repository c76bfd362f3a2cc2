//! What carries the frames of a station: a driver that does not block, or asynchronous functions.

use super::{Driver, Event, Station, Step};
use crate::clock::time_left;
use crate::{Addressed, Frame, Quantities};

/// Carries the frames of a station by a driver.
#[derive(Clone, Copy, Debug)]
pub struct Drive<D> {
    driver: D,
    /// When all was handed over that had come. What comes after that is not older.
    since: Option<u32>,
}

impl<D: Driver> Drive<D> {
    /// Returns what carries frames by a driver.
    pub const fn new(driver: D) -> Self {
        Self { driver, since: None }
    }

    /// Returns the driver.
    pub const fn driver(&mut self) -> &mut D {
        &mut self.driver
    }

    /// Hands over what has come and what the driver knows of the bus, sends what is due, and tells what has happened.
    /// Returns when it is to be called again at the latest, if nothing comes before.
    ///
    /// No driver says when a frame came. So each counts as old as it can be. If the program stands still for long, what
    /// the driver has kept meanwhile does not count as new. What came before the first turn can be of any age, so it is
    /// dropped.
    ///
    /// # Errors
    ///
    /// Fails if the driver does. What was not sent is sent later.
    pub fn turn<P, const M: usize, const G: usize, const R: usize>(
        &mut self,
        station: &mut Station<P, M, G, R>,
        clock: impl Fn() -> u32,
        mut tell: impl FnMut(&mut Station<P, M, G, R>, Event),
    ) -> Result<u32, D::Error>
    where
        P: Quantities + Addressed,
    {
        loop {
            let now = clock();
            while let Some(frame) = self.driver.receive()? {
                self.since.into_iter().for_each(|since| station.handle(&frame, since));
            }
            self.since = Some(now);
            station.bus(self.driver.bus(), now);
            match station.poll(now) {
                Step::Send { ticket, frame } => {
                    let sent = self.driver.send(&frame);
                    if !matches!(sent, Ok(true)) {
                        station.not_sent(ticket, now);
                    }
                    sent?;
                }
                Step::Event(event) => tell(station, event),
                Step::Wait(until) => return Ok(until),
            }
        }
    }
}

/// Carries the frames of a station by asynchronous functions, for ever.
///
/// `send` returns whether the driver has taken the frame. `receive` waits for a frame, for this number of milliseconds at
/// most. With 0 it returns only a frame that has come. With embassy it is
/// `with_timeout(Duration::from_millis(wait.into()), can.read())`, and with tokio the same by `timeout`. It must not
/// give frames back that the program has sent itself. What came before the first call is dropped, since it can be of any
/// age.
pub async fn pump<P, const M: usize, const G: usize, const R: usize>(
    station: &mut Station<P, M, G, R>,
    clock: impl Fn() -> u32,
    mut send: impl AsyncFnMut(&Frame) -> bool,
    mut receive: impl AsyncFnMut(u32) -> Option<Frame>,
    mut tell: impl FnMut(&mut Station<P, M, G, R>, Event),
) where
    P: Quantities + Addressed,
{
    while receive(0).await.is_some() {}
    let mut since = clock();
    loop {
        let now = clock();
        while let Some(frame) = receive(0).await {
            station.handle(&frame, since);
        }
        since = now;
        match station.poll(now) {
            Step::Send { ticket, frame } => {
                if !send(&frame).await {
                    station.not_sent(ticket, now);
                }
            }
            Step::Event(event) => tell(station, event),
            Step::Wait(until) => {
                if let Some(frame) = receive(time_left(until, clock())).await {
                    station.handle(&frame, since);
                }
            }
        }
    }
}
