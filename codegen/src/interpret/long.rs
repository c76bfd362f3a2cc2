//! Reads what the joined parts of a long message say, and makes its parts.

use std::collections::{HashMap, HashSet};
use std::ops::Range;

use super::arrays::parted_texts;
use super::continuation::continue_all_but_last;
use super::oddities::signal_note;
use super::refusal::{refuse, twice};
use super::value::{Limits, bytes_of, raw_of};
use super::{Frame, Input, Note, Reading, Refusal};
use crate::model::{
    Announcement, Extent, FrameLayout, LongMessage, Message, ModelId, NoteRule, Parts, Protocol, Signal, SignalId,
    TextForm,
};
use crate::words::hex;

/// What a call writes for each signal, by name.
type Texts = Vec<(String, String)>;

/// The data of a long message, as far as they came.
pub struct Joined {
    /// The bytes; 0 where one is missing.
    pub data: Vec<u8>,
    /// Which of the bytes came.
    pub came: Vec<bool>,
    /// How many elements the array of varying length has, if that is known.
    pub count: Option<usize>,
    /// Whether a frame said that it is the last one.
    pub is_ended: bool,
}

/// What the joined parts say.
pub struct Values {
    pub signals: Vec<Reading>,
    pub notes: Vec<Note>,
    /// Bits that none of the signals covers.
    pub reserved: Vec<u8>,
}

/// Writes a number of bytes.
pub fn in_bytes(count: usize) -> String {
    if count == 1 { "1 byte".to_owned() } else { format!("{count} bytes") }
}

impl Joined {
    /// Reads the signals whose bytes all came.
    pub fn read(&self, protocol: &Protocol, extent: Extent, model: Option<ModelId>) -> Values {
        let content = &extent.long().content;
        let present =
            extent.signals().filter_map(|(id, signal)| Some((id, signal, self.bytes(extent.long(), signal)?)));
        let signals: Vec<_> = present
            .map(|(id, signal, bytes)| {
                if signal.run.is_some() {
                    return Reading::of_bytes((id, signal), self.data[bytes].to_vec());
                }
                let bits = signal.place.get(&window(&self.data, signal));
                Reading::of(protocol, (id, signal.on(model)), bits)
            })
            .collect();
        let shortest = extent.long().shortest_sent();
        let note = |reading: &Reading| signal_note(protocol, (content, shortest), model, reading);
        let mut notes: Vec<_> = signals.iter().filter_map(note).collect();
        notes.extend(self.count_note(extent, model));
        let covered = signals.iter().map(|known| (&content[known.signal], Some(known.bytes.len())));
        let reserved = without(&self.data, extent, covered);
        notes.extend(self.reserved_note(extent));
        Values { signals, notes, reserved }
    }

    /// Returns the bytes of a signal, if all of them came. An element beyond the known number is none.
    fn bytes(&self, long: &LongMessage, signal: &Signal) -> Option<Range<usize>> {
        let mut bytes = signal.bytes();
        if let Some(run) = signal.run.filter(|run| run.varies()) {
            let end = signal.reach_with(self.count);
            // Only what says that it has ended may be shorter than it was announced.
            let is_announced = self.count.is_some() && !self.is_ended;
            let end = if is_announced { end } else { end.min(self.data.len()) };
            bytes.end = end.max(bytes.start + usize::from(run.least));
        }
        let came = self.came.get(bytes.clone()).filter(|_| long.is_among(self.count, signal))?;
        came.iter().all(|came| *came).then_some(bytes)
    }

    /// Notes that some of the elements may be none, if the device model has any.
    fn count_note(&self, extent: Extent, model: Option<ModelId>) -> Option<Note> {
        let field = extent.varying().filter(|_| self.count.is_none() && !self.is_ended)?;
        let is_had = |signal: &Signal| model.is_none_or(|model| signal.is_of(model));
        if !extent.signals().any(|(_, signal)| extent.long().varies(signal) && is_had(signal)) {
            return None;
        }
        let what = if field.is_text { "bytes" } else { "elements" };
        let text = format!("nothing says how many of the {what} of `{}` are real", field.name);
        Some(Note { rule: NoteRule::Count, text })
    }

