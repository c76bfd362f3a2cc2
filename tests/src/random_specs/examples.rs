//! Examples of frames: random frames, and what the interpreter decodes them to.

use canspec_codegen::interpret::{
    Assembled, Assembly, Content, Decoded, Frame, Input, Problem, Reading, Unrecognised, Value as Meaning, decode,
    encode, encode_long, escape,
};
use canspec_codegen::model::{Encoding, Id, Kind, LongMessage, Message, ModelId, Protocol, Signal};
use canspec_codegen::number::Rational;
use serde_yaml::Value;

use super::draft::Draft;
use super::names::Scope;
use super::yaml::{Map, list};
use crate::{Frames, models};

/// How many random frames are tried.
const FRAMES: usize = 24;

/// An example, and where it can stand.
struct Example {
    map: Map,
    kind: Kind,
    /// The message in whose list it can stand, and the one that it names there.
    of: Option<(String, Option<String>)>,
    /// The message that it names in a sequence.
    message: Option<String>,
}

impl Draft {
    /// Adds examples to messages, and sequences of them.
    pub fn add_examples(&mut self, root: &mut Value, protocol: &Protocol) {
        if protocol.modes.is_empty() || protocol.frames.is_empty() || !self.chance(70) {
            return;
        }
        let examples = self.examples(protocol);
        let is_of_transport = |example: &Example| {
            let messages =
                protocol.messages.entries().filter(|(_, known)| example.message.as_ref() == Some(&known.name));
            messages.into_iter().any(|(id, _)| protocol.transport_frame(id).is_some())
        };
        let (in_sequence, in_messages): (Vec<_>, Vec<_>) =
            examples.into_iter().partition(|example| is_of_transport(example) || self.chance(35));
        Self::add_to_messages(root, in_messages);
        self.add_sequence(root, in_sequence);
    }

    /// Returns examples, in an order in which no reply answers a request.
    fn examples(&mut self, protocol: &Protocol) -> Vec<Example> {
        let mut frames = Frames::new(protocol, self.random.u64(..));
        let models: Vec<_> = models(protocol).take(4).collect();
        let mut examples = Vec::new();
        for _ in 0..FRAMES {
            let (model, frame) = (self.one(&models), frames.next_frame());
            examples.extend(match decode(protocol, model, &frame) {
                Ok(decoded) if self.chance(10) => self.cut(protocol, &frame, &decoded),
                Ok(decoded) => self.example(protocol, model, &frame, &decoded),
                Err(unrecognised) => self.failing(protocol, &frame, &unrecognised),
            });
        }
        for _ in 0..4 * FRAMES * protocol.long_messages.len() {
            let (model, frame) = (self.one(&models), frames.next_frame());
            let decoded = decode(protocol, model, &frame).ok();
            examples.extend(decoded.and_then(|decoded| self.of_all_parts(protocol, model, &frame, &decoded)));
        }
        for long in &protocol.long_messages {
            for _ in 0..FRAMES {
                let model = self.one(&models);
                examples.extend(self.of_transfer(protocol, model, long));
            }
        }
        examples.sort_by_key(|example| example.kind == Kind::Request);
        examples
    }

