//! Device models, and the limits that depend on them.

use proc_macro2::{Ident, TokenStream};

use super::about;
use super::doc::{self, Comment};
use super::limits;
use super::naming::{Pool, model_variant};
use crate::emit::Scaled;
use crate::model::{FrameLayout, ModelId, Protocol, Range, Signal, SignalId, Table};
use crate::report::tree::Step;

/// Device models.
pub struct Models {
    /// The models.
    pub rows: Table<ModelId, Model>,
    /// Whether the values of some request depend on the model.
    pub has_within: bool,
    /// Limits by device model, which signals share.
    pub limits: Vec<Limits>,
    sources: Vec<Source>,
    scaled: Scaled,
}

/// The source of limits: the ranges as they are compared, and the type of their ends.
#[derive(PartialEq)]
struct Source {
    ranges: Table<ModelId, Option<Range>>,
    kind: String,
}

impl Source {
    fn new(protocol: &Protocol, signal: &Signal, form: limits::Limits) -> Self {
        let range = |model| Some(form.range(signal, signal.limits_for(Some(model))?));
        Self { ranges: protocol.models.ids().map(range).collect(), kind: form.kind(signal).to_string() }
    }
}

/// A device model.
pub struct Model {
    /// Its variant.
    pub variant: Ident,
    /// Comment of the variant.
    pub comment: Comment,
    /// The vendor's name.
    pub name: String,
    /// Speeds of the bus in bit/s.
    pub bit_rates: Vec<TokenStream>,
}

/// Limits by device model.
pub struct Limits {
    /// Their constant.
    pub constant: Ident,
    /// Comment of the constant.
    pub comment: Comment,
    /// Type of a limit.
    pub kind: TokenStream,
    /// Variants of the models, and their lowest and highest value.
    pub rows: Vec<(Ident, Option<[TokenStream; 2]>)>,
}

impl Models {
    /// Plans the device models.
    pub fn new(protocol: &Protocol, scaled: Scaled, constants: &mut Pool) -> Self {
        let mut variants = Pool::default();
        let rows = protocol.models.map(|model| {
            let title = model.doc.title.as_ref().map_or_else(String::new, |title| format!(": {}", title.in_rust_doc()));
            let sentence = doc::sentence_of(&format!("`{}`{title}", model.name));
            Model {
                variant: variants.take(model_variant(&model.name), "_"),
                comment: Comment::item(protocol, &model.doc, &sentence, None),
                name: model.name.clone(),
                bit_rates: about::rates(&model.bit_rates),
            }
        });
        let has_within = protocol.frames.iter().any(|frame| depends_on_model(protocol, frame));
        let mut models = Self { rows, has_within, limits: Vec::new(), sources: Vec::new(), scaled };
        for signal in protocol.contents().flat_map(|message| &message.signals) {
            models.add_limits(protocol, signal, constants);
        }
        models
    }

    /// Adds the limits of a signal, unless another has the same.
    fn add_limits(&mut self, protocol: &Protocol, signal: &Signal, constants: &mut Pool) {
        if signal.model_ranges.is_empty() || self.limits_of(protocol, signal).is_some() {
            return;
        }
        let form = limits::Limits::new(signal, self.scaled);
        let source = Source::new(protocol, signal, form);
        let limits = self.limits(signal, &source.ranges, form, constants);
        self.limits.push(limits);
        self.sources.push(source);
    }

    fn limits(
        &self,
        signal: &Signal,
        ranges: &Table<ModelId, Option<Range>>,
        form: limits::Limits,
        constants: &mut Pool,
    ) -> Limits {
        let of = type_name(signal).unwrap_or(&signal.name);
        let ends = |range: Range| form.ends(signal, range);
        let rows = ranges.iter().zip(&self.rows).map(|(range, model)| (model.variant.clone(), range.map(ends)));
        Limits {
            constant: constants.constant(&format!("{of}_LIMITS")),
            comment: Comment::line(format!("Limits of `{of}` by device model.")),
            kind: form.kind(signal),
            rows: rows.collect(),
        }
    }

    /// Returns the constant of the limits that a signal has by device model.
    pub fn limits_of(&self, protocol: &Protocol, signal: &Signal) -> Option<&Ident> {
        if signal.model_ranges.is_empty() {
            return None;
        }
        let source = Source::new(protocol, signal, limits::Limits::new(signal, self.scaled));
        let known = self.sources.iter().position(|known| *known == source)?;
        Some(&self.limits.get(known)?.constant)
    }

    /// Returns the variant of a model.
    pub fn variant(&self, model: ModelId) -> &Ident {
        &self.rows[model].variant
    }
}

/// Returns the type that a model changes: the last step but one of `models.MODEL.types.TYPE.range`.
fn type_name(signal: &Signal) -> Option<&str> {
    let (changed, _) = signal.model_ranges.first()?.path.split()?;
    match changed.split()? {
        (_, Step::Key(name)) => Some(name),
        _ => None,
    }
}

/// Tests whether a frame is a request with values that depend on the device model. A part of a long message is none.
pub fn depends_on_model(protocol: &Protocol, frame: &FrameLayout) -> bool {
    let message = &protocol[frame.message];
    let lacks =
        |signal: &Signal| protocol.models_of(message).any(|model| protocol.lacking(message, signal, model).is_some());
    let depends_itself = |(_, signal): (SignalId, &Signal)| !signal.model_ranges.is_empty() || lacks(signal);
    let depends = !message.models.is_empty() || protocol.signals_of(frame).any(depends_itself);
    let is_whole = !frame.signals.is_empty() && protocol.part_of(frame).is_none();
    frame.is_to_module() && frame.set.is_none() && depends && is_whole
}
