//! The documentation of generated modules: what a reader of it finds, with the frames and values of the documents.

use std::path::Path;

use canspec_codegen::emit::{self, Options};
use canspec_codegen::model::{Example, Kind, Message, MessageId, Protocol};
use canspec_codegen::text::Text;
use canspec_tests::{protocol, specs};
use syn::{Expr, ExprLit, Lit, Meta};

/// Returns the documentation of each struct of a protocol's module.
fn structs(protocol: &Protocol) -> Vec<(String, String)> {
    let file = syn::parse_file(&emit::rust(protocol, &Options::default())).expect("it is Rust");
    let structs = file.items.into_iter().filter_map(|item| match item {
        syn::Item::Struct(item) => Some((item.ident.to_string(), documentation(&item.attrs))),
        _ => None,
    });
    structs.collect()
}

/// Returns a documentation comment as one line.
fn documentation(attributes: &[syn::Attribute]) -> String {
    let lines = attributes.iter().filter_map(|attribute| match &attribute.meta {
        Meta::NameValue(known) if known.path.is_ident("doc") => match &known.value {
            Expr::Lit(ExprLit { lit: Lit::Str(text), .. }) => Some(text.value()),
            _ => None,
        },
        _ => None,
    });
    lines.collect::<String>().split_whitespace().collect::<Vec<_>>().join(" ")
}

/// Converts `set_output` to `SetOutput`.
fn camel_case(name: &str) -> String {
    let words = name.split('_').map(|word| word[..1].to_uppercase() + &word[1..]);
    words.collect()
}

/// Returns the frames of a message that its document prints whole, and as they are.
fn printed(protocol: &Protocol, id: MessageId, kind: Kind) -> Vec<&Example> {
    let of_message = |example: &&Example| example.message == Some(id) && example.kind == kind;
    let holds = |example: &&Example| example.is_documented() && example.fails.is_none() && example.data.is_some();
    protocol.examples.iter().filter(of_message).filter(holds).collect()
}

/// Writes a frame as documents print it.
fn frame(example: &Example) -> String {
    let data = example.data.iter().flatten().fold(String::new(), |text, byte| format!("{text}{byte:02X}"));
    if example.extended { format!("{:08X}#{data}", example.id) } else { format!("{:03X}#{data}", example.id) }
}

/// Tests that a documentation shows a frame with the values that the document states.
fn shows(documentation: &str, message: &Message, example: &Example) -> bool {
    let plain = documentation.replace(['\\', '`'], "");
    let values = example.means.iter().map(|known| format!("{} {}", message.signals[known.signal].name, known.text));
    let values = values.collect::<Vec<_>>().join(", ").replace('`', "");
    let colon = if values.is_empty() { "" } else { ": " };
    plain.contains(&format!("{}{colon}{values}.", frame(example)))
}

#[test]
fn the_struct_of_a_message_shows_a_printed_frame_of_each_kind_with_its_values() {
    let mut shown = 0;
    for path in specs("specs") {
        let protocol = protocol(path);
        let structs = structs(&protocol);
        for (id, message) in protocol.messages.entries() {
            let name = camel_case(&message.name);
            let (_, documentation) = structs.iter().find(|(known, _)| *known == name).expect(&name);
            for kind in Kind::ALL {
                let printed = printed(&protocol, id, kind);
                shown += usize::from(!printed.is_empty());
                let is_shown = printed.iter().any(|example| shows(documentation, message, example));
                assert!(is_shown || printed.is_empty(), "{}: {}", protocol.name, documentation);
            }
        }
    }
    assert!(shown > 60, "{shown}");
}

#[test]
fn the_struct_of_a_message_says_who_answers_in_which_mode_and_how_often_a_report_comes() {
    for (protocol, name, expected) in [
        (
            "infy",
            "SetModuleOutput",
            "the module answers (`point_to_point`), each module answers (`group`), nobody answers (`broadcast`).",
        ),
        ("infy", "SystemOutput", "one answers for all (`group`, `broadcast`, `all_groups`)."),
        ("trio", "OutputValues", "the module sends it (`point_to_point`). It comes every 200 ms."),
    ] {
        let structs = structs(&shipped(protocol));
        let (_, documentation) = structs.iter().find(|(known, _)| *known == name).expect(name);
        assert!(documentation.contains(expected), "{documentation}");
    }
}

#[test]
fn the_struct_of_a_message_names_its_selectors_and_accesses_and_the_errata_with_their_reasons() {
    for path in specs("specs") {
        let protocol = protocol(path);
        let structs = structs(&protocol);
        for message in &*protocol.messages {
            let name = camel_case(&message.name);
            let (_, documentation) = structs.iter().find(|(known, _)| *known == name).expect(&name);
            for known in &message.constants {
                let selector = &protocol[known.selector].name;
                let value = protocol.selector_value(known.selector, known.value);
                assert!(documentation.contains(&format!("`{selector}` {value}")), "{selector}: {documentation}");
            }
            for exchange in &*message.exchanges {
                let access = &protocol[exchange.access];
                assert!(documentation.contains(&format!("- [`{}`](", access.name)), "{documentation}");
            }
            let errata = protocol.errata.iter().filter(|erratum| message.doc.errata.contains(&erratum.name));
            for erratum in errata.filter(|erratum| !["ocr", "note"].contains(&erratum.kind.as_str())) {
                let plain = documentation.replace(['`', '\\'], "");
                let because = erratum.because.for_people().replace(['`', '\\'], "");
                assert!(plain.contains(&format!(", because {because}")), "{because}: {documentation}");
            }
        }
    }
}

/// Returns the rows of the table of messages, cell by cell.
fn rows(manual: &str) -> Vec<Vec<&str>> {
    let rows = manual.lines().filter_map(|line| line.strip_prefix("//! | ")?.strip_suffix(" |"));
    rows.skip(2).map(|row| row.split(" | ").map(str::trim).collect()).collect()
}

