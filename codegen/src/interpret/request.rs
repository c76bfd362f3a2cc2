//! A request by name: `set_output` to `module:3`.

use super::encode::{find_message, frame, not_of, refuse};
use super::value::{Limits, raw_of};
use super::{Frame, Input, Refusal, decode};
use crate::model::{AddressType, Encoding, Kind, Message, Mode, Protocol, SelectorPlace, Set, Shape, Signal};
use crate::number::Rational;

/// Whom a request goes to.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Target {
    /// The addressing mode, or the address type that only one mode leaves open.
    pub name: String,
    /// Number of the address, if the mode leaves one open.
    pub number: Option<i64>,
}

impl Target {
    /// Reads `broadcast`, `module:3` or `module:0x3B`.
    ///
    /// # Errors
    ///
    /// Says that what follows the colon is no number.
    pub fn parse(text: &str) -> Result<Self, Refusal> {
        let Some((name, number)) = text.split_once(':') else {
            return Ok(Self { name: text.to_owned(), number: None });
        };
        let whole =
            Rational::parse(number).and_then(Rational::to_integer).and_then(|number| i64::try_from(number).ok());
        let number = whole.ok_or_else(|| Refusal(format!("`{number}` is not an address; write `{name}:3`")))?;
        Ok(Self { name: name.to_owned(), number: Some(number) })
    }
}

/// Makes the frames of a request to a device `model` (an index into [`Protocol::models`]) or to any: one, or as many as a
/// set has members. A signal that is left out takes its default.
///
/// # Errors
///
/// As [`request`].
pub fn requests(
    protocol: &Protocol,
    model: Option<usize>,
    access: Option<&str>,
    message: &str,
    target: &Target,
    source: Option<i64>,
    signals: &[(String, String)],
) -> Result<Vec<Frame>, Refusal> {
    let known = find_message(protocol, message)?;
    match known.set.as_ref().filter(|set| set.kinds.contains(&Kind::Request)) {
        Some(set) => of_members(protocol, model, (known, set), access, (target, source), signals),
        None => Ok(vec![request(protocol, model, access, message, target, source, signals)?]),
    }
}

/// Makes one request for each member of a set; all but the last say that more follow.
fn of_members(
    protocol: &Protocol,
    model: Option<usize>,
    (message, set): (&Message, &Set),
    access: Option<&str>,
    to: (&Target, Option<i64>),
    signals: &[(String, String)],
) -> Result<Vec<Frame>, Refusal> {
    let name = message.accesses.first().map(|known| protocol.accesses[known.access].name.as_str());
    if let Some(other) = access.filter(|access| Some(*access) != name) {
        return Err(refuse(message, &format!("it has no request of the access `{other}`")));
    }
    if let Some((name, _)) = signals.first() {
        return Err(refuse(message, &format!("there is no signal `{name}` to send; it has none")));
    }
    let mut frames = Vec::new();
    for member in set.members.iter().map(|member| &protocol.messages[*member]) {
        let is_of_set = |shape: &&Shape| {
            shape.kind == Kind::Request
                && member.accesses[shape.access].set.is_some_and(|set| protocol.messages[set].name == message.name)
        };
        let shape = member.shapes.iter().find(is_of_set).ok_or_else(|| refuse(member, "nobody requests it"))?;
        frames.push(made(protocol, model, (member, shape), to, signals)?);
    }
    if let Some((_, others)) = frames.split_last_mut() {
        for frame in others {
            continue_after(protocol, frame);
        }
    }
    Ok(frames)
}

/// Lets a frame say that more follow.
fn continue_after(protocol: &Protocol, frame: &mut Frame) {
    let Some(continuation) = protocol.continuation() else { return };
    match continuation.place {
        SelectorPlace::Identifier(field) => {
            let raw = u32::try_from(continuation.raw).unwrap_or(0);
            frame.id = replaced(frame.id, &protocol.identifier.fields[field], raw);
        }
        SelectorPlace::Payload(place) => {
            let mut data = [0; 8];
            data.iter_mut().zip(&frame.data).for_each(|(byte, given)| *byte = *given);
            place.put(&mut data, continuation.raw);
            frame.data = data.into_iter().take(frame.data.len()).collect();
        }
    }
}

/// Makes the frame of a request to a device `model` (an index into [`Protocol::models`]) or to any; a signal that is left
/// out takes its default.
///
/// # Errors
///
/// Refuses what [`super::encode()`] refuses in requests, and a signal that has neither a value nor a default.
pub fn request(
    protocol: &Protocol,
    model: Option<usize>,
    access: Option<&str>,
    message: &str,
    target: &Target,
    source: Option<i64>,
    signals: &[(String, String)],
) -> Result<Frame, Refusal> {
    let message = find_message(protocol, message)?;
    let shape = request_shape(protocol, message, access)?;
    made(protocol, model, (message, shape), (target, source), signals)
}

