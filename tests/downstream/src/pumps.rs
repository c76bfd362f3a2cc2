//! A driver for circulation pumps of several models, and a pump that is simulated.

use crate::pump::{Error, Frame, Identifier, Message, Model, Motion, Request, SetSpeed, Target, embedded_can};

/// Finds the model that a configuration names.
pub fn model(name: &str) -> Option<Model> {
    Model::ALL.into_iter().find(|model| model.name() == name)
}

/// Sets the speed of a pump.
///
/// # Errors
///
/// The pump is out of range, or this model does not run so fast.
pub fn turn(model: Model, pump: u8, speed_rpm: u16) -> Result<Request<SetSpeed>, Error> {
    SetSpeed { speed_rpm }.within(model)?.set(Target::Pump(pump))
}

/// Returns how many litres a minute flow, if a frame of the bus reports it.
pub fn flow(model: Model, frame: &impl embedded_can::Frame) -> Option<f64> {
    match Message::decode_for(model, frame).ok()?.report()? {
        Message::Motion(motion) => Some(motion.flow),
        Message::SetSpeed(_) => None,
    }
}

/// Answers as a simulated pump, which obeys.
pub fn answer(pump: u8, request: &impl embedded_can::Frame) -> Option<Frame> {
    let received = Message::decode(request).ok()?;
    let set = *received.request()?;
    received.answer(pump, set).ok()
}

/// Builds the report of a simulated pump.
pub fn report(pump: u8, motion: Motion) -> Option<Frame> {
    Motion::REPORT.report_from(pump, Message::Motion(motion)).ok()
}

/// Builds the same frame with the highest priority.
pub fn urgent(request: &Request<SetSpeed>) -> Option<Frame> {
    let sent = Message::decode(request.frame()).ok()?;
    let identifier = Identifier { priority: 0, ..sent.identifier() };
    sent.with_identifier(identifier).encode().ok()
}
