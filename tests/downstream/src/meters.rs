//! A driver for energy meters, whose registers the manual lists in a table.

use crate::meter::{self, Error, Period, Request, Target};

/// Returns requests that read every register of a meter.
pub fn readings(meter: u8) -> impl Iterator<Item = Result<Request<()>, Error>> {
    meter::MESSAGES.iter().filter_map(move |entry| entry.request("read", Target::Meter(meter)))
}

/// Sets how often a meter measures. Only what the manual lets one write has `write`:
///
/// ```
/// # use winch_driver::meter::{Period, Target, Voltage};
/// let measured = Voltage { value_v: 230.0 };
/// assert!(Voltage::read(Target::Meter(7)).is_ok());
/// assert!(Period { value_s: 60 }.write(Target::Meter(7)).is_ok());
/// ```
///
/// ```compile_fail,E0599
/// # use winch_driver::meter::{Period, Target, Voltage};
/// let measured = Voltage { value_v: 230.0 };
/// let request = measured.write(Target::Meter(7));
/// ```
///
/// # Errors
///
/// The meter or the time is out of range.
pub fn measure_every(meter: u8, seconds: u32) -> Result<Request<Period>, Error> {
    Period { value_s: seconds }.write(Target::Meter(meter))
}
