//! Limits of a product, which narrow those of the document.

use super::{feature, frame, model, notes, requested, written};
use canspec_codegen::interpret::{Target, decode, requests};
use canspec_codegen::model::{ModelId, Range};

#[test]
fn a_limit_of_the_product_holds_on_every_model_and_for_every_field_that_sets_the_quantity() {
    let supplies = feature("product_limits");
    let refused = |model_name: Option<&str>, message: &str, signals: &[(&str, &str)]| {
        let model = model_name.map(|name| model(&supplies, name));
        requested(&supplies, model, message, "unit:1", signals).err().map(|refusal| refusal.to_string())
    };
    let output = |model, voltage| refused(model, "set_output", &[("voltage", voltage), ("current", "10")]);
    let of_product = "is outside 15..45.25 V, the limit of `output_voltage` in `product`";
    for model in [None, Some("SMALL"), Some("LARGE"), Some("OTHER")] {
        assert_eq!(output(model, "45.2"), None, "{model:?}");
        // 45.25 V lies within the limit, but goes out as 45.3 V.
        let rounded = output(model, "45.25").expect("a refusal");
        assert_eq!(rounded, format!("set_output.voltage: 45.25 V would be sent as 45.3 V, which {of_product}"));
        assert_eq!(output(model, "45.3"), Some(format!("set_output.voltage: 45.3 V {of_product}")));
        assert_eq!(output(model, "14.9"), Some(format!("set_output.voltage: 14.9 V {of_product}")));
        let total = |voltage, current, step_2| {
            let signals = [("voltage", voltage), ("current", current), ("step_1", "45"), ("step_2", step_2)];
            refused(model, "set_total", &signals)
        };
        assert_eq!(total("60", "10", "none"), Some(format!("set_total.voltage: 60 V {of_product}")));
        assert_eq!(total("40", "10", "46"), Some(format!("set_total.step_2: 46 V {of_product}")));
        // Special values stay legal.
        assert_eq!(total("40", "60", "none"), None);
        let current = "set_total.current: 60.5 A is outside 0..60 A, the limit of `total_current` in `product`";
        assert_eq!(total("40", "60.5", "none").as_deref(), Some(current));
    }
    // A range of the document that is narrower still counts: the large model begins at 20 V.
    assert_eq!([output(None, "15"), output(Some("SMALL"), "15"), output(Some("OTHER"), "15")], [None, None, None]);
    assert!(output(Some("LARGE"), "19.9").is_some_and(|why| why.ends_with("is outside 20..80 V")));
    // Floats keep to the limit of their own quantity.
    let current = refused(None, "set_output", &[("voltage", "40"), ("current", "20.1")]);
    assert!(current.is_some_and(|why| why.ends_with("outside 0..20 A, the limit of `output_current` in `product`")));
}

#[test]
fn what_is_received_keeps_the_ranges_of_the_document_beside_a_limit_of_the_product() {
    let supplies = feature("product_limits");
    // 60 V and 30 A, in a reply and in a request of another controller; then 90 V, beyond all models.
    for text in ["411#0258000041F00000", "011#0258000041F00000"] {
        assert!(notes(&supplies, text).is_empty(), "{text}");
    }
    let large = model(&supplies, "LARGE");
    let beyond = decode(&supplies, Some(large), &frame("411#0384000041F00000")).expect("a reply");
    assert_eq!(
        beyond.notes.iter().map(|note| note.text.as_str()).collect::<Vec<_>>(),
        ["voltage 90 V is outside 20..80 V"]
    );
}

#[test]
fn a_limit_of_the_product_holds_in_messages_of_several_frames() {
    let product = "quantities:\n  heat: {also: [program.temperature]}\nproduct:\n  limits: {heat: 100..200 °C}\n";
    let ovens = include_str!("../../../tests/specs/features/parts_to_modules.yaml");
    let ovens = written(&(ovens.to_owned() + product));
    let set = |values: [&str; 3]| {
        let signals =
            [("hold", "10"), ("temperature_1", values[0]), ("temperature_2", values[1]), ("temperature_3", values[2])];
        let signals = signals.map(|(name, value)| (name.to_owned(), value.to_owned()));
        let target = Target::parse(&ovens, "oven:3").expect("an oven");
        requests(&ovens, None, Some("set"), "program", &target, None, &signals).err().map(|refusal| refusal.to_string())
    };
    assert_eq!(set(["100", "150", "200"]), None);
    let refused = "program.temperature_3: 201 °C is outside 100..200 °C, the limit of `heat` in `product`";
    assert_eq!(set(["100", "150", "201"]).as_deref(), Some(refused));
}

#[test]
fn a_signal_has_the_limits_of_requests_to_a_model_and_to_any_of_several() {
    let range = |range: Range| format!("{}..{}", range.minimum, range.maximum);
    let supplies = feature("product_limits");
    let [small, large, other] = ["SMALL", "LARGE", "OTHER"].map(|name| model(&supplies, name));
    let output = supplies.messages.first().expect("a message");
    let voltage = output.signals.iter().find(|signal| signal.name == "voltage").expect("a voltage");
    let of = |model| voltage.limits_for(model).map(range);
    let narrowed = Some("15..45.25".to_owned());
    assert_eq!([of(Some(small)), of(Some(other)), of(None)], [(); 3].map(|()| narrowed.clone()));
    assert_eq!(of(Some(large)).as_deref(), Some("20..45.25"));
    let hull = |models: &[ModelId]| voltage.hull(models.iter().copied()).map(range);
    assert_eq!([hull(&[small, large, other]), hull(&[])], [(); 2].map(|()| narrowed.clone()));
    assert_eq!(hull(&[large, other]).as_deref(), Some("20..45.25"), "a model without a range does not widen the hull");
    let all: Vec<_> = voltage.limits().map(|(limits, _)| range(limits)).collect();
    assert_eq!(all, ["10..50", "20..80", "15..45.25"]);
    assert!(!voltage.has_whole_limits());
    // A greatest value of the document below that of the product still counts.
    let product = "quantities:\n  heat: {also: [program.temperature]}\nproduct:\n  limits: {heat: 100..280 °C}\n";
    let ovens = include_str!("../../../tests/specs/features/parts_to_modules.yaml");
    let ovens = written(&(ovens.to_owned() + product));
    let program = &ovens.long_messages.first().expect("a program").content;
    let heat = program.signals.iter().find(|signal| signal.name == "temperature_1");
    let limits = heat.and_then(|heat| heat.limits_for(Some(model(&ovens, "OV1")))).map(range);
    assert_eq!(limits.as_deref(), Some("100..250"));
}
