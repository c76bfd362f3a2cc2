#![doc = include_str!("../../docs/rules/product_limit.md")]

use crate::model::{Fixed, Limit, Message, ModelId, OfModel, Protocol, QuantityPaths, Range, Signal};
use crate::report::diagnostic::{Diagnostic, Diagnostics};
use crate::resolve::rules::PRODUCT_LIMIT;

/// What the document allows on a device model, or on every one.
struct Documented<'a> {
    message: &'a Message,
    signal: &'a Signal,
    model: Option<ModelId>,
    /// It is `None` for a float that the document does not limit.
    range: Option<Range>,
}

pub fn check(protocol: &Protocol, diagnostics: &mut Diagnostics) {
    for (known, limit) in protocol.quantities.iter().filter_map(|known| Some((known, protocol.limit_of(known)?))) {
        let documented = documented(protocol, known);
        let problem = beyond(limit, &documented).or_else(|| without_value(protocol, limit, &documented));
        if let Some(problem) = problem {
            diagnostics.push(problem);
        }
    }
    for set in protocol.quantities.iter().filter_map(|known| known.set.as_ref()) {
        let message = &protocol[set.message];
        let problems = set.with.iter().filter_map(|fixed| beyond_fixed(&message[fixed.signal], fixed));
        problems.for_each(|problem| diagnostics.push(problem));
    }
    unreached(protocol, diagnostics);
    of_one_model(protocol, diagnostics);
}

fn documented<'a>(protocol: &'a Protocol, known: &'a QuantityPaths) -> Vec<Documented<'a>> {
    let setters = protocol.setters(known).flat_map(|(message, signal)| {
        let models: Vec<_> = protocol.models_of(message).map(Some).collect();
        let models = if models.is_empty() { vec![None] } else { models };
        let range = |model| signal.range_for(model).or_else(|| signal.held());
        models.into_iter().map(move |model| Documented { message, signal, model, range: range(model) })
    });
    setters.collect()
}

/// Refuses a limit that would allow more than the document.
fn beyond(limit: &Limit, documented: &[Documented]) -> Option<Diagnostic> {
    let ranges: Option<Vec<Range>> = documented.iter().map(|known| known.range).collect();
    let allowed = ranges?.into_iter().reduce(Range::hull)?;
    let shared = allowed.shared(limit.range);
    if shared == limit.range {
        return None;
    }
    let unit = documented.first()?.signal.unit_text();
    let text =
        format!("the limit of `{}` goes beyond {}{unit}, which the document allows", limit.quantity, shown(allowed));
    let within =
        if shared.minimum <= shared.maximum { format!("`{}{unit}`", shown(shared)) } else { "one within".to_owned() };
    let help = format!("a limit only narrows: write {within}");
    Some(Diagnostic::error(&PRODUCT_LIMIT, limit.path.at_value(), text).help(help))
}

/// Refuses a limit that leaves no value for a signal, or none on some device models.
fn without_value(protocol: &Protocol, limit: &Limit, documented: &[Documented]) -> Option<Diagnostic> {
    let is_empty = |known: &&Documented| known.is_empty(limit);
    let first = documented.iter().find(is_empty)?;
    let Documented { message, signal, .. } = first;
    let same = documented.iter().filter(is_empty).filter(|known| known.signal.doc.path == signal.doc.path);
    let models: Vec<_> = same.filter_map(|known| Some(format!("`{}`", protocol[known.model?].name))).collect();
    let (on, what) =
        if models.is_empty() { (String::new(), "message") } else { (format!(" on {}", models.join(", ")), "model") };
    let field = format!("`{}.{}`", message.name, message.field_name(signal));
    let text = format!("the limit of `{}` leaves no value for {field}{on}", limit.quantity);
    let help = format!("widen it; or name the {what} in `removes`, if the product does not have it");
    let problem = Diagnostic::error(&PRODUCT_LIMIT, limit.path.at_value(), text).help(help);
    Some(problem.other(signal.doc.path.at_key(), "the field"))
}

impl Documented<'_> {
    /// Tests whether nothing that can be sent lies within the limit.
    fn is_empty(&self, limit: &Limit) -> bool {
        let left = self.range.map_or(limit.range, |range| range.shared(limit.range));
        let integers = self.signal.encoding.linear().and_then(|linear| linear.integers(left));
        left.minimum > left.maximum || integers.is_some_and(|[first, last]| first > last)
    }
}