    /// Notes bits that nothing covers, if they are not as they are sent.
    fn reserved_note(&self, extent: Extent) -> Option<Note> {
        let reserved = extent.long().content.reserved;
        let named = || extent.signals().map(|(_, signal)| (signal, None));
        let mut odd = without(&self.data, extent, named());
        if reserved.are_ones {
            let unnamed = without(&vec![0xFF; self.data.len()], extent, named());
            odd.iter_mut().zip(unnamed).for_each(|(byte, unnamed)| *byte ^= unnamed);
        }
        let found = if reserved.are_ones { "clear" } else { "set" };
        let text = format!("bits are {found} that no field has: 0x{}", hex::digits(&odd));
        let is_odd = odd.iter().zip(&self.came).any(|(byte, came)| *came && *byte != 0);
        (is_odd && !reserved.are_free).then_some(Note { rule: NoteRule::ReservedBit, text })
    }
}

/// Returns the bits of data that neither the header nor one of these signals covers. Beside each stands the number of
/// bytes of a text whose length varies; without one it is the longest.
fn without<'s>(data: &[u8], extent: Extent, signals: impl Iterator<Item = (&'s Signal, Option<usize>)>) -> Vec<u8> {
    let mut rest = data.to_vec();
    rest.iter_mut().zip(extent.header().to_be_bytes()).for_each(|(byte, mask)| *byte &= !mask);
    for (signal, count) in signals {
        let start = usize::from(signal.window);
        let bytes = rest.iter_mut().skip(start);
        match signal.run {
            Some(_) => bytes.take(signal.reach_with(count) - start).for_each(|byte| *byte = 0),
            None => bytes.zip(signal.place.mask()).for_each(|(byte, mask)| *byte &= !mask),
        }
    }
    rest
}

/// Returns the eight bytes in which a signal has its place.
fn window(data: &[u8], signal: &Signal) -> [u8; 8] {
    let mut window = [0; 8];
    window.iter_mut().zip(data.iter().skip(signal.window.into())).for_each(|(byte, given)| *byte = *given);
    window
}

/// Makes the data of a long message. `header` has the bits of its constants and selectors. Elements of the array of varying
/// length may be missing at its end, and so may what lies beyond the shortest length. Without `reserved`, bits that nothing
/// covers are as they are sent, and a signal that is left out takes its default. One that the device model does not have
/// may always be left out.
pub fn joined(
    protocol: &Protocol,
    (extent, header): (Extent, [u8; 8]),
    given: &[(String, Input)],
    reserved: Option<&[u8]>,
    (model, limits): (Option<ModelId>, Limits),
) -> Result<Vec<u8>, Refusal> {
    let given = Given { protocol, extent, inputs: known(extent, given)?, reserved, model, limits };
    let (long, content) = (extent.long(), &extent.long().content);
    let count = given.count()?;
    let mut data = vec![0; given.length(count)?];
    if reserved.is_none() && content.reserved.are_ones {
        data.fill(0xFF);
    }
    data.iter_mut().zip(reserved.unwrap_or_default()).for_each(|(byte, given)| *byte = *given);
    for (byte, (bits, mask)) in data.iter_mut().zip(header.into_iter().zip(extent.header().to_be_bytes())) {
        *byte = *byte & !mask | bits & mask;
    }
    let is_meant = |signal: &Signal| long.is_among(count, signal) || given.blank(signal).is_some();
    let is_there = |signal: &&Signal| is_meant(signal) && signal.reach_with(count) <= data.len();
    for signal in extent.signals().map(|(_, signal)| signal).filter(is_there).collect::<Vec<_>>() {
        let places = data.iter_mut().skip(signal.window.into());
        if signal.run.is_some() {
            places.zip(given.text(signal)?).for_each(|(place, byte)| *place = byte);
            continue;
        }
        let bits = given.bits(signal)?;
        let mut bytes = window(&data, signal);
        signal.place.put(&mut bytes, bits);
        data.iter_mut().skip(signal.window.into()).zip(bytes).for_each(|(byte, new)| *byte = new);
    }
    Ok(data)
}

