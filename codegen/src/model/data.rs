//! What a spec says beside the codec.

use serde::{Deserialize, Serialize};

use crate::model::{Quantity, Range, Side, Unit};
use crate::report::tree::Path;
use crate::words::number::Rational;
use crate::words::text::Text;

/// What the two sides are called in texts.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[non_exhaustive]
pub struct Sides {
    /// A module.
    pub module: String,
    /// The controller.
    pub controller: String,
}

impl Default for Sides {
    fn default() -> Self {
        Self { module: "module".to_owned(), controller: "controller".to_owned() }
    }
}

impl Sides {
    /// Tests whether the spec names one of them.
    pub fn are_named(&self) -> bool {
        *self != Self::default()
    }

    /// Returns what a side is called.
    pub fn name(&self, side: Side) -> &str {
        match side {
            Side::Module => &self.module,
            Side::Controller => &self.controller,
        }
    }

    /// Names both ends of a frame.
    pub fn either(&self) -> String {
        let Self { module, controller } = self;
        let article = if self.are_named() { "the" } else { "a" };
        format!("{article} {module} or to the {controller}")
    }

    /// Says which is which, if the spec names them.
    pub fn sentence(&self) -> Option<String> {
        let Self { module, controller } = self;
        self.are_named().then(|| format!("The modules are called `{module}`, and the controller `{controller}`."))
    }
}

/// A document that the spec follows.
#[derive(Clone, Debug, Serialize, Deserialize)]
#[non_exhaustive]
pub struct Document {
    /// Name that begins its sections; none if a section without such a name stands in it.
    pub name: Option<String>,
    /// Title as printed.
    pub title: Text,
    /// Version as printed.
    pub version: Text,
    /// Date of that version, if the spec states it.
    pub date: Option<Text>,
    /// Name of the file that was read, if the spec states it.
    pub file: Option<Text>,
}

/// What a spec says about an item beside its meaning for the codec.
#[derive(Clone, Debug, Default, Serialize, Deserialize)]
#[non_exhaustive]
pub struct Doc {
    /// What the item is, in a few words without a full stop.
    pub title: Option<Text>,
    /// What else a reader must know.
    pub note: Option<Text>,
    /// The item's own section, or that of the item around it.
    pub section: Option<Text>,
    /// Errata by name.
    pub errata: Vec<Text>,
    /// Place in the spec.
    pub path: Path,
}

/// A device model.
#[derive(Clone, Debug, Serialize, Deserialize)]
#[non_exhaustive]
pub struct DeviceModel {
    /// Name in the spec, as the vendor spells it.
    pub name: String,
    /// What the spec says beside it.
    pub doc: Doc,
    /// Item numbers.
    pub items: Vec<Text>,
    /// Largest number of devices that can work together, if the document says it.
    pub max_parallel: Option<u32>,
    /// Bit rates of this model in bit/s; empty if the document does not say them.
    pub bit_rates: Vec<u32>,
    /// Ratings that no message carries, by name.
    pub facts: Vec<(Text, Quantity)>,
    /// What this model changes of a type, by the type's name.
    pub types: Vec<TypeOfModel>,
}

/// What a device model changes of a type.
#[derive(Clone, Debug, Serialize, Deserialize)]
#[non_exhaustive]
pub struct TypeOfModel {
    /// Name of the type.
    pub name: String,
    /// Physical limits of this model, if it has its own.
    pub range: Option<Range>,
    /// Physical value that the device starts with.
    pub default: Option<Rational>,
    /// Physical value of one step, if the model has its own.
    pub scale: Option<Rational>,
    /// Physical value of raw 0, if the model has its own.
    pub offset: Option<Rational>,
    /// Unit of the physical value, if the model has its own.
    pub unit: Option<Unit>,
    /// What the spec says beside it.
    pub doc: Doc,
}

/// Steps in order.
#[derive(Clone, Debug, Serialize, Deserialize)]
#[non_exhaustive]
pub struct Procedure {
    /// Name in the spec, in `snake_case`.
    pub name: String,
    /// What the spec says beside it.
    pub doc: Doc,
    /// One sentence each; names of messages stand in backquotes.
    pub steps: Vec<Text>,
}

/// A departure from the document.
#[derive(Clone, Debug, Serialize, Deserialize)]
#[non_exhaustive]
pub struct Erratum {
    /// Name in the spec.
    pub name: Text,
    /// What is wrong: `vendor`, `translation`, `ocr`, `unclear`, `gap` or `note`.
    pub kind: String,
    /// Section of the document that prints it.
    pub section: Option<Text>,
    /// What the document prints.
    pub prints: Text,
    /// What the spec uses.
    pub uses: Text,
    /// Why the spec departs from the document.
    pub because: Text,
    /// Place in the spec.
    pub path: Path,
}

/// A type that a spec defines.
#[derive(Clone, Debug, Serialize, Deserialize)]
#[non_exhaustive]
pub struct NamedType {
    /// What the spec says beside it.
    pub doc: Doc,
    /// What it says of the bits of its fields, as the spec writes it, by key: `scale` and `1/10`.
    pub keys: Vec<(String, Text)>,
}

/// A warning that a spec accepts.
#[derive(Clone, Debug, Serialize, Deserialize)]
#[non_exhaustive]
pub struct Allowance {
    /// The rule that warns.
    pub rule: Text,
    /// The item in which the warnings are, by the keys that lead to it, as `messages.output`.
    pub at: Text,
    /// Why they are accepted.
    pub because: Text,
}
