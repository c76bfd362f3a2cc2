//! What surrounds the messages: documents, transports, quantities, device models, times, procedures, errata and
//! accepted warnings.

use canspec_codegen::model::{self, FieldId, Protocol, SignalPath, Standard};
use canspec_codegen::text::Text;
use serde::Serialize;

use super::remarks::Remarks;
use super::signal::limits;
use crate::command::list::words;

#[derive(Serialize)]
pub struct Document<'a> {
    name: Option<&'a str>,
    title: &'a Text,
    version: &'a Text,
    date: Option<&'a Text>,
    file: Option<&'a Text>,
}

impl<'a> From<&'a model::Document> for Document<'a> {
    fn from(known: &'a model::Document) -> Self {
        let model::Document { name, title, version, date, file, .. } = known;
        Self { name: name.as_deref(), title, version, date: date.as_ref(), file: file.as_ref() }
    }
}

/// What a spec takes from another one.
#[derive(Serialize)]
pub struct Base<'a> {
    name: &'a Text,
    replaces: &'a [Text],
    removes: &'a [Text],
}

impl<'a> From<&'a model::Derivation> for Base<'a> {
    fn from(known: &'a model::Derivation) -> Self {
        Self { name: &known.base, replaces: &known.replaces, removes: &known.removes }
    }
}

#[derive(Serialize)]
pub struct Sides<'a> {
    module: &'a str,
    controller: &'a str,
}

impl<'a> From<&'a model::Sides> for Sides<'a> {
    fn from(known: &'a model::Sides) -> Self {
        Self { module: &known.module, controller: &known.controller }
    }
}

#[derive(Serialize)]
pub struct Transport<'a> {
    name: &'a str,
    #[serde(flatten)]
    remarks: Remarks<'a>,
    standard: &'static str,
    fill: Option<u8>,
    group: Vec<&'a str>,
    target: Option<&'a str>,
    source: Option<&'a str>,
    frames: Vec<&'a str>,
}

impl<'a> Transport<'a> {
    pub fn of(protocol: &'a Protocol, known: &'a model::Transport) -> Self {
        let field = |field: FieldId| protocol[field].name.as_str();
        let groups = match &known.standard {
            Standard::J1939(groups) => Some(groups),
            // The enum may grow.
            Standard::Isotp(_) | _ => None,
        };
        let fill = match known.standard {
            Standard::Isotp(isotp) => isotp.fill,
            Standard::J1939(_) | _ => None,
        };
        Self {
            name: &known.name,
            remarks: (&known.doc).into(),
            standard: words::standard(&known.standard),
            fill,
            group: groups.iter().flat_map(|groups| &groups.group).map(|known| field(*known)).collect(),
            target: groups.map(|groups| field(groups.target)),
            source: groups.map(|groups| field(groups.source)),
            frames: known.frames.iter().map(|message| protocol[*message].name.as_str()).collect(),
        }
    }
}

/// A quantity, and the signals in which it is read and set.
#[derive(Serialize)]
pub struct Quantity<'a> {
    name: &'a str,
    unit: Option<String>,
    read: Option<Lead<'a>>,
    set: Option<Lead<'a>>,
    also: Vec<String>,
    minimum: Option<String>,
    maximum: Option<String>,
}

/// The way to a signal.
#[derive(Serialize)]
struct Lead<'a> {
    path: String,
    inactive: Option<u64>,
    active: Option<u64>,
    with: Vec<Fixed<'a>>,
}

#[derive(Serialize)]
struct Fixed<'a> {
    signal: &'a str,
    raw: i128,
}

impl<'a> Quantity<'a> {
    pub fn of(protocol: &'a Protocol, known: &'a model::QuantityPaths) -> Self {
        let lead = |path: Option<&'a SignalPath>| path.map(|path| Lead::of(protocol, path));
        let unit = protocol.unit_of(known).map(|unit| unit.symbol.to_string());
        let also = known.also.iter().map(|also| format!("{}.{}", protocol[also.message].name, also.field)).collect();
        let [minimum, maximum] = limits(protocol.limit_of(known).map(|limit| limit.range));
        let [read, set] = [&known.read, &known.set].map(|path| lead(path.as_ref()));
        Self { name: &known.name, unit, read, set, also, minimum, maximum }
    }
}

impl<'a> Lead<'a> {
    fn of(protocol: &'a Protocol, path: &'a SignalPath) -> Self {
        let message = &protocol[path.message];
        let fixed = path.with.iter().map(|fixed| {
            let signal = &message[fixed.signal];
            Fixed { signal: &signal.name, raw: signal.raw_of(fixed.bits) }
        });
        let [inactive, active] = path.states.map_or([None, None], |states| states.map(Some));
        Self { path: protocol.path_text(path), inactive, active, with: fixed.collect() }
    }
}

