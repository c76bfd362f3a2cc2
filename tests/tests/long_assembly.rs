//! Parts that are lost, repeated, late and mixed: both engines put the same messages together, and miss the same parts.

use std::fmt::Debug;

use canspec_codegen::interpret::{Assembled, Assembly, Form, Frame, decode};
use canspec_codegen::model::{
    AddressPattern, FrameLayout, Kind, LongMessage, MessageId, ModelId, Protocol, SelectorPlace, SignalId,
};
use canspec_runtime::Place;
use canspec_runtime::parts::{Assembler, Outcome, Parted};
use canspec_tests::long::{is_same, long, member};
use canspec_tests::{Optional, PartedVisitor, models, number, protocol, received, visit_parted};
use embedded_can::Frame as _;
use fastrand::Rng;

/// How many frames each message sees, for each device model.
const FRAMES: usize = 20_000;

/// What is sent on a bus with several devices: parts mostly in their order, requests, and numbers of elements.
struct Bus<'a> {
    protocol: &'a Protocol,
    long: &'a LongMessage,
    first: u64,
    rng: Rng,
    /// How many parts each device has sent of its message.
    sent: [u64; 8],
    /// How many messages each device has begun.
    begun: [u64; 8],
    last: Option<Frame>,
}

impl Bus<'_> {
    fn next_frame(&mut self) -> Frame {
        let frame = match (self.rng.u8(..24), self.last.take()) {
            (0, _) => self.request().unwrap_or_else(|| self.part()),
            (1 | 2, _) => self.count().unwrap_or_else(|| self.part()),
            (3 | 4, Some(last)) => last,
            _ => self.part(),
        };
        self.last = Some(frame.clone());
        frame
    }

    /// Returns the next part of a device. Sometimes it is another one, and sometimes none.
    fn part(&mut self) -> Frame {
        let device = self.rng.usize(..self.sent.len());
        let parts = u64::try_from(self.long.parts_of(self.long.longest())).expect("a few parts");
        self.sent[device] = match self.rng.u8(..12) {
            0 => self.rng.u64(..parts + 2),
            1 => self.sent[device] + 2,
            _ => self.sent[device] + 1,
        };
        if self.sent[device] >= parts || self.rng.u8(..9) == 0 {
            self.sent[device] = 0;
        }
        self.begun[device] += u64::from(self.sent[device] == 0 || self.rng.u8(..32) == 0);
        let number = (self.first + self.sent[device]).saturating_sub(u64::from(self.rng.u8(..32) == 0));
        let parts = self.long.parts().expect("its frames have numbers");
        let place = |signal: SignalId| self.protocol[self.long.message][signal].place;
        let (at, counter) = (place(parts.number), parts.counter.map(place));
        let mut values = vec![(at, number), (parts.data, self.data(number))];
        values.extend(counter.map(|counter| (counter, self.begun[device])));
        self.sent_frame(self.long.message, Kind::Reply, device, &values)
            .or_else(|| self.sent_frame(self.long.message, Kind::Report, device, &values))
            .expect("modules send parts")
    }

    /// Returns the data of a part. The first one mostly announces a length that the message can have.
    fn data(&mut self, number: u64) -> u64 {
        let parts = self.long.parts().expect("its frames have numbers");
        let any = self.rng.u64(..);
        let Some(length) = parts.length.filter(|_| number == self.first && self.rng.u8(..12) > 0) else { return any };
        let lengths: Vec<_> = (0..=self.long.longest()).filter(|length| self.long.has_length(*length)).collect();
        let said = u64::try_from(*self.rng.choice(&lengths).expect("it has a length")).expect("a few bytes");
        let mut frame = [0; 8];
        parts.data.put(&mut frame, any & parts.data.max());
        length.place.put(&mut frame, said);
        parts.data.get(&frame)
    }

    fn request(&mut self) -> Option<Frame> {
        let device = self.rng.usize(..self.sent.len());
        self.sent_frame(self.long.message, Kind::Request, device, &[])
    }

    fn count(&mut self) -> Option<Frame> {
        let ((message, signal), device) = (self.long.parts()?.count?, self.rng.usize(..self.sent.len()));
        let value = self.rng.u64(..12);
        let place = self.protocol[message][signal].place;
        self.sent_frame(message, Kind::Reply, device, &[(place, value)])
    }

    /// Builds a frame of a device.
    fn sent_frame(&mut self, message: MessageId, kind: Kind, device: usize, values: &[(Place, u64)]) -> Option<Frame> {
        let protocol = self.protocol;
        let layout = protocol.frames_of(&protocol[message]).find(|frame| frame.kind == kind)?;
        let (_, pattern) = protocol.patterns_of(layout).next()?;
        let mut data = self.rng.u64(..).to_be_bytes();
        for (place, value) in layout.payload() {
            place.put(&mut data, value);
        }
        for (place, value) in values {
            place.put(&mut data, *value & place.max());
        }
        let mut id = self.identifier(layout, pattern, device);
        if let Some(continuation) = protocol.continuation().filter(|_| self.rng.u8(..5) > 0) {
            match continuation.place {
                SelectorPlace::Identifier(field) => {
                    id = protocol[field].put(id, u32::try_from(continuation.raw).expect("a field of the identifier"));
                }
                SelectorPlace::Payload(place) => place.put(&mut data, continuation.raw),
            }
        }
        let data = data[..layout.longest().into()].to_vec();
        Some(Frame { id, extended: protocol.identifier.extended, data, form: Form::Data })
    }

    /// Returns an identifier with the addresses of a device.
    fn identifier(&self, layout: &FrameLayout, pattern: &AddressPattern, device: usize) -> u32 {
        let id = self.protocol.base_identifier(layout, pattern);
        pattern.addresses.iter().fold(id, |id, address| {
            let (kind, field) = (&self.protocol[address.address_type], &self.protocol[address.field]);
            let (first, last) = kind.raw_ranges()[0];
            let device = u32::try_from(device).expect("a few devices");
            field.put(id, if kind.send.is_some() { first } else { first + device % (last - first + 1) })
        })
    }
}

