//! An example that runs: a request as the document prints it, and a printed frame that is decoded.

mod value;

use std::cmp::Reverse;
use std::collections::BTreeSet;

use super::{Manual, section};
use crate::emit::rust::plan::literal::hexadecimal;
use crate::emit::rust::plan::signal::Member;
use crate::emit::rust::plan::usage::frame;
use crate::emit::rust::plan::{address, doc};
use crate::interpret::{Decoded, Frame, Target, decode, padded, request};
use crate::model::{Example, Protocol, Side, SignalId};
use value::{literal, shown, squeezed};

/// How wide a line of code can be.
const WIDTH: usize = 100;

/// A frame that the document prints and that holds, and what it says.
struct Printed<'a> {
    protocol: &'a Protocol,
    example: &'a Example,
    decoded: Decoded,
}

/// How little a frame shows.
type Rank = (bool, bool, Reverse<usize>);

/// Statements, and the names that they take from the module.
struct Part {
    names: Vec<String>,
    lines: Vec<String>,
}

impl Manual<'_> {
    /// Shows the frames of the document that say most; nothing if it prints none that can be shown.
    pub fn example(&self) -> String {
        let printed = || self.protocol.examples.iter().filter_map(|example| Printed::new(self.protocol, example));
        let requests = printed().filter_map(|printed| Some((printed.rank(), self.built(&printed)?)));
        let others = printed().filter_map(|printed| Some((printed.rank(), self.decoded(&printed)?)));
        let parts = [requests.min_by_key(|(rank, _)| *rank), others.min_by_key(|(rank, _)| *rank)];
        let parts: Vec<Part> = parts.into_iter().flatten().map(|(_, part)| part).collect();
        if parts.is_empty() { String::new() } else { written(&parts) }
    }

    /// Builds a request or a report of the controller that comes out as it is printed.
    fn built(&self, printed: &Printed) -> Option<Part> {
        let Printed { protocol, decoded, .. } = printed;
        let (target, argument) = self.target(printed)?;
        if printed.rebuilt(&target)? != Frame::of(protocol, printed.example) {
            return None;
        }
        let (message, layout) = (&self.plan.messages[decoded.message], &protocol[decoded.frame]);
        // A request that carries nothing is a method of the whole message's struct.
        let carried = message.structs.iter().find(|own| own.signals == layout.signals);
        let name = carried.map_or(message.whole(), |own| &own.name).to_string();
        let (mut names, mut values) = (vec![name.clone(), "Target".to_owned()], Vec::new());
        for ids in carried.iter().flat_map(|own| &own.members) {
            let elements = ids.iter().map(|id| self.element(printed, *id)).collect::<Option<Vec<_>>>()?;
            let kinds = elements.iter().filter_map(|value| Some(value.trim_start_matches("Some(").split_once("::")?.0));
            names.extend(kinds.map(str::to_owned));
            let Member { name, index, .. } = &message.signals[ids[0]].member;
            let value = elements.join(", ");
            values.push(if index.is_some() { format!("{name}: [{value}]") } else { format!("{name}: {value}") });
        }
        let call = format!("{}({argument})?;", message.methods[layout.exchange]);
        let mut lines = call_of(&name, &values, &call);
        lines.push(format!("assert_eq!(request.frame().to_string(), \"{}\");", frame(printed.example)));
        Some(Part { names, lines })
    }

    /// Writes the value of a signal in a frame.
    fn element(&self, Printed { protocol, decoded, .. }: &Printed, id: SignalId) -> Option<String> {
        let (signal, known) = (&self.plan.messages[decoded.message].signals[id], &protocol[decoded.message][id]);
        let Some(reading) = decoded.signals.iter().find(|reading| reading.signal == id) else {
            return Some("None".to_owned());
        };
        let value = literal(self, signal, known, reading.bits)?;
        Some(if signal.member.is_optional && value != "None" { format!("Some({value})") } else { value })
    }

    /// Returns whom a request addresses, for the interpreter and in Rust.
    fn target(&self, printed: &Printed) -> Option<(Target, String)> {
        let Printed { protocol, decoded, .. } = printed;
        let mode = decoded.addressing?.mode;
        let variant = self.plan.targets.as_ref()?.variants.iter().find(|target| target.mode == mode)?;
        let mode = &protocol[mode];
        let addresses = || mode.request.iter().flat_map(|pattern| &pattern.addresses);
        let chosen = mode.target.map(|kind| addresses().find(|address| address.address_type == kind));
        let number = chosen
            .flatten()
            .map(|address| protocol[address.address_type].number(protocol[address.field].get(decoded.id)));
        let argument = number.map_or_else(String::new, |number| format!("({})", squeezed(&address::number(number))));
        Some((Target { name: mode.name.clone(), number }, format!("Target::{}{argument}", variant.variant)))
    }

    /// Decodes what a module sends.
    fn decoded(&self, Printed { protocol, example, decoded }: &Printed) -> Option<Part> {
        if decoded.sender == Side::Controller || decoded.signals.is_empty() {
            return None;
        }
        let message = &protocol[decoded.message];
        let values = decoded.signals.iter().map(|reading| {
            let signal = &message[reading.signal];
            Some(format!("{:?}", format!("{} {}", signal.name, shown(self, signal, &reading.value)?)))
        });
        let values = values.collect::<Option<Vec<_>>>()?;
        let bytes = example.data.as_deref().unwrap_or_default();
        let data: Vec<_> = padded(bytes).iter().map(|byte| format!("0x{byte:02X}")).collect();
        let (extended, length) = (example.extended, bytes.len());
        let id = squeezed(&hexadecimal(example.id, if extended { 29 } else { 11 }));
        let mut lines = vec![
            format!("let frame = Frame::new_raw({id}, {extended}, [{}], {length});", data.join(", ")),
            "let mut shown = vec![];".to_owned(),
            "Message::decode(&frame)?.visit(|reading| shown.push(reading.to_string()));".to_owned(),
        ];
        lines.extend(listed("assert_eq!(shown, [", &values, "]);"));
        Some(Part { names: ["Frame", "Message"].map(str::to_owned).to_vec(), lines })
    }
}

