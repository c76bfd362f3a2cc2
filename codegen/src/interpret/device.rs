//! Makes a frame that a module sends, by name: a report or a reply of `module:3`.

use super::arrays::parted_texts;
use super::content::{blank_data, constant_data};
use super::encode::find_message;
use super::given::Given;
use super::long::{typed, typed_frames};
use super::refusal::refuse;
use super::request::{Target, address, length_typed, put_signals, raw_address, written_address};
use super::transfer::frames;
use super::{Frame, Limits, Refusal, decode, frame};
use crate::model::{
    AddressPattern, AddressType, FrameLayout, Kind, Message, Mode, ModelId, Protocol, SelectorPlace, Side,
};

/// What a module sends.
#[derive(Clone, Copy, Debug)]
pub struct Sent<'a> {
    /// A reply or a report; `None` for the only one that there is.
    pub kind: Option<Kind>,
    /// The access, if it is named.
    pub access: Option<&'a str>,
    /// The device model, if one is chosen.
    pub model: Option<ModelId>,
    /// The message.
    pub message: &'a str,
    /// The addressing mode or the controller's address, if it is named.
    pub to: Option<&'a Target>,
    /// The module, if the identifier shows it.
    pub source: Option<i64>,
}

impl Sent<'_> {
    /// Tests whether no request is meant, and no report of the controller. Without a kind, it is a message that modules
    /// only report.
    ///
    /// # Errors
    ///
    /// There is no such message.
    pub fn is_of_module(&self, protocol: &Protocol) -> Result<bool, Refusal> {
        let (_, message) = find_message(protocol, self.message)?;
        let mut frames = protocol.layouts_of(message).filter(|frame| self.is_by_access(protocol, frame));
        if let Some(kind) = self.kind {
            return Ok(!frames.any(|frame| frame.kind == kind && frame.sender == Side::Controller));
        }
        let mut frames = frames.peekable();
        let is_reported = |frame: &FrameLayout| frame.kind == Kind::Report && frame.sender == Side::Module;
        Ok(frames.peek().is_some() && frames.all(is_reported))
    }

    fn is_by_access(&self, protocol: &Protocol, frame: &FrameLayout) -> bool {
        self.access.is_none_or(|access| protocol[frame.access].name == access)
    }
}

/// Reads the address of a module: a number, or its name.
///
/// # Errors
///
/// Says that the text is neither.
pub fn module(protocol: &Protocol, text: &str) -> Result<i64, Refusal> {
    let patterns = protocol.modes.iter().flat_map(|mode| [&mode.one, &mode.each, &mode.coordinator]).flatten();
    let addresses = patterns.flat_map(|pattern| &pattern.addresses);
    address(addresses.map(|address| &protocol[address.address_type]), text, "3` or `0x03")
}

/// Makes the frames that a module sends: one, or as many as a long message has parts. A signal that is left out takes
/// its default.
///
/// # Errors
///
/// Refuses values that do not fit, and addresses that the document does not name. It also refuses to choose among
/// kinds of frames, accesses and addressing modes.
pub fn sent(protocol: &Protocol, sent: Sent<'_>, signals: &[(String, String)]) -> Result<Vec<Frame>, Refusal> {
    let (_, message) = find_message(protocol, sent.message)?;
    let layout = layout(protocol, message, sent)?;
    if let Some((transport, long)) = protocol.carried(layout) {
        let (mode, pattern) = way(protocol, message, layout, sent.to)?;
        let id = identifier(protocol, (message, layout), (mode, pattern), sent)?;
        let mut header = constant_data(layout);
        put_normal(protocol, layout, &mut header);
        let data = typed(protocol, (long.extent(layout), header), signals, (sent.model, Limits::Bits))?;
        return frames(protocol, transport, (layout, id), &data);
    }
    let one = |layout: &_, signals: &[_]| one(protocol, sent, layout, signals);
    typed_frames(protocol, layout, signals, (sent.model, Limits::Bits), one)
}

/// Makes one frame that a module sends.
fn one(
    protocol: &Protocol,
    sent: Sent<'_>,
    layout: &FrameLayout,
    signals: &[(String, String)],
) -> Result<Frame, Refusal> {
    let message = &protocol[layout.message];
    let (mode, pattern) = way(protocol, message, layout, sent.to)?;
    let given = Given::of(protocol, (message, layout), pattern, parted_texts(message, signals)?)?;
    let id = identifier(protocol, (message, layout), (mode, pattern), sent)?;
    let mut data = blank_data(layout);
    put_normal(protocol, layout, &mut data);
    let (id, signals) = (given.put(protocol, id, &mut data), &given.signals);
    let length = length_typed(message, layout, signals, sent.model);
    put_signals(protocol, message, (layout, length), signals, (sent.model, Limits::Bits), &mut data)?;
    let frame = frame(protocol, id, data[..length].to_vec());
    let decoded = decode(protocol, sent.model, &frame).map_err(|problem| refuse(message, &problem.text))?;
    if (decoded.message, decoded.kind) == (layout.message, layout.kind) {
        return Ok(frame);
    }
    let shown = format!("such a frame is a {} of `{}`", decoded.kind.name(), protocol[decoded.message].name);
    Err(refuse(message, &shown))
}

