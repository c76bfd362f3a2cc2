//! Lists what a DBC says and the spec does not.

use std::collections::BTreeSet;

use can_dbc::{AttributeValue, Comment, Dbc, MessageId};

use super::index::Index;
use super::spec::one_line;

/// Lists what the file has beside messages and signals, by kind.
pub fn beside_messages(dbc: &Dbc) -> Vec<String> {
    let attributes = attributes(dbc);
    let variables = dbc.environment_variables.iter().map(|variable| variable.name.as_str()).collect();
    let groups = dbc.signal_groups.iter().map(|group| group.name.as_str()).collect();
    let comments = dbc.comments.iter().filter_map(|comment| match comment {
        Comment::Node { name, comment } => Some(format!("`{name}` is described as: {}", one_line(comment))),
        Comment::Plain { comment } => Some(format!("the file is described as: {}", one_line(comment))),
        Comment::Message { .. } | Comment::Signal { .. } | Comment::EnvVar { .. } => None,
    });
    let lists = [("attributes", attributes), ("environment variables", variables), ("groups of signals", groups)];
    let lists = lists
        .into_iter()
        .filter(|(_, names)| !names.is_empty())
        .map(|(what, names)| format!("{what}: {}", names.into_iter().map(one_line).collect::<Vec<_>>().join(", ")));
    lists.chain(comments).chain(senders(dbc)).collect()
}

/// Lists the messages that come from several nodes.
fn senders(dbc: &Dbc) -> impl Iterator<Item = String> {
    dbc.message_transmitters.iter().filter(|known| !known.transmitter.is_empty()).map(|known| {
        let id = known.message_id.raw() & !(1 << 31);
        format!("further senders of 0x{id:X}: {}", one_line(&known.transmitter.join(", ")))
    })
}

/// Returns the names of the attributes that have values, without the one that is imported.
fn attributes(dbc: &Dbc) -> BTreeSet<&str> {
    let of_messages = dbc.attribute_values_message.iter().map(|value| value.name.as_str());
    let of_signals = dbc.attribute_values_signal.iter().map(|value| value.name.as_str());
    let of_nodes = dbc.attribute_values_node.iter().map(|value| value.name.as_str());
    let of_file = dbc.attribute_values_database.iter().map(|value| value.name.as_str());
    let of_variables = dbc.attribute_values_env.iter().map(|value| value.name.as_str());
    let of_relations = dbc.relation_attribute_values.iter().map(|value| value.name.as_str());
    let all = of_messages.chain(of_signals).chain(of_nodes).chain(of_file).chain(of_variables).chain(of_relations);
    all.filter(|name| *name != "GenMsgCycleTime").collect()
}

/// Tests whether an identifier stands for a parameter group of J1939, from any source at any priority.
pub fn is_parameter_group(index: &Index, id: MessageId) -> bool {
    match index.attribute(id, "VFrameFormat") {
        Some(AttributeValue::Uint(3)) => true,
        Some(AttributeValue::String(format)) => format == "J1939PG",
        _ => false,
    }
}

/// Returns the milliseconds between two frames of a message.
pub fn cycle(index: &Index, id: MessageId) -> Option<u64> {
    match index.attribute(id, "GenMsgCycleTime") {
        Some(AttributeValue::Uint(time)) => Some(*time).filter(|time| (1..=86_400_000).contains(time)),
        _ => None,
    }
}
