//! Sets: messages that travel as several frames.

use serde::{Deserialize, Serialize};

use crate::model::{
    Address, AddressTypeId, Constant, Exchange, Kind, MessageId, Mode, Protocol, SelectorPlace, Standard, Who,
};

/// What a message that travels as several frames consists of.
#[derive(Clone, Debug, Serialize, Deserialize)]
#[non_exhaustive]
pub struct Set {
    /// The messages that travel in the frames, in order, one in each.
    pub members: Vec<MessageId>,
    /// The kinds of frames that each member has.
    pub kinds: Vec<Kind>,
    /// Constants that each reply shows, whatever it carries.
    pub replies: Vec<Constant>,
}

/// The field that says whether more frames of a set follow.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub struct Continuation {
    /// Where it stands.
    pub place: SelectorPlace,
    /// The value if more frames follow. Any other value says that the frame is the last.
    pub raw: u64,
}

impl Protocol {
    /// Returns the field that says whether more frames of a set follow, if there is one.
    pub fn continuation(&self) -> Option<Continuation> {
        let fields = self.identifier.fields.entries();
        let mut in_identifier = fields.filter_map(|(index, field)| {
            Some(Continuation { place: SelectorPlace::Identifier(index), raw: field.continues?.into() })
        });
        let in_data = || {
            let mut selectors = self.selectors.iter();
            selectors.find_map(|selector| Some(Continuation { place: selector.place, raw: selector.continues? }))
        };
        in_identifier.next().or_else(in_data)
    }
}

impl Protocol {
    /// Returns the kind of address that shows which node sends a reply. It is `None` if a reply
    /// does not show it, or replies show different kinds.
    pub fn answering(&self, exchange: &Exchange) -> Option<AddressTypeId> {
        let answers = self.modes.iter().zip(&exchange.answers).filter_map(|(mode, who)| Some((mode, (*who)?)));
        let mut patterns = answers.filter(|(_, who)| *who != Who::Nobody).map(|(mode, who)| self.sender(mode, who));
        let first = patterns.next()??;
        patterns.all(|other| other == Some(first)).then_some(first)
    }

    /// Returns the kind of address of the node that answers. It is that of the request's target, or
    /// else the only kind without a default to send.
    fn sender(&self, mode: &Mode, who: Who) -> Option<AddressTypeId> {
        let types = || mode.reply(who).into_iter().flat_map(|pattern| &pattern.addresses);
        let types = || types().map(|address| address.address_type);
        let addressed = types().find(|known| Some(*known) == mode.target);
        let mut free = types().filter(|known| self[*known].send.is_none());
        let alone = free.next().filter(|_| free.next().is_none());
        addressed.or(alone)
    }

    /// Returns the kind of address that shows which module sends a frame or, without `who`, is asked.
    /// It is one by which some module answers for itself.
    pub(crate) fn node(&self, mode: &Mode, who: Option<Who>) -> Option<AddressTypeId> {
        let kind = who.map_or(mode.target, |who| self.sender(mode, who))?;
        let single = |mode| [Who::One, Who::Each].map(|who| self.sender(mode, who));
        self.modes.iter().flat_map(single).any(|known| known == Some(kind)).then_some(kind)
    }
    /// Returns the kind of address of the controller that sends the requests of a mode.
    ///
    /// If both peers have a usual address, the controller's is the one that a J1939 transport calls the source, or
    /// else the one that stands alone in the requests of another mode.
    pub(crate) fn controller(&self, mode: &Mode) -> Option<AddressTypeId> {
        let own = usual(mode);
        let is_known = |address: &&&Address| self.is_source(address) || self.is_alone(address);
        let known: Vec<_> = own.iter().filter(|known| own.len() == 1 || is_known(known)).collect();
        <[_; 1]>::try_from(known).ok().map(|[address]| address.address_type)
    }

    /// Tests whether a J1939 transport calls the field that of the sender.
    fn is_source(&self, address: &Address) -> bool {
        let is_source =
            |standard: &Standard| matches!(standard, Standard::J1939(known) if known.source == address.field);
        self.transports.iter().any(|transport| is_source(&transport.standard))
    }

    /// Tests whether the requests of some mode show no other usual address.
    fn is_alone(&self, address: &Address) -> bool {
        let is_only = |own: &[&Address]| matches!(own, [only] if only.address_type == address.address_type);
        self.modes.iter().any(|mode| is_only(&usual(mode)))
    }
}

/// Returns the addresses in a request that the caller need not choose.
fn usual(mode: &Mode) -> Vec<&Address> {
    let addresses = mode.request.iter().flat_map(|request| &request.addresses);
    addresses.filter(|address| Some(address.address_type) != mode.target).collect()
}
