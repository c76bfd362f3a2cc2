#![doc = include_str!("../../docs/rules/starting.md")]

use crate::model::{ErrorCode, Protocol};
use crate::report::diagnostic::{At, Diagnostic, Diagnostics};
use crate::report::rule::rules;

rules! {
    STARTING "starting" Check ERROR;
}

pub fn check(protocol: &Protocol, diagnostics: &mut Diagnostics) {
    for code in protocol.error_codes().filter(|code| code.starting.is_some()) {
        let mut others = protocol.error_codes().filter(|other| other.doc.path != code.doc.path);
        let ErrorCode { name, normal, .. } = code;
        if normal.is_none() {
            let text = format!("`{name}` does not say what it is in a reply that is no error reply");
            diagnostics.push(at(&code, text).help("write its `normal`, or take `starting` out"));
        } else if normal == code.starting {
            let text = format!("`{name}` is the same in a reply that is no error reply");
            diagnostics.push(at(&code, text).help("write the code of replies while the device starts"));
        } else if let Some(other) = others.next() {
            let text = format!("`{name}` is not the only error code: `{}` is one, too", other.name);
            let help = "take `starting` out, or `normal` of the other field";
            diagnostics.push(at(&code, text).help(help).other(other.doc.path.at_key(), "the other field"));
        }
    }
}

fn at(code: &ErrorCode<'_>, text: String) -> Diagnostic {
    let at: At = code.doc.path.key("starting").at_value();
    Diagnostic::error(&STARTING, at, text)
}
