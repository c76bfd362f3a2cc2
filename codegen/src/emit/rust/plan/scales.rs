//! Scales that depend on the device model.

use proc_macro2::{Ident, TokenStream};

use super::encoding::fraction;
use super::limits::Limits;
use super::literal::Precision;
use super::models::Models;
use super::naming::Pool;
use crate::emit::Scaled;
use crate::model::{Message, OfModel, Protocol, Signal};
use crate::words::number::Rational;

/// The methods that read and set a number whose scale depends on the device model.
pub struct Scales {
    /// The method that returns the signal of a device model.
    pub on: Ident,
    /// The method that reads the value.
    pub get: Ident,
    /// The method that sets it.
    pub set: Ident,
    /// Name of the message in the spec.
    pub message: String,
    /// Type of the value.
    pub kind: TokenStream,
    /// The signals of the models.
    pub rows: Vec<Row>,
    /// Whether other models have no scale.
    pub has_others: bool,
}

/// What is particular to a device model.
pub struct Row {
    /// Variant of the model.
    pub model: Ident,
    /// Unit of the value.
    pub unit: Option<String>,
    /// Numerator and denominator of the step, unless it is 1.
    pub scale: Option<[TokenStream; 2]>,
    /// Numerator and denominator of the value of raw 0, unless it is 0.
    pub offset: Option<[TokenStream; 2]>,
    /// Lowest and highest value.
    pub limits: Option<[TokenStream; 2]>,
}

impl Scales {
    /// Plans the methods of a signal. Whole steps need none, since they are raw values.
    pub fn new(
        protocol: &Protocol,
        (models, scaled): (&Models, Scaled),
        message: &Message,
        signal: &Signal,
        members: &mut Pool,
    ) -> Option<Self> {
        let own = signal.encoding.by_model();
        let precision = Precision::of(scaled).filter(|_| !own.is_empty())?;
        let mut name = |name: String| members.take(name, "_value");
        Some(Self {
            on: name(format!("{}_on", signal.name)),
            get: name(signal.name.clone()),
            set: name(format!("set_{}", signal.name)),
            message: message.name.clone(),
            kind: precision.kind(),
            rows: own.iter().map(|own| Row::new(models, precision, own)).collect(),
            has_others: own.len() < protocol.models.len(),
        })
    }
}

impl Row {
    fn new(models: &Models, precision: Precision, own: &OfModel<Signal>) -> Self {
        let signal = &own.value;
        let linear = signal.encoding.linear();
        let scale = linear.map(|linear| linear.scale).filter(|scale| *scale != Rational::ONE);
        let offset = linear.map(|linear| linear.offset).filter(|offset| *offset != Rational::ZERO);
        Self {
            model: models.variant(own.model).clone(),
            unit: signal.unit.map(|unit| unit.symbol.to_string()),
            scale: scale.map(fraction),
            offset: offset.map(fraction),
            limits: signal.range.map(|range| Limits::Physical(precision).ends(signal, range)),
        }
    }
}
