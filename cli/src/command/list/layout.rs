//! Tables of what messages share: identifier, header, addresses, addressing modes, accesses, transports and types.

use std::cmp::Reverse;
use std::io::{self, Write};

use canspec_codegen::model::{
    Access, AddressPattern, AddressType, Allowance, EnumerationId, FieldId, Foreign, IdentifierField, Kind, Mode,
    Protocol, Selector, SelectorPlace, Side, Transport, WrittenPlace,
};

use super::remarks::{self, Type, words as text};
use super::rows::{row, table};
use super::{heading, words};
use crate::show::columns::Row;

/// Writes the tables that have rows.
pub fn write(out: &mut impl Write, protocol: &Protocol) -> io::Result<()> {
    table(out, &["BITS", "IDENTIFIER", "SECTION"], &identifier(protocol))?;
    let header: Vec<_> = protocol.selectors.iter().filter_map(|known| selector(protocol, known)).collect();
    table(out, &["BYTES", "HEADER", "SECTION"], &header)?;
    table(out, &["ADDRESS", "SECTION"], &protocol.address_types.iter().map(address).collect::<Vec<_>>())?;
    table(out, &["MODE", "SECTION"], &protocol.modes.iter().map(|known| mode(protocol, known)).collect::<Vec<_>>())?;
    accesses(out, protocol, &protocol.accesses.iter().collect::<Vec<_>>())?;
    let transports: Vec<_> = protocol.transports.iter().map(|known| transport(protocol, known)).collect();
    table(out, &["TRANSPORT", "SECTION"], &transports)?;
    let others: Vec<_> = protocol.foreign.iter().map(|known| foreign(protocol, known)).collect();
    table(out, &["FOREIGN", "SECTION"], &others)?;
    types(out, remarks::types(protocol))?;
    let allowed: Vec<_> = protocol.allowances.iter().map(allowance).collect();
    table(out, &["ALLOWED WARNING", "AT"], &allowed)
}

/// Returns the rows of the fields of the identifier, and of the bits that nothing names.
fn identifier(protocol: &Protocol) -> Vec<Row> {
    let fields = protocol.identifier.fields.iter().map(|known| (known.shift, field(protocol, known)));
    let nameless = heading::nameless(&protocol.identifier).into_iter().map(|(low, high, value)| {
        let cells = vec![heading::span(low, high), String::new(), String::new()];
        (low, Row { cells, last: vec![format!("always {value}")], ..Row::default() })
    });
    let mut all: Vec<_> = fields.chain(nameless).collect();
    all.sort_by_key(|(low, _)| Reverse(*low));
    all.into_iter().map(|(_, row)| row).collect()
}

fn allowance(known: &Allowance) -> Row {
    let cells = vec![known.rule.for_people().to_owned(), known.at.for_people().to_owned()];
    Row { cells, last: vec![known.because.for_people().to_owned()], ..Row::default() }
}

/// Writes a table of accesses.
pub fn accesses(out: &mut impl Write, protocol: &Protocol, accesses: &[&Access]) -> io::Result<()> {
    let rows: Vec<_> = accesses.iter().map(|known| access(protocol, known)).collect();
    table(out, &["ACCESS", "SECTION"], &rows)
}

/// Writes a table of types with their remarks.
pub fn types(out: &mut impl Write, types: Vec<Type>) -> io::Result<()> {
    let named = |Type { name, doc, keys }: Type| {
        let keys = keys.iter().map(|(key, text)| format!("{key} {}", text.for_people())).collect();
        row(vec![name, text(doc.section.as_ref())], doc, keys)
    };
    table(out, &["TYPE", "SECTION"], &types.into_iter().map(named).collect::<Vec<_>>())
}

fn field(protocol: &Protocol, field: &IdentifierField) -> Row {
    let cells = vec![heading::bits(field), field.name.clone(), text(field.doc.section.as_ref())];
    let special = [field.constant, field.send, field.normal, field.starting, field.continues];
    row(cells, &field.doc, facts(protocol, special.map(|value| value.map(u64::from)), field.enumeration))
}

fn selector(protocol: &Protocol, selector: &Selector) -> Option<Row> {
    let SelectorPlace::Payload(place) = selector.place else { return None };
    let cells = vec![WrittenPlace::of(place).to_string(), selector.name.clone(), text(selector.doc.section.as_ref())];
    let special = [None, None, selector.normal, selector.starting, selector.continues];
    Some(row(cells, &selector.doc, facts(protocol, special, selector.enumeration)))
}