/// Returns the values that are given by the names of their signals.
fn known<'g>(extent: Extent, given: &'g [(String, Input)]) -> Result<HashMap<&'g str, &'g Input>, Refusal> {
    let names: HashSet<_> = extent.signals().map(|(_, signal)| signal.name.as_str()).collect();
    match given.iter().find(|(name, _)| !names.contains(&**name)) {
        Some((name, _)) => Err(refuse(&extent.long().content, &format!("there is no signal `{name}`"))),
        None => Ok(given.iter().map(|(name, input)| (name.as_str(), input)).collect()),
    }
}

/// What is given for the data of a long message.
struct Given<'a> {
    protocol: &'a Protocol,
    extent: Extent<'a>,
    /// Values by the names of their signals.
    inputs: HashMap<&'a str, &'a Input>,
    reserved: Option<&'a [u8]>,
    model: Option<ModelId>,
    limits: Limits,
}

impl Given<'_> {
    fn content(&self) -> &Message {
        &self.extent.long().content
    }

    fn has(&self, signal: &Signal) -> bool {
        self.inputs.contains_key(&*signal.name)
    }

    /// Returns the least number of bytes, which is that of the reserved ones.
    fn told(&self) -> usize {
        self.reserved.unwrap_or_default().len()
    }

    /// Returns the bits of a signal that is left out since the device model does not have it.
    fn blank(&self, signal: &Signal) -> Option<u64> {
        self.content().blank(signal, self.model?).filter(|_| !self.has(signal))
    }

    fn missing(&self, signal: &Signal) -> Refusal {
        refuse(self.content(), &format!("the signal `{}` is missing", signal.name))
    }

    /// Returns the bytes of a text.
    fn text(&self, signal: &Signal) -> Result<Vec<u8>, Refusal> {
        if let Some(blank) = self.blank(signal) {
            let start = usize::from(signal.window);
            let bytes = signal.reach_with(Some(self.told().saturating_sub(start))) - start;
            return Ok(vec![u8::try_from(blank).unwrap_or(u8::MAX); bytes]);
        }
        let input = self.inputs.get(&*signal.name).ok_or_else(|| self.missing(signal))?;
        bytes_of(self.protocol, self.content(), signal, input, self.limits)
    }

    /// Returns the bits of any other signal.
    fn bits(&self, signal: &Signal) -> Result<u64, Refusal> {
        if let Some(blank) = self.blank(signal) {
            return Ok(blank);
        }
        let has_default = self.reserved.is_none() && self.extent.long().counted(signal).is_none();
        let default = signal.default_for(self.model).filter(|_| has_default).map(Input::Raw);
        let input = self.inputs.get(&*signal.name).copied().or(default.as_ref());
        let input = input.ok_or_else(|| self.missing(signal))?;
        raw_of(self.protocol, self.content(), signal.on(self.model), input, self.limits)
    }

    /// Returns how many elements the arrays of varying length have, or how many bytes the open text, if there are any.
    fn count(&self) -> Result<Option<usize>, Refusal> {
        if let Some((signal, _)) = self.extent.open_text() {
            return self.text(signal).map(|bytes| Some(bytes.len()));
        }
        let given = self.extent.signals().map(|(_, signal)| signal).filter(|signal| self.has(signal));
        let given = given.filter_map(|signal| self.extent.long().counted(signal)).map(|index| index + 1).max();
        Ok(self.extent.varying().map(|array| given.unwrap_or(0).max(array.least)))
    }

    /// Returns how many bytes the message has, at least those of the reserved ones. What only some device models have is
    /// there if it is given. Where nothing is reserved, it is also there if the chosen one has it.
    fn length(&self, count: Option<usize>) -> Result<usize, Refusal> {
        let Self { extent, model, reserved, .. } = self;
        let (long, told) = (extent.long(), self.told());
        let too_long =
            |most: usize| refuse(&long.content, &format!("`reserved` has {told} bytes, which are more than {most}"));
        if extent.lengths().is_empty() {
            let length = extent.bytes_with(count).max(told);
            let most = match long.parts() {
                Some(parts) if parts.length.is_none() => long.parts_of(long.longest()) * long.size(),
                _ => extent.bytes_with(count),
            };
            return if length > most { Err(too_long(most)) } else { Ok(length) };
        }
        let model = model.filter(|_| reserved.is_none());
        let is_own = |signal: &Signal| !signal.models.is_empty() && model.is_some_and(|model| signal.is_of(model));
        let there = long.content.signals.iter().filter(|signal| self.has(signal) || is_own(signal));
        let needed = there.map(Signal::reach).max().unwrap_or(0).max(told);
        let mut lengths = extent.lengths().iter().map(|length| usize::from(*length));
        lengths.find(|length| *length >= needed).ok_or_else(|| too_long(extent.longest()))
    }
}

