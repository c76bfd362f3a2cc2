//! Turns a line of JSON into the content of a frame.

use std::fmt;
use std::marker::PhantomData;

use canspec_codegen::interpret::{self, Frame, Input, Problem};
use canspec_codegen::model::Kind;
use serde::de::value::MapAccessDeserializer;
use serde::de::{Error, IgnoredAny, MapAccess, Visitor};
use serde::{Deserialize, Deserializer};
use serde_json::Value;
use serde_json::value::RawValue;

use super::Members;
use crate::log;

/// A line: what it says of the log that it came from, and of the frame.
#[derive(Debug)]
pub struct Line {
    /// A JSON number.
    pub time: Option<Box<RawValue>>,
    pub channel: Option<String>,
    pub content: Content,
}

/// What a line says about a frame.
#[derive(Debug)]
pub enum Content {
    Message(Message),
    /// A message that is longer than a frame.
    Long(Message),
    /// The frame itself, which no protocol recognised.
    Frame(Frame),
}

/// A message with its values.
#[derive(Debug)]
pub struct Message {
    pub protocol: Option<String>,
    pub frame: interpret::Content,
    /// The units that the line states, by signal.
    pub units: Vec<(String, String)>,
    /// What is missing of a long message.
    pub incomplete: Option<String>,
}

impl Line {
    /// Reads a line. A blank line gives `None`.
    ///
    /// # Errors
    ///
    /// Says why the line is unreadable, or names the member that cannot be sent.
    pub fn read(line: &str) -> Result<Option<Self>, String> {
        if line.trim_ascii().is_empty() {
            return Ok(None);
        }
        let ByName(object) = serde_json::from_str::<ByName<Object>>(line).map_err(|error| without_line(&error))?;
        object.line().map(Some)
    }
}

