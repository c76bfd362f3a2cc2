//! Addresses, addressing modes, and the targets of requests.

use indexmap::IndexSet;
use proc_macro2::{Ident, TokenStream};

use super::comparison::field_place;
use super::doc::{self, Comment};
use super::literal::{decimal, hexadecimal};
use super::naming::{Pool, camel_case, ident, screaming};
use crate::model::{self, AddressPattern, AddressTypeId, Doc, ModeId, Protocol, Table, Who};

/// A kind of address.
pub struct AddressType {
    /// Its constant.
    pub constant: Ident,
    /// Comment of the constant.
    pub comment: Comment,
    /// The name in the spec.
    pub name: String,
    /// First documented number.
    pub first: TokenStream,
    /// Last documented number.
    pub last: TokenStream,
    /// Number of raw 0, unless it is 0.
    pub offset: Option<TokenStream>,
    /// Whether numbers fall as raw values rise.
    pub descending: bool,
    /// Whether a number outside the range is no such address.
    pub strict: bool,
    /// The number that is sent unless the caller says otherwise.
    pub send: Option<TokenStream>,
    /// The only documented numbers, if they have names.
    pub named: Vec<NamedAddress>,
    /// Type of the numbers.
    pub number: Number,
}

/// An address with a name.
pub struct NamedAddress {
    /// Its constant.
    pub constant: Ident,
    /// Comment of the constant.
    pub comment: Comment,
    /// The number.
    pub number: TokenStream,
}

/// An addressing mode.
pub struct Mode {
    /// Its constant.
    pub constant: Ident,
    /// Comment of the constant.
    pub comment: Comment,
    /// The name in the spec.
    pub name: String,
    /// The constant of the kind of address that the caller chooses.
    pub target: Option<Ident>,
    /// What requests show, and replies of one, of each and of the coordinator.
    pub patterns: [Option<Pattern>; 4],
}

/// Constants and addresses that an identifier must show.
pub struct Pattern {
    /// Places of fields, and their values.
    pub constants: Vec<(Ident, TokenStream)>,
    /// Fields that hold addresses.
    pub addresses: Vec<Address>,
}

/// A field that holds an address.
pub struct Address {
    /// Place of the field.
    pub place: Ident,
    /// Constant of the kind of address.
    pub kind: Ident,
    /// First and last raw value of the ranges that are no such address.
    pub excluded: Vec<(TokenStream, TokenStream)>,
}

/// Whom requests address.
pub struct Targets {
    /// The variants, one for each mode that has requests.
    pub variants: Vec<Target>,
    /// The kinds of addresses that requests are sent from.
    pub sender: Option<Sender>,
}

/// A target.
pub struct Target {
    /// Its variant.
    pub variant: Ident,
    /// The name of the variant in texts, where that is not made of it.
    pub renamed: Option<String>,
    /// Comment of the variant.
    pub comment: Comment,
    /// The mode.
    pub mode: ModeId,
    /// Type of its number, if it has one.
    pub number: Option<Number>,
    /// Whether its number is that of a module, which answers alone.
    pub is_module: bool,
    /// What the identifier of a request shows.
    pub request: Vec<Shown>,
    /// Who answers, and what the identifiers of these replies show, as far as the request says it.
    pub replies: Vec<(Ident, Vec<Shown>)>,
}

/// A field of the identifier in a request or its replies.
pub struct Shown {
    /// Place of the field.
    pub place: Ident,
    /// What it shows.
    pub value: Value,
}

/// What a field of the identifier shows.
pub enum Value {
    /// A constant.
    Constant(TokenStream),
    /// The target's address. The identifier is the constant of its kind.
    Target(Ident),
    /// The sender's address. The identifier is the constant of its kind.
    Sender(Ident),
    /// The usual address of a kind. The identifier is the constant of the kind.
    Usual(Ident),
}

/// The kinds of addresses that requests are sent from.
pub struct Sender {
    /// The argument.
    pub argument: Ident,
    /// Type of their numbers.
    pub number: Number,
    /// Comment of the method.
    pub comment: Comment,
}

/// The type of an address number.
#[derive(Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub enum Number {
    /// Eight bits.
    U8,
    /// Sixteen bits.
    U16,
    /// Any number.
    I32,
}

