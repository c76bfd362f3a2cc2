//! Encodes a message with its values to a frame.

use super::continuation::continue_all_but_last;
use super::decode::transported;
use super::refusal::{not_of, refuse};
use super::value::{Limits, raw_of};
use super::{Content, Decoded, Frame, Input, Refusal, arrays, decode, frame, long, padded, transfer};
use crate::model::{
    Carrier, FrameLayout, LongMessage, Message, MessageId, ModelId, NoteRule, Parts, Protocol, SelectorPlace, Signal,
    Transport,
};
use crate::words::nearest::nearest;

/// Notes that no request may get. It is refused instead.
const FORBIDDEN: [NoteRule; 2] = [NoteRule::Address, NoteRule::Addressing];

/// Makes the frame that shows `content`, for a device model or for any model.
///
/// # Errors
///
/// Refuses unknown names, missing and superfluous fields and signals, and values that do not fit.
/// Refuses foreign identifiers, and a message that contradicts the identifier or the selectors. In
/// requests, it also refuses values outside their range, and messages that the model does not have.
/// It also refuses addresses and addressing modes that the document does not have.
pub fn encode(protocol: &Protocol, model: Option<ModelId>, content: &Content) -> Result<Frame, Refusal> {
    let (_, message) = find_message(protocol, &content.message)?;
    let content = &*arrays::parted(message, content)?;
    let layout = layout(protocol, message, protocol.frames_of(message), content, identifier(protocol, content)?)?;
    encode_as(protocol, model, (message, layout), content)
}

/// Makes a frame of a known kind.
fn encode_as(
    protocol: &Protocol,
    model: Option<ModelId>,
    (message, layout): (&Message, &FrameLayout),
    content: &Content,
) -> Result<Frame, Refusal> {
    let limits = Limits::of(layout, model);
    let data = payload(protocol, message, layout, content, (model, limits))?;
    let frame = frame(protocol, identifier(protocol, content)?, data);
    let one_that_has_it = model.or_else(|| message.models.first().copied());
    let decoded = decode(protocol, one_that_has_it, &frame).map_err(|problem| refuse(message, &problem.text))?;
    confirm(protocol, message, layout, &decoded, model)?;
    Ok(frame)
}

/// Makes the frames that show a long message, for a device model or for any model.
///
/// # Errors
///
/// Refuses what [`encode()`] refuses, and a message that is never longer than a frame. Without a model, it refuses parts
/// whose numbers depend on it.
pub fn encode_long(protocol: &Protocol, model: Option<ModelId>, content: &Content) -> Result<Vec<Frame>, Refusal> {
    let (_, message) = find_message(protocol, &content.message)?;
    let (_, known) =
        protocol.long_message(message).ok_or_else(|| refuse(message, "it is never longer than a frame"))?;
    let content = &*arrays::parted(&known.content, content)?;
    match &known.carrier {
        Carrier::Parts(parts) => encode_parts(protocol, model, content, (known, parts)),
        Carrier::Transport(transport) => encode_transfer(protocol, model, content, (known, &protocol[*transport])),
    }
}

fn encode_parts(
    protocol: &Protocol,
    model: Option<ModelId>,
    content: &Content,
    (known, parts): (&LongMessage, &Parts),
) -> Result<Vec<Frame>, Refusal> {
    let message = &protocol[known.message];
    let mut selectors = content.selectors.clone();
    let counter = parts.counter.map(|counter| &message[counter].name);
    let given = selectors.iter().position(|(name, _)| Some(name) == counter).map(|place| selectors.remove(place));
    let counter = counter.map(|name| (name.clone(), Input::Integer(given.map_or(0, |(_, value)| value.into()))));
    let bare = Content { selectors: selectors.clone(), ..content.clone() };
    let layout = layout(protocol, message, protocol.frames_of(message), &bare, identifier(protocol, content)?)?;
    let (whole, reserved) = ((known.whole(), [0; 8]), Some(&*content.reserved));
    let data = long::joined(protocol, whole, &content.signals, reserved, (model, Limits::Bits))?;
    // Nothing says whether elements at the end are real, so what looks like filling is tested against no limits.
    let real = long::real(known, model, &data, &content.signals);
    long::joined(protocol, whole, &real, reserved, (model, Limits::of(layout, model)))?;
    let (mut frames, layout) = (Vec::new(), long::without_data(parts, layout));
    for (number, data) in long::parts(known, model, &data)? {
        let number = (message[parts.number].name.clone(), Input::Integer(number.into()));
        let (signals, selectors) = (counter.clone().into_iter().chain([number]).collect(), selectors.clone());
        let part = Content { signals, selectors, arrays: Vec::new(), reserved: Vec::new(), ..content.clone() };
        let mut frame = encode_as(protocol, model, (message, &layout), &part)?;
        frame.data.iter_mut().zip(layout.filled().to_be_bytes()).for_each(|(byte, bits)| *byte |= bits);
        long::put_data(parts, &data, &mut frame);
        frames.push(frame);
    }
    continue_all_but_last(protocol, &mut frames);
    Ok(frames)
}

