//! Selectors, and the filters that are made of their constants.

use proc_macro2::{Ident, TokenStream};

use super::doc::{self, Comment};
use super::literal::hexadecimal;
use super::naming::{Pool, screaming};
use super::place::Written;
use crate::model::{Constant, FieldId, Protocol, SelectorId, SelectorPlace, Table};

/// What is read to tell frames apart.
#[derive(Clone)]
pub enum Source {
    /// A field of the identifier, by the constant of its place.
    Identifier(Ident),
    /// Bits of the data, by the constant of the selector.
    Data(Ident),
}

/// A selector that tells frames apart.
pub struct Selector {
    /// What is read.
    pub source: Source,
    /// Its rank among others. Fields of the identifier come first.
    pub rank: (Option<SelectorId>, Option<FieldId>),
    width: u8,
}

impl Selector {
    /// Writes a value of the selector.
    pub fn value(&self, value: u64) -> TokenStream {
        hexadecimal(value, self.width)
    }

    fn new(protocol: &Protocol, id: SelectorId, constants: &mut Pool) -> Self {
        match protocol[id].place {
            SelectorPlace::Identifier(field) => {
                let (rank, known) = ((None, Some(field)), &protocol[field]);
                Self { source: Source::Identifier(screaming(&known.name)), rank, width: known.width }
            }
            SelectorPlace::Payload(place) => {
                let rank = (Some(id), None);
                Self { source: Source::Data(constant(protocol, id, constants)), rank, width: place.width() }
            }
        }
    }
}

/// Every selector.
pub type Selectors = Table<SelectorId, Selector>;

/// Returns every selector.
pub fn selectors(protocol: &Protocol, constants: &mut Pool) -> Selectors {
    protocol.selectors.ids().map(|id| Selector::new(protocol, id, constants)).collect()
}

/// Names a payload selector's constant. Numbers tell two places under one name apart.
fn constant(protocol: &Protocol, id: SelectorId, constants: &mut Pool) -> Ident {
    let name = &protocol[id].name;
    let earlier = protocol.selectors.entries().take_while(|(other, _)| *other < id);
    let earlier = earlier.filter(|(_, known)| known.name == *name).count();
    let suffix = if earlier == 0 { String::new() } else { format!("_{}", earlier + 1) };
    constants.constant(&format!("{name}_SELECTOR{suffix}"))
}

/// The constant of a selector in the data.
pub struct InData {
    /// Its name.
    pub constant: Ident,
    /// Its comment.
    pub comment: Comment,
    /// The name in the spec.
    pub name: String,
    /// Where it stands.
    pub place: Written,
    /// The value of a reply that reports no error.
    pub normal: Option<TokenStream>,
}

/// Returns the selectors in the data that some frame or some long message has.
pub fn in_data(protocol: &Protocol, selectors: &Selectors) -> Vec<InData> {
    let layouts = || protocol.frames.iter().chain(protocol.long_messages.iter().flat_map(|long| &long.frames));
    let is_used = |id: &SelectorId| layouts().any(|frame| frame.selectors.contains(id));
    let used = protocol.selectors.ids().filter(is_used);
    used.filter_map(|id| InData::new(protocol, &selectors[id], id)).collect()
}

impl InData {
    fn new(protocol: &Protocol, selector: &Selector, id: SelectorId) -> Option<Self> {
        let known = &protocol[id];
        let (SelectorPlace::Payload(place), Source::Data(constant)) = (known.place, &selector.source) else {
            return None;
        };
        let place = Written::new(place);
        let sentence = doc::sentence_of(&format!("{}: {}", doc::title(&known.doc, &known.name), place.text()));
        Some(Self {
            constant: constant.clone(),
            comment: Comment::item(protocol, &known.doc, &sentence, None),
            name: known.name.clone(),
            place,
            normal: known.normal.map(|normal| selector.value(normal)),
        })
    }
}

/// What some frames show beside what all frames show.
pub struct Filter {
    /// The constants of the selectors that they have in the data.
    pub selectors: Vec<Ident>,
    /// What they show.
    pub required: Vec<Required>,
}

impl Filter {
    /// Makes a filter of payload selectors and constants.
    pub fn new(known: &Selectors, selectors: &[SelectorId], constants: &[Constant]) -> Self {
        let in_data = selectors.iter().filter_map(|id| match &known[*id].source {
            Source::Data(constant) => Some(constant.clone()),
            Source::Identifier(_) => None,
        });
        Self { selectors: in_data.collect(), required: required(known, constants) }
    }
}

/// A value that frames show in a selector.
pub struct Required {
    /// What is read.
    pub source: Source,
    /// The value.
    pub value: TokenStream,
    /// The bits that do not count, if there are any.
    pub open: Option<TokenStream>,
}

/// Returns what constants require.
pub fn required(known: &Selectors, constants: &[Constant]) -> Vec<Required> {
    let required = constants.iter().map(|constant| {
        let selector = &known[constant.selector];
        let open = (constant.open != 0).then(|| selector.value(constant.open));
        Required { source: selector.source.clone(), value: selector.value(constant.value), open }
    });
    required.collect()
}
