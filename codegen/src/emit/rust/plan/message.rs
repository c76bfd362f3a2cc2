//! Messages: their structs, exchanges and requests.

use proc_macro2::{Ident, TokenStream};
use quote::quote;

use super::doc::{self, Comment};
use super::exchange::{Accesses, Exchange, exchange_name};
use super::literal;
use super::long::{Carriage, Long, Transfer};
use super::models::depends_on_model;
use super::naming::Pool;
use super::request::Request;
use super::selector::Selectors;
use super::signal::{Context, Signal};
use super::{types, usage};
use crate::model::{self, ExchangeId, FrameLayout, Kind, LongMessageId, MessageId, SignalId, Table};

/// A message.
pub struct Message {
    /// The struct of its own.
    pub home: Ident,
    /// The struct that has its exchanges.
    pub owner: Ident,
    /// First paragraphs of the comment of its own struct.
    pub paragraphs: Vec<String>,
    /// Its title in the list of all messages.
    pub title: String,
    /// The selectors that choose it, and their values.
    pub constants: Vec<(String, TokenStream)>,
    /// Its signals.
    pub signals: Table<SignalId, Signal>,
    /// How it travels.
    pub exchanges: Table<ExchangeId, Exchange>,
    /// The methods that build its requests, by exchange.
    pub methods: Table<ExchangeId, Ident>,
    /// Its structs.
    pub structs: Vec<Struct>,
    /// What its frames carry together, if it can be longer than one.
    pub long: Option<Long>,
}

impl Message {
    /// Returns the struct that stands for the whole message, and has the requests that carry nothing.
    pub fn whole(&self) -> &Ident {
        self.long.as_ref().map_or(&self.home, |long| &long.name)
    }
}

/// A struct of a message.
pub struct Struct {
    /// Its name.
    pub name: Ident,
    /// Its comment.
    pub comment: Comment,
    /// Whether it is the message's own, which has the constants.
    pub is_home: bool,
    /// The signals whose values it has.
    pub signals: Vec<SignalId>,
    /// The same by member: those of an array together, in order.
    pub members: Vec<Vec<SignalId>>,
    /// The numbers of data bytes that its frame can have, if there are several.
    pub lengths: Vec<Length>,
    /// Whether equality is exact.
    pub is_exact: bool,
    /// The bits that the document reserves, if it has signals, and a comment if they are not sent as zeros.
    pub reserved: Option<(Option<Comment>, TokenStream)>,
    /// The methods that build requests.
    pub requests: Vec<Request>,
    /// The values within the limits of a device model.
    pub within: Option<Within>,
}

/// A number of data bytes that a frame can have.
pub struct Length {
    /// The number.
    pub bytes: TokenStream,
    /// The signals that shorter frames lack.
    pub added: Vec<SignalId>,
}

/// Values within the limits of a device model.
pub struct Within {
    /// The path of the exchange by which they are tested.
    pub exchange: TokenStream,
    /// The methods that build requests.
    pub requests: Vec<Request>,
}

/// What messages are planned from.
pub struct Planner<'a> {
    /// The context of signals.
    pub context: &'a Context<'a>,
    /// Selectors.
    pub selectors: &'a Selectors,
    /// What messages share of each access.
    pub accesses: &'a Accesses,
}