fn encode_transfer(
    protocol: &Protocol,
    model: Option<ModelId>,
    content: &Content,
    (known, transport): (&LongMessage, &Transport),
) -> Result<Vec<Frame>, Refusal> {
    let message = &protocol[known.message];
    let id = identifier(protocol, content)?;
    let layout = layout(protocol, message, known.frames.iter(), content, id)?;
    let limits = (model, Limits::of(layout, model));
    let mut header = [0; 8];
    put_selectors(protocol, message, layout, content, &mut header)?;
    let extent = (known.extent(layout), header);
    let data = long::joined(protocol, extent, &content.signals, Some(&content.reserved), limits)?;
    let head = data.iter().copied().take(layout.head()).collect();
    let decoded = transported(protocol, model, layout, &frame(protocol, id, head));
    confirm(protocol, message, layout, &decoded, model)?;
    transfer::frames(protocol, transport, (layout, id), &data)
}

/// Finds a message by name.
pub fn find_message<'a>(protocol: &'a Protocol, name: &str) -> Result<(MessageId, &'a Message), Refusal> {
    protocol.messages.entries().find(|(_, message)| message.name == name).ok_or_else(|| {
        let near = nearest(name, protocol.messages.iter().map(|message| message.name.as_str()));
        let hint = near.map_or_else(String::new, |near| format!("; did you mean `{near}`?"));
        Refusal(format!("`{}` has no message `{name}`{hint}", protocol.name))
    })
}

/// Returns how many data bytes a frame has if it carries some of its signals.
pub fn length_with(message: &Message, layout: &FrameLayout, is_there: impl Fn(&Signal) -> bool) -> usize {
    let there = layout.signals.iter().map(|id| &message[*id]).filter(|signal| is_there(signal));
    let needed = there.map(Signal::end).max().unwrap_or(0);
    let fitting = layout.lengths.iter().copied().find(|length| *length >= needed);
    fitting.unwrap_or(layout.longest()).into()
}

/// Builds the identifier from its named fields.
fn identifier(protocol: &Protocol, content: &Content) -> Result<u32, Refusal> {
    let fields = &protocol.identifier.fields;
    if let Some((name, _)) = content.identifier.iter().find(|(name, _)| fields.iter().all(|field| field.name != *name))
    {
        return Err(Refusal(format!("{}: the identifier has no field `{name}`", content.message)));
    }
    fields.iter().try_fold(protocol.identifier.value, |id, field| {
        let given = content.identifier.iter().find(|(name, _)| *name == field.name);
        let (_, value) = given
            .ok_or_else(|| Refusal(format!("{}: the identifier lacks its field `{}`", content.message, field.name)))?;
        let greatest = field.mask() >> field.shift;
        let fits = u32::try_from(*value).ok().filter(|value| *value <= greatest);
        let fits = fits.filter(|value| field.constant.is_none_or(|constant| constant == *value));
        let value = fits.ok_or_else(|| {
            let wanted = field.constant.map_or_else(|| format!("0..{greatest}"), |constant| constant.to_string());
            Refusal(format!("{}: the identifier's {} is {value}, not {wanted}", content.message, field.name))
        })?;
        Ok(field.put(id, value))
    })
}

/// Finds the frame whose constants the identifier and the selectors show.
fn layout<'a>(
    protocol: &'a Protocol,
    message: &Message,
    frames: impl Iterator<Item = &'a FrameLayout> + Clone,
    content: &Content,
    id: u32,
) -> Result<&'a FrameLayout, Refusal> {
    let access = |frame: &FrameLayout| &protocol[frame.access].name;
    let named = |frame: &&FrameLayout| {
        content.access.as_ref().is_none_or(|name| access(frame) == name)
            && content.kind.is_none_or(|kind| frame.kind == kind)
    };
    let shows = |frame: &&FrameLayout| {
        frame.constants.iter().all(|constant| match constant.place {
            SelectorPlace::Identifier(field) => u64::from(protocol[field].get(id)) == constant.value,
            SelectorPlace::Payload(_) => {
                let name = &protocol[constant.selector].name;
                content.selectors.iter().any(|(known, value)| known == name && constant.admits(*value))
            }
        })
    };
    let mut known = frames.clone();
    let mut fitting = frames.filter(named).filter(shows);
    let first = fitting.next().ok_or_else(|| {
        let unknown = content.access.as_ref().filter(|name| !known.any(|frame| access(frame) == *name));
        let other = || "the identifier and the selectors are not those of this message".to_owned();
        refuse(message, &unknown.map_or_else(other, |name| format!("it has no access `{name}`")))
    })?;
    if content.kind.is_some() {
        return Ok(first);
    }
    let bare = frame(protocol, id, vec![0; message.shortest().into()]);
    let kind = decode(protocol, None, &bare).map(|decoded| decoded.kind);
    let all = std::iter::once(first).chain(fitting).collect::<Vec<_>>();
    Ok(all.iter().find(|frame| Ok(frame.kind) == kind).copied().unwrap_or(first))
}

