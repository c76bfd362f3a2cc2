//! What a call works with: protocols, a device model, channels.
//!
//! A protocol is built in, or a spec of the user's. `settings` are those of the folder, which arguments
//! override. A `device` is a protocol with the chosen model of a device. Names that do not exist are
//! refused with those that do, and with the one that was probably meant.

pub mod channels;
pub mod device;
pub mod protocols;
pub mod settings;
