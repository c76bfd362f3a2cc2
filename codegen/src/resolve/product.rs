//! Resolves the limits of the product in which the devices work.

use super::Resolver;
use crate::model::{Limit, Message, MessageId, QuantityPaths, SignalId, Table, Unit};
use crate::report::tree::Path;
use crate::resolve::rules;

impl Resolver<'_> {
    /// Reads the limits, and gives each to all signals that set its quantity.
    pub fn limits(&mut self, quantities: &[QuantityPaths], messages: &mut Table<MessageId, Message>) -> Vec<Limit> {
        let (spec, path) = (self.spec, Path::default().key("product"));
        let Some(product) = &spec.product else { return Vec::new() };
        self.check_not_empty(&Path::default(), &["product"]);
        self.check_not_empty(&path, &["limits"]);
        let mut limits = Vec::new();
        for (name, text) in &product.limits {
            let path = path.key("limits").key(name);
            let names = quantities.iter().map(|known| known.name.as_str());
            let Some(index) = self.lookup_key(&path, "quantity", name, names) else { continue };
            let Some(limit) = self.limit(&path, text, &quantities[index], quantities, messages) else { continue };
            self.narrow(&limit, &quantities[index], messages);
            limits.push(limit);
        }
        limits
    }

    fn limit(
        &mut self,
        path: &Path,
        text: &str,
        known: &QuantityPaths,
        quantities: &[QuantityPaths],
        messages: &Table<MessageId, Message>,
    ) -> Option<Limit> {
        if self.diagnostics.has_errors_in(&known.path) {
            return None;
        }
        let Some((message, field)) = setter(known, messages) else {
            let why = if is_switch(known) { "is a switch" } else { "is set by no request" };
            let text = format!("`{}` {why}, so it has no limit", known.name);
            let others = quantities.iter().filter(|known| setter(known, messages).is_some());
            let others: Vec<_> = others.map(|known| format!("`{}`", known.name)).collect();
            let others = if others.is_empty() { String::new() } else { format!(" ({})", others.join(", ")) };
            let help = format!("limit a number that a request sets{others}, or take it out");
            self.error_with_help(&rules::PRODUCT_LIMIT, path.at_key(), text, help);
            return None;
        };
        let unit = self.unit_of_setter(&messages[message], field);
        if let Some(Unit { symbol, .. }) = unit.filter(|_| !text.contains(' ')) {
            let help = format!("write `{text} {symbol}`");
            self.error_with_help(&rules::UNIT, path.at_value(), format!("the limit `{text}` has no unit"), help);
            return None;
        }
        let range = self.range_of(path, text, unit)?;
        Some(Limit { quantity: known.name.clone(), range, unit, path: path.clone() })
    }

    /// Returns the unit of a field, which may travel in several frames.
    fn unit_of_setter(&self, message: &Message, field: &str) -> Option<Unit> {
        let content = message.long.map_or(message, |long| &self.tables.long_messages[long].content);
        content.signals_of(field).next()?.unit
    }

    /// Gives the limit to the signals of messages, and not to the numbers and the data of parts.
    fn narrow(&mut self, limit: &Limit, known: &QuantityPaths, messages: &mut Table<MessageId, Message>) {
        let fields: Vec<_> = known.fields(|id| &messages[id]).map(|(id, field, _)| (id, field.to_owned())).collect();
        for (id, field) in fields {
            let long = messages[id].long.map(|long| &mut self.tables.long_messages[long]);
            let own = long.as_ref().is_none_or(|long| long.parts().is_none()).then(|| &mut messages[id]);
            let contents = long.map(|long| &mut long.content).into_iter().chain(own);
            contents.for_each(|content| narrow(content, &field, limit));
        }
    }
}

/// Returns a field of a request that sets a number.
fn setter<'a>(known: &'a QuantityPaths, messages: &'a Table<MessageId, Message>) -> Option<(MessageId, &'a str)> {
    let (message, field, _) = known.fields(|id| &messages[id]).next().filter(|_| !is_switch(known))?;
    Some((message, field))
}

fn is_switch(known: &QuantityPaths) -> bool {
    known.set.as_ref().is_some_and(|set| set.states.is_some())
}

fn narrow(content: &mut Message, field: &str, limit: &Limit) {
    let is_of_field = |id: &SignalId| content.field_name(&content[*id]) == field;
    let limited: Vec<_> = content.signals.ids().filter(is_of_field).collect();
    for id in limited {
        content.signals[id].limit = Some(limit.clone());
    }
}
