//! What several frames carry together: a struct that reads the joined data, and writes them.

use proc_macro2::Ident;

use super::doc::Comment;
use super::place::Written;
use super::request::Request;
use super::signal::Signal;
use crate::model::{self, ByteRun, LongMessage, LongMessageId, SignalId};

/// What several frames carry together.
pub struct Long {
    /// The long message.
    pub id: LongMessageId,
    /// Its struct.
    pub name: Ident,
    /// Comment of the struct.
    pub comment: Comment,
    /// The message's name in the spec.
    pub message: String,
    /// Its fields, by first byte.
    pub fields: Vec<Field>,
    /// Whether equality is exact.
    pub is_exact: bool,
    /// The least number of data bytes: those up to the last field that is always there.
    pub shortest: usize,
    /// The greatest number of data bytes.
    pub longest: usize,
    /// The least and the greatest number of elements of arrays that vary in length.
    pub elements: Option<[usize; 2]>,
    /// The numbers of data bytes that it can have beside the shortest, the least first.
    pub lengths: Vec<Length>,
    /// Whether bits that no field has are sent as 1.
    pub are_ones: bool,
    /// The methods that build requests.
    pub requests: Vec<Request>,
    /// How it travels.
    pub carriage: Carriage,
}

/// How a long message travels.
pub struct Carriage {
    /// The methods that build frames with its numbered parts for a module.
    pub parts: Vec<Request>,
    /// How a transport carries it, if one does.
    pub transfer: Option<Transfer>,
}

/// How a transport carries a long message.
pub struct Transfer {
    /// The transport.
    pub transport: Ident,
    /// The numbers of data bytes that it can have, if the spec lists them.
    pub sizes: Vec<u16>,
    /// The methods that send it to a module.
    pub requests: Vec<Request>,
    /// Those that send it without values.
    pub bare: Vec<Request>,
}

/// A number of data bytes that a message can have.
pub struct Length {
    /// The number.
    pub bytes: usize,
    /// The fields that end there, or the numbers of elements from 0.
    pub added: Vec<(usize, Option<usize>)>,
}

/// A signal that stands alone, or an array.
pub struct Field {
    /// The signal, or the first element.
    pub signal: Signal,
    /// The byte from which its place counts.
    pub start: u16,
    /// Where the other elements are, if it is an array.
    pub row: Option<Row>,
    /// How many bytes it takes, if it is a text that no place holds.
    pub run: Option<ByteRun>,
}

/// The elements of an array.
pub struct Row {
    /// How many there are, at most if that varies.
    pub count: usize,
    /// Whether their number varies.
    pub varies: bool,
    /// How far it is from one to the next.
    pub step: Step,
}

/// How far it is from an element to the next one.
pub enum Step {
    /// In bytes of the data.
    Bytes(i32),
    /// In bits of the same eight bytes.
    Bits(i32),
}

impl Long {
    /// Plans the struct of a long message.
    pub fn new(
        (id, long): (LongMessageId, &LongMessage),
        name: &Ident,
        (comment, requests): (Comment, Vec<Request>),
        signals: Vec<(Signal, SignalId)>,
        carriage: Carriage,
    ) -> Self {
        let lengths = lengths(long, &signals);
        let fields: Vec<_> = signals.into_iter().map(|(signal, id)| Field::new(&long.content, signal, id)).collect();
        Self {
            id,
            name: name.clone(),
            comment,
            message: long.content.name.clone(),
            is_exact: fields.iter().all(|field| field.signal.coding.is_exact()),
            fields,
            shortest: long.least(),
            longest: long.longest(),
            elements: long.varying().map(|field| [field.least, field.most]),
            lengths,
            are_ones: long.content.reserved.are_ones,
            requests,
            carriage,
        }
    }
}

/// Returns the lengths of a message but for the shortest, and what shorter messages lack.
fn lengths(long: &LongMessage, fields: &[(Signal, SignalId)]) -> Vec<Length> {
    let lengths = || long.lengths.iter().map(|length| usize::from(*length));
    let longer = lengths().zip(lengths().skip(1)).map(|(shorter, bytes)| {
        let ends_here = |id: &SignalId| (shorter + 1..=bytes).contains(&long.content[*id].reach());
        let added = fields.iter().enumerate().flat_map(|(place, (_, first))| {
            let array = long.content.array_of(&long.content[*first]);
            let alone = (array.is_none() && ends_here(first)).then_some((place, None));
            let elements = array.into_iter().flat_map(|array| array.elements.iter().enumerate());
            let elements = elements.filter(move |(_, id)| ends_here(id)).map(move |(index, _)| (place, Some(index)));
            alone.into_iter().chain(elements)
        });
        Length { bytes, added: added.collect() }
    });
    longer.collect()
}

impl Field {
    /// Tests whether its length varies.
    pub fn varies(&self) -> bool {
        self.row.as_ref().is_some_and(|row| row.varies) || self.run.is_some_and(ByteRun::varies)
    }

    fn new(content: &model::Message, signal: Signal, id: SignalId) -> Self {
        let known = &content[id];
        let row = Row::new(content, known);
        let place = match row {
            Some(Row { step: Step::Bits(_), .. }) => Written::in_all(known.place),
            _ => Written::new(known.place),
        };
        let comment = match row {
            Some(_) => {
                format!("The elements of `{}`, to read or write one alone, or to ask for their limits.", signal.name)
            }
            None => return Self { signal, start: known.window, row, run: known.run },
        };
        let signal = Signal { place, comment: Comment::line(comment), ..signal };
        Self { signal, start: known.window, row, run: None }
    }
}

impl Row {
    fn new(content: &model::Message, first: &model::Signal) -> Option<Self> {
        let array = content.array_of(first)?;
        let next = &content[*array.elements.get(1)?];
        let bytes = i32::from(next.window) - i32::from(first.window);
        let [low, above] = [first, next].map(|signal| i32::from(signal.place.bits_of_payload().shift()));
        let step = if bytes == 0 { Step::Bits(above - low) } else { Step::Bytes(bytes) };
        Some(Self { count: array.elements.len(), varies: array.least.is_some(), step })
    }
}