/// Says which values of a field mean what.
fn facts(protocol: &Protocol, special: [Option<u64>; 5], names: Option<EnumerationId>) -> Vec<String> {
    let words = ["always", "sent as", "normally", "while a device starts", "if more frames follow"];
    let special = words.into_iter().zip(special).filter_map(|(word, value)| Some(format!("{word} {:#X}", value?)));
    let values = names.iter().flat_map(|names| &protocol[*names].values);
    special.chain(values.map(|value| format!("{:#X} = {}", value.raw, value.text(&protocol.models)))).collect()
}

fn address(known: &AddressType) -> Row {
    let AddressType { name, doc, first, last, names, offset, sign, strict, send, .. } = known;
    let mut facts = if names.is_empty() { vec![numbers(*first, *last)] } else { Vec::new() };
    facts.extend(names.iter().map(|(number, name)| format!("{number} = {name}")));
    facts.extend((*sign != 1).then(|| format!("scale {sign}")));
    facts.extend((*offset != 0).then(|| format!("offset {offset}")));
    facts.extend(send.map(|send| format!("sent as {send}")));
    facts.extend(strict.then(|| "no other number is such an address".to_owned()));
    row(vec![name.clone(), text(doc.section.as_ref())], doc, facts)
}

/// Writes a range of numbers. Documents print addresses in both bases.
fn numbers(first: i64, last: i64) -> String {
    let is_plain = first < 0 || last < 10;
    let digits = if is_plain { String::new() } else { format!(" ({first:#04X}..{last:#04X})") };
    format!("{first}..{last}{digits}")
}

fn mode(protocol: &Protocol, mode: &Mode) -> Row {
    let patterns =
        [("request", &mode.request), ("one", &mode.one), ("each", &mode.each), ("coordinator", &mode.coordinator)];
    let mut item = row(vec![mode.name.clone(), text(mode.doc.section.as_ref())], &mode.doc, Vec::new());
    let shown = patterns.into_iter().filter_map(|(word, pattern)| Some((word, pattern.as_ref()?)));
    item.below.extend(shown.map(|(word, pattern)| format!("{word}: {}", shown_by(protocol, pattern))));
    item
}

/// Says what an identifier shows in an addressing mode.
fn shown_by(protocol: &Protocol, pattern: &AddressPattern) -> String {
    let fields = protocol.identifier.fields.iter().filter(|field| pattern.mask & field.mask() == field.mask());
    let constants = fields.map(|field| format!("{} = {:#X}", field.name, field.get(pattern.value)));
    let addresses = pattern.addresses.iter();
    let addresses =
        addresses.map(|known| format!("{} = {}", protocol[known.field].name, protocol[known.address_type].name));
    constants.chain(addresses).collect::<Vec<_>>().join(", ")
}

fn access(protocol: &Protocol, access: &Access) -> Row {
    let Access { name, doc, kinds, carries, answers, every, from, .. } = access;
    let names = |kinds: &[Kind]| kinds.iter().map(|kind| kind.name()).collect::<Vec<_>>().join(", ");
    let mut item = row(vec![name.clone(), text(doc.section.as_ref())], doc, Vec::new());
    item.below.push(format!("frames: {}; with fields: {}", names(kinds), names(carries)));
    let answers = answers.entries().filter_map(|(mode, who)| Some((mode, (*who)?)));
    let answers: Vec<_> = answers.map(|(mode, who)| format!("{}: {}", protocol[mode].name, words::who(who))).collect();
    item.below.push(format!("answers: {}", answers.join(", ")));
    item.below.extend((*from == Side::Controller).then(|| "the controller sends the reports".to_owned()));
    item.below.extend(every.map(|timing| format!("every `{}`", protocol[timing].name)));
    item
}

fn transport(protocol: &Protocol, known: &Transport) -> Row {
    let frames: Vec<_> = known.frames.iter().map(|message| protocol[*message].name.as_str()).collect();
    let facts = vec![words::standard(&known.standard).to_owned(), format!("frames {}", frames.join(", "))];
    row(vec![known.name.clone(), text(known.doc.section.as_ref())], &known.doc, facts)
}

fn foreign(protocol: &Protocol, known: &Foreign) -> Row {
    let range = |(field, first, last): &(Option<FieldId>, u32, u32)| {
        let field = field.map_or("identifier", |field| protocol[field].name.as_str());
        if first == last { format!("{field} = {first:#X}") } else { format!("{field} = {first:#X}..{last:#X}") }
    };
    let facts = known.ranges.iter().map(range).collect();
    row(vec![known.name.clone(), text(known.doc.section.as_ref())], &known.doc, facts)
}