impl Number {
    /// Returns the type that holds the numbers of a kind of address.
    pub fn of(address: &model::AddressType) -> Self {
        match (address.first, address.last) {
            (0.., ..=0xFF) => Self::U8,
            (0.., ..=0xFFFF) => Self::U16,
            _ => Self::I32,
        }
    }
}

/// The constants of the kinds of addresses.
pub type Addresses = Table<AddressTypeId, Ident>;

/// Names the constants of the kinds of addresses.
pub fn addresses(protocol: &Protocol, constants: &mut Pool) -> Addresses {
    protocol.address_types.map(|known| constants.constant(&format!("{}_ADDRESS", known.name)))
}

impl AddressType {
    /// Plans a kind of address.
    pub fn new(protocol: &Protocol, constant: &Ident, address: &model::AddressType, constants: &mut Pool) -> Self {
        let title = doc::title(&address.doc, &address.name);
        let sentence = doc::sentence_of(&format!("{title}: {}", range(address)));
        Self {
            constant: constant.clone(),
            comment: Comment::item(protocol, &address.doc, &sentence, None),
            name: address.name.clone(),
            first: number(address.first),
            last: number(address.last),
            offset: (address.offset != 0).then(|| number(address.offset)),
            descending: address.sign < 0,
            strict: address.strict,
            send: address.send.map(number),
            named: address.names.iter().map(|known| NamedAddress::new(address, known, constants)).collect(),
            number: Number::of(address),
        }
    }
}

impl NamedAddress {
    fn new(address: &model::AddressType, (known, name): &(i64, String), constants: &mut Pool) -> Self {
        Self {
            constant: constants.constant(&format!("{}_{name}", address.name)),
            comment: Comment::line(format!("The `{}` called `{name}`.", address.name)),
            number: number(*known),
        }
    }
}

/// Writes the documented numbers for people.
fn range(address: &model::AddressType) -> String {
    let shown = |(number, name): &(i64, String)| format!("`0x{number:02X}` (`{name}`)");
    match address.names.as_slice() {
        [] => format!("`0x{:02X}..=0x{:02X}`", address.first, address.last),
        names => names.iter().map(shown).collect::<Vec<_>>().join(", "),
    }
}

/// Writes an address number: hexadecimal as in documents, decimal if it is negative.
pub fn number(number: i64) -> TokenStream {
    u32::try_from(number).map_or_else(|_| decimal(number), |number| hexadecimal(number, 8))
}

impl Mode {
    /// Plans a mode.
    pub fn new(protocol: &Protocol, addresses: &Addresses, mode: &model::Mode, constants: &mut Pool) -> Self {
        let sentence = doc::sentence_of(&doc::title(&mode.doc, &mode.name));
        let patterns = [&mode.request, &mode.one, &mode.each, &mode.coordinator];
        Self {
            constant: constants.constant(&format!("{}_MODE", mode.name)),
            comment: Comment::item(protocol, &mode.doc, &sentence, None),
            name: mode.name.clone(),
            target: mode.target.map(|id| addresses[id].clone()),
            patterns: patterns.map(|known| Some(Pattern::new(protocol, addresses, known.as_ref()?))),
        }
    }
}

impl Pattern {
    /// Plans what an identifier must show.
    pub fn new(protocol: &Protocol, kinds: &Addresses, pattern: &AddressPattern) -> Self {
        let fields = protocol.identifier.fields.iter().filter(|field| pattern.mask & field.mask() != 0);
        let constants =
            fields.map(|field| (screaming(&field.name), hexadecimal(field.get(pattern.value), field.width)));
        let addresses = pattern.addresses.iter().map(|known| Address::new(protocol, kinds, known));
        Self { constants: constants.collect(), addresses: addresses.collect() }
    }
}

impl Address {
    fn new(protocol: &Protocol, kinds: &Addresses, address: &model::Address) -> Self {
        let (place, width) = field_place(protocol, address.field);
        let excluded = address.excluded.iter().filter(|_| !protocol[address.address_type].strict);
        let excluded = excluded.map(|(first, last)| (hexadecimal(*first, width), hexadecimal(*last, width)));
        Self { place, kind: kinds[address.address_type].clone(), excluded: excluded.collect() }
    }
}