/// A device model.
#[derive(Serialize)]
pub struct Model<'a> {
    name: &'a str,
    #[serde(flatten)]
    remarks: Remarks<'a>,
    items: &'a [Text],
    max_parallel: Option<u32>,
    bit_rates: &'a [u32],
    facts: Vec<Fact<'a>>,
    types: Vec<TypeOfModel<'a>>,
}

/// A rating that no message carries.
#[derive(Serialize)]
struct Fact<'a> {
    name: &'a Text,
    #[serde(flatten)]
    quantity: Amount,
}

/// A number with a unit.
#[derive(Serialize)]
struct Amount {
    value: String,
    unit: Option<String>,
}

impl From<model::Quantity> for Amount {
    fn from(known: model::Quantity) -> Self {
        Self { value: known.value.to_string(), unit: known.unit.map(|unit| unit.symbol.to_string()) }
    }
}

/// What a device model changes of a type.
#[derive(Serialize)]
struct TypeOfModel<'a> {
    name: &'a str,
    #[serde(flatten)]
    remarks: Remarks<'a>,
    minimum: Option<String>,
    maximum: Option<String>,
    default: Option<String>,
    scale: Option<String>,
    offset: Option<String>,
    unit: Option<String>,
}

impl<'a> From<&'a model::DeviceModel> for Model<'a> {
    fn from(known: &'a model::DeviceModel) -> Self {
        Self {
            name: &known.name,
            remarks: (&known.doc).into(),
            items: &known.items,
            max_parallel: known.max_parallel,
            bit_rates: &known.bit_rates,
            facts: known.facts.iter().map(|(name, fact)| Fact { name, quantity: (*fact).into() }).collect(),
            types: known.types.iter().map(TypeOfModel::from).collect(),
        }
    }
}

impl<'a> From<&'a model::TypeOfModel> for TypeOfModel<'a> {
    fn from(known: &'a model::TypeOfModel) -> Self {
        let [minimum, maximum] = limits(known.range);
        let [default, scale, offset] =
            [known.default, known.scale, known.offset].map(|number| number.map(|number| number.to_string()));
        let unit = known.unit.map(|unit| unit.symbol.to_string());
        Self { name: &known.name, remarks: (&known.doc).into(), minimum, maximum, default, scale, offset, unit }
    }
}

/// A time that the document states.
#[derive(Serialize)]
pub struct Timing<'a> {
    name: &'a str,
    #[serde(flatten)]
    remarks: Remarks<'a>,
    shortest: String,
    longest: String,
    unit: String,
    minimum: Option<Amount>,
    role: Option<&'static str>,
    tries: Option<u8>,
    messages: Vec<&'a str>,
}

impl<'a> Timing<'a> {
    pub fn of(protocol: &'a Protocol, known: &'a model::Timing) -> Self {
        Self {
            name: &known.name,
            remarks: (&known.doc).into(),
            shortest: known.range.minimum.to_string(),
            longest: known.range.maximum.to_string(),
            unit: known.unit.symbol.to_string(),
            minimum: known.minimum.map(Amount::from),
            role: known.role.map(model::TimeRole::name),
            tries: known.tries,
            messages: known.messages.iter().map(|message| protocol[*message].name.as_str()).collect(),
        }
    }
}

/// What a device does after the controller was silent.
#[derive(Serialize)]
pub struct Silence<'a> {
    output: &'static str,
    #[serde(flatten)]
    remarks: Remarks<'a>,
}

impl<'a> From<&'a model::Silence> for Silence<'a> {
    fn from(known: &'a model::Silence) -> Self {
        Self { output: known.output.name(), remarks: (&known.doc).into() }
    }
}

#[derive(Serialize)]
pub struct Procedure<'a> {
    name: &'a str,
    #[serde(flatten)]
    remarks: Remarks<'a>,
    steps: &'a [Text],
}

impl<'a> From<&'a model::Procedure> for Procedure<'a> {
    fn from(known: &'a model::Procedure) -> Self {
        Self { name: &known.name, remarks: (&known.doc).into(), steps: &known.steps }
    }
}

#[derive(Serialize)]
pub struct Erratum<'a> {
    name: &'a Text,
    kind: &'a str,
    section: Option<&'a Text>,
    prints: &'a Text,
    uses: &'a Text,
    because: &'a Text,
}

impl<'a> From<&'a model::Erratum> for Erratum<'a> {
    fn from(known: &'a model::Erratum) -> Self {
        let model::Erratum { name, kind, section, prints, uses, because, .. } = known;
        Self { name, kind, section: section.as_ref(), prints, uses, because }
    }
}

/// A warning that the spec accepts.
#[derive(Serialize)]
pub struct Allowance<'a> {
    rule: &'a Text,
    at: &'a Text,
    because: &'a Text,
}

impl<'a> From<&'a model::Allowance> for Allowance<'a> {
    fn from(known: &'a model::Allowance) -> Self {
        let model::Allowance { rule, at, because, .. } = known;
        Self { rule, at, because }
    }
}