/// Refuses a value beside a quantity that lies outside the limit of its own one.
fn beyond_fixed(signal: &Signal, fixed: &Fixed) -> Option<Diagnostic> {
    let limit = signal.limit.as_ref()?;
    let is_special = signal.specials.iter().any(|special| special.raw == signal.raw_of(fixed.bits));
    if is_special || signal.is_in(&limit.range, fixed.bits) {
        return None;
    }
    let text = format!("`{}` lies outside the limit of `{}` here", signal.name, limit.quantity);
    let problem = Diagnostic::error(&PRODUCT_LIMIT, fixed.path.at_value(), text);
    Some(problem.other(limit.path.at_value(), "the limit").help("write a value within the limit"))
}

/// Warns of a model's range that a spec narrows, though a request that names no model does not keep to it.
fn of_one_model(protocol: &Protocol, diagnostics: &mut Diagnostics) {
    for message in &protocol.messages {
        let content = protocol.whole(message);
        let open =
            content.signals.entries().filter(|(id, signal)| signal.limit.is_none() && protocol.is_sent(message, *id));
        for (_, signal) in open {
            let Some(hull) = signal.hull(protocol.models_of(message)) else { continue };
            let narrowed = signal.model_ranges.iter().filter(|own| own.value != hull);
            let own: Vec<_> = narrowed.filter(|own| is_own(protocol, diagnostics, own)).collect();
            for own in own {
                diagnostics.push_first(passed(protocol, signal, own, hull));
            }
        }
    }
}

/// Tests whether a spec narrows a model that it takes over, and states no section for it.
fn is_own(protocol: &Protocol, diagnostics: &Diagnostics, own: &OfModel<Range>) -> bool {
    let section = protocol[own.model].doc.path.key("section").at_value();
    diagnostics.is_taken_over(&section) && !diagnostics.is_taken_over(&own.path.at_value())
}

fn passed(protocol: &Protocol, signal: &Signal, own: &OfModel<Range>, hull: Range) -> Diagnostic {
    let (range, unit, model) = (shown(own.value), signal.unit_text(), &protocol[own.model].name);
    let text =
        format!("`{model}` has {range}{unit} here, but a request that names no model takes {}{unit}", shown(hull));
    let name = set_by(protocol, signal).map_or("QUANTITY", |known| &known.name);
    let limit = format!("`product: {{limits: {{{name}: {range}{unit}}}}}`");
    let help = format!("to limit the product, write {limit}, which narrows every model; or `allow` the warning");
    Diagnostic::warning(&PRODUCT_LIMIT, own.path.at_value(), text).help(help)
}

/// Warns of signals that a request sets, and that no limit reaches though it limits others in the same unit.
fn unreached(protocol: &Protocol, diagnostics: &mut Diagnostics) {
    for message in &protocol.messages {
        let content = protocol.whole(message);
        // An array is one field.
        let fields = content.signals.entries().filter(|(_, signal)| signal.element.is_none_or(|of| of.index == 0));
        let open = fields.filter(|(id, signal)| signal.limit.is_none() && protocol.is_sent(message, *id));
        for (_, signal) in open {
            let limit = signal
                .on_each()
                .filter(|own| own.unit.is_some())
                .find_map(|own| protocol.limits.iter().find(|limit| limit.unit == own.unit));
            if let Some(limit) = limit {
                diagnostics.push(open_path(protocol, content, signal, limit));
            }
        }
    }
}

fn open_path(protocol: &Protocol, message: &Message, signal: &Signal, limit: &Limit) -> Diagnostic {
    let field = format!("{}.{}", message.name, message.field_name(signal));
    let help = match set_by(protocol, signal) {
        Some(known) => format!("it sets `{0}`: add a limit of `{0}`, or `allow` the warning", known.name),
        None => format!("add `{field}` to `also` of the quantity that it sets, or `allow` the warning"),
    };
    let text = format!("no limit of the product reaches `{field}`, which a request sets");
    let warning = Diagnostic::warning(&PRODUCT_LIMIT, signal.doc.path.at_key(), text).help(help);
    warning.other(limit.path.at_value(), format!("`{}` has one", limit.quantity))
}

/// Returns the quantity that a signal sets.
fn set_by<'a>(protocol: &'a Protocol, signal: &Signal) -> Option<&'a QuantityPaths> {
    let is_this = |(_, other): (&Message, &Signal)| other.doc.path == signal.doc.path;
    protocol.quantities.iter().find(|known| protocol.setters(known).any(is_this))
}

fn shown(range: Range) -> String {
    format!("{}..{}", range.minimum, range.maximum)
}
