//! Recognised frames as a line of text.

use core::fmt;

use crate::{Protocol, Received};

impl<P: Protocol> fmt::Display for Received<P> {
    /// Writes `read module_output of 3: 43FA000040600000`: the access, the message, `to` or `of` a module, and the data
    /// of the [frame](Received::frame).
    ///
    /// Where the identifier does not show one [module](Received::node), it stands there itself, as in
    /// `read_total system_output to 02C101F0: 0000000000000000`.
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        let (exchange, frame) = (self.exchange(), self.frame());
        let direction = if self.is_to_module() { "to" } else { "of" };
        write!(formatter, "{} {} {direction} ", exchange.access(), exchange.message())?;
        match self.node() {
            Some(node) => write!(formatter, "{node}")?,
            None => frame.write_id(formatter)?,
        }
        let is_empty = embedded_can::Frame::dlc(frame) == 0;
        formatter.write_str(if is_empty { ": no data" } else { ": " })?;
        frame.write_data(formatter)
    }
}
