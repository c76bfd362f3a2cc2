//! What a spec says beside an item.

use std::collections::BTreeMap;

use canspec_codegen::model::{Doc, ModelId, NamedValue, Protocol};
use canspec_codegen::text::Text;
use serde::Serialize;

use crate::command::list::remarks;

/// Title, note, section and errata of an item.
#[derive(Serialize)]
pub struct Remarks<'a> {
    title: Option<&'a Text>,
    note: Option<&'a Text>,
    section: Option<&'a Text>,
    errata: &'a [Text],
}

impl<'a> From<&'a Doc> for Remarks<'a> {
    fn from(doc: &'a Doc) -> Self {
        let Doc { title, note, section, errata, .. } = doc;
        Self { title: title.as_ref(), note: note.as_ref(), section: section.as_ref(), errata }
    }
}

/// An item that shows only its remarks.
#[derive(Serialize)]
pub struct Named<'a> {
    /// The last key of its place in the spec.
    name: &'a str,
    #[serde(flatten)]
    remarks: Remarks<'a>,
}

/// A type, named values, a status word, or a word.
#[derive(Serialize)]
pub struct Type<'a> {
    name: String,
    #[serde(flatten)]
    remarks: Remarks<'a>,
    /// What a type says of bits, as the spec writes it.
    keys: BTreeMap<&'a str, &'a Text>,
}

impl<'a> From<&'a Doc> for Named<'a> {
    fn from(doc: &'a Doc) -> Self {
        Self { name: remarks::name_of(doc), remarks: doc.into() }
    }
}

impl<'a> Type<'a> {
    /// Returns the types that say something: those of the spec, named values, status words, and words.
    pub fn all(protocol: &'a Protocol) -> Vec<Self> {
        let of = |remarks::Type { name, doc, keys }: remarks::Type<'a>| {
            let keys = keys.iter().map(|(key, text)| (key.as_str(), text)).collect();
            Self { name, remarks: doc.into(), keys }
        };
        remarks::types(protocol).into_iter().map(of).collect()
    }
}

/// A named raw value.
#[derive(Serialize)]
pub struct Value<'a> {
    raw: i128,
    name: &'a str,
    title: Option<&'a Text>,
    models: Vec<&'a str>,
}

impl<'a> Value<'a> {
    /// Returns named values.
    pub fn all(protocol: &'a Protocol, values: &'a [NamedValue]) -> Vec<Self> {
        let of = |value: &'a NamedValue| {
            let NamedValue { raw, name, title, models, .. } = value;
            Self { raw: *raw, name, title: title.as_ref(), models: names(protocol, models) }
        };
        values.iter().map(of).collect()
    }
}

/// Returns the names of device models.
pub fn names<'a>(protocol: &'a Protocol, models: &[ModelId]) -> Vec<&'a str> {
    models.iter().map(|model| protocol[*model].name.as_str()).collect()
}
