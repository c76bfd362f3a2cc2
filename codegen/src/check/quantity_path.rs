#![doc = include_str!("../rules/quantity_path.md")]

use canspec_runtime::{Quantity, QuantityKind};

use crate::diagnostic::{Diagnostic, Diagnostics};
use crate::model::{Encoding, Fixed, Protocol, QuantityPaths, Signal, SignalPath};
use crate::resolve::rules::QUANTITY_PATH;

pub fn check(protocol: &Protocol, diagnostics: &mut Diagnostics) {
    for known in &protocol.quantities {
        for path in known.read.iter().chain(&known.set) {
            check_value(protocol, path, diagnostics);
            check_standard(protocol, known, path, diagnostics);
        }
        if let (Some(read), Some(set)) = (&known.read, &known.set) {
            check_agreement(protocol, [read, set], diagnostics);
        }
        if let Some(read) = known.read.as_ref().filter(|read| protocol.frames_with(read).next().is_none()) {
            diagnostics.push(untold(protocol, read, "no reply and no report of a module has", "read"));
        }
        if let Some(set) = &known.set {
            check_request(protocol, set, diagnostics);
        }
    }
    check_once(protocol, diagnostics);
}

/// Tests that a path leads to a number, or to a switch with states.
fn check_value(protocol: &Protocol, path: &SignalPath, diagnostics: &mut Diagnostics) {
    if path.states.is_some() {
        return;
    }
    let signal = protocol.signal_at(path);
    if let Some(text) = refused(signal) {
        diagnostics.push(at(path, format!("`{}` {text}", name(protocol, path))).help(match signal.encoding {
            Encoding::Named(_) | Encoding::Status(_) => {
                "write its states, as in `{signal: .., active: on, inactive: off}`"
            }
            Encoding::Number { .. } | Encoding::Float => "write its `unit`, whose thousandths are counted",
            Encoding::ByModel { .. } | Encoding::Text(_) | Encoding::Packed { .. } => "leave the quantity out",
        }));
    }
}

/// Says why a signal is no number that a program could use.
fn refused(signal: &Signal) -> Option<&'static str> {
    match &signal.encoding {
        Encoding::Number { scale, offset, .. } => {
            let is_whole = [scale, offset].into_iter().all(|number| number.to_integer().is_some());
            (signal.unit.is_none() && !is_whole).then_some("has fractions, but no unit")
        }
        Encoding::Float => signal.unit.is_none().then_some("has fractions, but no unit"),
        Encoding::ByModel { .. } => Some("has another scale on other device models"),
        Encoding::Named(_) => Some("has names for its values, and is no number"),
        Encoding::Status(_) => Some("is a status word, and no number"),
        Encoding::Text(_) | Encoding::Packed { .. } => Some("is a text, and no number"),
    }
}

/// Tests that a standard name has values of its kind.
fn check_standard(protocol: &Protocol, known: &QuantityPaths, path: &SignalPath, diagnostics: &mut Diagnostics) {
    let mut standard = Quantity::STANDARD.iter();
    let Some((_, kind)) = standard.find(|(quantity, _)| quantity.name() == known.name) else { return };
    let unit = protocol.unit_at(path);
    let symbol = unit.as_ref().map(|unit| &*unit.symbol);
    let is_right = match kind {
        QuantityKind::Unit(unit) => symbol == Some(unit),
        QuantityKind::Count => symbol.is_none() && path.states.is_none(),
        QuantityKind::Switch => path.states.is_some(),
    };
    if is_right {
        return;
    }
    let wanted = match kind {
        QuantityKind::Unit(unit) => format!("is in {unit}"),
        QuantityKind::Count => "is a number without a unit".to_owned(),
        QuantityKind::Switch => "is a switch".to_owned(),
    };
    let text = format!("`{}` {wanted}, but `{}` {}", known.name, name(protocol, path), kind_of(protocol, path));
    diagnostics.push(at(path, text).help("name another signal, or give the quantity a name of its own"));
}

/// Tests that what is read and what is set have one unit.
fn check_agreement(protocol: &Protocol, [read, set]: [&SignalPath; 2], diagnostics: &mut Diagnostics) {
    let kinds = [read, set].map(|path| kind_of(protocol, path));
    if kinds[0] != kinds[1] {
        let names = [read, set].map(|path| name(protocol, path));
        let text = format!("`{}` {}, but `{}`, which is read, {}", names[1], kinds[1], names[0], kinds[0]);
        let problem = at(set, text).other(read.path.at_value(), "what is read");
        diagnostics.push(problem.help("name a signal of the same unit, or make them two quantities"));
    }
}

