//! The words of the spec language for what a model holds.

use canspec_codegen::model::{Encoding, Numeral, Origin, OutOfRange, Side, Standard, TextForm, Who};

/// Returns the word for what bits are, as after `as`, or else the key that makes them so.
pub fn encoding(encoding: &Encoding) -> &'static str {
    match encoding {
        Encoding::Number { numeral, .. } | Encoding::ByModel { numeral, .. } => match numeral {
            Numeral::Unsigned => "unsigned",
            Numeral::Signed => "signed",
            Numeral::Bcd => "bcd",
        },
        Encoding::Float => "float",
        Encoding::Named(_) => "values",
        Encoding::Status(_) => "status",
        Encoding::Text(TextForm::Ascii { .. }) => "text",
        Encoding::Text(TextForm::Hexadecimal) => "bytes",
        Encoding::Packed { .. } => "format",
    }
}

/// Returns the word for a side of the bus.
pub fn side(side: Side) -> &'static str {
    match side {
        Side::Module => "module",
        Side::Controller => "controller",
    }
}

/// Returns the word for who answers.
pub fn who(who: Who) -> &'static str {
    match who {
        Who::One => "one",
        Who::Each => "each",
        Who::Coordinator => "coordinator",
        Who::Nobody => "nobody",
    }
}

/// Returns the word for what a device does with a value outside the range.
pub fn out_of_range(known: OutOfRange) -> &'static str {
    match known {
        OutOfRange::Refused => "refused",
        OutOfRange::Ignored => "ignored",
        OutOfRange::Limited => "limited",
    }
}

/// Returns the word for what becomes of a value without power.
pub fn power_off(keeps: bool) -> &'static str {
    if keeps { "kept" } else { "lost" }
}

/// Returns the word for where an example comes from.
pub fn origin(origin: Origin) -> &'static str {
    match origin {
        Origin::Document => "document",
        Origin::Ours => "ours",
        Origin::Captured => "captured",
    }
}

/// Returns the word for a standard of transports.
pub fn standard(standard: &Standard) -> &'static str {
    match standard {
        Standard::J1939(_) => "j1939",
        Standard::Isotp(_) => "isotp",
        // The enum may grow.
        _ => "",
    }
}
