//! Makes a request by name: `set_output` to `module:3`.

use super::arrays::parted_texts;
use super::content::{blank_data, constant_data};
use super::continuation::continue_all_but_last;
use super::encode::{confirm, find_message, length_with};
use super::given::Given;
use super::refusal::{not_of, refuse, twice};
use super::transfer::frames;
use super::value::{Limits, raw_of, typed};
use super::{Frame, Input, Refusal, decode, frame};
use crate::model::{
    AddressPattern, AddressType, FrameLayout, Kind, Message, MessageId, Mode, ModelId, Protocol, Set, Signal,
};
use crate::words::number::Rational;

/// Where a request goes.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Target {
    /// The addressing mode, or the address type that only one mode leaves open.
    pub name: String,
    /// Number of the address, if the mode leaves one open.
    pub number: Option<i64>,
}

impl Target {
    /// Reads `broadcast`, `module:3`, `module:0x3B`, or `host:gprs` if the address has a name.
    ///
    /// # Errors
    ///
    /// Says that the text after the colon is neither a number nor a name.
    pub fn parse(protocol: &Protocol, text: &str) -> Result<Self, Refusal> {
        let Some((name, number)) = text.split_once(':') else {
            return Ok(Self { name: text.to_owned(), number: None });
        };
        let is_meant = |mode: &&Mode| mode.name == name || protocol.target_name(mode) == name;
        let targets: Vec<_> = protocol.modes.iter().filter(is_meant).filter_map(|mode| mode.target).collect();
        let is_chosen = |(id, known): &(_, &AddressType)| targets.contains(id) || known.name == name;
        let chosen = protocol.address_types.entries().filter(is_chosen).map(|(_, known)| known);
        Ok(Self { name: name.to_owned(), number: Some(address(chosen, number, &format!("{name}:3"))?) })
    }
}

/// Shows how an address is written.
pub fn written_address(known: &AddressType) -> String {
    known.names.first().map_or_else(|| format!("{:#04X}", known.first), |(_, name)| name.clone())
}

/// Reads the address of a sender: a number, or its name.
///
/// # Errors
///
/// Says that the text is neither.
pub fn source(protocol: &Protocol, text: &str) -> Result<i64, Refusal> {
    let senders = protocol.modes.iter().filter_map(|mode| protocol.controller(mode));
    address(senders.map(|kind| &protocol[kind]), text, "240` or `0xF0")
}

/// Reads an address: a number, or a name of one of the types.
pub fn address<'a>(types: impl Iterator<Item = &'a AddressType>, text: &str, form: &str) -> Result<i64, Refusal> {
    let whole = Rational::parse(text).and_then(Rational::to_integer).and_then(|number| i64::try_from(number).ok());
    if let Some(number) = whole {
        return Ok(number);
    }
    let types: Vec<_> = types.collect();
    types.iter().find_map(|known| known.named(text)).ok_or_else(|| {
        let names = types.iter().flat_map(|known| &known.names);
        let mut quoted: Vec<_> = names.map(|(_, name)| format!("`{name}`")).collect();
        quoted.dedup();
        let others =
            if quoted.is_empty() { String::new() } else { format!(", or one of the names {}", quoted.join(", ")) };
        Refusal(format!("`{text}` is not an address; write `{form}`{others}"))
    })
}

/// Whom a request can go to.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Targets {
    /// Nobody else can be meant.
    One(Target),
    /// How the targets are written, `N` standing for an address.
    Choice(Vec<String>),
}

