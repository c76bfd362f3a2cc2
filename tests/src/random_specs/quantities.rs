//! Quantities of a random spec: names for some of its signals.

use canspec_codegen::model::{Encoding, Enumeration, FrameLayout, Kind, Message, Protocol, Signal};
use canspec_runtime::Quantity;
use serde_yaml::Value;

use super::draft::Draft;
use super::names::Scope;
use super::yaml::{Map, list};

impl Draft {
    /// Gives names to some signals of replies, reports and requests.
    pub fn add_quantities(&mut self, root: &mut Value, protocol: &Protocol) {
        if self.chance(40) {
            return;
        }
        let (mut quantities, mut scope) = (Map::default(), Scope::default());
        // Each of these has a unit of its own.
        for (standard, _) in Quantity::STANDARD {
            scope.take(standard.name());
        }
        // Another message may look like that of some models.
        let is_of_all = |message: &&Message| message.models.is_empty();
        let messages = protocol.messages.iter().filter(|message| message.long.is_none() && message.set.is_none());
        let messages = messages.filter(is_of_all);
        for message in messages.take(6) {
            let frames = || protocol.frames_of(message).filter(|frame| frame.long.is_none());
            if let Some(frame) = frames().find(|frame| !frame.is_to_module()) {
                self.read_quantities(protocol, message, frame, (&mut quantities, &mut scope));
            }
            let asks = |frame: &&FrameLayout| frame.kind == Kind::Request && frame.set.is_none();
            if let Some(frame) = frames().filter(asks).find(|frame| !frame.signals.is_empty()) {
                self.set_quantities(protocol, message, frame, (&mut quantities, &mut scope));
            }
        }
        let product = self.product(protocol, (&mut quantities, &mut scope));
        if let (false, Some(root)) = (quantities.is_empty(), root.as_mapping_mut()) {
            root.insert("quantities".into(), quantities.into());
            root.extend(product.map(|product| ("product".into(), product)));
        }
    }

    /// Limits quantities of fields that requests carry and no other quantity sets.
    fn product(&mut self, protocol: &Protocol, (quantities, scope): (&mut Map, &mut Scope)) -> Option<Value> {
        let mut limits = Map::default();
        let named = Value::from(quantities.clone());
        let is_named = |path: &str| serde_yaml::to_string(&named).is_ok_and(|text| text.contains(path));
        let messages = protocol
            .messages
            .iter()
            .map(|message| (message, protocol.long_message(message).map_or(message, |(_, long)| &long.content)));
        for (message, signal) in
            messages.flat_map(|(message, whole)| whole.signals.iter().map(move |signal| (message, signal)))
        {
            let path = format!("{}.{}", message.name, signal.name);
            let is_sent = protocol.layouts_of(message).any(|frame| {
                let is_part = protocol.part_of(frame).is_some();
                frame.is_to_module() && (is_part || protocol.signals_of(frame).any(|(_, own)| own.name == signal.name))
            });
            let range = limit(protocol, message, signal).filter(|_| is_sent && signal.element.is_none());
            let Some(range) = range.filter(|_| !is_named(&path) && self.chance(50)) else { continue };
            let name = self.names.plain(scope);
            limits.put(name.clone(), range);
            quantities.put(name, Map::of([("also", list([path]))]));
        }
        (!limits.is_empty()).then(|| Map::of([("limits", limits)]).into())
    }

    fn read_quantities(
        &mut self,
        protocol: &Protocol,
        message: &Message,
        frame: &FrameLayout,
        (quantities, scope): (&mut Map, &mut Scope),
    ) {
        for id in frame.signals.iter().take(3) {
            if let Some(path) = self.quantity_path(protocol, message, &message[*id]) {
                let name = self.names.plain(scope);
                quantities.put(name, Map::of([("read", path)]));
            }
        }
    }

