//! The optional traits of generated code: what is written for people, and that every value comes back.

use std::fmt::Debug;

use arbitrary::{Arbitrary, Unstructured};
use canspec_codegen::emit::{Options, Switch};
use canspec_codegen::interpret;
use canspec_codegen::source::Source;
use canspec_protocols::gcp::{SetWalkIn, WalkIn};
use canspec_protocols::infy::{self, BarcodeValue, Message, Status1, Target};
use canspec_runtime::plumbing::{Raw, Task};
use canspec_runtime::with_serde::{array, float};
use canspec_runtime::{Bcd, Bytes, Elements, Frame, Layout, Payload, Protocol, Text};
use canspec_tests::features_status_word_switched::State;
use canspec_tests::{Frames, Optional, SwitchedVisitor, models, protocol, received, visit_switched};
use serde::de::DeserializeOwned;
use serde_json::value::Serializer;
use serde_json::{Value, json};

/// How many random frames each protocol sees.
const FRAMES: usize = 10_000;

/// Returns a value as it comes back from JSON, and as it comes back from a binary format.
fn both_ways<T: Optional>(value: &T) -> [T; 2] {
    let text = serde_json::to_string(value).expect("every value has JSON");
    let bytes = postcard::to_allocvec(value).expect("every value has bytes");
    [
        serde_json::from_str(&text).unwrap_or_else(|error| panic!("{text}: {error}")),
        postcard::from_bytes(&bytes).unwrap_or_else(|error| panic!("{bytes:?}: {error}")),
    ]
}

/// Writes the values of a message into bytes.
struct Bytewise;

impl Task for Bytewise {
    type Output = [u8; 8];

    fn run<L: Layout>(self, values: &L) -> [u8; 8] {
        let mut payload = Payload::new("message", [0; 8]);
        values.encode(&mut payload).expect("what was decoded fits its signals");
        *payload.data()
    }
}

#[test]
fn a_spec_without_messages_imports_only_what_its_code_names() {
    let spec = include_str!("../specs/rules/grid/good.yaml");
    let (head, _) = spec.split_once("access:").expect("the spec has an access");
    let spec = format!("{head}access: {{}}\nmodels: {{HX: {{section: \"1\"}}}}\n");
    let [serde, defmt, arbitrary] = [(); 3].map(|()| Switch::Always);
    let options = Options { serde, defmt, arbitrary, ..Options::default() };
    let source = Source::new("heater.yaml", spec.into_bytes()).expect("plain text");
    let code = canspec_codegen::generate(source, &options).unwrap_or_else(|why| panic!("{why}")).code;
    for name in ["arbitrary", "defmt", "serde"] {
        let is_imported = code.contains(&format!("use canspec_runtime::plumbing::{name};"));
        assert_eq!(is_imported, code.contains(&format!("{name}::")), "{name}");
    }
}

struct Examples {
    frames: usize,
}

impl SwitchedVisitor for Examples {
    fn visit<P>(&mut self, path: &str)
    where
        P: Protocol<Identifier: Optional> + Optional + PartialEq,
    {
        for example in protocol(path).examples.iter().filter(|example| example.fails.is_none()) {
            let Some(data) = example.data.clone() else { continue };
            let form = interpret::Form::Data;
            let frame = interpret::Frame { id: example.id, extended: example.extended, data, form };
            let model = example.model;
            let Ok(received) = received::<P>(model, &frame) else { panic!("{path}: {}", example.doc.path) };
            assert_eq!(both_ways(received.content()), [*received.content(); 2], "{path}");
            assert_eq!(both_ways(&received.identifier()), [received.identifier(); 2], "{path}");
            assert_eq!(both_ways(received.frame()), [*received.frame(); 2], "{path}");
            self.frames += 1;
        }
    }
}

#[test]
fn every_documented_frame_comes_back_from_serde() {
    let mut examples = Examples { frames: 0 };
    visit_switched(&mut examples);
    assert!(examples.frames >= 140, "{} frames", examples.frames);
}

struct Random;