struct Agreement {
    whole: usize,
    incomplete: usize,
}

impl Agreement {
    fn on_model<L: Parted + Optional + Debug>(&mut self, protocol: &Protocol, model: Option<ModelId>) {
        let long = long::<L>(protocol);
        let first = long.first(model).unwrap_or_default().into();
        let rng = Rng::with_seed(0xA55E);
        let mut bus = Bus { protocol, long, first, rng, sent: [0; 8], begun: [0; 8], last: None };
        let mut assembly = Assembly::default();
        let mut assembler = Assembler::<L, 16>::new(u32::MAX);
        if let Some(model) = model {
            assembler = assembler.for_model(number(model));
        }
        let mut now = 0;
        for _ in 0..FRAMES {
            now += if bus.rng.u8(..10) == 0 { 100 } else { 3 };
            let frame = bus.next_frame();
            let decoded = decode(protocol, model, &frame).expect("the frame is one of the protocol");
            let stamp = Some(u64::from(now) * 1_000_000);
            let mut interpreted = assembly.take_at(stamp, (protocol, model), (), &frame, &decoded).ended;
            let received = received::<L::Protocol>(model, &frame).expect("the frame is one of the protocol");
            let mut generated: Vec<_> = std::iter::from_fn(|| assembler.timed_out(now)).collect();
            generated.extend(assembler.take(&received, now));
            interpreted.sort_by_key(|message| message.frame.id);
            generated.sort_by_key(|outcome| frame_of(outcome).raw_id());
            self.compare(protocol, model, &interpreted, &generated);
        }
        let mut interpreted = assembly.finish(protocol, model);
        let mut generated: Vec<_> = std::iter::from_fn(|| assembler.finish()).collect();
        interpreted.sort_by_key(|message| message.frame.id);
        generated.sort_by_key(|outcome| frame_of(outcome).raw_id());
        self.compare(protocol, model, &interpreted, &generated);
    }