/// Takes the line number, always 1, out of a message of `serde_json`.
fn without_line(error: &serde_json::Error) -> String {
    let text = error.to_string();
    let place = format!(" at line {} column {}", error.line(), error.column());
    let text = text.strip_suffix(&place).map_or(text.clone(), |what| format!("{what} (column {})", error.column()));
    if error.is_data() { text } else { format!("the line is no JSON object: {text}") }
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct Object {
    time: Option<Box<RawValue>>,
    channel: Option<String>,
    protocol: Option<String>,
    #[serde(deserialize_with = "Option::deserialize")]
    message: Option<String>,
    access: Option<String>,
    kind: Option<String>,
    identifier: Option<Members<String, u64>>,
    selectors: Option<Members<String, u64>>,
    signals: Option<Members<String, ByName<SignalObject>>>,
    reserved: Option<String>,
    #[serde(rename = "line")]
    _line: Option<IgnoredAny>,
    lines: Option<IgnoredAny>,
    incomplete: Option<String>,
    id: Option<Box<RawValue>>,
    data: Option<Box<RawValue>>,
    #[serde(rename = "addressing")]
    _addressing: Option<IgnoredAny>,
    #[serde(rename = "addresses")]
    _addresses: Option<IgnoredAny>,
    #[serde(rename = "notes")]
    _notes: Option<IgnoredAny>,
    problem: Option<ByName<ProblemObject>>,
}

/// Why a frame was not recognised.
#[derive(Deserialize)]
struct ProblemObject {
    kind: String,
}

impl Object {
    fn line(mut self) -> Result<Line, String> {
        let time = self.time.take().map(stamp).transpose()?;
        let channel = self.channel.take().as_deref().map(channel).transpose()?;
        let content = match self.message.take() {
            Some(message) if self.lines.is_some() => Content::Long(self.message(message)?),
            Some(message) => Content::Message(self.message(message)?),
            None => Content::Frame(self.frame()?),
        };
        Ok(Line { time, channel, content })
    }

    fn message(self, message: String) -> Result<Message, String> {
        let most = if self.lines.is_some() { MOST_LONG_DIGITS } else { MOST_DIGITS };
        let Values { signals, arrays, units } = Values::of(self.signals.ok_or_else(|| missing("signals"))?)?;
        let frame = interpret::Content {
            message,
            access: self.access,
            kind: self.kind.as_deref().map(kind).transpose()?,
            identifier: self.identifier.ok_or_else(|| missing("identifier"))?.0,
            selectors: self.selectors.ok_or_else(|| missing("selectors"))?.0,
            signals,
            arrays,
            reserved: self.reserved.as_deref().map(|digits| reserved(digits, most)).transpose()?.unwrap_or_default(),
        };
        Ok(Message { protocol: self.protocol, frame, units, incomplete: self.incomplete })
    }

    /// Returns a frame that was not recognised. The line does not say which form it has, if it is no data frame.
    fn frame(self) -> Result<Frame, String> {
        let ByName(problem) = self.problem.ok_or_else(|| missing("problem"))?;
        if problem.kind == Problem::Frame.name() {
            return Err("a remote, error or FD frame is not made again".to_owned());
        }
        let digits = |name, member: Option<Box<RawValue>>| {
            let member = member.ok_or_else(|| missing(name))?;
            serde_json::from_str::<String>(member.get()).map_err(|_| format!("`{name}` is a text, not {member}"))
        };
        log::data_frame(&digits("id", self.id)?, &digits("data", self.data)?)
    }
}

/// Most digits of the bits of a frame that no signal covers.
const MOST_DIGITS: usize = 16;

/// The same for a long message.
const MOST_LONG_DIGITS: usize = 2 * 4095;

fn missing(field: &str) -> String {
    format!("missing field `{field}`")
}

/// The inputs and the units of all signals and arrays, by name.
#[derive(Default)]
struct Values {
    signals: Vec<(String, Input)>,
    arrays: Vec<(String, Vec<Option<Input>>)>,
    units: Vec<(String, String)>,
}

impl Values {
    fn of(objects: Members<String, ByName<SignalObject>>) -> Result<Self, String> {
        let mut signals = Self::default();
        for (name, ByName(mut object)) in objects.0 {
            signals.units.extend(object.unit.take().map(|unit| (name.clone(), unit)));
            let refuse = |why| format!("signal `{name}`: {why}");
            match object.elements() {
                None => {
                    let input = object.input().map_err(refuse)?;
                    signals.signals.push((name, input));
                }
                Some(elements) => {
                    let inputs = elements.into_iter().map(SignalObject::element).collect::<Result<_, _>>();
                    let inputs = inputs.map_err(refuse)?;
                    signals.arrays.push((name, inputs));
                }
            }
        }
        Ok(signals)
    }
}

fn kind(word: &str) -> Result<Kind, String> {
    let kind = Kind::ALL.into_iter().find(|kind| kind.name() == word);
    kind.ok_or_else(|| format!("`kind` is request, reply or report, not {word:?}"))
}

fn reserved(digits: &str, most: usize) -> Result<Vec<u8>, String> {
    let refusal = || format!("`reserved` is an even number of hexadecimal digits, at most {most}, not {digits:?}");
    hexadecimal(digits, most).ok_or_else(refusal)
}

/// Reads two digits a byte, of at most `most` digits.
fn hexadecimal(digits: &str, most: usize) -> Option<Vec<u8>> {
    let is_hexadecimal = digits.bytes().all(|digit| digit.is_ascii_hexdigit());
    if !is_hexadecimal || digits.len() > most || !digits.len().is_multiple_of(2) {
        return None;
    }
    (0..digits.len()).step_by(2).map(|place| u8::from_str_radix(&digits[place..place + 2], 16).ok()).collect()
}

fn stamp(time: Box<RawValue>) -> Result<Box<RawValue>, String> {
    let is_time = log::is_number(&time) && log::is_finite(time.get());
    if is_time { Ok(time) } else { Err(format!("`time` is a number or null, not {}", time.get())) }
}

fn channel(name: &str) -> Result<String, String> {
    log::channel(name).map(str::to_owned)
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct SignalObject {
    /// As they are written, so that no digit is lost.
    raw: Option<Box<RawValue>>,
    value: Option<Box<RawValue>>,
    unit: Option<String>,
    set: Option<Value>,
    unknown: Option<Value>,
    #[serde(rename = "severity")]
    _severity: Option<IgnoredAny>,
}

impl SignalObject {
    /// Returns the elements of an array, whose members are lists.
    fn elements(&self) -> Option<Vec<Self>> {
        let [raw, value] = [&self.raw, &self.value].map(|member| list(member.as_deref()?));
        let [mut set, unknown] = [&self.set, &self.unknown].map(|member| member.as_ref()?.as_array());
        // The names of the set bits are a list in any case.
        if unknown.is_none() {
            set = None;
        }
        let written = [&raw, &value].map(|list| list.as_ref().map(Vec::len));
        let count = written.into_iter().chain([set, unknown].map(|list| list.map(Vec::len))).flatten().max()?;
        let item = |list: Option<&Vec<Value>>, index: usize| list?.get(index).filter(|item| !item.is_null()).cloned();
        let text = |list: &Option<Vec<Box<RawValue>>>, index: usize| {
            list.as_ref()?.get(index).filter(|item| item.get() != "null").cloned()
        };
        let element = |index| Self {
            raw: text(&raw, index),
            value: text(&value, index),
            unit: None,
            set: item(set, index),
            unknown: item(unknown, index),
            _severity: None,
        };
        Some((0..count).map(element).collect())
    }

    /// Returns the value of an element, if the frame has it.
    fn element(self) -> Result<Option<Input>, String> {
        let is_there = self.raw.is_some() || self.value.is_some() || self.set.is_some();
        is_there.then(|| self.input()).transpose()
    }

    fn input(self) -> Result<Input, String> {
        match (self.value, self.set, self.unknown) {
            (Some(value), None, None) => physical(&value, self.raw.as_deref()),
            (None, Some(set), Some(unknown)) => status(set, unknown),
            (None, None, None) => raw(&self.raw.ok_or("`value` is missing, and so is `raw`")?),
            (Some(_), ..) => Err("it has a `value` and the bits of a status word".to_owned()),
            (None, Some(_), None) => Err(missing("unknown")),
            (None, None, Some(_)) => Err(missing("set")),
        }
    }
}

fn status(set: Value, unknown: Value) -> Result<Input, String> {
    let set = serde_json::from_value(set).map_err(|error| format!("`set` is a list of names: {error}"))?;
    let unknown =
        serde_json::from_value(unknown).map_err(|error| format!("`unknown` is a mask of 64 bits: {error}"))?;
    Ok(Input::Status { set, unknown })
}

/// Reads a number, a name or a text. `raw` is what stands beside it.
fn physical(value: &RawValue, raw: Option<&RawValue>) -> Result<Input, String> {
    if let Some(text) = string(value) {
        return with_bytes(text, raw);
    }
    if !log::is_number(value) {
        return Err(format!("`value` is a number, a text or null, not {value}"));
    }
    number(value.get())
}

/// From here on doubles have no fraction.
const WHOLE: f64 = 4_503_599_627_370_496.0;

/// Reads a number. A whole one keeps each digit, however it is written, but a zero has a sign as a double alone.
fn number(text: &str) -> Result<Input, String> {
    let double =
        text.parse().ok().filter(|number: &f64| number.is_finite()).ok_or("`value` is no number of 64 bits")?;
    let Some((digits, power)) = decimal(text).filter(|_| double != 0.0) else {
        return Ok(Input::Number(double));
    };
    if power < 0 && double.abs() >= WHOLE {
        return Err(format!("`value` is {text}; numbers of that size are whole"));
    }
    Ok(integer(&digits, power).map_or(Input::Number(double), Input::Integer))
}

/// Splits a JSON number into digits that do not end in 0, with their sign, and a power of ten.
fn decimal(text: &str) -> Option<(String, i64)> {
    let (digits, exponent) = text.split_once(['e', 'E']).unwrap_or((text, "0"));
    let (whole, fraction) = digits.split_once('.').unwrap_or((digits, ""));
    let (all, places) = (format!("{whole}{fraction}"), fraction.len());
    let digits = all.trim_end_matches('0');
    let zeros = i64::try_from(all.len() - digits.len()).ok()?;
    let power = exponent.parse::<i64>().ok()?.checked_add(zeros)?.checked_sub(i64::try_from(places).ok()?)?;
    Some((digits.to_owned(), power))
}

/// Returns a whole number within 64 bits and a sign.
fn integer(digits: &str, power: i64) -> Option<i128> {
    let number = digits.parse::<i128>().ok()?.checked_mul(10_i128.checked_pow(u32::try_from(power).ok()?)?)?;
    Some(number).filter(is_of_64_bits)
}

fn is_of_64_bits(number: &i128) -> bool {
    number.unsigned_abs() <= u64::MAX.into()
}

/// Returns a name or a text. Digits beside a text say which bytes fill it up.
fn with_bytes(text: String, raw: Option<&RawValue>) -> Result<Input, String> {
    match raw.and_then(string) {
        Some(digits) => Ok(Input::Bytes { bytes: long_bytes(&digits)?, text: Some(text) }),
        None => Ok(Input::Text(text)),
    }
}

fn long_bytes(digits: &str) -> Result<Vec<u8>, String> {
    hexadecimal(digits, MOST_LONG_DIGITS).ok_or_else(|| {
        format!("`raw` of a longer text is an even number of hexadecimal digits, at most {MOST_LONG_DIGITS}")
    })
}

fn raw(value: &RawValue) -> Result<Input, String> {
    if let Some(digits) = string(value) {
        return Ok(Input::Bytes { bytes: long_bytes(&digits)?, text: None });
    }
    let whole = value.get().parse().ok().filter(is_of_64_bits).map(Input::Raw);
    whole.ok_or_else(|| format!("`raw` is an integer of up to 64 bits, not {value}"))
}

/// Returns the text that a JSON text stands for.
fn string(value: &RawValue) -> Option<String> {
    serde_json::from_str(value.get()).ok()
}

/// Returns the items of a JSON list.
fn list(value: &RawValue) -> Option<Vec<Box<RawValue>>> {
    serde_json::from_str(value.get()).ok()
}

/// A struct that only a JSON object gives a value. serde would take a list as well.
struct ByName<T>(T);

impl<'de, T: Deserialize<'de>> Deserialize<'de> for ByName<T> {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        deserializer.deserialize_map(ByNameVisitor(PhantomData))
    }
}