impl SwitchedVisitor for Random {
    fn visit<P>(&mut self, path: &str)
    where
        P: Protocol<Identifier: Optional> + Optional + PartialEq,
    {
        let protocol = protocol(path);
        let mut frames = Frames::new(&protocol, 0x5E7D);
        for model in models(&protocol).cycle().take(FRAMES) {
            let Ok(received) = received::<P>(model, &frames.next_frame()) else { continue };
            let expected = received.content().run(Bytewise);
            assert_eq!(both_ways(received.content()).map(|content| content.run(Bytewise)), [expected; 2], "{path}");
            assert_eq!(both_ways(&received.identifier()), [received.identifier(); 2], "{path}");
        }
    }
}

#[test]
fn whatever_bits_a_frame_has_they_come_back_from_serde() {
    visit_switched(&mut Random);
}

fn infy(frame: &str) -> infy::Received {
    let frame: Frame = serde_json::from_value(json!(frame)).expect("a frame");
    Message::decode(&frame).expect("a frame of the protocol")
}

fn shown(value: impl serde::Serialize) -> Value {
    serde_json::to_value(value).expect("every value has JSON")
}

fn refused<T: DeserializeOwned + Debug>(value: Value) -> String {
    serde_json::from_value::<T>(value).expect_err("a refusal").to_string()
}

#[test]
fn a_message_is_a_map_of_its_fields_under_its_name() {
    // 500.0 and 3.5 as IEEE floats are 43FA0000 and 40600000.
    let output = infy("0283F000#43FA000040600000");
    assert_eq!(shown(output.content()), json!({"module_output": {"voltage_v": 500.0, "current_a": 3.5}}));
    let identifier = json!({"error": "normal", "device": 10, "command": 3, "target": 240, "source": 0});
    assert_eq!(shown(output.identifier()), identifier);
    assert_eq!(shown(output.frame()), json!("0283F000#43FA000040600000"));
}

#[test]
fn the_page_about_formats_shows_what_is_written() {
    let output = infy("0283F000#43FA000040600000");
    let Message::ModuleOutput(values) = *output.content() else { panic!("{:?} is no output", output.content()) };
    let written = [
        serde_json::to_string(&values),
        serde_json::to_string(output.content()),
        serde_json::to_string(output.frame()),
        serde_json::to_string(&Status1::WALK_IN_ENABLED),
        serde_json::to_string(&SetWalkIn { walk_in: WalkIn::Enabled, interval_s: SetWalkIn::INTERVAL_UNSPECIFIED }),
    ];
    let page = include_str!("../../docs/formats.md");
    let (_, section) = page.split_once("\n## `serde`\n").expect("the page has this section");
    let shown = section.split("```json\n").nth(1).and_then(|rest| rest.split("\n```").next());
    let written = written.map(|line| line.expect("every value has JSON"));
    assert_eq!(shown, Some(written.join("\n").as_str()));
}

#[test]
fn a_float_that_is_no_number_is_the_text_of_its_bits() {
    let output = infy("0283F000#7FC01234FF800000");
    let written = json!({"module_output": {"voltage_v": "0x7FC01234", "current_a": "0xFF800000"}});
    assert_eq!(shown(output.content()), written);
    let back: Message = serde_json::from_value(written).expect("what was written");
    assert_eq!(back.run(Bytewise), [0x7F, 0xC0, 0x12, 0x34, 0xFF, 0x80, 0, 0]);
    for wrong in [json!("NaN"), json!("0x7FC0"), json!(null), json!("7FC01234")] {
        refused::<infy::ModuleOutput>(json!({"voltage_v": wrong, "current_a": 0.0}));
    }
}

#[test]
fn an_array_of_floats_has_an_item_for_each() {
    let values = [f32::from_bits(0x7FC0_1234), 2.5];
    let written = float::serialize(&values, Serializer).expect("every float has JSON");
    assert_eq!(written, json!(["0x7FC01234", 2.5]));
    let back: [f32; 2] = float::deserialize(written).expect("what was written");
    assert_eq!(back.map(f32::to_bits), values.map(f32::to_bits));
    let written = float::serialize(&[None, Some(values[0])], Serializer).expect("every float has JSON");
    assert_eq!(written, json!([null, "0x7FC01234"]));
    let back: [Option<f32>; 2] = float::deserialize(written).expect("what was written");
    assert_eq!(back.map(|value| value.map(f32::to_bits)), [None, Some(0x7FC0_1234)]);
    assert!(float::deserialize::<[f32; 2], _>(json!([1.0])).is_err());
}

