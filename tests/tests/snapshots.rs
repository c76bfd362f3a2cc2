//! The generated Rust, whole, as a pull request shows it.

use std::path::Path;

use canspec_codegen::emit::{self, Goal, Options, Scaled, Switch};
use canspec_tests::{protocol, specs};

/// Snapshots of one-feature specs stay short enough to be read.
const LINES: usize = 470;

/// The frames of a transport take as many more. They are the same in each spec.
const TRANSPORT_LINES: usize = 440;

/// Returns the Rust of a spec.
fn rust(path: &Path) -> String {
    emit::rust(&protocol(path), &Options::default())
}

/// Compares the Rust of a spec with `snapshots/FOLDER/SPEC.snap.rs`.
fn compare(path: &Path, folder: &str, options: &Options) -> String {
    let code = emit::rust(&protocol(path), options);
    let name = path.file_stem().expect("a spec has a name").to_string_lossy();
    let mut settings = insta::Settings::clone_current();
    settings.set_prepend_module_to_snapshot(false);
    settings.set_omit_expression(true);
    settings.set_snapshot_path(format!("../snapshots/{folder}"));
    settings.bind(|| insta::assert_binary_snapshot!(&format!("{name}.rs"), code.clone().into_bytes()));
    code
}

#[test]
fn each_feature_generates_the_rust_that_was_reviewed() {
    for path in specs("tests/specs/features") {
        let lines = compare(&path, "features", &Options::default()).lines().count();
        let limit = LINES + TRANSPORT_LINES * protocol(&path).transports.len();
        assert!(lines <= limit, "{}: {lines} lines of Rust are more than anybody reviews", path.display());
    }
}

#[test]
fn each_protocol_generates_the_rust_that_was_reviewed() {
    for path in [specs("specs"), specs("tests/specs")].concat() {
        compare(&path, "protocols", &Options::default());
    }
}

#[test]
fn each_option_adds_the_rust_that_was_reviewed() {
    let gated = |feature: &str| Switch::Gated(feature.to_owned());
    let [serde, defmt, arbitrary] = ["serde", "defmt", "arbitrary"].map(gated);
    let gated = Options { serde, defmt, arbitrary, ..Options::default() };
    let [serde, defmt, arbitrary] = [const { Switch::Always }; 3];
    let always = Options { scaled: Scaled::F32, goal: Goal::Size, serde, defmt, arbitrary };
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("specs/features");
    compare(&folder.join("status_word.yaml"), "options/gated", &gated);
    compare(&folder.join("scaled_signal.yaml"), "options/always_f32", &always);
    let steps = Options { scaled: Scaled::Steps, ..Options::default() };
    compare(&folder.join("scaled_signal.yaml"), "options/steps", &steps);
    compare(&folder.join("limits_between_steps.yaml"), "options/steps", &steps);
}

/// Returns the part of a dissector that is not the same for every protocol.
fn dissector_table(path: &Path) -> String {
    let code = emit::wireshark(&protocol(path));
    let (table, _) = code.split_once("\n-- Values").expect("the interpreter follows the table");
    table.to_owned()
}

#[test]
fn a_dissector_starts_with_the_table_that_was_reviewed() {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("specs/features");
    let mut settings = insta::Settings::clone_current();
    settings.set_prepend_module_to_snapshot(false);
    settings.set_omit_expression(true);
    settings.set_snapshot_path("../snapshots/wireshark");
    for name in ["addressing", "model_layouts", "packed_value", "refusal", "scaled_signal", "status_word"] {
        let table = dissector_table(&folder.join(name).with_extension("yaml"));
        settings.bind(|| insta::assert_snapshot!(name, table));
    }
}

#[test]
fn generation_is_deterministic() {
    for path in [specs("specs"), specs("tests/specs")].concat() {
        assert_eq!(rust(&path), rust(&path));
        assert_eq!(dissector_table(&path), dissector_table(&path));
    }
}
