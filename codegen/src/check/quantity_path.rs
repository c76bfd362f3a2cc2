#![doc = include_str!("../../docs/rules/quantity_path.md")]

use canspec_runtime::{Place, Quantity, QuantityKind};

use super::ambiguous::are_alike;
use crate::interpret::Reading;
use crate::interpret::signal_note;
use crate::model::{
    Encoding, FieldPath, Fixed, FrameLayout, MessageId, Protocol, QuantityPaths, Signal, SignalId, SignalPath, Unit,
};
use crate::report::diagnostic::{Diagnostic, Diagnostics};
use crate::report::tree::Path;
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
        if let Some(read) = &known.read {
            check_recognised(protocol, read, diagnostics);
        }
        if let Some(set) = &known.set {
            check_request(protocol, set, diagnostics);
            check_states(protocol, set, diagnostics);
        }
        check_also(protocol, known, diagnostics);
    }
    check_once(protocol, diagnostics);
    check_set_once(protocol, diagnostics);
}

/// Tests that other fields that set a quantity are numbers of the same kind in requests.
fn check_also(protocol: &Protocol, known: &QuantityPaths, diagnostics: &mut Diagnostics) {
    let (first, also) = (known.set.as_ref().or(known.read.as_ref()), &known.also);
    let of_path = first.map(|path| (kind_of(protocol, path), path.path.clone()));
    let of_field = |field: &FieldPath| Some((kind_in(signals_of(protocol, field).next()?.1.unit), field.path.clone()));
    let Some((wanted, place)) = of_path.or_else(|| of_field(also.first()?)) else { return };
    for field in also {
        let name = format!("{}.{}", protocol[field.message].name, field.field);
        for (id, signal) in signals_of(protocol, field) {
            let found = kind_in(signal.unit);
            let (text, help) = if let Some(text) = refused(signal) {
                (format!("`{name}` {text}"), "name a number that a request sets, or take it out")
            } else if !protocol.is_sent(&protocol[field.message], id) {
                (format!("no request carries `{name}`"), "name a number that a request sets, or take it out")
            } else if found != wanted {
                (format!("`{name}` {found}, but `{}` {wanted}", known.name), "make them two quantities")
            } else {
                continue;
            };
            let problem = Diagnostic::error(&QUANTITY_PATH, field.path.at_value(), text).help(help);
            let is_other = field.path != place && found != wanted;
            diagnostics.push_first(if is_other { problem.other(place.at_value(), "the quantity") } else { problem });
        }
    }
}

/// Returns the signals of a field, with their ids in what the message says.
fn signals_of<'a>(protocol: &'a Protocol, path: &'a FieldPath) -> impl Iterator<Item = (SignalId, &'a Signal)> {
    let content = protocol.whole(&protocol[path.message]);
    content.signals.entries().filter(|(_, signal)| content.field_name(signal) == path.field)
}

/// Tests that a field sets one quantity, and is named once.
fn check_set_once(protocol: &Protocol, diagnostics: &mut Diagnostics) {
    let fields = protocol.quantities.iter().flat_map(|known| {
        known.fields(|message| &protocol[message]).map(move |(message, field, path)| (known, message, field, path))
    });
    let fields: Vec<_> = fields.collect();
    for known in &protocol.quantities {
        for also in &known.also {
            let is_same = |(_, message, field, path): &&(&QuantityPaths, MessageId, &str, &Path)| {
                (*message, *field) == (also.message, also.field.as_str()) && **path != also.path
            };
            if let Some((other, .., path)) = fields.iter().find(is_same) {
                let name = format!("{}.{}", protocol[also.message].name, also.field);
                let text = format!("`{name}` sets `{}` already", other.name);
                let problem = Diagnostic::error(&QUANTITY_PATH, also.path.at_value(), text);
                diagnostics.push(problem.other(path.at_value(), "here").help("take one of the two out"));
            }
        }
    }
}

