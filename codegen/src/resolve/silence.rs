//! Resolves what devices do after silence.

use super::Resolver;
use super::texts::remarks;
use crate::model::{AfterSilence, Silence};
use crate::report::tree::Path;

impl Resolver<'_> {
    pub fn after_silence(&mut self) -> Option<Silence> {
        let path = Path::default().key("after_silence");
        let written = self.spec.after_silence.as_ref()?;
        let words = AfterSilence::ALL.map(AfterSilence::name).into_iter();
        let index = self.lookup(&path.key("output"), "output after silence", &written.output, words)?;
        Some(Silence { doc: remarks!(written).doc(&path, None), output: AfterSilence::ALL[index] })
    }
}