/// Returns the number of each part, and its data.
pub fn parts(long: &LongMessage, model: Option<ModelId>, data: &[u8]) -> Result<Vec<(u16, Vec<u8>)>, Refusal> {
    let first = long.first(model).ok_or_else(|| {
        let text = "the first part has another number on each model; choose a model";
        refuse(&long.content, text)
    })?;
    let mut parts = filled(long, model, data);
    if let Some(length) = long.parts().and_then(|parts| parts.length) {
        put_length(length, data.len(), &mut parts);
    }
    Ok((first..).zip(parts.chunks(long.size()).map(<[u8]>::to_vec)).collect())
}

/// Puts the data of a part into its frame.
pub fn put_data(parts: &Parts, data: &[u8], frame: &mut Frame) {
    let mut payload = frame.padded();
    parts.data.put(&mut payload, data.iter().fold(0, |word, byte| word << 8 | u64::from(*byte)));
    frame.data = payload.into_iter().take(frame.data.len()).collect();
}

/// Returns the frame of a part without its data, which have no limits of their own.
pub fn without_data(parts: &Parts, layout: &FrameLayout) -> FrameLayout {
    let signals = parts.counter.into_iter().chain([parts.number]).collect();
    FrameLayout { signals, ..layout.clone() }
}

/// Writes the number of data bytes before the data.
fn put_length(length: Announcement, bytes: usize, parts: &mut Vec<u8>) {
    let mut frame = [0; 8];
    length.place.put(&mut frame, u64::try_from(bytes).unwrap_or(u64::MAX));
    let said = frame.into_iter().zip(length.place.mask()).filter(|(_, mask)| *mask != 0);
    parts.splice(0..0, said.map(|(byte, _)| byte));
}

/// Fills up the last part.
fn filled(long: &LongMessage, model: Option<ModelId>, data: &[u8]) -> Vec<u8> {
    let head = long.parts().map_or(0, Parts::head);
    let (mut whole, length) = (data.to_vec(), long.parts_of(data.len()) * long.size() - head);
    if head == 0
        && let Some((text, _)) = long.open_text()
        && model.is_none_or(|model| text.is_of(model))
        && let Some(TextForm::Ascii { fill }) = text.encoding.text_form()
    {
        whole.resize(text.reach().min(length).max(data.len()), fill);
    }
    whole.resize(length, if long.content.reserved.are_ones { 0xFF } else { 0 });
    whole
}

/// Returns what is given without those elements at the end that look like what fills up the last part. A message that
/// says its length has none.
pub fn real(
    long: &LongMessage,
    model: Option<ModelId>,
    data: &[u8],
    given: &[(String, Input)],
) -> Vec<(String, Input)> {
    let is_open = long.parts().is_some_and(|parts| parts.length.is_none());
    let array = long.varying().filter(|field| is_open && !field.is_text);
    let whole = filled(long, model, data);
    let is_enough = |count: &usize| {
        let start = data.get(..long.bytes_with(Some(*count)));
        start.is_some_and(|start| filled(long, model, start) == whole)
    };
    let count = array.and_then(|array| (array.least..array.most).find(is_enough));
    let is_real = |name: &str| {
        let signal = long.content.signals.iter().find(|signal| signal.name == name);
        signal.is_none_or(|signal| long.is_among(count, signal))
    };
    given.iter().filter(|(name, _)| is_real(name)).cloned().collect()
}

