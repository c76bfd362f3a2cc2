//! How a long message travels: in numbered parts, or by a transport.

use canspec_codegen::model::{Carrier, LongMessage, Parts, Protocol, WrittenPlace};

/// Says how many bytes or parts it has.
pub fn text(protocol: &Protocol, long: &LongMessage) -> String {
    match &long.carrier {
        Carrier::Parts(known) => parts(protocol, long, known),
        Carrier::Transport(transport) => {
            let (least, most) = (long.shortest(), long.longest());
            let lengths: Vec<_> = match long.lengths.as_slice() {
                [] if least == most => vec![most.to_string()],
                [] => vec![format!("{least} to {most}")],
                several => several.iter().map(u16::to_string).collect(),
            };
            format!("{} bytes by {}", lengths.join(" or "), protocol[*transport].name)
        }
        // The enum may grow.
        _ => String::new(),
    }
}

/// Says in how many parts a long message travels, and how they are numbered.
fn parts(protocol: &Protocol, long: &LongMessage, parts: &Parts) -> String {
    let of_models = parts.model_firsts.iter().map(|own| format!("{} ({})", own.value, protocol[own.model].name));
    let firsts: Vec<_> = parts.first.map(|first| first.to_string()).into_iter().chain(of_models).collect();
    let (least, most) = (long.parts_of(long.shortest()), long.parts_of(long.longest()));
    let count = if least == most { most.to_string() } else { format!("{least} to {most}") };
    let numbers = format!("in {count} parts of {} bytes, numbered from {}", parts.size, firsts.join(" or "));
    [Some(numbers), length(parts), elements(protocol, parts), silence(protocol, parts)].into_iter().flatten().collect()
}

/// Says where the first part has the number of bytes.
fn length(parts: &Parts) -> Option<String> {
    let length = parts.length?;
    let bytes = if length.bytes() == 1 { "byte" } else { "bytes" };
    Some(format!(", length in {bytes} {} of the first part", WrittenPlace::of(length.place)))
}

/// Says which field has the number of elements.
fn elements(protocol: &Protocol, parts: &Parts) -> Option<String> {
    let (message, signal) = parts.count?;
    let message = &protocol[message];
    Some(format!(", as many elements as `{}.{}` says", message.name, message[signal].name))
}

fn silence(protocol: &Protocol, parts: &Parts) -> Option<String> {
    parts.silence.map(|time| format!(", until `{}`", protocol.timing[time].name))
}