#[test]
fn elements_are_a_list_of_any_length_that_there_is_room_for() {
    let some = Elements::<u8, 40>::from_slice(&[3, 4]).expect("two of forty");
    assert_eq!(shown(some), json!([3, 4]));
    assert_eq!(both_ways(&some), [some; 2]);
    let floats = Elements::<f32, 40>::from_slice(&[f32::INFINITY, 0.5]).expect("two of forty");
    let written = float::serialize(&floats, Serializer).expect("every float has JSON");
    assert_eq!(written, json!(["0x7F800000", 0.5]));
    assert_eq!(float::deserialize::<Elements<f32, 40>, _>(written).expect("what was written"), floats);
    refused::<Elements<u8, 2>>(json!([]));
    assert!(serde_json::from_str::<Elements<u8, 2>>("[1, 2, 3]").is_err());
}

#[test]
fn a_long_array_has_all_its_elements() {
    let values: [u8; 40] = std::array::from_fn(|index| index.try_into().expect("forty numbers"));
    let written = array::serialize(&values, Serializer).expect("every number has JSON");
    assert_eq!(written.as_array().map(Vec::len), Some(40));
    assert_eq!(array::deserialize::<u8, _, 40>(written).expect("what was written"), values);
    assert!(array::deserialize::<u8, _, 40>(json!([1, 2])).is_err());
}

#[test]
fn named_values_go_by_their_names_and_others_by_their_numbers() {
    assert_eq!([infy::Power::On, infy::Power::Unknown(7)].map(shown), [json!("on"), json!(7)]);
    assert_eq!(serde_json::from_value::<infy::Power>(json!(0)).ok(), Some(infy::Power::On));
    assert_eq!(
        refused::<infy::Power>(json!("dim")),
        "invalid value: string \"dim\", expected the name of a value, or its raw number"
    );
    assert!(refused::<infy::Power>(json!(256)).starts_with("invalid value: integer `256`"));
    assert!(refused::<infy::Power>(json!(-1)).starts_with("invalid value: integer `-1`"));
}

#[test]
fn a_status_word_names_its_set_bits_and_keeps_the_others() {
    for (raw, written) in [
        (0x0201, json!({"set": ["calm", "fan_fault"], "unknown": 0})),
        (0x8402, json!({"set": ["hot"], "unknown": 0x8400})),
        (0, json!({"set": [], "unknown": 0})),
    ] {
        assert_eq!(shown(State(raw)), written);
        assert_eq!(both_ways(&State(raw)), [State(raw); 2]);
    }
    let read = |value| serde_json::from_value::<State>(value).ok();
    assert_eq!(read(json!({"set": ["fan_fault", "hot"]})), Some(State::FAN_FAULT | State::HOT));
    assert_eq!(read(json!(0x8402)), Some(State(0x8402)));
    for wrong in [json!({"set": ["cold"]}), json!({"set": [], "unknown": 0x1_0000}), json!({"unset": []}), json!("hot")]
    {
        refused::<State>(wrong);
    }
}

#[test]
fn a_packed_value_is_its_text_or_its_number() {
    let barcode: BarcodeValue = Raw::from_bits(0x5613_0C15_A3FB_06A8);
    let odd: BarcodeValue = Raw::from_bits(0x5613_0C15_A3FB_2710);
    assert_eq!([barcode, odd].map(shown), [json!("081807123451V1704"), json!(0x5613_0C15_A3FB_2710_u64)]);
    assert_eq!([barcode, odd].map(|value| both_ways(&value)), [[barcode; 2], [odd; 2]]);
    assert_eq!(
        refused::<BarcodeValue>(json!({})),
        "invalid type: map, expected the text of a packed value, or its raw number"
    );
    let too_large = BarcodeValue { number: 1 << 40, ..barcode };
    assert!(serde_json::to_value(too_large).is_err());
}

