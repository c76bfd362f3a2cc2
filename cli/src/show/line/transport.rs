//! The frames of transports. A line calls them `TRANSPORT.control` and `TRANSPORT.data`, and has their numbers among the
//! selectors.

use canspec_codegen::interpret::{Content, Decoded, Input};
use canspec_codegen::model::{Constant, Message, Protocol, Signal, Transport};

/// Tests whether a transport has a frame.
pub fn carries(protocol: &Protocol, decoded: &Decoded) -> bool {
    decoded.long.is_none() && protocol.transport_frame(decoded.message).is_some()
}

/// Returns the name of a frame, if a transport has it.
pub fn name(protocol: &Protocol, decoded: &Decoded) -> Option<String> {
    let (_, transport, frame) = protocol.transport_frame(decoded.message).filter(|_| carries(protocol, decoded))?;
    let part = if frame.has_data() { DATA } else { CONTROL };
    Some(format!("{}.{part}", transport.name))
}

/// Tests whether a signal of a transport's frame stands among the selectors.
pub fn is_number(signal: &Signal) -> bool {
    signal.encoding.is_unscaled()
}

/// Returns the content of a line as the spec has it, with the name of the transport. It returns nothing if the line is no
/// frame of a transport.
pub fn content<'a>(protocol: &'a Protocol, line: &'a Content) -> Option<(&'a str, Content)> {
    let (name, part) = line.message.split_once('.')?;
    let transport = protocol.transports.iter().find(|transport| transport.name == name)?;
    let message = message(protocol, transport, part, line)?;
    let is_of_message = |name: &str| message.signals.iter().any(|signal| is_number(signal) && signal.name == name);
    let (numbers, selectors): (Vec<_>, Vec<_>) =
        line.selectors.iter().cloned().partition(|(name, _)| is_of_message(name));
    let numbers = numbers.into_iter().map(|(name, number)| (name, Input::Raw(number.into())));
    let signals = numbers.chain(line.signals.iter().cloned()).collect();
    Some((name, Content { message: message.name.clone(), selectors, signals, ..line.clone() }))
}

/// Finds the message of a frame by what it is for.
fn message<'a>(protocol: &'a Protocol, transport: &Transport, part: &str, line: &Content) -> Option<&'a Message> {
    let is_constant = |constant: &Constant| {
        let known =
            |(name, value): &(String, u64)| *name == protocol[constant.selector].name && *value == constant.value;
        constant.in_payload().is_none() || line.selectors.iter().any(known)
    };
    let frames = transport.standard.frames().iter().filter(|(frame, _)| frame.has_data() == (part == DATA));
    let messages = frames.filter_map(|(frame, _)| Some(&protocol[transport.message(*frame)?]));
    let mut fitting = messages.filter(|message| message.constants.iter().all(is_constant));
    fitting.next().filter(|_| [DATA, CONTROL].contains(&part))
}

/// The frames with packets.
const DATA: &str = "data";
/// The frames that manage a transfer.
const CONTROL: &str = "control";
