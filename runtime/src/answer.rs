//! The frames by which a module answers a request.

use crate::plumbing::{Address, IdFilter};
use crate::{Addressed, Destination, Error, Filter, Frame, Kind, Protocol, Received};

impl<P: Addressed> Received<P> {
    /// Builds the reply of a module to this request. `content` is what the reply carries, and reports
    /// no error. The frame goes to the controller that asked. If one module answers
    /// for all, the number does not count.
    ///
    /// # Errors
    ///
    /// Refuses
    /// - a frame that is no request, or that nobody answers in its addressing mode,
    /// - a module that was not asked, and one of a group whose address the document does not name,
    /// - content of another message or of another kind of frame,
    /// - values that the signals cannot hold.
    pub fn answer(&self, node: impl Into<i32>, content: P) -> Result<Frame, Error> {
        let (_, blank) = self.blank_reply(node.into())?;
        self.reply_with(blank, content).encode()
    }

    /// Builds the frame by which a module refuses this request: a reply with an error code, in the
    /// identifier or in a selector. Its signals are 0. If one module answers for all, the number
    /// does not count.
    ///
    /// # Errors
    ///
    /// Refuses
    /// - a frame that is no request, or that nobody answers in its addressing mode,
    /// - a module that was not asked, and one of a group whose address the document does not name,
    /// - a code that the field cannot hold, and the one that reports no error,
    /// - any code if the replies have no field for it.
    pub fn refuse(&self, node: impl Into<i32>, code: u64) -> Result<Frame, Error> {
        let (reply, blank) = self.blank_reply(node.into())?;
        let refused = with_code::<P>(&reply, &blank, code);
        refused.filter(|refused| *refused != blank).ok_or(Error::Code { message: self.exchange().message(), code })
    }

    /// Returns what replies to this request show, and one that reports no error and has no values.
    fn blank_reply(&self, node: i32) -> Result<(Filter, Frame), Error> {
        let exchange = self.exchange();
        let unanswered = Error::Unanswered { message: exchange.message(), access: exchange.access() };
        let (reply, id) = self.reply_filter(node).ok_or(unanswered)?;
        let reply = reply.narrowed(id?);
        let blank = reply.frame(exchange.data_length());
        match exchange.way::<P>(Kind::Reply, blank.raw_id()).and_then(|way| P::node(&way)) {
            Some(asked) if asked != node => Err(Error::Node { message: exchange.message(), node, asked }),
            _ => Ok((reply, blank)),
        }
    }

    /// Returns what replies show, and what identifiers of those of a module do.
    fn reply_filter(&self, node: i32) -> Option<(Filter, Result<IdFilter, Error>)> {
        let exchange = self.exchange();
        let route = self.route().filter(|_| self.kind() == Kind::Request)?;
        let mode = route.target().mode();
        let who = exchange.who(mode)?;
        let known = route.target().replies(who, route.sender())?;
        let addresses = P::MODES.get(mode)?.reply(who)?.addresses;
        Some((exchange.filter(Kind::Reply)?, from(known, addresses, node)))
    }
}

/// Adds the module to what the identifier of its reply shows, if the request does not say it.
fn from(known: IdFilter, addresses: &[Address], node: i32) -> Result<IdFilter, Error> {
    addresses
        .iter()
        .filter(|address| !known.requires(address.bits()))
        .try_fold(known, |known, address| known.documented(address.bits(), address.kind(), node))
}

/// Puts an error code where replies have one: in the identifier or in a selector.
fn with_code<P: Protocol>(reply: &Filter, blank: &Frame, code: u64) -> Option<Frame> {
    match P::NORMAL.id_mask() & !P::FRAME.id_mask() {
        0 => in_data(reply, blank, code),
        fields => in_id(fields, blank, code),
    }
}

/// Puts an error code into fields of the identifier, and nothing into bits between them.
fn in_id(fields: u32, blank: &Frame, code: u64) -> Option<Frame> {
    let (shift, greatest) = (fields.trailing_zeros(), fields.checked_shr(fields.trailing_zeros())?);
    let code = u32::try_from(code).ok().filter(|code| *code <= greatest)?;
    let bits = code.checked_shl(shift).filter(|bits| bits & !fields == 0)?;
    Some(blank.with_id((blank.raw_id() & !fields | bits).into()))
}

/// Puts an error code into the first selector whose value may vary.
fn in_data(reply: &Filter, blank: &Frame, code: u64) -> Option<Frame> {
    let mut selectors = reply.data_selectors().iter();
    let selector = selectors.find(|selector| selector.has_normal() && !reply.requires(selector.place))?;
    let mut data = blank.bytes();
    selector.place.put(&mut data, code);
    (selector.place.get(&data) == code).then(|| blank.with_data(data))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{Place, Selector};

    #[test]
    fn a_code_leaves_the_bits_between_two_fields_as_they_are() {
        let blank = Frame::new_raw(0x1F03_0000, true, [0; 8], 8);
        let id = |code| in_id(0x00F0_000F << 4, &blank, code).map(|frame| frame.raw_id());
        assert_eq!([id(5), id(0x30_0005)], [Some(0x1003_0050), Some(0x1303_0050)]);
        assert_eq!([id(0x10), id(0x0F_0000), id(0x100_0000), id(1 << 32)], [None; 4]);
    }

    #[test]
    fn a_code_is_written_where_the_reply_may_vary() {
        const KIND: Selector = Selector::new("kind", Place::byte(0)).normal(1);
        const RESULT: Selector = Selector::new("result", Place::byte(1)).normal(0xF0);
        let reply = Filter::EXTENDED.selectors(&[KIND, RESULT]).data(KIND.place, 1).accepting();
        let refused = in_data(&reply, &reply.frame(8), 0xF2).map(|frame| frame.bytes());
        assert_eq!(refused, Some([1, 0xF2, 0, 0, 0, 0, 0, 0]));
        let fixed = reply.data(RESULT.place, 0xF0);
        assert_eq!(in_data(&fixed, &fixed.frame(8), 0xF2), None);
    }
}