#[test]
fn a_text_is_a_text_or_its_bytes() {
    let texts = [Text::<4>::new("AB").expect("two letters"), Raw::from_bits(0x4100_4200)];
    assert_eq!(texts.map(shown), [json!("AB"), json!([0x41, 0, 0x42, 0])]);
    assert_eq!(texts.map(|text| both_ways(&text)), texts.map(|text| [text; 2]));
    assert!(
        refused::<Text<4>>(json!("ABCDE")).ends_with("expected at most 4 ASCII characters without NUL, or 4 bytes")
    );
    refused::<Text<4>>(json!([1, 2, 3]));
}

#[test]
fn raw_bytes_are_their_hexadecimal_digits() {
    let code = Bytes::new([0x0A, 0xFF]);
    assert_eq!(shown(code), json!("0AFF"));
    assert_eq!(both_ways(&code), [code; 2]);
    assert!(refused::<Bytes<2>>(json!("0AF")).ends_with("expected two hexadecimal digits for each of 2 bytes"));
    refused::<Bytes<2>>(json!([10, 255]));
}

#[test]
fn a_number_in_decimal_digits_is_a_number_or_its_bits() {
    let values = [Bcd::<u8>::from_raw(0x42), Bcd::from_raw(0x2A)];
    assert_eq!(values.map(shown), [json!(42), json!("0x2A")]);
    assert_eq!(values.map(|value| both_ways(&value)), values.map(|value| [value; 2]));
    assert!(refused::<Bcd<u8>>(json!(100)).ends_with("expected a number that fits, or raw bits such as `0x2A`"));
    refused::<Bcd<u8>>(json!("0x100"));
}

#[test]
fn a_target_goes_by_the_name_of_its_mode() {
    assert_eq!(shown(Target::Module(3)), json!({"module": 3}));
    assert_eq!(both_ways(&Target::Module(3)), [Target::Module(3); 2]);
}

#[test]
fn a_device_model_goes_by_the_name_that_the_vendor_gives_it() {
    for model in infy::Model::ALL {
        assert_eq!(shown(model), json!(model.name()));
        assert_eq!(both_ways(&model), [model; 2]);
    }
}

#[test]
fn a_frame_is_read_as_in_a_log_only() {
    let frame = |text| serde_json::from_value::<Frame>(json!(text)).ok();
    assert_eq!(frame("083#5501"), Some(Frame::new_raw(0x83, false, [0x55, 1, 0, 0, 0, 0, 0, 0], 2)));
    assert_eq!(frame("0283F000#"), Some(Frame::new_raw(0x0283_F000, true, [0; 8], 0)));
    for text in
        ["", "083", "83#55", "800#55", "20000000#", "083#5", "083#001122334455667788", "083#+1", "+83#55", "083#GG"]
    {
        assert_eq!(frame(text), None, "{text}");
    }
}

#[test]
fn arbitrary_values_of_a_message_fit_its_signals() {
    let mut random = fastrand::Rng::with_seed(0xA3B);
    for _ in 0..1000 {
        let seed = random.u64(..).to_be_bytes();
        let output = infy::SetModuleOutput::arbitrary(&mut Unstructured::new(&seed)).expect("eight bytes");
        let mut payload = Payload::new("message", [0; 8]);
        assert_eq!(output.encode(&mut payload), Ok(()));
        assert_eq!(payload.data(), &seed);
    }
}

/// Returns the texts that `defmt` sends; numbers, and what stands in the format strings, are none.
fn logged<T: defmt::Format>(value: T) -> String {
    defmt::export::fmt(&value);
    let bytes = defmt::export::fetch_bytes();
    bytes.into_iter().filter(|byte| matches!(byte, b' '..=b'~')).map(char::from).collect()
}

#[test]
fn logs_of_defmt_have_the_names_of_the_spec() {
    assert_eq!(logged(infy::Power::Off), "off");
    assert_eq!(logged(State(0x0201)), "calm | fan_fault");
    assert_eq!(logged(State(0x8002)), "hot");
    assert_eq!(logged::<BarcodeValue>(Raw::from_bits(0x5613_0C15_A3FB_06A8)), "081807123451V1704");
    assert_eq!(logged(Text::<4>::new("AB").expect("two letters")), "AB");
    assert_eq!(logged(Text::<4>::new("A\n\\").expect("three characters")), r"A\n\\");
    assert_eq!(logged(Frame::new_raw(0x83, false, [0x55, 1, 0, 0, 0, 0, 0, 0], 2)), "083#5501");
}
