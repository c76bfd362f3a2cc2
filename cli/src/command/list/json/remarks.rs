//! What a spec says beside an item.

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

impl<'a> From<&'a Doc> for Named<'a> {
    fn from(doc: &'a Doc) -> Self {
        Self { name: remarks::name_of(doc), remarks: doc.into() }
    }
}

impl<'a> Named<'a> {
    /// Returns the types that have remarks: those of the spec, named values, status words, and words.
    pub fn types(protocol: &'a Protocol) -> Vec<Self> {
        remarks::types(protocol).into_iter().map(|(name, doc)| Self { name, remarks: doc.into() }).collect()
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