/// Returns whom a message can be requested of.
///
/// # Errors
///
/// Nobody requests it, or several accesses do and none is named.
pub fn targets(protocol: &Protocol, access: Option<&str>, message: &str) -> Result<Targets, Refusal> {
    let (id, known) = find_message(protocol, message)?;
    let layout = match known.set.as_ref().filter(|set| set.kinds.contains(&Kind::Request)) {
        Some(set) => {
            let member = set.members.first().ok_or_else(|| refuse(known, "nobody requests it"))?;
            layout_of_member(protocol, id, &protocol[*member])?
        }
        None => request_layout(protocol, known, access)?,
    };
    let mut modes: Vec<&Mode> = layout.travels.iter().map(|travel| &protocol[travel.mode]).collect();
    modes.dedup_by_key(|mode| &mode.name);
    let only = |mode: &Mode| match mode.target.map(|target| &protocol[target]) {
        None => Some(None),
        Some(address) => (address.first == address.last).then_some(Some(address.first)),
    };
    match modes.as_slice() {
        [mode] if let Some(number) = only(mode) => {
            Ok(Targets::One(Target { name: protocol.target_name(mode).to_owned(), number }))
        }
        modes => Ok(Targets::Choice(modes.iter().map(|mode| written(protocol, mode)).collect())),
    }
}

/// Returns the accesses by which a message can be requested. First comes the one whose request carries these signals and
/// fewest others.
///
/// # Errors
///
/// There is no such message.
pub fn accesses<'a>(
    protocol: &'a Protocol,
    message: &str,
    signals: &[(String, String)],
) -> Result<Vec<&'a str>, Refusal> {
    let (_, message) = find_message(protocol, message)?;
    let content = protocol.long_message(message).map_or(message, |(_, long)| &long.content);
    let signals = parted_texts(content, signals)?;
    let mut requests = requests_of(protocol, message, |_| true);
    requests.sort_by_key(|frame| {
        let carried = carried(protocol, frame);
        let missing = signals.iter().filter(|(name, _)| !carried.contains(&name.as_str())).count();
        (missing, carried.len())
    });
    let mut names: Vec<_> = requests.into_iter().map(|frame| protocol[frame.access].name.as_str()).collect();
    names.dedup();
    Ok(names)
}

/// Returns the names of the signals that a request carries. Those of a message in parts are the signals of the whole.
fn carried<'a>(protocol: &'a Protocol, frame: &'a FrameLayout) -> Vec<&'a str> {
    match protocol.part_of(frame) {
        Some(long) => protocol[long].content.signals.iter().map(|signal| signal.name.as_str()).collect(),
        None => protocol.signals_of(frame).map(|(_, signal)| signal.name.as_str()).collect(),
    }
}

/// Returns the requests of a message. Those by the accesses of its sets count if none of its own is meant.
fn requests_of<'a>(
    protocol: &'a Protocol,
    message: &'a Message,
    is_meant: impl Fn(&FrameLayout) -> bool,
) -> Vec<&'a FrameLayout> {
    let requests = protocol.layouts_of(message).filter(|frame| frame.is_to_module());
    let has_own = requests.clone().any(|frame| frame.set.is_none() && is_meant(frame));
    requests.filter(|frame| frame.set.is_none() || !has_own).collect()
}

/// Returns the request of a member by the access of its set.
fn layout_of_member<'a>(
    protocol: &'a Protocol,
    set: MessageId,
    member: &'a Message,
) -> Result<&'a FrameLayout, Refusal> {
    let is_of_set = |frame: &&FrameLayout| frame.kind == Kind::Request && frame.set == Some(set);
    protocol.frames_of(member).find(is_of_set).ok_or_else(|| refuse(member, "nobody requests it"))
}

