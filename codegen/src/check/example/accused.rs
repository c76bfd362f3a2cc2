//! Decides what is wrong if examples and fields disagree: a field, or a type that several fields
//! share.

use std::collections::HashSet;

use super::evidence::{Evidence, Field, collect, missing_bit};
use super::repair::{self, Repair};
use crate::model::{Protocol, Signal};
use crate::report::diagnostic::{At, Diagnostic, Diagnostics};
use crate::report::tree::{Path, Step};
use crate::resolve::rules;

/// Largest number of examples that are shown beside a field.
const SHOWN: usize = 3;

/// Keys of a type that say which value its bits mean.
const MEANING: [&str; 6] = ["bytes", "bits", "as", "scale", "offset", "values"];

/// Blames the fields that are more probably wrong than their examples. It returns the places of the
/// values that this explains.
pub fn blame(protocol: &Protocol, diagnostics: &mut Diagnostics) -> HashSet<Path> {
    let collected = collect(protocol);
    let fields: Vec<_> =
        collected.iter().map(|((message, signal), known)| Field::new(protocol, *message, *signal, known)).collect();
    let types = protocol.types.iter().map(|known| &known.doc.path);
    let types: Vec<_> = types.filter_map(|path| Accused::of_type(protocol, path, &fields)).collect();
    let alone: Vec<_> = fields.iter().map(|field| Accused::of_field(protocol, field)).collect();
    let verdicts: [(&[Accused], Verdict); 4] = [
        (&types, Accused::repaired),
        (&alone, Accused::explained),
        (&types, Accused::contradicted),
        (&alone, Accused::contradicted),
    ];
    let mut explained = HashSet::new();
    for (accused, verdict) in
        verdicts.iter().flat_map(|(all, verdict)| all.iter().map(move |accused| (accused, verdict)))
    {
        let places: Vec<_> = accused.denials().map(|denial| denial.meaning.path.clone()).collect();
        if places.iter().any(|place| explained.contains(place)) {
            continue;
        }
        if let Some(diagnostic) = verdict(accused, diagnostics) {
            diagnostics.push_first(diagnostic);
            explained.extend(places);
        }
    }
    explained
}

/// A test that finds a mistake of the accused.
type Verdict<'a> = fn(&Accused<'a>, &Diagnostics) -> Option<Diagnostic>;

/// What can be wrong if examples are right: a field, or a type with all fields that take keys from
/// it.
struct Accused<'a> {
    protocol: &'a Protocol,
    name: String,
    path: Path,
    fields: Vec<&'a Field<'a>>,
}

impl<'a> Accused<'a> {
    fn of_field(protocol: &'a Protocol, field: &'a Field<'a>) -> Self {
        Self { protocol, name: format!("`{}`", field.name), path: field.signal.doc.path.clone(), fields: vec![field] }
    }

    /// Accuses a type if the examples of several fields contradict it, and its own do not support
    /// it.
    fn of_type(protocol: &'a Protocol, path: &Path, fields: &'a [Field<'a>]) -> Option<Self> {
        let (_, Step::Key(name)) = path.split()? else { return None };
        let is_its = |field: &&Field| field.signal.types.contains(name) && !is_status(field.signal);
        let fields: Vec<_> = fields.iter().filter(is_its).collect();
        let is_denied = fields.iter().filter(|field| field.denials().next().is_some()).count() > 1;
        let own =
            protocol.value_examples.iter().filter(|example| example.doc.path.ancestors().any(|outer| outer == path));
        let is_borne_out =
            own.clone().any(|example| example.meaning.is(&example.signal, example.signal.place.get(&example.data)));
        (is_denied && !is_borne_out).then(|| Self {
            protocol,
            name: format!("the type `{name}`"),
            path: path.clone(),
            fields,
        })
    }

    fn denials(&self) -> impl Iterator<Item = &'a Evidence<'a>> {
        self.fields.iter().flat_map(|field| field.denials())
    }

    /// The field alone explains the difference.
    fn explained(&self, diagnostics: &Diagnostics) -> Option<Diagnostic> {
        let (field, first) = (self.fields.first()?, self.denials().next()?);
        self.repaired(diagnostics).or_else(|| match field.signal.encoding.status_word() {
            Some(word) => {
                let bits = &self.protocol[word].bits;
                field.moved_bit(first, bits).or_else(|| missing_bit(first, bits))
            }
            None => field.misnumbered(first, diagnostics),
        })
    }

    /// No example holds, and all would after one change.
    fn repaired(&self, diagnostics: &Diagnostics) -> Option<Diagnostic> {
        let denials: Vec<_> = self.denials().collect();
        let is_slip = |denial: &Evidence| self.fields.iter().any(|field| denial.is_slip(field.signal));
        if self.is_borne_out() || denials.len() == 1 && is_slip(denials[0]) {
            return None;
        }
        let Repair { at, text, .. } =
            repair::find(self.protocol, &self.fields, |key| self.written(key, diagnostics), diagnostics)?;
        let help = format!("with `{text}` all of them hold; write that, or correct the examples");
        Some(self.denied(At::Value(at)).help(help))
    }

    /// No example holds, and there are several.
    fn contradicted(&self, diagnostics: &Diagnostics) -> Option<Diagnostic> {
        let is_misfit = |denial: &Evidence| denial.meaning.said.is_err();
        let says_what_bits_mean = MEANING.iter().any(|key| self.written(key, diagnostics).is_some());
        let is_several = self.denials().count() > 1 && (self.fields.len() == 1 || says_what_bits_mean);
        if self.fields.iter().any(|field| is_status(field.signal))
            || self.is_borne_out()
            || !is_several
            || self.denials().any(is_misfit)
        {
            return None;
        }
        let help = "correct its place, its scale, its offset, its `as`, or the examples";
        let of_types = MEANING.iter().filter_map(|key| self.written(key, diagnostics));
        let of_types = of_types.filter(|at| !at.ancestors().any(|outer| *outer == self.path));
        let denied = self.denied(self.path.at_key()).help(help);
        Some(of_types.fold(denied, |denied, at| denied.other(at.at_value(), "the field takes this from a type")))
    }

    fn denied(&self, at: At) -> Diagnostic {
        let contradict = match self.denials().count() {
            1 => "1 contradicts".to_owned(),
            count => format!("{count} contradict"),
        };
        let text = format!("no example confirms {}, and {contradict} it", self.name);
        self.denials().take(SHOWN).fold(Diagnostic::error(&rules::EXAMPLE, at, text), |diagnostic, denial| {
            diagnostic.other(
                denial.meaning.path.at_value(),
                format!("according to the field, this frame says {}", denial.read),
            )
        })
    }

    /// Tests whether an example agrees in bits that are not all zero.
    fn is_borne_out(&self) -> bool {
        self.fields.iter().any(|field| field.is_borne_out(|bits| bits != 0))
    }

    /// Finds the one place from which all of the fields have a key. For a type it must be the
    /// type's own key.
    fn written(&self, key: &str, diagnostics: &Diagnostics) -> Option<Path> {
        let at = self.fields.first()?.written(key, diagnostics)?;
        let is_shared = self.fields.len() == 1 || at == self.path.key(key);
        let is_everywhere = self.fields.iter().all(|field| field.written(key, diagnostics).as_ref() == Some(&at));
        (is_shared && is_everywhere).then_some(at)
    }
}

fn is_status(signal: &Signal) -> bool {
    signal.encoding.status_word().is_some()
}
