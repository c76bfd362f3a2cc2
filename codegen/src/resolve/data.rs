//! Resolves what a spec says beside the codec: document, procedures, models and errata.

use super::Resolver;
use super::keys::Role;
use super::texts::{remarks, text};
use crate::model::keywords::ERRATUM_KINDS;
use crate::model::{DeviceModel, Document, Erratum, Id, ModelId, Procedure, Quantity, Table, TypeOfModel};
use crate::read::syntax::ast::{self, Key};
use crate::report::tree::Path;
use crate::resolve::rules;
use crate::words::number::Rational;
use crate::words::text::Text;

/// The version of the spec language.
const VERSION: &str = "1";

impl Resolver<'_> {
    pub fn version(&mut self) {
        let version = &self.spec.canspec;
        if version != VERSION {
            let message = format!("this spec is written in version `{version}` of the language");
            let help = format!("this compiler reads version {VERSION}");
            self.error_with_help(&rules::VERSION, Path::default().key("canspec").at_value(), message, help);
        }
    }

    pub fn protocol_name(&mut self) -> String {
        let name = self.spec.protocol.clone();
        self.check_name_at(Path::default().key("protocol").at_value(), &name);
        name
    }

    /// Reads the document that has no name, then those that have one.
    pub fn documents(&mut self) -> Vec<Document> {
        self.check_not_empty(&Path::default(), &["documents"]);
        let (root, spec) = (Path::default().key("documents"), self.spec);
        for name in spec.documents.keys() {
            self.check_document_name(&root.key(name), name);
        }
        let first = spec.document.iter().map(|written| document(None, written));
        first.chain(spec.documents.iter().map(|(name, written)| document(Some(name), written))).collect()
    }

    /// Reads bit rates such as `125 kbit/s`, in bit/s.
    pub fn bit_rates(&mut self, path: &Path, texts: &[String]) -> Vec<u32> {
        let rates = texts.iter().enumerate().map(|(index, text)| (path.index(index), text));
        rates
            .filter_map(|(path, text)| {
                let rate = bit_rate(text);
                if rate.is_none() {
                    let message = format!("`{text}` is not a bit rate");
                    self.error_with_help(&rules::NUMBER, path.at_value(), message, "write `125 kbit/s` or `1 Mbit/s`");
                }
                rate
            })
            .collect()
    }

    /// Reads the speeds of a device model, which are among those of the protocol.
    fn bit_rates_of_model(&mut self, path: &Path, texts: &[String]) -> Vec<u32> {
        let known: Vec<_> = self.spec.bit_rates.iter().filter_map(|text| bit_rate(text)).collect();
        let own = texts.iter().enumerate().filter_map(|(index, text)| Some((index, text, bit_rate(text)?)));
        let strange = own.filter(|(_, _, rate)| !known.is_empty() && !known.contains(rate));
        for (index, text, _) in strange {
            let message = format!("`{text}` is none of the protocol's `bit_rates`");
            let help = format!("correct it, or write it there, too: {}", self.spec.bit_rates.join(", "));
            self.error_with_help(&rules::NUMBER, path.index(index).at_value(), message, &help);
        }
        self.bit_rates(path, texts)
    }

    pub fn procedures(&mut self) -> Vec<Procedure> {
        let root = Path::default().key("procedures");
        let spec = self.spec;
        let entries = spec.procedures.iter().map(|(name, procedure)| (root.key(name), name, procedure));
        entries
            .map(|(path, name, procedure)| {
                self.check_name(&path, name);
                self.check_steps(&path.key("steps"), &procedure.steps);
                let doc = remarks!(procedure).doc(&path, None);
                Procedure { name: name.clone(), doc, steps: texts(&procedure.steps) }
            })
            .collect()
    }

    /// Tests that names in backquotes in the steps are messages.
    fn check_steps(&mut self, path: &Path, steps: &[ast::Words]) {
        for (index, step) in steps.iter().enumerate() {
            for name in step.0.split('`').skip(1).step_by(2) {
                let known = self.spec.messages.keys().map(String::as_str);
                self.lookup(&path.index(index), "message", name, known);
            }
        }
    }

    pub fn models(&mut self) -> Table<ModelId, DeviceModel> {
        let root = Path::default().key("models");
        let spec = self.spec;
        spec.models.iter().map(|(name, model)| self.model(&root.key(name), name, model)).collect()
    }

    fn model(&mut self, path: &Path, name: &str, model: &ast::DeviceModel) -> DeviceModel {
        self.check_document_name(path, name);
        let doc = remarks!(model).doc(path, None);
        let parallel = model.max_parallel.as_ref();
        let types =
            model.types.iter().filter_map(|(name, field)| self.type_of_model(path, name, field, &doc)).collect();
        DeviceModel {
            name: name.to_owned(),
            items: texts(&model.items),
            max_parallel: parallel
                .and_then(|text| self.integer(&path.key("max_parallel"), text, 1, u32::from(u16::MAX))),
            bit_rates: self.bit_rates_of_model(&path.key("bit_rates"), &model.bit_rates),
            facts: self.facts(&path.key("facts"), &model.facts),
            types,
            doc,
        }
    }

    /// Finds a device model by name.
    pub fn device_model(&mut self, path: &Path, name: &str) -> Option<ModelId> {
        self.lookup(path, "model", name, self.spec.models.keys().map(String::as_str)).map(ModelId::new)
    }

    fn facts(&mut self, path: &Path, facts: &ast::Map<String>) -> Vec<(Text, Quantity)> {
        let entries = facts.iter();
        entries.filter_map(|(name, text)| Some((Text::new(name), self.quantity(&path.key(name), text)?))).collect()
    }

    fn type_of_model(
        &mut self,
        path: &Path,
        name: &str,
        field: &ast::Field,
        outer: &crate::model::Doc,
    ) -> Option<TypeOfModel> {
        let path = path.key("types").key(name);
        self.lookup(&path, "type", name, self.spec.types.keys().map(String::as_str))?;
        self.check_own_keys(&path, field, Role::OfModel);
        let range = field.range.as_ref().and_then(|text| self.range(&path.key("range"), text));
        let mut number =
            |key: Key, text: &Option<String>| text.as_ref().and_then(|text| self.number(&path.key(key), text));
        Some(TypeOfModel {
            name: name.to_owned(),
            range,
            default: number(Key::Default, &field.default),
            scale: number(Key::Scale, &field.scale),
            offset: number(Key::Offset, &field.offset),
            unit: field.unit.as_ref().and_then(|text| self.unit_of_field(&path.key(Key::Unit), text, field)),
            doc: remarks!(field).doc(&path, Some(outer)),
        })
    }

    pub fn errata(&mut self) -> Vec<Erratum> {
        let root = Path::default().key("errata");
        let spec = self.spec;
        spec.errata.iter().map(|(name, erratum)| self.erratum(&root.key(name), name, erratum)).collect()
    }

    fn erratum(&mut self, path: &Path, name: &str, erratum: &ast::Erratum) -> Erratum {
        self.lookup(&path.key("kind"), "kind of erratum", &erratum.kind, ERRATUM_KINDS.into_iter());
        let [prints, uses, because] =
            [&erratum.prints, &erratum.uses, &erratum.because].map(|written| Text::new(&written.0));
        let (name, kind, section) = (Text::new(name), erratum.kind.clone(), text(erratum.section.as_ref()));
        Erratum { name, kind, section, prints, uses, because, path: path.clone() }
    }
}

fn document(name: Option<&String>, written: &ast::Document) -> Document {
    let ast::Document { title, version, date, file } = written;
    let [title, version] = [title, version].map(|written| Text::new(&written.0));
    Document { name: name.cloned(), title, version, date: text(date.as_ref()), file: text(file.as_ref()) }
}

fn texts(written: &[ast::Words]) -> Vec<Text> {
    written.iter().map(|words| Text::new(&words.0)).collect()
}

/// Reads a bit rate in bit/s, up to the limit of CAN.
fn bit_rate(text: &str) -> Option<u32> {
    let (number, unit) = text.split_once(' ')?;
    let factor = match unit {
        "kbit/s" => 1_000,
        "Mbit/s" => 1_000_000,
        _ => return None,
    };
    let rate = Rational::parse(number)?.times(Rational::integer(factor))?.to_integer()?;
    u32::try_from(rate).ok().filter(|rate| (1..=1_000_000).contains(rate))
}
