#![doc = include_str!("../../docs/rules/erratum.md")]

use crate::model::Protocol;
use crate::report::diagnostic::{Diagnostic, Diagnostics};
use crate::report::rule::rules;

rules! {
    ERRATUM "erratum" Check EITHER;
}

pub fn check(protocol: &Protocol, diagnostics: &mut Diagnostics) {
    let docs = protocol.docs();
    for erratum in &protocol.errata {
        if !docs.iter().any(|doc| doc.errata.contains(&erratum.name)) {
            let name = erratum.name.for_people();
            let text = format!("nothing refers to the erratum `{name}`");
            let help =
                format!("add `erratum: {name}` to the item that departs from the document, or take the erratum out");
            diagnostics.push(Diagnostic::warning(&ERRATUM, erratum.path.at_key(), text).help(help));
        }
    }
    for doc in &docs {
        for name in &doc.errata {
            if !protocol.errata.iter().any(|erratum| erratum.name == *name) {
                let text = format!("there is no erratum `{}`", name.for_people());
                let at = doc.path.key("erratum").at_value();
                diagnostics.push(Diagnostic::error(&ERRATUM, at, text).help("correct the name, or add it to `errata`"));
            }
        }
    }
}
