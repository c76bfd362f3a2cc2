//! Who names no protocol has it from the environment, or from the nearest `canspec.toml`.

use std::fs;
use std::path::Path;
use std::process::{Command, Output, Stdio};

use tempfile::TempDir;

const LOG: &str = "0283F000#43FA000040600000\n";

const SPECS: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/../specs");

/// Returns a folder with `bus.log` and, if there is one, `canspec.toml`, and with a folder `logs/today` below it.
fn folder(settings: Option<&str>) -> TempDir {
    let folder = tempfile::tempdir().expect("there is a folder for temporary files");
    let write = |name: &str, text: &str| fs::write(folder.path().join(name), text).expect("the folder can be written");
    write("bus.log", LOG);
    if let Some(settings) = settings {
        write("canspec.toml", settings);
    }
    fs::create_dir_all(folder.path().join("logs/today")).expect("the folder can be written");
    folder
}

fn canspec(folder: &Path, variable: Option<&str>, arguments: &[&str]) -> Output {
    let mut canspec = Command::new(env!("CARGO_BIN_EXE_canspec"));
    canspec.args(arguments).current_dir(folder).stdin(Stdio::null()).env_remove("CANSPEC_PROTOCOL");
    if let Some(value) = variable {
        canspec.env("CANSPEC_PROTOCOL", value);
    }
    canspec.output().expect("the command starts")
}

/// Returns the protocol by which the log is read.
#[track_caller]
fn protocol(folder: &Path, variable: Option<&str>, arguments: &[&str]) -> String {
    let log = folder.ancestors().map(|folder| folder.join("bus.log")).find(|log| log.exists()).expect("there is a log");
    let log = log.to_string_lossy();
    let output = canspec(folder, variable, &[&["decode", "--format", "jsonl", &log], arguments].concat());
    let said = String::from_utf8_lossy(&output.stderr);
    assert!(output.status.success(), "{said}");
    let line: serde_json::Value = serde_json::from_slice(&output.stdout).expect("one line of JSON");
    line["protocol"].as_str().expect("every line has it").to_owned()
}

#[track_caller]
fn assert_refused(output: &Output, status: i32, why: &str) {
    let said = String::from_utf8_lossy(&output.stderr);
    assert_eq!(output.status.code(), Some(status), "{said}");
    assert!(said.contains(why), "{said}");
}

#[test]
fn the_environment_names_protocols() {
    let folder = folder(None);
    assert_eq!(protocol(folder.path(), Some("infy"), &[]), "infy");
    assert_eq!(protocol(folder.path(), Some("trio, infy"), &[]), "infy");
    let output = canspec(folder.path(), Some("ifny"), &["decode", "bus.log"]);
    assert_refused(
        &output,
        2,
        "canspec: CANSPEC_PROTOCOL: unknown protocol `ifny`; built in: daly, gbt27930, gcp, huawei, infy, megmeet, mxr, trio; did you mean",
    );
    assert_refused(
        &canspec(folder.path(), Some(""), &["decode", "bus.log"]),
        2,
        "name a protocol with --protocol NAME",
    );
}

#[test]
fn the_nearest_file_names_protocols_for_the_folders_below_it() {
    let folder = folder(Some("protocol = \"infy\"\n"));
    let below = folder.path().join("logs/today");
    assert_eq!(protocol(&below, None, &[]), "infy");
    fs::write(folder.path().join("logs/canspec.toml"), "protocol = [\"mxr\"]\n").expect("the folder can be written");
    assert_eq!(protocol(&below, None, &[]), "mxr");
    assert_eq!(protocol(folder.path(), None, &[]), "infy");
    fs::write(folder.path().join("canspec.toml"), "protocol = \"trio, infy\"\n").expect("the folder can be written");
    assert_eq!(protocol(folder.path(), None, &[]), "infy");
}

#[test]
fn what_the_call_says_wins_over_the_environment_and_that_over_the_file() {
    let folder = folder(Some("protocol = \"trio\"\nmodel = \"PM_1AC_24DC_2500W\"\n"));
    let spec = format!("{SPECS}/gcp.yaml");
    assert_eq!(protocol(folder.path(), None, &[]), "trio");
    assert_eq!(protocol(folder.path(), Some("mxr"), &[]), "mxr");
    assert_eq!(protocol(folder.path(), Some("mxr"), &["--protocol", "infy"]), "infy");
    assert_eq!(protocol(folder.path(), Some("mxr"), &["--spec", &spec]), "gcp");
    // A capture needs no protocol, and is none of a call that names two.
    let output = canspec(folder.path(), Some("mxr"), &["decode", "--to", "pcapng", "out", "bus.log"]);
    assert!(output.status.success());
}

#[test]
fn a_wrong_name_is_blamed_on_the_place_where_it_stands() {
    let folder = folder(Some("protocol = \"ifny\"\n"));
    let below = folder.path().join("logs/today");
    let call = ["decode", "bus.log"];
    assert_refused(&canspec(&below, None, &call), 2, "canspec: ../../canspec.toml: unknown protocol `ifny`");
    let named = ["decode", "--protocol", "ifny", "bus.log"];
    assert_refused(&canspec(&below, Some("fniy"), &named), 2, "canspec: unknown protocol `ifny`");
}