fn kind_of(protocol: &Protocol, path: &SignalPath) -> String {
    match protocol.unit_at(path) {
        _ if path.states.is_some() => "is a switch".to_owned(),
        Some(unit) => format!("is in {}", unit.symbol),
        None => "has no unit".to_owned(),
    }
}

/// Tests that a request says all that its frame carries.
fn check_request(protocol: &Protocol, set: &SignalPath, diagnostics: &mut Diagnostics) {
    let Some(request) = protocol.setting(set) else {
        diagnostics.push(untold(protocol, set, "no request carries", "set"));
        return;
    };
    let message = &protocol[set.message];
    if request.lengths.len() > 1 {
        let text = format!("requests of `{}` have several lengths", message.name);
        diagnostics.push(at(set, text).help("name a message with one length, or leave `set` out"));
        return;
    }
    let mut setters = protocol.setters_of(set.message);
    let is_first = setters.next().is_some_and(|first| first.path == set.path);
    let is_given = |signal| {
        let mut setters = protocol.setters_of(set.message);
        setters.any(|path| path.signal == signal) || protocol.fixed_beside(set).any(|fixed| fixed.signal == signal)
    };
    let missing = request.signals.iter().filter(|signal| !is_given(**signal));
    let missing: Vec<_> = missing.map(|signal| format!("`{}`", message[*signal].name)).collect();
    if let Some(first) = missing.first().filter(|_| is_first) {
        let text = format!("nothing says what {} of `{}` is in the request", missing.join(" and "), message.name);
        let help = format!("write it in `with: {{{}: ..}}`, or make it a quantity", first.trim_matches('`'));
        diagnostics.push(at(set, text).help(help));
    }
    set.with.iter().for_each(|fixed| check_fixed(protocol, set, fixed, diagnostics));
}

/// Tests that a signal of a request has one value.
fn check_fixed(protocol: &Protocol, set: &SignalPath, fixed: &Fixed, diagnostics: &mut Diagnostics) {
    let mut earlier = protocol.fixed_beside(set).take_while(|other| other.path != fixed.path);
    let other = earlier.find(|other| other.signal == fixed.signal && other.bits != fixed.bits);
    let quantity = protocol.setters_of(set.message).find(|path| path.signal == fixed.signal);
    let name = &protocol[set.message][fixed.signal].name;
    if let Some(quantity) = quantity {
        let text = format!("`{name}` is set by a quantity, and has a value here");
        let problem = Diagnostic::error(&QUANTITY_PATH, fixed.path.at_key(), text);
        diagnostics.push(problem.other(quantity.path.at_value(), "the quantity").help("take one of the two out"));
    }
    if let Some(other) = other {
        let text = format!("`{name}` has another value beside another quantity of the same request");
        let problem = Diagnostic::error(&QUANTITY_PATH, fixed.path.at_value(), text);
        diagnostics.push(problem.other(other.path.at_value(), "the other value").help("write one value for both"));
    }
}

/// Tests that no two quantities set the same bits, or read them.
fn check_once(protocol: &Protocol, diagnostics: &mut Diagnostics) {
    let both: [fn(&QuantityPaths) -> Option<&SignalPath>; 2] =
        [|known| known.read.as_ref(), |known| known.set.as_ref()];
    for path_of in both {
        let paths: Vec<_> = protocol.quantities.iter().filter_map(|known| Some((known, path_of(known)?))).collect();
        for (index, (known, path)) in paths.iter().enumerate() {
            let is_same = |(_, other): &&(&QuantityPaths, &SignalPath)| {
                (other.message, other.signal, other.place) == (path.message, path.signal, path.place)
            };
            if let Some((earlier, other)) = paths[..index].iter().find(is_same) {
                let text = format!("both `{}` and `{}` are `{}`", earlier.name, known.name, name(protocol, path));
                let problem = at(path, text).other(other.path.at_value(), "the other quantity");
                diagnostics.push(problem.help("take one of the two out"));
            }
        }
    }
}

fn untold(protocol: &Protocol, path: &SignalPath, what: &str, key: &str) -> Diagnostic {
    let text = format!("{what} `{}`", name(protocol, path));
    at(path, text).help(format!("name a message that can be {key}, or take `{key}` out"))
}

fn at(path: &SignalPath, text: String) -> Diagnostic {
    Diagnostic::error(&QUANTITY_PATH, path.path.at_value(), text)
}

fn name(protocol: &Protocol, path: &SignalPath) -> String {
    format!("{}.{}", protocol[path.message].name, protocol.signal_at(path).name)
}