fn payload(
    protocol: &Protocol,
    message: &Message,
    layout: &FrameLayout,
    content: &Content,
    limits: (Option<ModelId>, Limits),
) -> Result<Vec<u8>, Refusal> {
    let mut data = [0; 8];
    let is_given = |signal: &Signal| content.signals.iter().any(|(given, _)| *given == signal.name);
    let told = Some(content.reserved.len()).filter(|told| *told > 0 && layout.has_length(*told));
    let length = told.unwrap_or_else(|| length_with(message, layout, is_given));
    put_selectors(protocol, message, layout, content, &mut data)?;
    put_signals(protocol, message, (layout, length), content, limits, &mut data)?;
    put_reserved(message, (layout, length), content, &mut data)?;
    Ok(data[..length].to_vec())
}

fn put_selectors(
    protocol: &Protocol,
    message: &Message,
    layout: &FrameLayout,
    content: &Content,
    data: &mut [u8; 8],
) -> Result<(), Refusal> {
    let present = |name: &str| layout.selectors.iter().find(|id| protocol[**id].name == name);
    if let Some((name, _)) = content.selectors.iter().find(|(name, _)| present(name).is_none()) {
        return Err(refuse(message, &format!("it has no selector `{name}`")));
    }
    for id in &layout.selectors {
        let selector = &protocol[*id];
        let SelectorPlace::Payload(place) = selector.place else { continue };
        let given = content.selectors.iter().find(|(name, _)| *name == selector.name);
        let (_, value) =
            given.ok_or_else(|| refuse(message, &format!("the selector `{}` is missing", selector.name)))?;
        if *value > place.max() {
            let text = format!("the selector {} is {value}, not 0..{}", selector.name, place.max());
            return Err(refuse(message, &text));
        }
        place.put(data, *value);
    }
    Ok(())
}

fn put_signals(
    protocol: &Protocol,
    message: &Message,
    (layout, length): (&FrameLayout, usize),
    content: &Content,
    (model, limits): (Option<ModelId>, Limits),
    data: &mut [u8; 8],
) -> Result<(), Refusal> {
    let carried = |name: &str| layout.signals.iter().any(|id| message[*id].name == name);
    if let Some((name, _)) = content.signals.iter().find(|(name, _)| !carried(name)) {
        return Err(refuse(message, &format!("a {} has no signal `{name}`", layout.kind.name())));
    }
    let signals = layout.signals.iter().map(|id| &message[*id]);
    for signal in signals.filter(|signal| usize::from(signal.end()) <= length) {
        let given = content.signals.iter().find(|(name, _)| *name == signal.name);
        if let Some(blank) = model.and_then(|model| message.blank(signal, model)).filter(|_| given.is_none()) {
            signal.place.put(data, blank);
            continue;
        }
        let (_, input) = given.ok_or_else(|| refuse(message, &format!("the signal `{}` is missing", signal.name)))?;
        let bits = raw_of(protocol, message, signal.on(model), input, limits)?;
        signal.place.put(data, bits);
    }
    Ok(())
}

fn put_reserved(
    message: &Message,
    (layout, length): (&FrameLayout, usize),
    content: &Content,
    data: &mut [u8; 8],
) -> Result<(), Refusal> {
    if content.reserved.is_empty() {
        return Ok(());
    }
    if content.reserved.len() != length {
        let text = format!("`reserved` has {} bytes instead of {length}", content.reserved.len());
        return Err(refuse(message, &text));
    }
    let bytes = padded(&content.reserved);
    if u64::from_be_bytes(bytes) & layout.covered != 0 {
        return Err(refuse(message, "`reserved` has bits that belong to a signal"));
    }
    data.iter_mut().zip(bytes).for_each(|(byte, bits)| *byte |= bits);
    Ok(())
}

/// Tests that the frame decodes to the content. A request must also keep to the documented
/// addresses and to the messages of the model.
pub fn confirm(
    protocol: &Protocol,
    message: &Message,
    layout: &FrameLayout,
    decoded: &Decoded,
    model: Option<ModelId>,
) -> Result<(), Refusal> {
    let shown = &protocol[decoded.message];
    if let Some(model) =
        model.filter(|model| (shown.name != message.name || layout.is_to_module()) && !message.is_of(*model))
    {
        return Err(not_of(protocol, message, model));
    }
    if decoded.message != layout.message || decoded.kind != layout.kind || decoded.access != layout.access {
        let (found, wanted) = (decoded.kind.name(), layout.kind.name());
        let text = format!("the identifier and the selectors show a {found} of `{}`, not this {wanted}", shown.name);
        return Err(refuse(message, &text));
    }
    let forbidden = decoded.notes.iter().find(|note| FORBIDDEN.contains(&note.rule));
    match forbidden.filter(|_| layout.is_to_module()) {
        Some(note) => Err(refuse(message, &note.text)),
        None => Ok(()),
    }
}