impl Targets {
    /// Plans the targets; `None` if nobody sends requests.
    pub fn new(protocol: &Protocol, addresses: &Addresses) -> Option<Self> {
        let names = target_names(protocol);
        let modes = protocol.modes.entries().filter_map(|(id, mode)| Some((id, mode.request.as_ref()?)));
        let mut texts = Pool::default();
        let target = |(id, request)| Target::new(protocol, addresses, &names[id], &mut texts, id, request);
        let variants: Vec<_> = modes.map(target).collect();
        (!variants.is_empty()).then(|| Self { variants, sender: Sender::of(protocol) })
    }
}

/// Names the targets of all modes.
pub fn target_names(protocol: &Protocol) -> Table<ModeId, Ident> {
    let mut variants = Pool::default();
    protocol.modes.map(|mode| variants.take(camel_case(protocol.target_name(mode)), "Mode"))
}

impl Target {
    fn new(
        protocol: &Protocol,
        addresses: &Addresses,
        name: &Ident,
        texts: &mut Pool,
        id: ModeId,
        request: &AddressPattern,
    ) -> Self {
        let mode = &protocol[id];
        let shown = |pattern: &AddressPattern| Shown::all(protocol, addresses, mode, request, pattern);
        let replies = [("One", &mode.one), ("Each", &mode.each), ("Coordinator", &mode.coordinator)];
        let replies = replies.into_iter().filter_map(|(who, pattern)| Some((ident(who), shown(pattern.as_ref()?))));
        let address = mode.target.map(|address| &protocol[address]);
        let numbers = address.map_or_else(String::new, |address| format!(": {}", range(address)));
        let sentence = doc::sentence_of(&format!("{}{numbers}", doc::title(&mode.doc, &mode.name)));
        let errata_elsewhere = Doc { errata: Vec::new(), ..mode.doc.clone() };
        Self {
            variant: name.clone(),
            renamed: texts.renamed(name, protocol.target_name(mode), "_mode"),
            comment: Comment::item(protocol, &errata_elsewhere, &sentence, None),
            mode: id,
            number: address.map(Number::of),
            is_module: mode.target.is_some() && protocol.node(mode, Some(Who::One)) == mode.target,
            request: shown(request),
            replies: replies.collect(),
        }
    }
}

impl Shown {
    /// Plans what a pattern shows of a request to a target: its constants, and the addresses that are in the request.
    fn all(
        protocol: &Protocol,
        kinds: &Addresses,
        mode: &model::Mode,
        request: &AddressPattern,
        pattern: &AddressPattern,
    ) -> Vec<Self> {
        let controller = protocol.controller(mode);
        let value_of = |known: AddressTypeId| match kinds[known].clone() {
            kind if mode.target == Some(known) => Value::Target(kind),
            kind if controller == Some(known) => Value::Sender(kind),
            kind => Value::Usual(kind),
        };
        let Pattern { constants, .. } = Pattern::new(protocol, kinds, pattern);
        let constants = constants.into_iter().map(|(place, value)| Self { place, value: Value::Constant(value) });
        let is_known =
            |known: &&model::Address| request.addresses.iter().any(|own| own.address_type == known.address_type);
        let addresses = pattern
            .addresses
            .iter()
            .filter(is_known)
            .map(|known| Self { place: field_place(protocol, known.field).0, value: value_of(known.address_type) });
        constants.chain(addresses).collect()
    }
}

impl Sender {
    /// Plans the senders of all modes; `None` if no request shows its own.
    fn of(protocol: &Protocol) -> Option<Self> {
        let kinds: IndexSet<_> = protocol.modes.iter().filter_map(|mode| protocol.controller(mode)).collect();
        let kinds: Vec<_> = kinds.into_iter().map(|kind| &protocol[kind]).collect();
        let (name, numbers) = match kinds.as_slice() {
            [only] => {
                (only.name.to_ascii_lowercase(), format!("another `{}` than the usual one: {}", only.name, range(only)))
            }
            several => {
                let several: Vec<_> = several.iter().map(|kind| format!("`{}`: {}", kind.name, range(kind))).collect();
                ("sender".to_owned(), format!("another sender than the usual one. {}", several.join("; ")))
            }
        };
        Some(Self {
            argument: ident(&name),
            number: kinds.into_iter().map(Number::of).max()?,
            comment: Comment::line(format!("Returns the route from {numbers}.")),
        })
    }
}