fn made(
    protocol: &Protocol,
    model: Option<usize>,
    (message, shape): (&Message, &Shape),
    (target, source): (&Target, Option<i64>),
    signals: &[(String, String)],
) -> Result<Frame, Refusal> {
    if let Some(model) = model.filter(|model| !message.is_of(*model)) {
        return Err(not_of(protocol, message, model));
    }
    let mode = mode(protocol, message, shape, target)?;
    let id = identifier(protocol, message, shape, mode, target, source)?;
    let mut data = [0; 8];
    for (selector, value) in &shape.constants {
        if let SelectorPlace::Payload(place) = protocol.selectors[*selector].place {
            place.put(&mut data, *value);
        }
    }
    put_signals(protocol, message, shape, signals, model, &mut data)?;
    let frame = frame(protocol, message, id, data);
    decode(protocol, model, &frame).map_err(|problem| refuse(message, &problem.text))?;
    Ok(frame)
}

fn request_shape<'a>(protocol: &Protocol, message: &'a Message, access: Option<&str>) -> Result<&'a Shape, Refusal> {
    let name = |shape: &Shape| protocol.accesses[message.accesses[shape.access].access].name.as_str();
    let requests = message.shapes.iter().filter(|shape| shape.kind == Kind::Request);
    let is_meant = |shape: &Shape| access.is_none_or(|access| name(shape) == access);
    let is_own = |shape: &Shape| message.accesses[shape.access].set.is_none();
    let has_own = requests.clone().any(|shape| is_own(shape) && is_meant(shape));
    let requests: Vec<_> = requests.filter(|shape| is_own(shape) || !has_own).collect();
    let names: Vec<_> = requests.iter().map(|shape| format!("`{}`", name(shape))).collect();
    let fitting: Vec<_> = requests.into_iter().filter(|shape| is_meant(shape)).collect();
    match (fitting.as_slice(), access) {
        ([shape], _) => Ok(shape),
        ([], Some(access)) if !names.is_empty() => {
            Err(refuse(message, &format!("it has no request of the access `{access}`; it has {}", names.join(", "))))
        }
        ([], _) => Err(refuse(message, "nobody requests it")),
        (_, _) => Err(refuse(message, &format!("say which access: {}", names.join(", ")))),
    }
}

/// Returns the short name of a mode's target: the address type that only this mode leaves open, else the mode.
fn target_name<'a>(protocol: &'a Protocol, mode: &'a Mode) -> &'a str {
    let alone = |index: &usize| protocol.modes.iter().filter(|other| other.target == Some(*index)).count() == 1;
    mode.target.filter(alone).map_or(mode.name.as_str(), |index| protocol.address_types[index].name.as_str())
}

fn mode<'a>(protocol: &'a Protocol, message: &Message, shape: &Shape, target: &Target) -> Result<&'a Mode, Refusal> {
    let answers = &message.accesses[shape.access].answers;
    let allowed = || protocol.modes.iter().zip(answers).filter(|(_, answer)| answer.is_some()).map(|(mode, _)| mode);
    let is_meant = |mode: &&Mode| mode.name == target.name || target_name(protocol, mode) == target.name;
    if let Some(mode) = allowed().find(is_meant) {
        return Ok(mode);
    }
    let names: Vec<_> = allowed().map(|mode| format!("`{}`", written(protocol, mode))).collect();
    let known = protocol.modes.iter().any(|mode| is_meant(&mode));
    let why = if known { "it is not addressed by" } else { "there is no address" };
    Err(refuse(message, &format!("{why} `{}`; write {}", target.name, names.join(", "))))
}

/// Shows how a target is written.
fn written(protocol: &Protocol, mode: &Mode) -> String {
    let name = target_name(protocol, mode);
    if mode.target.is_some() { format!("{name}:N") } else { name.to_owned() }
}

fn identifier(
    protocol: &Protocol,
    message: &Message,
    shape: &Shape,
    mode: &Mode,
    target: &Target,
    source: Option<i64>,
) -> Result<u32, Refusal> {
    let fields = &protocol.identifier.fields;
    let mut id = protocol.identifier.value;
    for field in fields {
        id |= field.send.or(field.normal).unwrap_or(0) << field.shift;
    }
    let Some(pattern) = &mode.request else { return Err(refuse(message, "this mode has no request")) };
    for (selector, value) in &shape.constants {
        if let SelectorPlace::Identifier(field) = protocol.selectors[*selector].place {
            id = replaced(id, &fields[field], u32::try_from(*value).unwrap_or(0));
        }
    }
    id = id & !pattern.mask | pattern.value;
    if mode.target.is_some() != target.number.is_some() {
        return Err(refuse(message, &format!("write the target as `{}`", written(protocol, mode))));
    }
    if source.is_some() && pattern.addresses.iter().all(|address| Some(address.address_type) == mode.target) {
        return Err(refuse(message, &format!("the mode `{}` has no address for a source", mode.name)));
    }
    for address in &pattern.addresses {
        let address_type = &protocol.address_types[address.address_type];
        let number =
            if Some(address.address_type) == mode.target { target.number } else { source.or(address_type.send) };
        let raw = raw_address(message, address_type, number)?;
        id = replaced(id, &fields[address.field], raw);
    }
    Ok(id)
}