/// Tests that a path leads to a number, or to a switch with states.
fn check_value(protocol: &Protocol, path: &SignalPath, diagnostics: &mut Diagnostics) {
    if path.states.is_some() {
        return;
    }
    let signal = protocol.signal_at(path);
    if let Some(text) = refused(signal) {
        diagnostics.push(at(path, format!("`{}` {text}", protocol.path_text(path))).help(match signal.encoding {
            Encoding::Named(_) | Encoding::Status(_) => {
                "write its states, as in `{signal: .., active: \"on\", inactive: \"off\"}`"
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
    let (wanted, found) = (kind_text(*kind), kind_of(protocol, path));
    if wanted != found {
        let text = format!("`{}` {wanted}, but `{}` {found}", known.name, protocol.path_text(path));
        diagnostics.push(at(path, text).help("name another signal, or give the quantity a name of its own"));
    }
}

/// Tests that what is read and what is set have one unit.
fn check_agreement(protocol: &Protocol, [read, set]: [&SignalPath; 2], diagnostics: &mut Diagnostics) {
    let kinds = [read, set].map(|path| kind_of(protocol, path));
    if kinds[0] != kinds[1] {
        let names = [read, set].map(|path| protocol.path_text(path));
        let text = format!("`{}` {}, but `{}`, which is read, {}", names[1], kinds[1], names[0], kinds[0]);
        let problem = at(set, text).other(read.path.at_value(), "what is read");
        diagnostics.push(problem.help("name a signal of the same unit, or make them two quantities"));
    }
}

/// Says what a path leads to.
fn kind_of(protocol: &Protocol, path: &SignalPath) -> String {
    if path.states.is_some() { kind_text(QuantityKind::Switch) } else { kind_in(protocol.unit_at(path)) }
}

/// Says what a number is.
fn kind_in(unit: Option<Unit>) -> String {
    unit.map_or_else(|| kind_text(QuantityKind::Count), |unit| in_unit(&unit.symbol))
}

fn kind_text(kind: QuantityKind) -> String {
    match kind {
        QuantityKind::Unit(symbol) => in_unit(symbol),
        QuantityKind::Count => "has no unit".to_owned(),
        QuantityKind::Switch => "is a switch".to_owned(),
    }
}

fn in_unit(symbol: &str) -> String {
    format!("is in {symbol}")
}

/// Tests that a request says all that its frame carries.
fn check_request(protocol: &Protocol, set: &SignalPath, diagnostics: &mut Diagnostics) {
    let Some(request) = protocol.setting(set) else {
        diagnostics.push(untold(protocol, set, "no request and no report of the controller carries", "set"));
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
    let given = given(protocol, set);
    let missing = request.signals.iter().flat_map(|signal| missing(protocol, &message[*signal], given));
    let missing: Vec<_> = missing.collect();
    if let Some(first) = missing.first().filter(|_| is_first) {
        let names: Vec<_> = missing.iter().map(|name| format!("`{name}`")).collect();
        let text = format!("nothing says what {} of `{}` is in the request", names.join(" and "), message.name);
        let help = match first.split_once('.') {
            Some(_) => "make each bit of the word a quantity, or leave `set` out".to_owned(),
            None => format!("write it in `with: {{{first}: ..}}`, or make it a quantity"),
        };
        diagnostics.push(at(set, text).help(help));
    }
    set.with.iter().for_each(|fixed| check_fixed(protocol, set, fixed, diagnostics));
}

/// Returns the bits of the data that quantities and fixed values of a request give.
fn given(protocol: &Protocol, set: &SignalPath) -> u64 {
    let of_quantities = protocol.setters_of(set.message).map(|path| path.place);
    let fixed = protocol.fixed_in(set.message).map(|fixed| protocol[set.message][fixed.signal].place);
    of_quantities.chain(fixed).fold(0, |given, place| given | mask(place))
}

/// Names a signal if some of its bits are not given. Of a status word it names the bits.
fn missing(protocol: &Protocol, signal: &Signal, given: u64) -> Vec<String> {
    let is_given = |place: Place| mask(place) & !given == 0;
    let Some(word) = signal.encoding.status_word().filter(|_| mask(signal.place) & given != 0) else {
        return if is_given(signal.place) { Vec::new() } else { vec![signal.name.clone()] };
    };
    let bits = protocol[word].bits_in(signal.place).filter(|bit| !is_given(signal.place.bit(bit.bit)));
    bits.map(|bit| format!("{}.{}", signal.name, bit.name)).collect()
}

/// Returns the bits of a place in the data.
fn mask(place: Place) -> u64 {
    u64::from_be_bytes(place.mask())
}

/// Tests that every device model takes both states of a switch.
fn check_states(protocol: &Protocol, set: &SignalPath, diagnostics: &mut Diagnostics) {
    let signal = protocol.signal_at(set);
    let shift = set.place.bits_of_payload().shift() - signal.place.bits_of_payload().shift();
    for state in set.states.into_iter().flatten() {
        if let Some(text) = unsendable(protocol, set.message, set.signal, state << shift) {
            let help = "write a state that may be sent to every device model, or leave `set` out";
            diagnostics.push(at(set, text).help(help));
        }
    }
}

/// Says why bits of a signal may not be sent to each device model that has the message.
fn unsendable(protocol: &Protocol, message: MessageId, signal: SignalId, bits: u64) -> Option<String> {
    let message = &protocol[message];
    let models: Vec<_> = protocol.models_of(message).map(Some).collect();
    // A number whose scale depends on the model has no value without one.
    let unknown = models.is_empty() || !message[signal].encoding.by_model().is_empty();
    unknown.then_some(None).into_iter().chain(models).find_map(|model| {
        let reading = Reading::of(protocol, (signal, message[signal].on(model)), bits);
        let text = signal_note(protocol, (message, message.shortest().into()), model, &reading)?.text;
        Some(model.map_or_else(|| text.clone(), |model| format!("on {}: {text}", protocol[model].name)))
    })
}

/// Tests that frames with a quantity are known without the device model.
fn check_recognised(protocol: &Protocol, read: &SignalPath, diagnostics: &mut Diagnostics) {
    let message = &protocol[read.message];
    let is_like = |frame: &&FrameLayout| {
        message.is_apart_from(&protocol[frame.message])
            && protocol
                .frames_with(read)
                .any(|own| own.is_to_module() == frame.is_to_module() && are_alike(protocol, own, frame))
    };
    if let Some(other) = protocol.frames.iter().find(is_like).map(|frame| &protocol[frame.message]) {
        let text = format!("only the device model tells `{}` from `{}`", message.name, other.name);
        let help = "name a message that is known without the model, or leave the quantity out";
        diagnostics.push(at(read, text).help(help).other(other.doc.path.at_key(), "the other message"));
    }
}

/// Tests that a signal of a request has one value.
fn check_fixed(protocol: &Protocol, set: &SignalPath, fixed: &Fixed, diagnostics: &mut Diagnostics) {
    let mut earlier = protocol.fixed_in(set.message).take_while(|other| other.path != fixed.path);
    let other = earlier.find(|other| other.signal == fixed.signal && other.bits != fixed.bits);
    let quantity = protocol.setters_of(set.message).find(|path| path.signal == fixed.signal);
    let name = &protocol[set.message][fixed.signal].name;
    if let Some(text) = unsendable(protocol, set.message, fixed.signal, fixed.bits) {
        let problem = Diagnostic::error(&QUANTITY_PATH, fixed.path.at_value(), text);
        diagnostics.push(problem.help("write a value that may be sent to every device model"));
    }
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
                (other.message, other.signal) == (path.message, path.signal)
                    && mask(other.place) & mask(path.place) != 0
            };
            if let Some((earlier, other)) = paths[..index].iter().find(is_same) {
                let text = format!("both `{}` and `{}` are `{}`", earlier.name, known.name, protocol.path_text(path));
                let problem = at(path, text).other(other.path.at_value(), "the other quantity");
                diagnostics.push(problem.help("take one of the two out"));
            }
        }
    }
}

fn untold(protocol: &Protocol, path: &SignalPath, what: &str, key: &str) -> Diagnostic {
    let text = format!("{what} `{}`", protocol.path_text(path));
    at(path, text).help(format!("name a message that can be {key}, or take `{key}` out"))
}

fn at(path: &SignalPath, text: String) -> Diagnostic {
    Diagnostic::error(&QUANTITY_PATH, path.path.at_value(), text)
}
