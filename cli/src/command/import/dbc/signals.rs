//! Translates what the number of a signal means.

use std::collections::HashSet;

use can_dbc::{MessageId, NumericValue, Signal, SignalExtendedValueType, ValueType};
use canspec_codegen::check::has_exact_steps;
use canspec_codegen::model::unit_prefixes::{prefixed, respelled};
use canspec_codegen::model::{Linear, Numeral, Unit};
use canspec_codegen::number::Rational;

use super::index::Index;
use super::names::{Names, snake_case, type_name};
use super::spec::one_line;
use super::yaml::{map, quoted};

/// The keys of a field without its place, and remarks about it.
#[derive(Default)]
pub struct Translated {
    pub keys: Vec<(&'static str, String)>,
    pub unit: Option<Unit>,
    /// Whether its values are only names, and no numbers.
    pub is_named: bool,
    pub decide: Vec<String>,
    /// What the spec does not say about it.
    pub lost: Vec<String>,
}

/// Lowest and highest physical value.
type Range = (Rational, Rational);

/// A raw value and its name in the DBC.
type Named<'a> = (i64, &'a str);

/// Returns what a signal means, or why a spec cannot say it.
pub fn meaning(index: &Index, id: MessageId, signal: &Signal) -> Result<Translated, String> {
    let format = index.format(id, &signal.name);
    let named = index.values(id, &signal.name);
    let named: Vec<Named> = named.iter().map(|value| (value.id, value.description.as_str())).collect();
    match format {
        None | Some(SignalExtendedValueType::SignedOrUnsignedInteger) => number(signal, &named),
        Some(SignalExtendedValueType::IEEEfloat32Bit) => float(signal, &named),
        Some(SignalExtendedValueType::IEEEdouble64bit) => Err("it is a float of 64 bits".to_owned()),
    }
}

fn float(signal: &Signal, named: &[Named]) -> Result<Translated, String> {
    if signal.size != 32 {
        return Err(format!("it is a float of 32 bits in {}", signal.size));
    }
    if exact(signal.factor) != Some(Rational::ONE) || exact(signal.offset) != Some(Rational::ZERO) {
        return Err("it is a float with a scale or an offset".to_owned());
    }
    let mut meaning = Translated { keys: vec![("as", "float".to_owned())], ..Translated::default() };
    let range = stated(signal, &mut meaning);
    if !named.is_empty() {
        meaning.lost.push("it is a float, whose values have no names".to_owned());
    }
    unit(signal, &mut meaning);
    meaning.keys.extend(range.map(range_key));
    Ok(meaning)
}

fn number(signal: &Signal, named: &[Named]) -> Result<Translated, String> {
    let scale = exact(signal.factor).ok_or_else(|| format!("no spec can write its scale {}", signal.factor))?;
    let offset = exact(signal.offset).ok_or_else(|| format!("no spec can write its offset {}", signal.offset))?;
    let is_scaled = (scale, offset) != (Rational::ONE, Rational::ZERO);
    let signed = signal.value_type == ValueType::Signed;
    let numeral = if signed { Numeral::Signed } else { Numeral::Unsigned };
    let linear = Linear { numeral, scale, offset };
    let width = u8::try_from(signal.size).unwrap_or(u8::MAX);
    if scale == Rational::ZERO {
        return Err("it has a scale of 0".to_owned());
    }
    if is_scaled && !has_exact_steps(width, linear) {
        return Err(format!("a double cannot tell the steps of {scale} of its {width} bits apart"));
    }
    let (first, last) = numeral.limits(width.clamp(1, 64));
    let mut meaning = Translated::default();
    let named = fitting(named, (first, last), &mut meaning);
    let held = linear.value(first).zip(linear.value(last)).map(|(one, other)| (one.min(other), one.max(other)));
    let stated = stated(signal, &mut meaning);
    let range = stated.zip(held).and_then(|(range, held)| within(range, held, &mut meaning));
    let range = range.and_then(|range| on_steps(range, linear, &mut meaning));
    let range = beside(range, &named, |raw| linear.value(raw.into()), &mut meaning);
    meaning.is_named = !named.is_empty() && !signed && !is_scaled && range.is_none() && unit_of(signal).is_none();
    meaning.keys.extend(signed.then(|| ("as", "signed".to_owned())));
    let is_plain = !named.is_empty() && !meaning.is_named && !is_scaled;
    meaning.keys.extend((scale != Rational::ONE || is_plain).then(|| ("scale", scale.to_string())));
    meaning.keys.extend((offset != Rational::ZERO).then(|| ("offset", offset.to_string())));
    unit(signal, &mut meaning);
    if is_scaled && signal.unit.trim().is_empty() {
        meaning.decide.push("the unit, which the DBC does not state".to_owned());
    }
    meaning.keys.extend(range.map(range_key));
    meaning.keys.extend((!named.is_empty()).then(|| ("values", values(&named))));
    Ok(meaning)
}

