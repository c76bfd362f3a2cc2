//! What several frames carry together, in both engines.

use canspec_codegen::interpret::Value;
use canspec_codegen::model::{LongMessage, Message, Protocol, Signal};
use canspec_runtime::LongLayout;
use serde_json::Value as Json;

/// Returns the long message whose struct is `L`.
///
/// # Panics
///
/// If the interpreter does not know it.
pub fn long<L: LongLayout>(protocol: &Protocol) -> &LongMessage {
    let found = protocol.long_messages.iter().find(|long| long.content.name == L::MESSAGE);
    found.expect("both engines have it")
}

/// Returns the values of a struct that are those of a signal. The name of a member may end with a unit.
///
/// # Panics
///
/// If it has none.
pub fn member<'a>(values: &'a Json, content: &Message, signal: &Signal) -> &'a Json {
    let name = content.field_name(signal);
    let members = values.as_object().expect("a struct").iter();
    let ending = |member: &str| member.strip_prefix(name).map(|ending| ending.is_empty() || ending.starts_with('_'));
    let mut members: Vec<_> = members.filter(|(member, _)| ending(member) == Some(true)).collect();
    members.sort_by_key(|(member, _)| member.len());
    let value = members.first().expect("both engines have the signal").1;
    signal.element.map_or(value, |element| &value[usize::from(element.index)])
}

/// Tests whether a value of the interpreter is one of a struct, whose numbers have single precision.
#[expect(clippy::cast_possible_truncation, reason = "numbers of both engines are compared in single precision")]
pub fn is_same(value: &Value, json: &Json) -> bool {
    match value {
        Value::Integer(number) => json.as_i64().map(i128::from) == Some(*number),
        Value::Number(number) => {
            json.as_f64().is_some_and(|json| (json as f32).to_bits() == (*number as f32).to_bits())
        }
        Value::Name(name) if json.is_null() => *name == "not_available",
        Value::Text(text) if json.is_array() => {
            let bytes = json.as_array().into_iter().flatten().filter_map(Json::as_u64);
            bytes.map(|byte| format!("{byte:02X}")).collect::<Vec<_>>().concat() == *text
        }
        Value::Name(text) | Value::Text(text) => json.as_str() == Some(text),
        Value::None | Value::Status { .. } => true,
    }
}
