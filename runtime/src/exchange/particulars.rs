//! What only some messages have.

use crate::address::{Kind, Who};
use crate::filter::IdFilter;
use crate::{Bits, Data, Filter};

/// What only some messages have. The others take no space for it.
#[derive(Clone, Copy, Debug)]
pub struct Particulars {
    pub(super) answers: Option<&'static [Option<Who>]>,
    pub(super) models: &'static [u8],
    pub(super) sent: Option<&'static Sent>,
    pub(super) refusal: Option<&'static Filter>,
}

impl Particulars {
    /// Nothing.
    pub const NOTHING: Self = Self { answers: None, models: &[], sent: None, refusal: None };

    /// Sets who answers in each mode, if not as the access says.
    #[must_use]
    pub const fn answers(self, answers: &'static [Option<Who>]) -> Self {
        Self { answers: Some(answers), ..self }
    }

    /// Sets the device models that have the message, by number. Without them every model has it.
    #[must_use]
    pub const fn models(self, models: &'static [u8]) -> Self {
        Self { models, ..self }
    }

    /// Sets what its frames have that are built, although any is accepted there.
    #[must_use]
    pub const fn sending(self, sent: &'static Sent) -> Self {
        Self { sent: Some(sent), ..self }
    }

    /// Adds the refusal, which answers a request in place of the reply. It is another message's
    /// reply and says why.
    #[must_use]
    pub const fn refusal(self, refusal: &'static Filter) -> Self {
        Self { refusal: Some(refusal), ..self }
    }
}

/// What the frames of a message have that are built, although any is accepted there.
#[derive(Clone, Copy, Debug)]
pub struct Sent {
    pub(super) id: IdFilter,
    request: Data,
    reply: Data,
    report: Data,
}

impl Sent {
    /// Nothing.
    pub const NOTHING: Self = Self { id: IdFilter::ANY, request: [0; 8], reply: [0; 8], report: [0; 8] };

    /// Sets the value of a field of the identifier.
    #[must_use]
    pub const fn id(self, bits: Bits, value: u32) -> Self {
        Self { id: self.id.id(bits, value), ..self }
    }

    /// Sets data bits that a request has as 1 although nothing names them.
    #[must_use]
    pub const fn request(self, ones: Data) -> Self {
        Self { request: ones, ..self }
    }

    /// Sets data bits that a reply has as 1 although nothing names them.
    #[must_use]
    pub const fn reply(self, ones: Data) -> Self {
        Self { reply: ones, ..self }
    }

    /// Sets data bits that a report has as 1 although nothing names them.
    #[must_use]
    pub const fn report(self, ones: Data) -> Self {
        Self { report: ones, ..self }
    }

    /// Returns the data bits that a kind of frame has as 1 although nothing names them.
    #[inline(always)]
    pub(super) const fn ones(&self, kind: Kind) -> Data {
        match kind {
            Kind::Request => self.request,
            Kind::Reply => self.reply,
            Kind::Report => self.report,
        }
    }
}