fn exact(number: f64) -> Option<Rational> {
    Rational::parse(&number.to_string())
}

fn range_key((minimum, maximum): Range) -> (&'static str, String) {
    ("range", format!("{minimum}..{maximum}"))
}

/// Returns the limits that the DBC states. Two zeros state none.
fn stated(signal: &Signal, meaning: &mut Translated) -> Option<Range> {
    let number = |limit: NumericValue| Rational::parse(&limit.to_string());
    let range = number(signal.min).zip(number(signal.max));
    if range.is_none_or(|(minimum, maximum)| minimum > maximum) {
        meaning.lost.push(format!("no spec can write its limits {} to {}", signal.min, signal.max));
        return None;
    }
    range.filter(|range| *range != (Rational::ZERO, Rational::ZERO))
}

/// Cuts limits to what the bits hold. Limits that exclude nothing are left out.
fn within(range: Range, held: Range, meaning: &mut Translated) -> Option<Range> {
    let cut = (range.0.max(held.0), range.1.min(held.1));
    if cut.0 > cut.1 {
        meaning.lost.push(format!("its limits {} to {} lie outside of its bits", range.0, range.1));
        return None;
    }
    (cut != held).then_some(cut)
}

/// Narrows limits to the steps inside them, which are all that can be sent.
fn on_steps(range: Range, linear: Linear, meaning: &mut Translated) -> Option<Range> {
    let raw = |end: Rational| end.minus(linear.offset)?.over(linear.scale);
    let Some((one, other)) = raw(range.0).zip(raw(range.1)) else { return Some(range) };
    let (first, last) = (one.min(other).ceiling(), one.max(other).floor());
    let stated = format!("the limits {}..{} of the DBC", range.0, range.1);
    if first > last {
        meaning.decide.push(format!("{stated}, between which there is no step"));
        return None;
    }
    let Some((one, other)) = linear.value(first).zip(linear.value(last)) else { return Some(range) };
    let steps = (one.min(other), one.max(other));
    if steps != range {
        meaning.decide.push(format!("{stated}, which lie between steps"));
    }
    Some(steps)
}

/// Drops limits that contain named values, because these would have two meanings.
fn beside(
    range: Option<Range>,
    named: &[Named],
    value: impl Fn(i64) -> Option<Rational>,
    meaning: &mut Translated,
) -> Option<Range> {
    let (minimum, maximum) = range?;
    let is_inside = |raw: i64| value(raw).is_some_and(|value| (minimum..=maximum).contains(&value));
    if named.iter().any(|(raw, _)| is_inside(*raw)) {
        meaning.decide.push(format!("the limits {minimum}..{maximum} of the DBC hold values with names"));
        return None;
    }
    range
}

/// Returns the values that the bits hold, each once.
fn fitting<'a>(named: &[Named<'a>], (first, last): (i128, i128), meaning: &mut Translated) -> Vec<Named<'a>> {
    let (mut kept, mut seen) = (Vec::new(), HashSet::new());
    for (raw, name) in named {
        if !(first..=last).contains(&i128::from(*raw)) {
            meaning.lost.push(format!("its bits do not hold {raw}, which is called {}", one_line(name)));
        } else if !seen.insert(*raw) {
            meaning.lost.push(format!("{raw} is also called {}", one_line(name)));
        } else {
            kept.push((*raw, *name));
        }
    }
    kept.sort_by_key(|(raw, _)| *raw);
    kept
}

/// Writes the names of values.
fn values(named: &[Named]) -> String {
    let mut taken = Names::default();
    let mut name = |text: &str| quoted(&taken.take(&snake_case(text, "value"), type_name));
    let entries: Vec<_> = named.iter().map(|(raw, text)| (raw.to_string(), name(text))).collect();
    map(entries.iter().map(|(raw, name)| (raw.as_str(), name.as_str())))
}

/// Returns the unit that the DBC states. `-` and `1` state none.
pub fn unit_of(signal: &Signal) -> Option<&str> {
    Some(signal.unit.trim()).filter(|symbol| !["", "-", "1"].contains(symbol))
}

/// Adds the unit if the language has it.
fn unit(signal: &Signal, meaning: &mut Translated) {
    let Some(symbol) = unit_of(signal) else { return };
    // `C` may also be coulomb.
    meaning.unit = Unit::find(symbol).or_else(|| respelled(symbol).filter(|_| symbol != "C"));
    meaning.keys.extend(meaning.unit.map(|unit| ("unit", quoted(&unit.symbol))));
    if let Some((unit, factor)) = prefixed(symbol).filter(|_| meaning.unit.is_none()) {
        meaning.decide.push(format!("a unit of {symbol}, or `unit: {}` and a scale times {factor}", unit.symbol));
    }
}