#[test]
fn a_spec_of_the_file_stands_beside_the_file() {
    let folder = folder(Some("spec = \"specs/my.yaml\"\n"));
    fs::create_dir(folder.path().join("specs")).expect("the folder can be written");
    fs::copy(format!("{SPECS}/infy.yaml"), folder.path().join("specs/my.yaml")).expect("the spec can be copied");
    assert_eq!(protocol(&folder.path().join("logs/today"), None, &[]), "infy");
}

#[test]
fn the_device_model_of_the_file_counts_for_its_protocols() {
    let folder = folder(Some("protocol = \"infy\"\nmodel = \"NOSUCH\"\n"));
    let refused = "canspec: canspec.toml: unknown model `NOSUCH`; `infy` has";
    assert_refused(&canspec(folder.path(), None, &["decode", "bus.log"]), 2, refused);
    let own = ["decode", "--model", "OTHER", "bus.log"];
    assert_refused(&canspec(folder.path(), None, &own), 2, "canspec: unknown model `OTHER`");
    let call = ["encode", "set_module_output", "--to", "module:3", "voltage=750V", "current=15A"];
    assert_refused(&canspec(folder.path(), None, &call), 2, "unknown model `NOSUCH`");
    assert_eq!(protocol(folder.path(), None, &["--protocol", "infy"]), "infy");
    // The document gives this model 150 V to 750 V.
    fs::write(folder.path().join("canspec.toml"), "protocol = \"infy\"\nmodel = \"REG75030\"\n").expect("it is ours");
    assert!(canspec(folder.path(), None, &call).status.success());
    let call = ["encode", "set_module_output", "--to", "module:3", "voltage=751V", "current=15A"];
    assert_refused(&canspec(folder.path(), None, &call), 2, "751");
}

#[test]
fn commands_for_one_protocol_refuse_several() {
    let folder = folder(Some("protocol = [\"infy\", \"mxr\"]\n"));
    assert_eq!(protocol(folder.path(), None, &[]), "infy");
    let why = "one protocol is needed, and here are `infy`, `mxr`; choose one with --protocol NAME";
    assert_refused(&canspec(folder.path(), None, &["examples"]), 2, &format!("canspec: canspec.toml: {why}"));
    let variable = canspec(folder.path(), Some("infy,mxr"), &["examples"]);
    assert_refused(&variable, 2, &format!("canspec: CANSPEC_PROTOCOL: {why}"));
    assert!(canspec(folder.path(), None, &["examples", "--protocol", "mxr"]).status.success());
}

#[test]
fn a_file_that_says_something_else_is_refused_in_its_place() {
    let cases = [
        (
            2,
            "protocl = \"infy\"\n",
            "canspec.toml:1: unknown field `protocl`, expected one of `protocol`, `spec`, `model`",
        ),
        (2, "model = \"x\"\nprotocol = {}\n", "canspec.toml:2: expected a text or a list of texts"),
        (2, "\n\nprotocol = infy\n", "canspec.toml:3: text needs quotes, as in `protocol = \"NAME\"`"),
        (2, "protocol = [\"mxr\", infy]\n", "canspec.toml:1: text needs quotes"),
        (2, "model = 75\n", "canspec.toml:1: text needs quotes"),
        (2, "[protocol]\n", "canspec.toml:1: expected a text or a list of texts"),
        (2, "protocol = \"ifny\"\n", "canspec: canspec.toml: unknown protocol `ifny`; built in: "),
        (
            2,
            "spec = \"nosuch.yaml\"\n",
            "canspec: canspec.toml: there is no spec file `nosuch.yaml`; a path in this file",
        ),
        (
            2,
            "",
            "name a protocol with --protocol NAME or a file with --spec FILE; CANSPEC_PROTOCOL or a file canspec.toml",
        ),
    ];
    for (status, settings, why) in cases {
        let folder = folder(Some(settings));
        assert_refused(&canspec(folder.path(), None, &["decode", "bus.log"]), status, why);
    }
}

#[test]
fn a_spec_that_is_missing_is_blamed_on_the_file_that_names_it() {
    let folder = folder(Some("spec = \"nosuch.yaml\"\n"));
    let below = folder.path().join("logs/today");
    let why = "canspec: ../../canspec.toml: there is no spec file `../../nosuch.yaml`";
    for call in [&["list", "--spec", "nosuch.yaml"][..], &["decode", "--spec", "nosuch.yaml"]] {
        assert_refused(&canspec(&below, None, call), 1, "error[file]: there is no such file");
    }
    for call in [&["decode"][..], &["identify", "../../bus.log"], &["encode", "x"], &["export", "dbc"]] {
        assert_refused(&canspec(&below, None, call), 2, why);
    }
}