impl<'a> Printed<'a> {
    /// Reads a frame; `None` if the document does not print it, or something about it is odd.
    fn new(protocol: &'a Protocol, example: &'a Example) -> Option<Self> {
        let is_printed =
            example.is_documented() && example.fails.is_none() && example.model.is_none() && example.data.is_some();
        let decoded = decode(protocol, None, &Frame::of(protocol, example)).ok().filter(|_| is_printed)?;
        (decoded.notes.is_empty() && decoded.set.is_none()).then_some(Self { protocol, example, decoded })
    }

    /// Returns how little the frame shows: whether it only echoes or asks, has errata that matter, or few values.
    fn rank(&self) -> Rank {
        let Self { protocol, example, decoded } = self;
        let access = &protocol[decoded.access];
        let sets = access.carries.iter().any(|kind| access.sender(*kind) == Side::Controller);
        let has_errata = example.doc.errata.iter().any(|name| doc::erratum(protocol, name).is_some());
        ((decoded.sender == Side::Controller) != sets, has_errata, Reverse(decoded.signals.len()))
    }

    /// Builds the request anew from what the document says that it means.
    fn rebuilt(&self, target: &Target) -> Option<Frame> {
        let Self { protocol, example, decoded } = self;
        let message = &protocol[decoded.message];
        let values = example.means.iter().map(|known| (message[known.signal].name.clone(), known.text.clone()));
        let (access, values) = (protocol[decoded.access].name.as_str(), values.collect::<Vec<_>>());
        let is_sent = decoded.sender == Side::Controller;
        is_sent.then(|| request(protocol, None, Some(access), &message.name, target, None, &values).ok())?
    }
}

/// Writes the call that builds a request.
fn call_of(name: &str, values: &[String], call: &str) -> Vec<String> {
    let one_line = format!("let request = {name} {{ {} }}.{call}", values.join(", "));
    if values.is_empty() {
        return vec![format!("let request = {name}::{call}")];
    }
    if one_line.len() <= WIDTH {
        return vec![one_line];
    }
    let values = values.iter().map(|value| format!("    {value},"));
    let head = std::iter::once(format!("let values = {name} {{"));
    head.chain(values).chain(["};".to_owned(), format!("let request = values.{call}")]).collect()
}

/// Writes a list in one line, or an item a line.
fn listed(head: &str, items: &[String], tail: &str) -> Vec<String> {
    let one_line = format!("{head}{}{tail}", items.join(", "));
    if one_line.len() <= WIDTH {
        return vec![one_line];
    }
    let items = items.iter().map(|item| format!("    {item},"));
    std::iter::once(head.to_owned()).chain(items).chain([tail.to_owned()]).collect()
}

/// Writes the example, whose module goes by the path that it has where it is compiled.
fn written(parts: &[Part]) -> String {
    let names: BTreeSet<&str> = parts.iter().flat_map(|part| &part.names).map(String::as_str).collect();
    let names = names.into_iter().collect::<Vec<_>>().join(", ");
    let head = ["# Example", "", "The document prints these frames:", "", "```"].map(str::to_owned);
    let imports = format!("#![doc = concat!(\"use \", module_path!(), \"::{{{names}}};\")]\n");
    let code = parts.iter().flat_map(|part| std::iter::once(String::new()).chain(part.lines.iter().cloned()));
    let end = ["# Ok::<(), std::boxed::Box<dyn std::error::Error>>(())", "```"].map(str::to_owned);
    format!("{}{imports}{}", section(&head), section(&code.chain(end).collect::<Vec<_>>()))
}
