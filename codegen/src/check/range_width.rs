#![doc = include_str!("../../docs/rules/range_width.md")]

use crate::encoding::about_offset;
use crate::model::{Message, Protocol, Range, Signal};
use crate::report::diagnostic::{At, Diagnostic, Diagnostics};
use crate::report::rule::rules;
use crate::report::tree::Path;
use crate::words::number::Rational;

rules! {
    RANGE_WIDTH "range_width" Check ERROR;
}

pub fn check(protocol: &Protocol, diagnostics: &mut Diagnostics) {
    for message in protocol.contents() {
        for signal in message.signals.iter().flat_map(Signal::on_each) {
            check_signal(message, signal, help, diagnostics);
            for part in signal.encoding.parts() {
                check_signal(message, part, |_, _, _| "correct the limits or the place".to_owned(), diagnostics);
            }
        }
    }
}

fn check_signal(
    message: &Message,
    signal: &Signal,
    help: impl FnOnce(&Signal, Range, Range) -> String,
    diagnostics: &mut Diagnostics,
) {
    let Some(holds) = signal.held() else { return };
    let exceeds = |range: &Range| range.minimum < holds.minimum || range.maximum > holds.maximum;
    let exceeding: Vec<_> = signal.ranges().filter(|(range, _)| exceeds(range)).collect();
    let place = diagnostics.written(&signal.doc.path, &["bytes", "bits"]);
    let field = format!("`{}.{}` has {}", message.name, signal.name, held(signal, holds));
    if let Some(diagnostic) = report(signal, place, &field, &exceeding) {
        diagnostics.push_first(diagnostic.help(help(signal, exceeding[0].0, holds)));
    }
}

/// Reports the limits of a field, or its place if several limits exceed it. The place can also be
/// wrong if the limit is that of a type.
fn report(signal: &Signal, place: At, field: &str, exceeding: &[(Range, Path)]) -> Option<Diagnostic> {
    let (range, path) = exceeding.first()?;
    let (minimum, maximum) = (range.minimum, range.maximum);
    if exceeding.len() > 1 {
        let text = format!("{field}; {} ranges lie outside", exceeding.len());
        let first = format!("{minimum}..{maximum}, the first of them");
        return Some(Diagnostic::error(&RANGE_WIDTH, place, text).other(path.at_value(), first));
    }
    let text = format!("{field}; its range is {minimum}..{maximum}");
    if path.ancestors().any(|outer| *outer == signal.doc.path) {
        return Some(Diagnostic::error(&RANGE_WIDTH, path.at_value(), text));
    }
    Some(Diagnostic::error(&RANGE_WIDTH, place, text).other(path.at_value(), "its range"))
}

/// Says what the bits of a signal hold.
fn held(signal: &Signal, holds: Range) -> String {
    format!("{}, which hold {}..{}", number_of_bits(signal.place.width()), holds.minimum, holds.maximum)
}

fn help(signal: &Signal, range: Range, holds: Range) -> String {
    if range.minimum < Rational::ZERO && holds.minimum == Rational::ZERO {
        return "numbers below 0 need `as: signed` or an `offset`; or correct the limits".to_owned();
    }
    match about_offset(signal) {
        Some(why) => format!("correct the limits, the scale, the offset or the place; {why}"),
        None => "correct the limits, the scale or the place".to_owned(),
    }
}

fn number_of_bits(width: u8) -> String {
    if width == 1 { "one bit".to_owned() } else { format!("{width} bits") }
}
