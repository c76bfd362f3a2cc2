//! The frames that a module sends unasked.

use crate::plumbing::{IdFilter, Pattern};
use crate::{Error, Exchange, Frame, Kind, Protocol, Received};

impl Exchange {
    /// Builds the report of a module. `content` is what it carries. The frame reports no error, and
    /// shows the controller to which the document lets it go. If the message is reported in several
    /// addressing modes, it is the first one. Where the identifier shows no module, the number does
    /// not count.
    ///
    /// # Errors
    ///
    /// Refuses
    /// - an access by which no module reports the message,
    /// - a module whose address the document does not name,
    /// - content of another message or of another kind of frame,
    /// - values that the signals cannot hold.
    pub fn report_from<P: Protocol>(&self, node: impl Into<i32>, content: P) -> Result<Frame, Error> {
        let blank = self.blank_report::<P>(node)?;
        let is_its = |known: &Received<P>| known.kind() == Kind::Report && known.exchange().is(self);
        let known = Received::decode(&blank).ok().filter(is_its);
        let known = known.ok_or(Error::Identifier { message: self.message(), id: blank.raw_id() })?;
        known.with_content(content).encode()
    }

    /// Builds the report of a module whose signals are 0. The parts of a
    /// [long message](crate::parts::Parted::frames) are made like it.
    ///
    /// # Errors
    ///
    /// Refuses an access by which no module reports the message, and a module whose address the
    /// document does not name.
    pub fn blank_report<P: Protocol>(&self, node: impl Into<i32>) -> Result<Frame, Error> {
        let node = node.into();
        let report = self.filter(Kind::Report).filter(|_| !self.is_to_module::<P>(Kind::Report));
        let (report, Pattern { constants, addresses }) =
            report.zip(self.pattern_of_module::<P>()).ok_or_else(|| self.no_mode(None))?;
        let shown = constants.iter().fold(IdFilter::ANY, |id, (bits, value)| id.id(*bits, *value));
        let shown = addresses.iter().try_fold(shown, |id, address| {
            let kind = address.kind();
            id.documented(address.bits(), kind, if kind.is_sent() { kind.sent_number() } else { node })
        });
        Ok(report.narrowed(shown?).frame(self.data_length()))
    }

    /// Returns what identifiers of frames that a module sends show in the first addressing mode.
    fn pattern_of_module<P: Protocol>(&self) -> Option<&'static Pattern> {
        P::MODES.iter().enumerate().find_map(|(mode, known)| known.reply(self.who(mode)?))
    }
}