impl Planner<'_> {
    /// Plans a message.
    pub fn message(&self, id: MessageId) -> Message {
        let Context { protocol, types, .. } = *self.context;
        let (known, home, mut members) = (&protocol[id], types.home(id), Pool::of_members());
        let signals = self.context.signals(id, &mut members);
        let names = known.exchanges.map(|own| exchange_name(protocol, &protocol[own.access].name, own.set));
        let constants = names.map(|name| members.take(name.to_ascii_uppercase(), "_EXCHANGE"));
        let methods = names.map(|name| members.take(name.clone(), "_request"));
        let ways = Ways { constants: &constants, methods: &methods };
        let long = known.long.map(|long| self.long(id, long, &ways));
        let is_other = |own: &&types::Struct| long.as_ref().is_none_or(|long| long.name != own.name);
        let structs = types.structs[id].iter().filter(is_other);
        let structs = structs.map(|own| self.structure(id, &signals, &ways, own)).collect();
        Message {
            home: home.clone(),
            owner: types.owner(protocol, id).clone(),
            paragraphs: usage::paragraphs(protocol, self.accesses, id),
            title: doc::plain_title(&known.doc, &known.name),
            constants: self.constants(known),
            exchanges: known.exchanges.ids().map(|exchange| self.exchange(id, exchange, &constants)).collect(),
            signals,
            structs,
            methods,
            long,
        }
    }

    fn constants(&self, message: &model::Message) -> Vec<(String, TokenStream)> {
        let constants = message.constants.iter();
        let name = |constant: &model::Constant| self.context.protocol[constant.selector].name.clone();
        constants.map(|known| (name(known), self.selectors[known.selector].value(known.value))).collect()
    }

    fn exchange(&self, id: MessageId, exchange: ExchangeId, constants: &Table<ExchangeId, Ident>) -> Exchange {
        let Context { protocol, models, .. } = *self.context;
        let names = (&constants[exchange], self.accesses.constant(id, exchange));
        Exchange::new(protocol, (self.selectors, models), names, &protocol[id], exchange)
    }

    fn structure(&self, id: MessageId, signals: &Table<SignalId, Signal>, ways: &Ways, own: &types::Struct) -> Struct {
        let Context { protocol, types, .. } = *self.context;
        let home = types.home(id);
        let is_home = own.name == *home;
        let is_whole = is_home && protocol[id].long.is_none();
        let host = Host { id, name: &own.name, is_home, is_whole };
        let hosted: Vec<_> = self.hosted(&host).collect();
        let dependent: Vec<_> = hosted.iter().filter(|frame| depends_on_model(protocol, frame)).copied().collect();
        let frame = protocol.frames_of(&protocol[id]).find(|frame| frame.signals == own.signals);
        let frame = frame.filter(|_| !own.signals.is_empty());
        Struct {
            name: own.name.clone(),
            comment: self.comment(&host, own),
            is_home: host.is_home,
            is_exact: own.signals.iter().all(|signal| signals[*signal].coding.is_exact()),
            signals: own.signals.clone(),
            members: members(&protocol[id], &own.signals),
            lengths: frame.map(|frame| lengths(&protocol[id], frame)).unwrap_or_default(),
            reserved: frame.map(reserved),
            requests: hosted.iter().map(|frame| self.request(&host, ways, frame)).collect(),
            within: dependent.first().map(|first| Within {
                exchange: self.exchange_path(&host, ways, first),
                requests: dependent.iter().map(|frame| self.request_of_model(&host, ways, frame)).collect(),
            }),
        }
    }

    /// Describes a struct; what holds for the whole message stands at its own.
    fn comment(&self, host: &Host, own: &types::Struct) -> Comment {
        let Context { protocol, types, .. } = *self.context;
        if let Some(long) = protocol[host.id].long {
            let (whole, is_part) = (&types.long[long], protocol[long].parts().is_some());
            let sentence = if is_part { "A part of [`{}`], as a frame carries it." } else { "[`{}`] in one frame." };
            return Comment::line(sentence.replace("{}", &whole.to_string()));
        }
        if host.is_home {
            return Comment::new(usage::paragraphs(protocol, self.accesses, host.id));
        }
        let (message, home) = (&protocol[host.id], types.home(host.id));
        let kinds = protocol.frames_of(message).filter(|frame| frame.signals == own.signals);
        let mut kinds: Vec<_> = kinds.map(|frame| format!("a {}", frame.kind.name())).collect();
        kinds.dedup();
        Comment::line(format!("What {} of [`{home}`] carries.", kinds.join(" or ")))
    }

    /// Returns the requests whose methods a struct has: those that carry it, and of a message's own struct those that
    /// carry nothing.
    fn hosted<'a>(&'a self, host: &'a Host) -> impl Iterator<Item = &'a FrameLayout> {
        let Context { protocol, types, .. } = *self.context;
        let frames = protocol[host.id].frames.iter().filter(|id| {
            let frame = &protocol[**id];
            let carried = types.frames[**id].carried.as_ref();
            let is_built_alone = frame.set.is_none() && protocol.part_of(frame).is_none();
            frame.is_to_module() && is_built_alone && carried.map_or(host.is_whole, |carried| carried == host.name)
        });
        frames.map(|id| &protocol[*id])
    }

    /// Plans what the frames of a message carry together.
    fn long(&self, id: MessageId, long: LongMessageId, ways: &Ways) -> Long {
        let Context { protocol, types, .. } = *self.context;
        let of_transport = ways.constants.iter().filter(|_| protocol[long].transport().is_some());
        let mut members = Pool::with_members(ways.methods.iter().chain(of_transport).map(Ident::to_string));
        let host = Host { id, name: &types.long[long], is_home: false, is_whole: true };
        let comment = Comment::new(usage::paragraphs(protocol, self.accesses, id));
        let requests = self.hosted(&host).map(|frame| self.request(&host, ways, frame)).collect();
        let signals = self.context.long_signals(&protocol[long], &mut members);
        let carriage = Carriage { parts: self.in_parts(&host, long, ways), transfer: self.transfer(&host, long, ways) };
        Long::new((long, &protocol[long]), host.name, (comment, requests), signals, carriage)
    }

    /// Plans the methods that build what goes to a module in parts. Without a model nobody knows the number of the
    /// first part if each model has its own.
    fn in_parts(&self, host: &Host, long: LongMessageId, ways: &Ways) -> Vec<Request> {
        let protocol = self.context.protocol;
        let is_numbered = protocol[long].first(None).is_some();
        let frames = protocol.frames_of(&protocol[host.id]).filter(|frame| frame.is_to_module() && frame.set.is_none());
        let carrying = frames.filter(|frame| is_numbered && protocol.part_of(frame) == Some(long));
        carrying.map(|frame| self.sending_parts(host, ways, frame)).collect()
    }

    /// Plans the method that builds the frames of a message in parts.
    fn sending_parts(&self, host: &Host, ways: &Ways, frame: &FrameLayout) -> Request {
        let (values, refused) = (" with these values, in parts", "values outside their limits");
        let comment = self.request_comment("Builds the frames of", frame, values, refused);
        Request { comment: Comment::line(comment), ..self.request(host, ways, frame) }
    }

    /// Plans how a transport carries a long message.
    fn transfer(&self, host: &Host, long: LongMessageId, ways: &Ways) -> Option<Transfer> {
        let Context { protocol, types, .. } = *self.context;
        let transport = protocol[long].transport()?;
        let to_module = protocol[long].frames.iter().filter(|frame| frame.is_to_module() && frame.set.is_none());
        let (bare, carrying): (Vec<_>, Vec<_>) = to_module.partition(|frame| frame.signals.is_empty());
        Some(Transfer {
            transport: types.transports[transport].clone(),
            sizes: protocol[long].lengths.clone(),
            requests: carrying.into_iter().map(|frame| self.sending(host, ways, frame)).collect(),
            bare: bare.into_iter().map(|frame| self.sending_nothing(host, ways, frame)).collect(),
        })
    }

    /// Plans the method that sends what can be longer than a frame.
    fn sending(&self, host: &Host, ways: &Ways, frame: &FrameLayout) -> Request {
        let shared = self.accesses.constant(frame.message, frame.exchange);
        let access = &self.context.protocol[frame.access].name;
        let comment = Comment::line(format!(
            "Returns what sends the {} [`{access}`]({shared}) with these values. The data are written to \
             `buffer`, for which `LONGEST` bytes are enough. Refuses values outside their limits, other addressing \
             modes, undocumented addresses, and a buffer with too few bytes.",
            frame.kind.name()
        ));
        Request { comment, carries: true, ..self.request(host, ways, frame) }
    }

    /// Plans the method that sends what carries nothing by a transport.
    fn sending_nothing(&self, host: &Host, ways: &Ways, frame: &FrameLayout) -> Request {
        let comment = self.request_comment("Returns what sends", frame, "", "");
        Request { comment: Comment::line(comment), ..self.request(host, ways, frame) }
    }

    fn request(&self, host: &Host, ways: &Ways, frame: &FrameLayout) -> Request {
        let carries = !frame.signals.is_empty();
        let (values, refused) =
            if carries { (" with these values", "values outside their limits, ") } else { ("", "") };
        let reply = match self.reply(frame) {
            None => quote!(()),
            Some(name) if name == host.name => quote!(Self),
            Some(name) => quote!(#name),
        };
        Request {
            method: ways.methods[frame.exchange].clone(),
            comment: Comment::line(self.request_comment("Builds", frame, values, refused)),
            exchange: self.exchange_path(host, ways, frame),
            reply,
            carries,
        }
    }

    /// Plans the method that builds a request to a device model.
    fn request_of_model(&self, host: &Host, ways: &Ways, frame: &FrameLayout) -> Request {
        let owner = self.context.types.owner(self.context.protocol, host.id);
        let exchange = &ways.constants[frame.exchange];
        let reply = self.reply(frame).map_or_else(|| quote!(()), |name| quote!(#name));
        Request {
            comment: Comment::line(self.request_comment("Builds", frame, " with these values", "")),
            exchange: quote!(#owner::#exchange),
            reply,
            ..self.request(host, ways, frame)
        }
    }

    /// Describes what a method does and refuses. The access describes what holds for all messages.
    fn request_comment(&self, does: &str, frame: &FrameLayout, values: &str, refused: &str) -> String {
        let shared = self.accesses.constant(frame.message, frame.exchange);
        let (kind, access) = (frame.kind.name(), &self.context.protocol[frame.access].name);
        format!(
            "{does} the {kind} [`{access}`]({shared}){values}. Refuses {refused}other addressing modes and \
             undocumented addresses."
        )
    }

    /// Returns the struct that the reply carries.
    fn reply(&self, request: &FrameLayout) -> Option<&Ident> {
        let Context { protocol, types, .. } = *self.context;
        let mut frames = protocol[request.message].frames.iter();
        let reply = frames.find(|id| {
            let frame = &protocol[**id];
            frame.exchange == request.exchange && frame.kind == Kind::Reply
        });
        types.frames[*reply?].carried.as_ref()
    }

    /// Returns the path to the exchange by which a kind of frame travels, from the struct that hosts its method.
    fn exchange_path(&self, host: &Host, ways: &Ways, frame: &FrameLayout) -> TokenStream {
        let owner = self.context.types.owner(self.context.protocol, host.id);
        let exchange = &ways.constants[frame.exchange];
        if host.name == owner { quote!(Self::#exchange) } else { quote!(#owner::#exchange) }
    }
}

/// The names of a message's exchanges, and of the methods that build their requests.
struct Ways<'a> {
    constants: &'a Table<ExchangeId, Ident>,
    methods: &'a Table<ExchangeId, Ident>,
}

/// A struct that has methods.
struct Host<'a> {
    id: MessageId,
    name: &'a Ident,
    /// Whether it is the message's own, which has the constants.
    is_home: bool,
    /// Whether it has the requests that carry nothing.
    is_whole: bool,
}

/// Puts the elements of each array together, at the place of the one that comes first.
fn members(message: &model::Message, signals: &[SignalId]) -> Vec<Vec<SignalId>> {
    let mut members: Vec<Vec<SignalId>> = Vec::new();
    for id in signals {
        let array = message.array_of(&message[*id]);
        if !members.iter().any(|known| known.contains(id)) {
            members.push(array.map_or_else(|| vec![*id], |array| array.elements.clone()));
        }
    }
    members
}

/// Returns the numbers of data bytes that a frame can have, if there are several.
fn lengths(message: &model::Message, frame: &FrameLayout) -> Vec<Length> {
    if frame.lengths.len() < 2 {
        return Vec::new();
    }
    let shorter = std::iter::once(0).chain(frame.lengths.iter().copied());
    let steps = shorter.zip(&frame.lengths).map(|(shorter, length)| {
        let ends_here = |id: &&SignalId| (shorter + 1..=*length).contains(&message[**id].end());
        Length { bytes: literal::decimal(*length), added: frame.signals.iter().filter(ends_here).copied().collect() }
    });
    steps.collect()
}

/// Writes the bits of the data that neither signals nor selectors cover.
fn reserved(frame: &FrameLayout) -> (Option<Comment>, TokenStream) {
    let comment = frame.reserved.are_ones.then(|| Comment::line("Requests send ones in these bits."));
    (comment, literal::data(frame.uncovered().to_be_bytes()))
}