/// Makes the frames of what a call writes: one, or as many as a message in parts has. `one` makes a frame of the texts for
/// its signals.
pub fn typed_frames(
    protocol: &Protocol,
    layout: &FrameLayout,
    given: &[(String, String)],
    limits: (Option<ModelId>, Limits),
    one: impl Fn(&FrameLayout, &[(String, String)]) -> Result<Frame, Refusal>,
) -> Result<Vec<Frame>, Refusal> {
    let long = protocol.part_of(layout).map(|id| &protocol[id]);
    let parted = long.and_then(|long| Some((long, long.parts()?)));
    let Some((long, parts)) = parted.filter(|known| !is_one_part(protocol, *known, layout, given)) else {
        return Ok(vec![one(layout, given)?]);
    };
    let layout = without_data(parts, layout);
    let made = |(texts, data): (Texts, Vec<u8>)| {
        let mut frame = one(&layout, &texts)?;
        put_data(parts, &data, &mut frame);
        Ok(frame)
    };
    let typed = typed_parts(protocol, (long, parts), given, limits)?.into_iter();
    let mut frames = typed.map(made).collect::<Result<Vec<_>, _>>()?;
    continue_all_but_last(protocol, &mut frames);
    Ok(frames)
}

/// Tests whether what is given is one frame of a module, by a signal that only a frame has. To a module goes the whole
/// alone, since its limits are those of its signals.
fn is_one_part(
    protocol: &Protocol,
    (long, parts): (&LongMessage, &Parts),
    layout: &FrameLayout,
    given: &[(String, String)],
) -> bool {
    let signals = protocol[long.message].signals.entries().filter(|(id, _)| Some(*id) != parts.counter);
    let names: HashSet<_> = signals.map(|(_, signal)| signal.name.as_str()).collect();
    let is_of_frame = |name: &str| names.contains(name) && !is_of_whole(long, name);
    !layout.is_to_module() && given.iter().any(|(name, _)| is_of_frame(name))
}

/// Tests whether a name is that of a signal or of a field of the whole. These come before those of a frame.
fn is_of_whole(long: &LongMessage, name: &str) -> bool {
    let mut signals = long.content.signals.iter();
    signals.any(|signal| signal.name == name || long.content.field_name(signal) == name)
}

/// Returns the texts for the signals of each frame that stand beside its data, and the data.
fn typed_parts(
    protocol: &Protocol,
    (long, carried): (&LongMessage, &Parts),
    given: &[(String, String)],
    (model, limits): (Option<ModelId>, Limits),
) -> Result<Vec<(Texts, Vec<u8>)>, Refusal> {
    let name = |id: SignalId| &protocol[long.message][id].name;
    let (number, counter) = (name(carried.number), carried.counter.map(name));
    let (counters, given): (Vec<_>, Vec<_>) =
        given.iter().cloned().partition(|(name, _)| Some(name) == counter && !is_of_whole(long, name));
    let counters = if counters.is_empty() {
        counter.map(|name| (name.clone(), "0".to_owned())).into_iter().collect()
    } else {
        counters
    };
    let joined = typed(protocol, (long.whole(), [0; 8]), &given, (model, limits))?;
    let parts = parts(long, model, &joined)?.into_iter();
    let texts = |part: u16| [(number.clone(), part.to_string())].into_iter().chain(counters.clone()).collect();
    Ok(parts.map(|(part, data)| (texts(part), data)).collect())
}

/// Makes the data of a long message of what a call writes. A signal that is left out takes its default, if it has one.
pub fn typed(
    protocol: &Protocol,
    (extent, header): (Extent, [u8; 8]),
    given: &[(String, String)],
    (model, limits): (Option<ModelId>, Limits),
) -> Result<Vec<u8>, Refusal> {
    let (mut inputs, long) = (Vec::new(), extent.long());
    for (name, text) in parted_texts(&long.content, given)? {
        let signal = long.content.signals.iter().find(|signal| signal.name == name);
        let input = match signal {
            Some(signal) => super::value::typed(protocol, &long.content, signal.on(model), &text)?,
            None => Input::Text(text),
        };
        inputs.push((name, input));
    }
    if let Some(name) = twice(&inputs) {
        return Err(refuse(&long.content, &format!("the signal `{name}` is given twice")));
    }
    joined(protocol, (extent, header), &inputs, None, (model, limits))
}