/// Makes the frames of a request to a device model or to any. It is one frame, one for each member of a set, or those of a
/// transport. A signal that is left out takes its default.
///
/// # Errors
///
/// Refuses what [`super::encode()`] refuses in requests, and a signal that has neither a value nor a default.
pub fn requests(
    protocol: &Protocol,
    model: Option<ModelId>,
    access: Option<&str>,
    message: &str,
    target: &Target,
    source: Option<i64>,
    signals: &[(String, String)],
) -> Result<Vec<Frame>, Refusal> {
    let (id, known) = find_message(protocol, message)?;
    if let Some(set) = known.set.as_ref().filter(|set| set.kinds.contains(&Kind::Request)) {
        return of_members(protocol, model, (id, set), access, (target, source), signals);
    }
    let layout = request_layout(protocol, known, access)?;
    let Some((transport, long)) = protocol.carried(layout) else {
        let made = |layout: &_, signals: &[_]| made(protocol, model, (known, layout), (target, source), signals);
        return super::long::typed_frames(protocol, layout, signals, (model, Limits::Range(model)), made);
    };
    if let Some(model) = model.filter(|model| !known.is_of(*model)) {
        return Err(not_of(protocol, known, model));
    }
    let mode = mode(protocol, known, layout, target)?;
    let id = identifier(protocol, known, layout, mode, target, source)?;
    let extent = (long.extent(layout), constant_data(layout));
    let data = super::long::typed(protocol, extent, signals, (model, Limits::Range(model)))?;
    frames(protocol, transport, (layout, id), &data)
}

/// Makes one request for each member of a set. All but the last say that more follow.
fn of_members(
    protocol: &Protocol,
    model: Option<ModelId>,
    (id, set): (MessageId, &Set),
    access: Option<&str>,
    to: (&Target, Option<i64>),
    signals: &[(String, String)],
) -> Result<Vec<Frame>, Refusal> {
    let message = &protocol[id];
    let name = message.exchanges.first().map(|exchange| protocol[exchange.access].name.as_str());
    if let Some(other) = access.filter(|access| Some(*access) != name) {
        return Err(refuse(message, &format!("it has no request of the access `{other}`")));
    }
    if let Some((name, _)) = signals.first() {
        return Err(refuse(message, &format!("there is no signal `{name}` to send; it has none")));
    }
    let mut frames = Vec::new();
    for member in set.members.iter().map(|member| &protocol[*member]) {
        let layout = layout_of_member(protocol, id, member)?;
        frames.push(made(protocol, model, (member, layout), to, signals)?);
    }
    continue_all_but_last(protocol, &mut frames);
    Ok(frames)
}

/// Makes the frame of a request to a device model or to any model. A signal that is left out takes
/// its default.
///
/// # Errors
///
/// Refuses what [`super::encode()`] refuses in requests, and a signal that has neither a value nor a default. Also
/// refuses a message that can be longer than a frame.
pub fn request(
    protocol: &Protocol,
    model: Option<ModelId>,
    access: Option<&str>,
    message: &str,
    target: &Target,
    source: Option<i64>,
    signals: &[(String, String)],
) -> Result<Frame, Refusal> {
    let (_, message) = find_message(protocol, message)?;
    let layout = request_layout(protocol, message, access)?;
    if protocol.carried(layout).is_some() || protocol.part_of(layout).is_some() {
        return Err(refuse(message, "it can be longer than a frame"));
    }
    made(protocol, model, (message, layout), (target, source), signals)
}

fn made(
    protocol: &Protocol,
    model: Option<ModelId>,
    (message, layout): (&Message, &FrameLayout),
    (target, source): (&Target, Option<i64>),
    signals: &[(String, String)],
) -> Result<Frame, Refusal> {
    if let Some(model) = model.filter(|model| !message.is_of(*model)) {
        return Err(not_of(protocol, message, model));
    }
    let mode = mode(protocol, message, layout, target)?;
    let pattern = mode.request.as_ref().ok_or_else(|| refuse(message, "this mode has no request"))?;
    let given = Given::of(protocol, (message, layout), pattern, parted_texts(message, signals)?)?;
    let id = identifier(protocol, message, layout, mode, target, source)?;
    let mut data = blank_data(layout);
    let (id, signals) = (given.put(protocol, id, &mut data), &given.signals);
    let length = length_typed(message, layout, signals, model);
    put_signals(protocol, message, (layout, length), signals, (model, Limits::Range(model)), &mut data)?;
    let frame = frame(protocol, id, data[..length].to_vec());
    let decoded = decode(protocol, model, &frame).map_err(|problem| refuse(message, &problem.text))?;
    confirm(protocol, message, layout, &decoded, model)?;
    Ok(frame)
}