fn replaced(id: u32, field: &crate::model::IdentifierField, value: u32) -> u32 {
    id & !field.mask() | value << field.shift
}

fn raw_address(message: &Message, address_type: &AddressType, number: Option<i64>) -> Result<u32, Refusal> {
    let number = number.unwrap_or(address_type.first);
    let raw = u32::try_from(address_type.raw(number)).ok();
    let documented = raw.filter(|_| (address_type.first..=address_type.last).contains(&number));
    documented.ok_or_else(|| {
        let AddressType { name, first, last, .. } = address_type;
        refuse(message, &format!("{name} {number} is outside {first}..{last} ({first:#04X}..{last:#04X})"))
    })
}

fn put_signals(
    protocol: &Protocol,
    message: &Message,
    shape: &Shape,
    given: &[(String, String)],
    model: Option<usize>,
    data: &mut [u8; 8],
) -> Result<(), Refusal> {
    let carried: Vec<_> = shape.signals.iter().map(|index| &message.signals[*index]).collect();
    for (index, (name, _)) in given.iter().enumerate() {
        if carried.iter().all(|signal| signal.name != *name) {
            return Err(refuse(message, &not_carried(protocol, message, shape, name)));
        }
        if given[..index].iter().any(|(earlier, _)| earlier == name) {
            return Err(refuse(message, &format!("the signal `{name}` is given twice")));
        }
    }
    for signal in carried {
        let input = match given.iter().find(|(name, _)| *name == signal.name) {
            Some((_, text)) => parse_input(signal, text),
            None => Input::Raw(
                signal
                    .default_for(model)
                    .ok_or_else(|| refuse(message, &format!("the signal `{}` is missing", signal.name)))?,
            ),
        };
        signal.place.put(data, raw_of(protocol, message, signal, &input, Limits::Range(model))?);
    }
    Ok(())
}

/// Says why a request has no place for a value.
fn not_carried(protocol: &Protocol, message: &Message, shape: &Shape, name: &str) -> String {
    let access = |shape: &Shape| &protocol.accesses[message.accesses[shape.access].access].name;
    let carries = |shape: &&Shape| shape.signals.iter().any(|index| message.signals[*index].name == name);
    let senders = message.shapes.iter().filter(|shape| shape.kind == Kind::Request).filter(carries);
    let senders: Vec<_> = senders.map(|shape| format!("`{}`", access(shape))).collect();
    let sent: Vec<_> = shape.signals.iter().map(|index| format!("`{}`", message.signals[*index].name)).collect();
    match (message.signals.iter().any(|signal| signal.name == name), sent.is_empty()) {
        (true, _) if senders.is_empty() => format!("`{name}` is read only: `{}` asks for it", access(shape)),
        (true, _) => format!("`{}` does not send `{name}`; {} does", access(shape), senders.join(", ")),
        (false, true) => format!("there is no signal `{name}`; `{}` sends none", access(shape)),
        (false, false) => format!("there is no signal `{name}`; `{}` sends {}", access(shape), sent.join(", ")),
    }
}

/// Reads a value as a person types it: `750V`, `750 V`, `750`, `on`, `[fan_fault]`.
pub fn parse_input(signal: &Signal, text: &str) -> Input {
    if matches!(signal.encoding, Encoding::Status(_)) {
        let names = text.trim_start_matches('[').trim_end_matches(']').split(',').map(str::trim);
        let set = names.filter(|name| !name.is_empty()).map(str::to_owned).collect();
        return Input::Status { set, unknown: 0 };
    }
    if !matches!(signal.encoding, Encoding::Number { .. } | Encoding::Float) {
        return Input::Text(text.to_owned());
    }
    let number = signal.unit.and_then(|unit| text.strip_suffix(unit.symbol)).unwrap_or(text).trim();
    match Rational::parse(number) {
        Some(value) => match value.to_integer() {
            Some(whole) => Input::Integer(whole),
            None => Input::Number(value.to_f64()),
        },
        None => Input::Text(text.to_owned()),
    }
}
