//! Scales that depend on the device model: makes a signal for each model that has one.

use super::Resolver;
use super::types::Merged;
use crate::model::{Encoding, ModelId, Numeral, OfModel, Range, Signal, Unit};
use crate::read::syntax::ast::Key;
use crate::resolve::rules;
use crate::words::number::Rational;

/// What says what a step is.
const SCALES: [Key; 3] = [Key::Scale, Key::Offset, Key::Unit];

/// What a device model says of a step.
struct Step {
    scale: Option<Rational>,
    offset: Option<Rational>,
    unit: Option<Unit>,
}

impl Resolver<'_> {
    /// Tests whether the scale, the offset or the unit of a field depends on the device model.
    pub fn is_scaled_by_models(&self, merged: &Merged) -> bool {
        self.tables.models.ids().any(|model| self.has_scale(merged, model))
    }

    fn has_scale(&self, merged: &Merged, model: ModelId) -> bool {
        SCALES.iter().any(|key| self.changed(merged, model, *key).is_some())
    }

    /// Makes a signal whose scale depends on the device model. Its own limits are raw numbers.
    pub fn scale_by_models(&mut self, merged: &Merged, signal: &mut Signal, default: Option<&String>) -> Option<()> {
        let Encoding::Number { numeral: numeral @ (Numeral::Unsigned | Numeral::Signed), .. } = signal.encoding else {
            self.is_no_number(merged, signal);
            return None;
        };
        let models: Vec<_> = self.tables.models.ids().collect();
        let own = models.into_iter().filter_map(|model| {
            let value = self.on_model(merged, signal, model, default)?;
            Some(OfModel { model, path: value.doc.path.clone(), value })
        });
        let signals: Vec<_> = own.collect();
        signal.model_ranges = signals.iter().filter_map(raw_range).collect();
        signal.model_defaults = signals.iter().filter_map(default_of).collect();
        signal.encoding = Encoding::ByModel { numeral, signals };
        (signal.unit, signal.range) = (None, None);
        Some(())
    }

    /// Returns the signal as a device model has it; nothing if nobody says what a step is there.
    fn on_model(
        &mut self,
        merged: &Merged,
        signal: &Signal,
        model: ModelId,
        default: Option<&String>,
    ) -> Option<Signal> {
        let is_general = merged.field.scale.is_some() || merged.field.offset.is_some();
        let Encoding::Number { numeral, scale, offset } = signal.encoding else { return None };
        let step = (is_general || self.has_scale(merged, model)).then(|| self.step_of_model(merged, model))?;
        if !self.may_change(merged) {
            return None;
        }
        let encoding =
            Encoding::Number { numeral, scale: step.scale.unwrap_or(scale), offset: step.offset.unwrap_or(offset) };
        let unit = step.unit.or(signal.unit);
        let is_comparable = unit == signal.unit;
        let mut own = Signal { encoding, unit, range: signal.range.filter(|_| is_comparable), ..signal.clone() };
        if let Some((path, range)) = self.range_of_model(merged, model) {
            (own.range, own.range_path) = (Some(range), path);
        }
        let general = default.filter(|_| is_comparable).map(|text| (signal.default_path.clone(), text.clone()));
        if let Some((path, text)) = self.default_of_model(merged, model).or(general) {
            own.default = self.default(&path, &own, &text);
            own.default_path = path;
        }
        Some(own)
    }

    fn step_of_model(&self, merged: &Merged, model: ModelId) -> Step {
        let [scale, offset, unit] = SCALES.map(|key| self.changed(merged, model, key));
        Step {
            scale: scale.and_then(|known| known.scale),
            offset: offset.and_then(|known| known.offset),
            unit: unit.and_then(|known| known.unit),
        }
    }

    /// Reports a scale of a device model for a signal that has none.
    fn is_no_number(&mut self, merged: &Merged, signal: &Signal) {
        let models: Vec<_> = self.tables.models.ids().collect();
        let changed = |model| SCALES.into_iter().find_map(|key| Some((key, self.changed(merged, model, key)?)));
        let Some((key, known)) = models.into_iter().find_map(changed) else { return };
        let message = format!("`{}` means nothing for `{}`, which is no number in steps", key.name(), signal.name);
        let help = "take it out, or give the field another type";
        self.error_with_help(&rules::MISPLACED_KEY, known.doc.path.key(key).at_key(), message, help);
    }
}

/// Returns the limits of a device model as raw numbers.
fn raw_range(own: &OfModel<Signal>) -> Option<OfModel<Range>> {
    let [minimum, maximum] = own.value.encoding.linear()?.integers(own.value.range?)?.map(Rational::integer);
    Some(OfModel { model: own.model, value: Range { minimum, maximum }, path: own.value.range_path.clone() })
}

/// Returns the raw value that a device model starts with.
fn default_of(own: &OfModel<Signal>) -> Option<OfModel<i128>> {
    Some(OfModel { model: own.model, value: own.value.default?, path: own.value.default_path.clone() })
}