fn request_layout<'a>(
    protocol: &'a Protocol,
    message: &'a Message,
    access: Option<&str>,
) -> Result<&'a FrameLayout, Refusal> {
    let name = |frame: &FrameLayout| protocol[frame.access].name.as_str();
    let is_meant = |frame: &FrameLayout| access.is_none_or(|access| name(frame) == access);
    let requests = requests_of(protocol, message, is_meant);
    let names: Vec<_> = requests.iter().map(|frame| format!("`{}`", name(frame))).collect();
    let fitting: Vec<_> = requests.into_iter().filter(|frame| is_meant(frame)).collect();
    match (fitting.as_slice(), access) {
        ([layout], _) => Ok(layout),
        ([], Some(access)) if !names.is_empty() => {
            Err(refuse(message, &format!("it has no request of the access `{access}`; it has {}", names.join(", "))))
        }
        ([], _) => Err(refuse(message, "nobody requests it")),
        (_, _) => Err(refuse(message, &format!("say which access: {}", names.join(", ")))),
    }
}

fn mode<'a>(
    protocol: &'a Protocol,
    message: &Message,
    layout: &FrameLayout,
    target: &Target,
) -> Result<&'a Mode, Refusal> {
    let allowed = || layout.travels.iter().map(|travel| &protocol[travel.mode]);
    let is_meant = |mode: &&Mode| mode.name == target.name || protocol.target_name(mode) == target.name;
    let has_type = |mode: &&Mode| mode.target.is_some_and(|address| protocol[address].name == target.name);
    let by_type: Vec<&Mode> = allowed().filter(has_type).collect();
    let only = <[&Mode; 1]>::try_from(by_type).ok().map(|[mode]| mode);
    if let Some(mode) = allowed().find(is_meant).or(only) {
        return Ok(mode);
    }
    let names: Vec<_> = allowed().map(|mode| format!("`{}`", written(protocol, mode))).collect();
    let known = protocol.modes.iter().any(|mode| is_meant(&mode));
    let why = if known { "it is not addressed by" } else { "there is no address" };
    Err(refuse(message, &format!("{why} `{}`; write {}", target.name, names.join(", "))))
}

/// Shows how a target is written.
fn written(protocol: &Protocol, mode: &Mode) -> String {
    let name = protocol.target_name(mode);
    if mode.target.is_some() { format!("{name}:N") } else { name.to_owned() }
}

fn identifier(
    protocol: &Protocol,
    message: &Message,
    layout: &FrameLayout,
    mode: &Mode,
    target: &Target,
    source: Option<i64>,
) -> Result<u32, Refusal> {
    let Some(pattern) = &mode.request else { return Err(refuse(message, "this mode has no request")) };
    let mut id = protocol.base_identifier(layout, pattern);
    if mode.target.is_some() != target.number.is_some() {
        return Err(refuse(message, &format!("write the target as `{}`", written(protocol, mode))));
    }
    let controller = protocol.controller(mode);
    if source.is_some() && controller.is_none() {
        return Err(refuse(message, &no_source(mode, pattern)));
    }
    for address in &pattern.addresses {
        let (kind, address_type) = (Some(address.address_type), &protocol[address.address_type]);
        let chosen = if kind == mode.target { target.number } else { source.filter(|_| kind == controller) };
        let raw = raw_address(message, address_type, chosen.or(address_type.send))?;
        id = protocol[address.field].put(id, raw);
    }
    Ok(id)
}

/// Says why a request has no address for a source.
fn no_source(mode: &Mode, pattern: &AddressPattern) -> String {
    let others = pattern.addresses.iter().filter(|address| Some(address.address_type) != mode.target).count();
    let why = if others == 0 { "has no address for a source" } else { "does not show which address is the source" };
    format!("the mode `{}` {why}", mode.name)
}