struct ByNameVisitor<T>(PhantomData<T>);

impl<'de, T: Deserialize<'de>> Visitor<'de> for ByNameVisitor<T> {
    type Value = ByName<T>;

    fn expecting(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        formatter.write_str("an object")
    }

    fn visit_map<A: MapAccess<'de>>(self, map: A) -> Result<Self::Value, A::Error> {
        T::deserialize(MapAccessDeserializer::new(map)).map(ByName)
    }
}

impl<'de, V: Deserialize<'de>> Deserialize<'de> for Members<String, V> {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        deserializer.deserialize_map(MembersVisitor(PhantomData))
    }
}

struct MembersVisitor<V>(PhantomData<V>);

impl<'de, V: Deserialize<'de>> Visitor<'de> for MembersVisitor<V> {
    type Value = Members<String, V>;

    fn expecting(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        formatter.write_str("an object")
    }

    fn visit_map<A: MapAccess<'de>>(self, mut map: A) -> Result<Self::Value, A::Error> {
        let mut members: Vec<(String, V)> = Vec::new();
        while let Some(name) = map.next_key::<String>()? {
            if members.iter().any(|(other, _)| *other == name) {
                return Err(A::Error::custom(format_args!("duplicate field `{name}`")));
            }
            members.push((name, map.next_value()?));
        }
        Ok(Members(members))
    }
}

#[cfg(test)]
mod tests;