    fn example(
        &mut self,
        protocol: &Protocol,
        model: Option<ModelId>,
        frame: &Frame,
        decoded: &Decoded,
    ) -> Option<Example> {
        let message = &protocol[decoded.message];
        let comes_back = encode(protocol, model, &Content::of(protocol, decoded)).is_ok();
        if model.is_none() && !message.models.is_empty() || !comes_back && decoded.notes.is_empty() {
            return None;
        }
        let printed = written(frame).replacen('#', self.one(&["#", "#", ": ", " "]), 1);
        let mut map = Map::of([(decoded.kind.name(), printed)]);
        if !decoded.signals.is_empty() {
            let means =
                decoded.signals.iter().map(|reading| means(protocol, message[reading.signal].on(model), reading));
            let means: Vec<_> = means.collect::<Option<Vec<_>>>()?;
            let said = means.into_iter().zip(&decoded.signals);
            let means: Vec<_> = said.map(|(text, reading)| self.rounded(text, &reading.value)).collect();
            let short = message.signals.len() == 1 && self.random.bool();
            let names = decoded.signals.iter().map(|reading| message[reading.signal].name.clone());
            let first = if self.chance(20) { self.random.usize(..means.len()) } else { 0 };
            let mut all = Map::of(names.zip(means.clone()).skip(first));
            if self.random.bool() {
                gather(message, &mut all);
            }
            map.put("means", if short { means[0].clone() } else { all.into() });
        }
        if let Some(model) = model {
            map.put("model", protocol.models[model].name.clone());
        }
        if !decoded.notes.is_empty() {
            map.put("notes", list(decoded.notes.iter().map(|note| note.rule.name())));
        }
        self.say_more(&mut map);
        let name = message.name.clone();
        let outer = decoded.set.map_or_else(|| name.clone(), |set| protocol[set].name.clone());
        let inner = decoded.set.map(|_| name.clone());
        Some(Example { map, kind: decoded.kind, of: Some((outer, inner)), message: Some(name) })
    }

    /// Returns an example of all frames of a long message. The frames have the form of `frame`.
    fn of_all_parts(
        &mut self,
        protocol: &Protocol,
        model: Option<ModelId>,
        frame: &Frame,
        decoded: &Decoded,
    ) -> Option<Example> {
        let message = &protocol[decoded.message];
        let (_, long) = protocol.long_message(message).filter(|_| !decoded.signals.is_empty())?;
        let parts = long.parts()?;
        let (number, data) = (message[parts.number].place, parts.data);
        let varying = long.varying().map(|field| field.least..=field.most);
        let count = varying.map(|counts| self.random.usize(counts));
        let mut assembly = Assembly::default();
        assembly.count_as(count);
        let (mut printed, mut ended) = (Vec::new(), Vec::new());
        let bytes_of_data = long.bytes_with(count);
        for index in 0..long.parts_of(bytes_of_data) {
            let mut bytes = frame.padded();
            number.put(&mut bytes, u64::from(long.first(model)?) + index as u64);
            data.put(&mut bytes, self.random.u64(..));
            if let Some(length) = parts.length {
                let behind = ((index + 1) * long.size()).saturating_sub(parts.head() + bytes_of_data);
                let filled = (1_u64 << (8 * behind)) - 1;
                let fill = if long.content.reserved.are_ones { filled } else { 0 };
                let kept = data.get(&bytes) & !filled;
                data.put(&mut bytes, kept | fill);
                if index == 0 {
                    length.place.put(&mut bytes, bytes_of_data as u64);
                }
            }
            let part = Frame { data: bytes[..frame.data.len()].to_vec(), ..frame.clone() };
            let decoded = decode(protocol, model, &part).ok()?;
            ended.extend(assembly.take(protocol, model, (), &part, &decoded).ended);
            printed.push(part);
        }
        let whole = ended.pop()?;
        let made = encode_long(protocol, model, &Content::of_long(protocol, &whole)).ok()?;
        if made != printed || model.is_none() && !message.models.is_empty() {
            return None;
        }
        self.of_whole(protocol, (model, count), (&whole, long), &printed)
    }

    /// Returns an example of all frames of a long message, which mean a whole.
    fn of_whole(
        &mut self,
        protocol: &Protocol,
        (model, count): (Option<ModelId>, Option<usize>),
        (whole, long): (&Assembled<()>, &LongMessage),
        frames: &[Frame],
    ) -> Option<Example> {
        let kind = whole.decoded.kind;
        let mut map = Map::of([(kind.name(), list(frames.iter().map(written)))]);
        let said = whole.decoded.signals.iter().map(|reading| {
            let signal = long.content[reading.signal].on(model);
            Some((signal.name.clone(), means(protocol, signal, reading)?))
        });
        map.put("means", Map::of(said.collect::<Option<Vec<_>>>()?));
        let is_announced = long.parts().is_some_and(|parts| parts.length.is_some());
        if let Some(count) = count.filter(|_| !is_announced) {
            map.put("count", count.to_string());
        }
        if let Some(model) = model {
            map.put("model", protocol.models[model].name.clone());
        }
        if !whole.decoded.notes.is_empty() {
            map.put("notes", list(whole.decoded.notes.iter().map(|note| note.rule.name())));
        }
        self.say_more(&mut map);
        let name = long.content.name.clone();
        Some(Example { map, kind, of: Some((name.clone(), None)), message: Some(name) })
    }