    /// Sets all fields of a request: the first ones by quantities, the others by what they always are.
    fn set_quantities(
        &mut self,
        protocol: &Protocol,
        message: &Message,
        frame: &FrameLayout,
        (quantities, scope): (&mut Map, &mut Scope),
    ) {
        if frame.lengths.len() > 1 {
            return;
        }
        let signals: Vec<&Signal> = frame.signals.iter().map(|id| &message[*id]).collect();
        // Each bit of a word would have to be a quantity.
        if signals.iter().any(|signal| matches!(signal.encoding, Encoding::Status(id) if protocol[id].bits.len() > 1)) {
            return;
        }
        let count = 1 + self.random.usize(..signals.len());
        let (set, fixed) = signals.split_at(count);
        let paths: Option<Vec<_>> = set.iter().map(|signal| self.quantity_path(protocol, message, signal)).collect();
        let fixed: Option<Vec<_>> =
            fixed.iter().map(|signal| Some((signal.name.clone(), first_name(protocol, signal)?))).collect();
        let (Some(paths), Some(fixed)) = (paths, fixed) else { return };
        for (index, path) in paths.into_iter().enumerate() {
            let path = if index == 0 && !fixed.is_empty() { with(path, &fixed) } else { path };
            let name = self.names.plain(scope);
            quantities.put(name, Map::of([("set", path)]));
        }
    }

    /// Returns the path to a signal, if it is a number with a unit or has states.
    fn quantity_path(&mut self, protocol: &Protocol, message: &Message, signal: &Signal) -> Option<Value> {
        let path = format!("{}.{}", message.name, signal.name);
        let (path, states) = match signal.encoding {
            Encoding::Number { .. } | Encoding::Float => {
                signal.unit?;
                return Some(if self.chance(80) { path.into() } else { Map::of([("signal", path)]).into() });
            }
            Encoding::Named(id) => {
                let mut names = names_of_all(&protocol[id]);
                (path, [names.next()?, names.next()?])
            }
            Encoding::Status(id) => {
                let bit = protocol[id].bits.first()?;
                (format!("{path}.{}", bit.name), ["0".to_owned(), "1".to_owned()])
            }
            Encoding::ByModel { .. } | Encoding::Text(_) | Encoding::Packed { .. } => return None,
        };
        let [active, inactive] = states;
        Some(Map::of([("signal", path), ("active", active), ("inactive", inactive)]).into())
    }
}

/// Returns limits of a number with a unit that leave values for every device model.
fn limit(protocol: &Protocol, message: &Message, signal: &Signal) -> Option<String> {
    let (unit, linear) = (signal.unit?, signal.encoding.linear()?);
    if !signal.encoding.by_model().is_empty() {
        return None;
    }
    let of_models = protocol.models_of(message).map(|model| signal.range_for(Some(model)));
    let ranges = of_models.chain([signal.range]).map(|range| linear.integers(range.or_else(|| signal.held())?));
    let ranges: Option<Vec<[i128; 2]>> = ranges.collect();
    let [first, last] = ranges?.into_iter().reduce(|one, other| [one[0].max(other[0]), one[1].min(other[1])])?;
    let (one, other) = (linear.value(first)?, linear.value(last)?);
    (first <= last).then(|| format!("{}..{} {}", one.min(other), one.max(other), unit.symbol))
}

/// Returns the names of values that every device model has.
fn names_of_all(values: &Enumeration) -> impl Iterator<Item = String> {
    values.values.iter().filter(|value| value.models.is_empty()).map(|value| value.name.clone())
}

/// Adds what other fields always are.
fn with(path: Value, fixed: &[(String, String)]) -> Value {
    let fixed = Value::from(Map::of(fixed.iter().cloned()));
    match path {
        Value::Mapping(mut path) => {
            path.insert("with".into(), fixed);
            path.into()
        }
        path => Map::of([("signal", path), ("with", fixed)]).into(),
    }
}

/// Returns the first name of a signal's values.
fn first_name(protocol: &Protocol, signal: &Signal) -> Option<String> {
    match signal.encoding {
        Encoding::Named(id) => names_of_all(&protocol[id]).next(),
        Encoding::Number { .. } => signal.specials.first().map(|special| special.name.clone()),
        Encoding::Float
        | Encoding::ByModel { .. }
        | Encoding::Status(_)
        | Encoding::Text(_)
        | Encoding::Packed { .. } => None,
    }
}
