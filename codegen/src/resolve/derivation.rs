//! Finds out what a spec takes over from the one that it is based on.

use super::Resolver;
use crate::model::{Derivation, Descent, Message, MessageId, Table};
use crate::report::tree::{Content, Node, Path};
use crate::words::text::Text;

impl Resolver<'_> {
    /// Describes how a spec changes its base, if it has one.
    pub fn derivation(&self, messages: &Table<MessageId, Message>) -> Option<Derivation> {
        let texts = |paths: &[String]| paths.iter().map(|path| Text::new(path)).collect();
        Some(Derivation {
            base: Text::new(self.spec.based_on.as_ref()?),
            replaces: texts(&self.spec.replaces),
            removes: texts(&self.spec.removes),
            descents: messages.entries().map(|(id, message)| self.descent(self.written_at(id, message))).collect(),
        })
    }

    /// Returns where a message is written. A frame of a transport has no place of its own.
    fn written_at<'a>(&'a self, id: MessageId, message: &'a Message) -> &'a Path {
        let carrier = self.tables.transports.iter().find(|known| known.frames.contains(&id));
        carrier.map_or(&message.doc.path, |carrier| &carrier.doc.path)
    }

    fn descent(&self, path: &Path) -> Descent {
        let place = path.to_string();
        let mut listed = self.spec.replaces.iter().chain(&self.spec.removes);
        let is_inside =
            |path: &String| path.strip_prefix(&place).is_some_and(|rest| rest.is_empty() || rest.starts_with('.'));
        let is_taken_over = self.diagnostics.is_taken_over(&path.at_key());
        if listed.any(is_inside) {
            Descent::Changed
        } else if is_taken_over {
            Descent::TakenOver
        } else if self
            .diagnostics
            .tree()
            .and_then(|tree| tree.get(path))
            .is_some_and(|node| self.holds_taken_over(node))
        {
            Descent::Changed
        } else {
            Descent::Own
        }
    }

    /// Tests whether something in an item is that of the base.
    fn holds_taken_over(&self, item: &Node) -> bool {
        let is_taken_over = |span: &std::ops::Range<usize>| self.diagnostics.is_taken_over(&span.clone().into());
        match &item.content {
            Content::Map(entries) => {
                entries.values().any(|entry| is_taken_over(&entry.key) || self.holds_taken_over(&entry.value))
            }
            Content::List(_) | Content::Text(_) | Content::Refused => is_taken_over(&item.span),
        }
    }
}