/// Finds the kind of frame. Those of sets count if none of the message's own is meant.
fn layout<'a>(protocol: &'a Protocol, message: &'a Message, sent: Sent<'_>) -> Result<&'a FrameLayout, Refusal> {
    let is_meant = |frame: &&FrameLayout| {
        let is_kind = sent.kind.is_none_or(|kind| frame.kind == kind);
        frame.sender == Side::Module && is_kind && sent.is_by_access(protocol, frame)
    };
    let frames: Vec<_> = protocol.layouts_of(message).filter(is_meant).collect();
    let own: Vec<_> = frames.iter().filter(|frame| frame.set.is_none()).copied().collect();
    let kind = sent.kind.unwrap_or(Kind::Report).name();
    let whose = if sent.kind == Some(Kind::Request) {
        "nobody requests it".to_owned()
    } else {
        format!("no module sends a {kind} of it")
    };
    match if own.is_empty() { frames } else { own }.as_slice() {
        [layout] => Ok(layout),
        [] => Err(refuse(message, &whose)),
        several => {
            let names: Vec<_> = several.iter().map(|frame| format!("`{}`", protocol[frame.access].name)).collect();
            Err(refuse(message, &format!("say which access: {}", names.join(" or "))))
        }
    }
}

/// Finds the addressing mode, and what its identifier shows.
fn way<'a>(
    protocol: &'a Protocol,
    message: &Message,
    layout: &'a FrameLayout,
    to: Option<&Target>,
) -> Result<(&'a Mode, &'a AddressPattern), Refusal> {
    let ways: Vec<_> = protocol.patterns_of(layout).map(|(mode, pattern)| (&protocol[mode], pattern)).collect();
    let named = to.and_then(|to| ways.iter().find(|(mode, _)| mode.name == to.name));
    match (named, ways.as_slice()) {
        (Some((mode, _)), _) if to.is_some_and(|to| to.number.is_some()) => {
            Err(refuse(message, &format!("write `--to {}` without a number; `--source` is the module", mode.name)))
        }
        (Some(way), _) | (None, [way]) => Ok(*way),
        (None, []) => Err(refuse(message, "it has no addressing mode")),
        (None, several) => {
            let forms: Vec<_> = several.iter().map(|(mode, _)| format!("`--to {}`", mode.name)).collect();
            Err(refuse(message, &format!("say by which mode, with {}", forms.join(" or "))))
        }
    }
}

/// Puts the addresses into an identifier: that of the module, and those that the spec says are sent.
fn identifier(
    protocol: &Protocol,
    (message, layout): (&Message, &FrameLayout),
    (mode, pattern): (&Mode, &AddressPattern),
    Sent { to, source, .. }: Sent<'_>,
) -> Result<u32, Refusal> {
    let is_module = |known: &AddressType| known.send.is_none();
    let addresses = || pattern.addresses.iter().map(|address| (address.field, &protocol[address.address_type]));
    let to = to.filter(|to| to.name != mode.name);
    if let Some(to) = to.filter(|to| !addresses().any(|(_, known)| known.name == to.name && !is_module(known))) {
        let sender = addresses().find(|(_, known)| is_module(known));
        let sender = sender.map(|(_, known)| format!("; say who sends it, with `--source {}`", written_address(known)));
        let why = format!("such a frame does not go to `{}`{}", to.name, sender.unwrap_or_default());
        return Err(refuse(message, &why));
    }
    if source.is_some() && !addresses().any(|(_, known)| is_module(known)) {
        return Err(refuse(message, &format!("the mode `{}` has no address for a source", mode.name)));
    }
    addresses().try_fold(protocol.base_identifier(layout, pattern), |id, (field, known)| {
        let named = to.filter(|to| to.name == known.name).and_then(|to| to.number);
        let number = if is_module(known) { source } else { named.or(known.send) };
        let missing = || refuse(message, &format!("say who sends it, with `--source {}`", written_address(known)));
        let raw = raw_address(message, known, Some(number.ok_or_else(missing)?))?;
        Ok(protocol[field].put(id, raw))
    })
}

/// Puts what says that a frame reports no error, unless a constant stands there.
fn put_normal(protocol: &Protocol, layout: &FrameLayout, data: &mut [u8; 8]) {
    for id in layout.selectors.iter().filter(|id| layout.constants.iter().all(|known| known.selector != **id)) {
        if let (SelectorPlace::Payload(place), Some(normal)) = (protocol[*id].place, protocol[*id].normal) {
            place.put(data, normal);
        }
    }
}
