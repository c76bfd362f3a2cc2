//! A driver for devices of made-up vendors.
#![no_std]
#![deny(warnings, missing_docs, unsafe_code)]

/// Rope winches, as `specs/winch.yaml` describes them.
pub mod winch {
    canspec_runtime::include_protocol!("winch");
}

/// Fans, as `specs/fan.yaml` describes them.
pub mod fan {
    canspec_runtime::include_protocol!("fan");
}

/// Circulation pumps, as `specs/pump.yaml` describes them.
pub mod pump {
    canspec_runtime::include_protocol!("pump");
}

/// Rectifiers, as `specs/rectifier.yaml` describes them.
pub mod rectifier {
    canspec_runtime::include_protocol!("rectifier");
}

/// Cars, chargers and testers, as `specs/tester.yaml` describes them.
pub mod tester {
    canspec_runtime::include_protocol!("tester");
}

/// Energy meters, as `specs/meter.yaml` describes them.
pub mod meter {
    canspec_runtime::include_protocol!("meter");
}

/// Supplies behind a fuse, as `specs/supply.yaml` describes them.
pub mod supply {
    canspec_runtime::include_protocol!("supply");
}

/// Batteries, as `specs/battery.yaml` describes them.
pub mod battery {
    canspec_runtime::include_protocol!("battery");
}

pub mod meters;
pub mod pumps;

/// Ovens, as `specs/oven.yaml` describes them.
pub mod oven {
    canspec_runtime::include_protocol!("oven");
}

pub mod ovens;

/// Heaters, as `specs/heater.yaml` describes them.
pub mod heater {
    canspec_runtime::include_protocol!("heater");
}

use canspec_runtime::Layout;
use winch::{Error, Message, Reply, Request, Run, Target, embedded_can};

/// Lets a winch pull its rope in.
///
/// # Errors
///
/// The winch or the speed is out of range.
pub fn pull(winch: u8, speed_rpm: i16) -> Result<Request<Run>, Error> {
    Run { speed_rpm, ramp_s: 2.5 }.set(Target::Winch(winch))
}

/// Sends a request, and waits for the frame that answers it until `is_late`.
pub fn ask<C, R>(can: &mut C, request: &Request<R>, is_late: impl Fn() -> bool) -> Option<Reply<R>>
where
    C: embedded_can::nb::Can,
    R: Layout,
{
    let frame = request.frame().to()?;
    while can.transmit(&frame).is_err() {
        if is_late() {
            return None;
        }
    }
    while !is_late() {
        if let Some(reply) = can.receive().ok().and_then(|frame| request.reply(&frame)) {
            return Some(reply);
        }
    }
    None
}

/// Returns how much rope is out, if a frame of the bus says so.
pub fn rope_m(frame: &impl embedded_can::Frame) -> Option<f64> {
    match Message::decode(frame).ok()?.reply()? {
        Ok(Message::Status(status)) => Some(status.rope_m),
        _ => None,
    }
}