    /// Returns an example of all frames of a message that a transport carries, with random bits.
    fn of_transfer(&mut self, protocol: &Protocol, model: Option<ModelId>, long: &LongMessage) -> Option<Example> {
        let ways = long.frames.iter().flat_map(|layout| protocol.patterns_of(layout).map(move |way| (layout, way.1)));
        let ways: Vec<_> = ways.collect();
        let (layout, pattern) = ways.get(self.random.usize(..=ways.len()))?;
        let id = pattern.addresses.iter().fold(protocol.base_identifier(layout, pattern), |id, address| {
            let raws = protocol[address.address_type].raw_ranges();
            protocol[address.field].put(id, raws.first().map_or(0, |(first, _)| *first))
        });
        let count = long.varying().map(|field| self.random.usize(field.least..=field.most));
        let signals = long.content.signals.iter().filter(|signal| long.is_among(count, signal));
        let content = Content {
            message: long.content.name.clone(),
            access: Some(protocol[layout.access].name.clone()),
            kind: Some(layout.kind),
            identifier: protocol
                .identifier
                .fields
                .iter()
                .map(|field| (field.name.clone(), field.get(id).into()))
                .collect(),
            signals: signals.map(|signal| (signal.name.clone(), self.input(protocol, signal))).collect(),
            ..Content::default()
        };
        let frames = encode_long(protocol, model, &content).ok().filter(|frames| frames.len() > 1)?;
        let mut assembly = Assembly::default();
        let mut ended = Vec::new();
        for frame in &frames {
            let decoded = decode(protocol, model, frame).ok()?;
            ended.extend(assembly.take(protocol, model, (), frame, &decoded).ended);
        }
        let whole = ended.pop()?;
        assert_eq!((whole.incomplete.as_ref(), ended.len()), (None, 0), "a message that was made is whole");
        if model.is_none() && !long.content.models.is_empty() {
            return None;
        }
        self.of_whole(protocol, (model, None), (&whole, long), &frames)
    }

    /// Returns random bits of a signal.
    fn input(&mut self, protocol: &Protocol, signal: &Signal) -> Input {
        if let Some(run) = signal.run {
            let count = self.random.u16(run.least..=run.most);
            let bytes = (0..count).map(|_| self.random.u8(b' '..=b'~')).collect();
            return Input::Bytes { bytes, text: None };
        }
        let bits = self.random.u64(..) & signal.place.max();
        Input::of(protocol, signal, &Reading::of(protocol, (Id::new(0), signal), bits))
    }

    /// Writes some numbers as rounded ones.
    fn rounded(&mut self, text: Value, value: &Meaning) -> Value {
        let number = text.as_str().filter(|number| !number.contains('/'));
        match (number, value) {
            (Some(number), Meaning::Integer(_) | Meaning::Number(_)) if self.chance(20) => format!("~{number}").into(),
            _ => text,
        }
    }

    /// Returns a frame that lacks its last byte.
    fn cut(&mut self, protocol: &Protocol, frame: &Frame, decoded: &Decoded) -> Option<Example> {
        let data = frame.data.split_last().map(|(_, data)| data.to_vec())?;
        let frame = Frame { data, ..frame.clone() };
        let why = decode(protocol, None, &frame).err()?;
        let name = (why.problem == Problem::Length && decoded.set.is_none())
            .then(|| protocol[decoded.message].name.clone())?;
        let mut map = Map::of([(decoded.kind.name(), written(&frame)), ("fails", why.problem.name().to_owned())]);
        self.say_more(&mut map);
        Some(Example { map, kind: decoded.kind, of: Some((name.clone(), None)), message: Some(name) })
    }