#[test]
fn the_table_has_each_message_once_in_the_order_of_the_document() {
    for path in specs("specs") {
        let protocol = protocol(path);
        let manual = emit::manual(&protocol, &Options::default());
        let rows = rows(&manual);
        assert_eq!(rows.len(), protocol.messages.len(), "{manual}");
        for (row, message) in rows.iter().zip(&*protocol.messages) {
            let link = format!("[`{0}`](struct@{0})", camel_case(&message.name));
            assert_eq!(row.iter().filter(|cell| **cell == link).count(), 1, "{row:?}");
            for known in &message.constants {
                assert!(row.contains(&&*protocol.selector_value(known.selector, known.value)), "{row:?}");
            }
            for exchange in &*message.exchanges {
                let access = format!("[`{}`](", protocol[exchange.access].name);
                assert!(row.iter().any(|cell| cell.contains(&access)), "{row:?}");
            }
            assert_eq!(row.last().copied(), message.doc.section.as_ref().map(Text::for_people));
        }
    }
}

/// Returns a protocol that ships.
fn shipped(name: &str) -> Protocol {
    protocol(Path::new(env!("CARGO_MANIFEST_DIR")).join("../specs").join(name).with_extension("yaml"))
}

#[test]
fn a_module_opens_with_the_document_and_its_bus_and_states_its_times() {
    let manual = emit::manual(&shipped("infy"), &Options::default());
    let head = "//! INFY POWER charging modules.\n//!\n\
        //! Document: 充电模块 CAN 通讯协议, version V1.08 of 2020-10-18. The bus runs at 125 kbit/s.\n";
    assert!(manual.starts_with(head), "{manual}");
    let one_line = manual.replace("\n//!  ", "");
    for time in [
        "- Silence after which a module reports `communication_lost` and switches off: 10 s (`watchdog`). Section 3.1. \
        10 s is the default; any command counts;",
        "- From one request to the next: 50 to 200 ms, at least 20 ms (`request_gap`). Section 3.6. Must be longer than \
        the minimum.",
    ] {
        assert!(one_line.contains(time), "{one_line}");
    }
}

#[test]
fn the_example_of_a_module_is_the_request_and_the_frame_that_show_most() {
    let manual = emit::manual(&shipped("infy"), &Options::default());
    let lines: Vec<_> = manual.lines().collect();
    let start = lines.iter().position(|line| line.starts_with("//! let request")).expect("it has a request");
    assert_eq!(
        lines[start..][..2],
        [
            "//! let request = SetTotalOutput { voltage_v: 300.0, current_a: 10.0 }.set_total(Target::Broadcast)?;",
            "//! assert_eq!(request.frame().to_string(), \"029B3FF0#000493E000002710\");",
        ]
    );
}

#[test]
fn the_example_of_a_module_has_printed_frames_and_their_values() {
    for path in specs("specs") {
        let protocol = protocol(path);
        let manual = emit::manual(&protocol, &Options::default());
        let all = || protocol.messages.ids();
        // What the controller sends is a request, or a report.
        let request = all().flat_map(|id| [Kind::Request, Kind::Report].map(|kind| printed(&protocol, id, kind)));
        let request = request.flatten();
        let built = |example: &&Example| {
            manual.contains(&format!("assert_eq!(request.frame().to_string(), \"{}\");", frame(example)))
        };
        assert!(request.filter(built).count() > 0, "{manual}");
        let others = all().flat_map(|id| [Kind::Reply, Kind::Report].map(|kind| printed(&protocol, id, kind)));
        let data = |example: &Example| {
            let bytes = example.data.iter().flatten().chain(&[0; 8]).take(8);
            bytes.map(|byte| format!("0x{byte:02X}")).collect::<Vec<_>>()
        };
        let decoded = |example: &&Example| manual.contains(&format!(", [{}], ", data(example).join(", ")));
        assert!(others.flatten().any(|example| decoded(&example)), "{manual}");
    }
}

/// Returns what the links in a text lead to.
fn links(text: &str) -> Vec<&str> {
    let links = text.split("[`").skip(1).filter_map(|rest| {
        let (name, behind) = rest.split_once("`]")?;
        let target = behind.strip_prefix('(').and_then(|rest| rest.split_once(')'));
        Some(target.map_or(name, |(target, _)| target.trim_start_matches("struct@")))
    });
    links.collect()
}

#[test]
fn each_link_in_a_module_leads_to_an_item_of_it_so_that_it_holds_without_the_runtimes_pages() {
    let mut checked = 0;
    for path in ["specs", "tests/specs", "tests/specs/features", "tests/specs/devices"].into_iter().flat_map(specs) {
        let protocol = protocol(path);
        let code = emit::rust(&protocol, &Options::default());
        let file = syn::parse_file(&code).expect("it is Rust");
        let items = file.items.iter().filter_map(|item| match item {
            syn::Item::Const(item) => Some(item.ident.to_string()),
            syn::Item::Enum(item) => Some(item.ident.to_string()),
            syn::Item::Struct(item) => Some(item.ident.to_string()),
            syn::Item::Type(item) => Some(item.ident.to_string()),
            _ => None,
        });
        let items: Vec<_> = items.collect();
        let comments = code.lines().filter(|line| line.trim_start().starts_with("///")).map(str::to_owned);
        let manual = emit::manual(&protocol, &Options::default());
        for comment in comments.chain(manual.lines().map(str::to_owned)) {
            for target in links(&comment) {
                checked += 1;
                assert!(items.iter().any(|item| item == target), "{}: {comment}", protocol.name);
            }
        }
    }
    assert!(checked > 500, "{checked}");
}