pub fn raw_address(message: &Message, address_type: &AddressType, number: Option<i64>) -> Result<u32, Refusal> {
    let number = number.unwrap_or(address_type.first);
    let raw = u32::try_from(address_type.raw(number)).ok();
    let documented = raw.filter(|_| address_type.has(number));
    documented.ok_or_else(|| {
        let AddressType { name, first, last, names, .. } = address_type;
        let named: Vec<_> = names.iter().map(|(number, name)| format!("{number:#04X} ({name})")).collect();
        refuse(
            message,
            &match named.as_slice() {
                [] => format!("{name} {number} is outside {first}..{last} ({first:#04X}..{last:#04X})"),
                _ => format!("{name} {number} ({number:#04X}) is none of {}", named.join(", ")),
            },
        )
    })
}

/// Returns how many data bytes a frame has with the signals that are given. Those that only some device models have are
/// there, too, if the chosen one has them.
pub fn length_typed(
    message: &Message,
    layout: &FrameLayout,
    given: &[(String, String)],
    model: Option<ModelId>,
) -> usize {
    let is_given = |signal: &Signal| given.iter().any(|(name, _)| *name == signal.name);
    let is_own = |signal: &Signal| !signal.models.is_empty() && model.is_some_and(|model| signal.is_of(model));
    length_with(message, layout, |signal| is_given(signal) || is_own(signal))
}

pub fn put_signals(
    protocol: &Protocol,
    message: &Message,
    (layout, length): (&FrameLayout, usize),
    given: &[(String, String)],
    (model, limits): (Option<ModelId>, Limits),
    data: &mut [u8; 8],
) -> Result<(), Refusal> {
    let carried: Vec<_> = protocol.signals_of(layout).map(|(_, signal)| signal).collect();
    if let Some((name, _)) = given.iter().find(|(name, _)| carried.iter().all(|signal| signal.name != *name)) {
        return Err(refuse(message, &not_carried(protocol, message, layout, name)));
    }
    if let Some(name) = twice(given) {
        return Err(refuse(message, &format!("the signal `{name}` is given twice")));
    }
    for signal in carried.into_iter().filter(|signal| usize::from(signal.end()) <= length) {
        let given = given.iter().find(|(name, _)| *name == signal.name);
        if let Some(blank) = model.and_then(|model| message.blank(signal, model)).filter(|_| given.is_none()) {
            signal.place.put(data, blank);
            continue;
        }
        let input = match given {
            Some((_, text)) => typed(protocol, message, signal.on(model), text)?,
            None => Input::Raw(
                signal
                    .default_for(model)
                    .ok_or_else(|| refuse(message, &format!("the signal `{}` is missing", signal.name)))?,
            ),
        };
        signal.place.put(data, raw_of(protocol, message, signal.on(model), &input, limits)?);
    }
    Ok(())
}

/// Says why a frame has no place for a value.
fn not_carried(protocol: &Protocol, message: &Message, layout: &FrameLayout, name: &str) -> String {
    let access = &protocol[layout.access].name;
    let carriers = protocol.frames_of(message).filter(|frame| carried(protocol, frame).contains(&name));
    let by = |frame: &FrameLayout| format!("a {} by `{}`", frame.kind.name(), protocol[frame.access].name);
    let is_choice = |frame: &&FrameLayout| frame.is_to_module() || !layout.is_to_module();
    let others: Vec<_> = carriers.clone().filter(is_choice).map(by).collect();
    let sent: Vec<_> = protocol.signals_of(layout).map(|(_, signal)| format!("`{}`", signal.name)).collect();
    match (carriers.count(), others.as_slice(), sent.is_empty()) {
        (0, _, true) => format!("there is no signal `{name}`; `{access}` sends none"),
        (0, _, false) => format!("there is no signal `{name}`; `{access}` sends {}", sent.join(", ")),
        (_, [], _) => format!("`{name}` is read only: `{access}` asks for it"),
        (..) => format!("{} does not carry `{name}`; {} does", by(layout), others.join(", or ")),
    }
}
