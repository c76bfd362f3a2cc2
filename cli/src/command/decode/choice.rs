//! Choosing messages and signals of a log.

use canspec_codegen::interpret::{Decoded, Reading, Value};
use canspec_codegen::model::{Message, Protocol, Signal};
use canspec_codegen::nearest;
use clap::Args;

use crate::failure::{Failure, MOST_NAMES};
use crate::show::line::set_bits;
use crate::show::severity::Severity;

/// Chooses what is shown of a log.
#[derive(Args)]
pub struct Choice {
    /// Only frames of this message; repeatable.
    #[arg(long, value_name = "NAME", value_delimiter = ',', conflicts_with = "to")]
    message: Vec<String>,
    /// Only this signal, and frames that have it; repeatable.
    #[arg(long, value_name = "NAME", value_delimiter = ',', conflicts_with = "to")]
    signal: Vec<String>,
    /// Only status words with a set bit of this severity, and frames that have one; repeatable.
    #[arg(long, value_enum, value_name = "SEVERITY", value_delimiter = ',', conflicts_with = "to")]
    severity: Vec<Severity>,
}

impl Choice {
    /// Refuses names that no protocol has.
    ///
    /// # Errors
    ///
    /// Says what can have been meant.
    pub fn check(&self, protocols: &[Protocol]) -> Result<(), Failure> {
        let messages =
            || protocols.iter().flat_map(|protocol| protocol.contents().map(move |message| (protocol, message)));
        for name in &self.message {
            let is_known = messages().any(|(protocol, message)| is_called(protocol, message, name));
            let known = messages().map(|(_, message)| message.name.as_str());
            is_known.then_some(()).ok_or_else(|| unknown("message", name, known))?;
        }
        let chosen = || messages().filter(|(protocol, message)| self.has_message(protocol, message));
        let signals = || chosen().flat_map(|(_, message)| names(message));
        for name in &self.signal {
            let is_known = signals().any(|known| known == name);
            is_known.then_some(()).ok_or_else(|| {
                if messages().any(|(protocol, message)| is_called(protocol, message, name)) {
                    return message_instead(name);
                }
                let both = messages().find_map(|(protocol, message)| parted(protocol, message, name));
                both.map_or_else(|| unknown("signal", name, signals()), |both| joined(name, both))
            })?;
        }
        Ok(())
    }

    /// Tests whether everything is shown, unrecognised frames too.
    pub fn is_everything(&self) -> bool {
        self.message.is_empty() && self.has_all_signals()
    }

    fn has_all_signals(&self) -> bool {
        self.signal.is_empty() && self.severity.is_empty()
    }

    /// Takes away signals that the device model does not have, or that are not chosen. It returns whether the frame is
    /// still to be shown.
    pub fn keep(&self, protocol: &Protocol, decoded: &mut Decoded) -> bool {
        let message = decoded.content(protocol);
        if !self.has_message(protocol, message) {
            return false;
        }
        decoded.hide_lacking(protocol);
        if self.has_all_signals() {
            return true;
        }
        let is_error_reply = decoded.is_error_reply();
        decoded.signals.retain(|reading| {
            let signal = &message.signals[reading.signal];
            let is_called = |name: &String| *name == signal.name || name == message.field_name(signal);
            let is_named = self.signal.is_empty() || self.signal.iter().any(is_called);
            // Values of an error reply mean nothing.
            is_named && (self.severity.is_empty() || !is_error_reply && self.is_grave(protocol, signal, reading))
        });
        !decoded.signals.is_empty()
    }

    /// Tests for a set bit of a chosen severity.
    fn is_grave(&self, protocol: &Protocol, signal: &Signal, reading: &Reading) -> bool {
        let Value::Status { set, .. } = &reading.value else { return false };
        let mut severities = set_bits(protocol, signal, *set).filter_map(Severity::of);
        severities.any(|severity| self.severity.contains(&severity))
    }

    fn has_message(&self, protocol: &Protocol, message: &Message) -> bool {
        self.message.is_empty() || self.message.iter().any(|name| is_called(protocol, message, name))
    }
}

/// Tests for the name of a message, which in tables of several protocols stands behind that of its protocol.
fn is_called(protocol: &Protocol, message: &Message, name: &str) -> bool {
    let own = name.strip_prefix(protocol.name.as_str()).and_then(|rest| rest.strip_prefix('.'));
    message.name == name || own == Some(&message.name)
}

/// Returns the names of signals and of arrays.
fn names(message: &Message) -> impl Iterator<Item = &str> {
    let signals = message.signals.iter().map(|signal| signal.name.as_str());
    signals.chain(message.arrays.iter().map(|array| array.name.as_str()))
}

/// Splits `MESSAGE.SIGNAL` if the message has that signal.
fn parted<'n>(protocol: &Protocol, message: &Message, name: &'n str) -> Option<(&'n str, &'n str)> {
    let (own, signal) = name.rsplit_once('.')?;
    let has_it = names(message).any(|known| known == signal);
    (has_it && is_called(protocol, message, own)).then_some((own, signal))
}

/// Refuses `MESSAGE.SIGNAL`.
fn joined(name: &str, (message, signal): (&str, &str)) -> Failure {
    Failure::Call(format!("unknown signal `{name}`; write `--message {message} --signal {signal}`"))
}

/// Refuses the name of a message in place of that of a signal.
fn message_instead(name: &str) -> Failure {
    Failure::Call(format!("unknown signal `{name}`; it is a message, so write `--message {name}`"))
}

fn unknown<'n>(what: &str, name: &str, known: impl IntoIterator<Item = &'n str>) -> Failure {
    let mut known: Vec<&str> = known.into_iter().collect();
    known.sort_unstable();
    known.dedup();
    let help = match nearest(name, known.iter().copied()) {
        Some(known) => format!("did you mean `{known}`?"),
        None if known.len() > MOST_NAMES => format!("`canspec list` shows the {what}s of a protocol"),
        None => format!("known are {}", known.join(", ")),
    };
    Failure::Call(format!("unknown {what} `{name}`; {help}"))
}