    fn failing(&mut self, protocol: &Protocol, frame: &Frame, why: &Unrecognised) -> Option<Example> {
        let problem = why.problem.name();
        let whole = ["identifier", "foreign", "unknown_message"].contains(&problem);
        if !whole || frame.extended != protocol.identifier.extended {
            return None;
        }
        let mut map = Map::of([("reply", written(frame)), ("fails", problem.to_owned())]);
        self.say_more(&mut map);
        Some(Example { map, kind: Kind::Reply, of: None, message: None })
    }

    fn say_more(&mut self, map: &mut Map) {
        if self.chance(50) {
            map.put("origin", self.one(&["ours", "captured"]));
        }
        if self.chance(20) {
            let note = self.text();
            map.put("note", note);
        }
        self.refer(map);
    }

    fn add_to_messages(root: &mut Value, examples: Vec<Example>) {
        for Example { mut map, of, .. } in examples {
            let Some((outer, inner)) = of else { continue };
            if let Some(member) = inner {
                map.put("message", member);
            }
            let entry = root["messages"][outer.as_str()]
                .as_mapping_mut()
                .map(|message| message.entry("examples".into()).or_insert_with(|| Value::Sequence(Vec::new())));
            if let Some(Value::Sequence(known)) = entry {
                known.push(map.into());
            }
        }
    }

    fn add_sequence(&mut self, root: &mut Value, examples: Vec<Example>) {
        let frames: Vec<_> = examples
            .into_iter()
            .map(|Example { mut map, message, .. }| {
                if let Some(name) = message {
                    map.put("message", name);
                }
                map
            })
            .collect();
        if frames.is_empty() {
            return;
        }
        let mut sequence = Map::of([("frames", list(frames))]);
        self.remark(&mut sequence);
        let name = self.names.name(&mut Scope::default());
        if let Some(root) = root.as_mapping_mut() {
            root.insert("examples".into(), Map::of([(name, sequence)]).into());
        }
    }
}

/// Makes lists of the values of arrays, as far as those of the first elements are there.
fn gather(message: &Message, means: &mut Map) {
    for array in &message.arrays {
        let names = array.elements.iter().map(|id| message[*id].name.as_str());
        let values: Vec<_> = names.map_while(|name| means.0.shift_remove(name)).collect();
        if !values.is_empty() {
            means.put(array.name.clone(), list(values));
        }
    }
}

/// Writes a frame as documents print it.
fn written(frame: &Frame) -> String {
    let id = if frame.extended { format!("{:08X}", frame.id) } else { format!("{:03X}", frame.id) };
    frame.data.iter().fold(format!("{id}#"), |text, byte| format!("{text}{byte:02X}"))
}

/// Writes what an example says that a signal means; nothing if it has no value.
fn means(protocol: &Protocol, signal: &Signal, reading: &Reading) -> Option<Value> {
    let text = match &reading.value {
        Meaning::None if !signal.encoding.by_model().is_empty() => signal.raw_of(reading.bits).to_string(),
        Meaning::None => {
            signal.encoding.enumeration()?;
            reading.bits.to_string()
        }
        Meaning::Name(text) | Meaning::Text(text) => escape::written(text),
        Meaning::Integer(value) => quantity(signal, Rational::integer(*value)),
        Meaning::Number(_) => quantity(signal, exact(signal, reading.bits)?),
        Meaning::Status { set, unknown } => {
            let word = &protocol[signal.encoding.status_word()?];
            let names = word.bits.iter().filter(|bit| set >> bit.bit & 1 == 1).map(|bit| bit.name.clone());
            let others = (0..64).filter(|bit| unknown >> bit & 1 == 1).map(|bit| bit.to_string());
            return Some(list(names.chain(others)));
        }
    };
    Some(text.into())
}

fn quantity(signal: &Signal, number: Rational) -> String {
    number.fraction() + &signal.unit_text()
}

/// Returns the exact value of a scaled number; that of a float is often too long to write.
fn exact(signal: &Signal, bits: u64) -> Option<Rational> {
    let Encoding::Number { scale, offset, .. } = &signal.encoding else { return None };
    Rational::integer(signal.raw_of(bits)).times(*scale)?.plus(*offset)
}
