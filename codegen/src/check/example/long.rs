//! Runs the examples of long messages: all frames together must say what the example says.

use canspec_runtime::Place;

use super::{Checked, fill, misfitting, shown, with_blanks, wrong};
use crate::interpret::{Assembled, Assembly, Content, Decoded, Form, Frame, Value, decode, encode_long};
use crate::model::{LongExample, LongMessage, Protocol, Said, Standard, TransportFrame};
use crate::report::diagnostic::{At, Diagnostic};
use crate::resolve::rules;

/// Decodes the frames, joins their parts, compares the values, and makes the frames again.
pub fn check(protocol: &Protocol, example: &LongExample) -> Checked {
    Checker { protocol, example, long: &protocol[example.long] }.run()
}

struct Checker<'a> {
    protocol: &'a Protocol,
    example: &'a LongExample,
    long: &'a LongMessage,
}

impl Checker<'_> {
    fn run(&self) -> Checked {
        let assembled = self.assembled()?;
        self.has_values(&assembled)?;
        self.has_notes(&assembled)?;
        self.encodes_back(&assembled)
    }

    fn frames(&self) -> Vec<Frame> {
        let extended = self.protocol.identifier.extended;
        let frame = |(id, data): &(u32, Vec<u8>)| Frame { id: *id, extended, data: data.clone(), form: Form::Data };
        self.example.frames.iter().map(frame).collect()
    }

    fn frames_at(&self) -> At {
        self.example.doc.path.key(self.example.kind.name()).at_value()
    }

    fn frame_at(&self, index: usize) -> At {
        self.example.doc.path.key(self.example.kind.name()).index(index).at_value()
    }

    /// Joins the parts, which must be one whole message.
    fn assembled(&self) -> Result<Assembled<usize>, Box<Diagnostic>> {
        let (protocol, model) = (self.protocol, self.example.model);
        let mut assembly = Assembly::default();
        assembly.count_as(self.example.count.map(usize::from));
        let mut ended = Vec::new();
        for (index, frame) in self.frames().iter().enumerate() {
            let decoded =
                decode(protocol, model, frame).map_err(|problem| wrong(self.frame_at(index), problem.text))?;
            if !self.is_its(&decoded) {
                let text = format!("this frame is a {} of `{}`", decoded.kind.name(), protocol[decoded.message].name);
                return Err(wrong(self.frame_at(index), text));
            }
            let taken = assembly.take(protocol, model, index, frame, &decoded);
            if let Some((_, transport, _)) = protocol.transport_frame(decoded.message).filter(|_| !taken.is_part) {
                return Err(self.belongs_to_nothing(&transport.standard, index));
            }
            if !taken.is_part {
                let notes: Vec<_> = decoded.notes.into_iter().map(|note| note.text).collect();
                return Err(wrong(self.frame_at(index), format!("this frame carries no part: {}", notes.join("; "))));
            }
            ended.extend(taken.ended);
        }
        // The list has all frames, so none follows.
        ended.extend(assembly.fall_silent(protocol, model));
        ended.extend(assembly.finish(protocol, model));
        let messages = ended.len();
        match <[Assembled<usize>; 1]>::try_from(ended) {
            Ok([whole]) if whole.decoded.message != self.long.message => {
                let text = format!(
                    "these frames are a {} of `{}`",
                    whole.decoded.kind.name(),
                    protocol[whole.decoded.message].name
                );
                Err(wrong(self.frames_at(), text))
            }
            Ok([whole]) if whole.incomplete.is_none() => Ok(whole),
            Ok([whole]) => Err(wrong(
                self.frames_at(),
                format!("the message is not whole: {}", whole.incomplete.unwrap_or_default()),
            )),
            Err(_) => Err(wrong(self.frames_at(), format!("these frames are {messages} messages"))),
        }
    }

    /// Says why a frame of a transport belongs to no message.
    fn belongs_to_nothing(&self, standard: &Standard, index: usize) -> Box<Diagnostic> {
        let (name, path) = (&self.long.content.name, &self.long.content.doc.path);
        match standard {
            Standard::J1939(_) => {
                let text = format!("the frames announce another group than that of `{name}`");
                let problem = Diagnostic::error(&rules::EXAMPLE, path.key("match").at_value(), text);
                Box::new(problem.other(self.frame_at(index), "the frame"))
            }
            Standard::Isotp(_) => {
                let text =
                    format!("this frame belongs to no message; the constants of `{name}` are not its first bytes");
                wrong(self.frame_at(index), text)
            }
        }
    }

    /// Tests whether a frame is one of the message, or of the transport that carries it.
    fn is_its(&self, decoded: &Decoded) -> bool {
        match self.protocol.transport_frame(decoded.message) {
            Some((transport, _, _)) => self.long.transport() == Some(transport),
            None => (decoded.message, decoded.kind) == (self.long.message, self.example.kind),
        }
    }

    fn has_values(&self, assembled: &Assembled<usize>) -> Checked {
        let content = &self.long.content;
        for meaning in &self.example.means {
            meaning.said.as_ref().map_err(|misfit| {
                let its = self.protocol.long_examples.iter().filter(|other| other.long == self.example.long);
                let means = its.flat_map(|other| &other.means);
                Box::new(misfitting(means, &content[meaning.signal], meaning, misfit))
            })?;
            let signal = content[meaning.signal].on(self.example.model);
            let reading = assembled.decoded.signals.iter().find(|reading| reading.signal == meaning.signal);
            let Some(reading) = reading else {
                return Err(wrong(meaning.path.at_value(), format!("the frames have no `{}`", signal.name)));
            };
            let is_said = match &meaning.said {
                Ok(Said::Text(text)) => reading.value == Value::Text(text.clone()),
                _ => meaning.is(signal, reading.bits),
            };
            if !is_said {
                let read = shown(self.protocol, signal, reading);
                let help = fill(&reading.value, &meaning.text);
                let [meant, read] = with_blanks(&meaning.text, &read);
                let text = format!("`{}` is {meant} here, but the frames say {read}", signal.name);
                return Err(Box::new(wrong(meaning.path.at_value(), text).help_if(help)));
            }
        }
        if self.example.means.is_empty() && !assembled.decoded.signals.is_empty() {
            let text = "the example does not say what the frames mean together".to_owned();
            return Err(wrong(self.example.doc.path.key("means").at_key(), text));
        }
        Ok(())
    }

    fn has_notes(&self, assembled: &Assembled<usize>) -> Checked {
        let notes = &assembled.decoded.notes;
        if let Some(note) = notes.iter().find(|note| !self.example.notes.contains(&note.rule)) {
            return Err(wrong(self.frames_at(), format!("the message has the note `{}`: {}", note.rule, note.text)));
        }
        let missing = |rule| !notes.iter().any(|note| note.rule == rule);
        match self.example.notes.iter().position(|rule| missing(*rule)) {
            None => Ok(()),
            Some(index) => {
                let at = self.example.doc.path.key("notes").index(index).at_value();
                Err(wrong(at, format!("the message has no note `{}`", self.example.notes[index])))
            }
        }
    }

    fn encodes_back(&self, assembled: &Assembled<usize>) -> Checked {
        if assembled.decoded.kind != self.example.kind {
            let text = format!("these frames are a {}", assembled.decoded.kind.name());
            return Err(wrong(self.frames_at(), text));
        }
        let content = Content::of_long(self.protocol, assembled);
        let all = self.frames();
        let frames: Vec<_> = assembled.marks.iter().map(|mark| all[*mark].clone()).collect();
        let mut made = encode_long(self.protocol, self.example.model, &content)
            .map_err(|refusal| wrong(self.frames_at(), format!("it does not encode back: {refusal}")))?;
        if let (Some(made), Some(frame)) = (made.first_mut(), frames.first()) {
            self.keep_free_number(frame, made);
        }
        let differing = made.iter().zip(&frames).position(|(made, frame)| made != frame);
        match differing.or_else(|| (made.len() != frames.len()).then_some(made.len().min(frames.len()))) {
            None => Ok(()),
            Some(index) => {
                let frame =
                    |frames: &[Frame]| frames.get(index).map_or_else(|| "no frame".to_owned(), Frame::to_string);
                let text = format!("it encodes back to {} instead of {}", frame(&made), frame(&frames));
                Err(wrong(self.frames_at(), text))
            }
        }
    }

    /// Takes over how many packets may come at once. Every sender chooses that for itself.
    fn keep_free_number(&self, frame: &Frame, made: &mut Frame) {
        if let (Some(place), Some(_)) = (self.free_place(frame), self.free_place(made)) {
            let mut data = made.padded();
            place.put(&mut data, place.get(&frame.padded()));
            made.data = data.to_vec();
        }
    }

    /// Returns where an announcement has that number.
    fn free_place(&self, frame: &Frame) -> Option<Place> {
        let decoded = decode(self.protocol, self.example.model, frame).ok()?;
        let (_, _, kind) = self.protocol.transport_frame(decoded.message)?;
        let message = &self.protocol[decoded.message];
        let most = message.signals.iter().find(|signal| signal.name == "most")?;
        (kind == TransportFrame::RequestToSend).then_some(most.place)
    }
}