    fn compare<L: Parted + Optional + Debug>(
        &mut self,
        protocol: &Protocol,
        model: Option<ModelId>,
        interpreted: &[Assembled<()>],
        generated: &[Outcome<L>],
    ) {
        assert_eq!(interpreted.len(), generated.len(), "{interpreted:?} and {generated:?}");
        let first = long::<L>(protocol).first(model);
        for (message, outcome) in interpreted.iter().zip(generated) {
            let (id, frame) = (message.frame.id, frame_of(outcome));
            assert_eq!((id, message.frame.data.as_slice()), (frame.raw_id(), frame.data()), "{message:?}");
            match outcome {
                Outcome::Whole(whole) => {
                    self.whole += 1;
                    assert!(message.incomplete.is_none(), "{message:?} and {outcome:?}");
                    compare_values(protocol, message, &whole.values);
                    let is_noted = message.decoded.notes.iter().any(|note| note.rule.name() == "count");
                    assert_eq!(whole.is_counted, !is_noted, "{message:?} and {outcome:?}");
                }
                Outcome::Incomplete(partial) => {
                    self.incomplete += 1;
                    let missing: Vec<_> = partial.missing().map(|number| number.to_string()).collect();
                    assert!(first.is_some());
                    let text = message.incomplete.as_ref().unwrap_or_else(|| panic!("{message:?} and {outcome:?}"));
                    let wrong = partial.announced().filter(|length| !long::<L>(protocol).has_length(*length));
                    // The last part is marked before all fields came.
                    let short = (missing.is_empty() && wrong.is_none()).then(|| partial.data().len());
                    let said = wrong.or(short).map(|length| format!("{length} byte")).unwrap_or_default();
                    assert_eq!(text.contains("announced"), wrong.is_some(), "{text}");
                    assert_eq!(text.contains("came, but"), short.is_some(), "{text}");
                    assert!(short.is_none_or(|length| length < L::SHORTEST), "{text}");
                    assert!(text.split("; ").any(|part| part.starts_with(&said)), "{text}");
                    assert!(text.contains(&missing.join(", ")), "{text}");
                }
                Outcome::Full(_) => panic!("there is room for all"),
            }
        }
    }
}

/// Compares each value that the interpreter has, and how many elements both have.
fn compare_values<L: Parted + Optional + Debug>(protocol: &Protocol, message: &Assembled<()>, values: &L) {
    let (long, content) = (long::<L>(protocol), message.decoded.content(protocol));
    let values = serde_json::to_value(values).expect("every value has JSON");
    let mut elements = 0;
    for reading in &message.decoded.signals {
        let signal = &content[reading.signal];
        let json = member(&values, content, signal);
        assert!(is_same(&reading.value, json), "{}: {json} is not {:?}", signal.name, reading.value);
        elements = elements.max(long.counted(signal).map_or(0, |index| index + 1));
    }
    let arrays = content.arrays.iter().filter(|array| array.least.is_some());
    for array in arrays {
        let json = member(&values, content, &content[array.elements[0]]);
        assert!(json.is_null() == (elements == 0), "{values}");
    }
    let all = values.as_object().expect("a struct").values().filter_map(|value| value.as_array().map(Vec::len));
    let has_arrays = long.varying().is_some_and(|field| !field.is_text);
    assert!(!has_arrays || all.clone().max() == Some(elements), "{values} has not {elements} elements");
}

fn frame_of<L: Parted>(outcome: &Outcome<L>) -> canspec_runtime::Frame {
    match outcome {
        Outcome::Whole(whole) => *whole.frame(),
        Outcome::Incomplete(partial) => *partial.frame(),
        Outcome::Full(frame) => *frame,
    }
}

impl PartedVisitor for Agreement {
    fn visit<L: Parted + Optional + PartialEq + Debug>(&mut self, path: &str) {
        let protocol = protocol(path);
        for model in models(&protocol) {
            self.on_model::<L>(&protocol, model);
        }
    }
}

#[test]
fn both_engines_put_the_same_messages_together() {
    let mut agreement = Agreement { whole: 0, incomplete: 0 };
    visit_parted(&mut agreement);
    let Agreement { whole, incomplete } = agreement;
    assert!(whole > 2_000 && incomplete > 2_000, "{whole} whole and {incomplete} incomplete messages");
}
