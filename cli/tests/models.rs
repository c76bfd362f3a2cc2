//! Fields that only some device models have: they are hidden on the others, and asked for where a model has them.

mod calls;

use std::path::Path;

/// Three bytes reach `warmth`, which `V1_2` does not have.
const LOG: &str = "\
(1.0) can0 007#540000
(1.1) can0 007#540060
(1.2) can0 007#54
";

fn canspec(arguments: &[&str], input: &str) -> (String, String) {
    let spec = Path::new(env!("CARGO_MANIFEST_DIR")).join("../tests/specs/features/revisions.yaml");
    calls::canspec(&spec, arguments, input)
}

#[test]
fn a_field_that_the_model_does_not_have_is_shown_only_where_its_bits_are_set() {
    let (table, _) = canspec(&["decode", "--model", "V1_2", "-"], LOG);
    assert!(!table.contains("warmth 0 W") && table.contains("warmth 96 W"), "{table}");
    assert!(table.contains("V1_2 has no `warmth`, for which the frame is long enough"), "{table}");
    let (table, _) = canspec(&["decode", "--model", "V1_3", "-"], LOG);
    assert!(table.contains("warmth 0 W") && !table.contains("model_dependent"), "{table}");
}

#[test]
fn frames_come_back_with_their_lengths_though_a_field_is_hidden() {
    for model in ["V1_2", "V1_3"] {
        let (lines, _) = canspec(&["decode", "--model", model, "--format", "jsonl", "-"], LOG);
        let has_reserved: Vec<_> = lines.lines().map(|line| line.contains("\"reserved\"")).collect();
        assert_eq!(has_reserved, [model == "V1_2", false, false], "{lines}");
        let (log, complaints) = canspec(&["encode", "--model", model, "--from", "jsonl", "-"], &lines);
        assert_eq!((log.as_str(), complaints.as_str()), (LOG, ""), "{lines}");
    }
}

#[test]
fn a_request_asks_for_what_the_model_has() {
    let set = |arguments: &[&str]| {
        let (frame, complaints) =
            canspec(&[&["encode", "set_charge", "--to", "battery", "charge=84%"], arguments].concat(), "");
        if complaints.is_empty() { frame } else { complaints }
    };
    assert_eq!(set(&["--model", "V1_2"]), "006#54\n");
    assert_eq!(set(&["--model", "V1_3", "warmth=96W"]), "006#540060\n");
    assert_eq!(set(&["--model", "V1_3"]), "canspec: set_charge: the signal `warmth` is missing\n");
    assert_eq!(set(&[]), "006#54\n");
}
