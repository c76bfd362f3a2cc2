//! The page about a crate of one's own shows what stands in `tests/downstream`, and calls that do what it says.

use std::fs;
use std::path::{Path, PathBuf};
use std::process::Command;

const PAGES: [&str; 2] = ["docs/your-own-crate.md", "README.md"];

/// Files of the crate that a page can quote.
const FILES: [&str; 15] = [
    "Cargo.toml",
    "build.rs",
    "frames.jsonl",
    "src/lib.rs",
    "src/meters.rs",
    "src/pumps.rs",
    "specs/meter.yaml",
    "specs/pump.yaml",
    "specs/winch.yaml",
    "steps/build.rs",
    "tests/frames.rs",
    "tests/meters.rs",
    "tests/pumps.rs",
    "tests/simulated.rs",
    "tests/steps.rs",
];

/// The part of the README that is about a crate of one's own.
const README_SECTION: &str = "## In your firmware";

#[test]
fn every_block_stands_in_a_file_of_the_crate() {
    let files = FILES.map(|file| read(&downstream().join(file)));
    for page in PAGES {
        let quoted: Vec<_> = blocks(page).into_iter().filter(|(language, _)| language != "sh").collect();
        assert!(quoted.len() >= 3, "{page} shows dependencies, build script and module");
        for (_, block) in quoted {
            let block = block.replace("\"../canspec/", "\"../../");
            assert!(files.iter().any(|file| file.contains(&block)), "{page}: no file of the crate has\n{block}");
        }
    }
}

#[test]
fn every_call_succeeds_in_the_crate() {
    let copy = tempfile::tempdir().expect("there is a folder for temporary files");
    for file in FILES {
        let path = copy.path().join(file);
        fs::create_dir_all(path.parent().expect("it stands in the copy")).expect("the copy can be written");
        fs::copy(downstream().join(file), path).expect("the crate has the file");
    }
    let blocks = blocks(PAGES[0]);
    let calls = blocks.iter().filter(|(language, _)| language == "sh").flat_map(|(_, block)| block.lines());
    for call in calls {
        let arguments = call.split(' ').skip(1);
        let done = Command::new(env!("CARGO_BIN_EXE_canspec")).args(arguments).current_dir(copy.path()).output();
        let done = done.expect("the command starts");
        assert!(done.status.success(), "{call}\n{}", String::from_utf8_lossy(&done.stderr));
    }
    assert!(read(&copy.path().join("src/winch.rs")).contains("pub struct Run {"));
}

#[test]
fn a_binary_with_public_modules_of_generated_code_gets_no_warning() {
    let folder = tempfile::tempdir().expect("there is a folder for temporary files");
    let source = folder.path().join("src");
    for spec in ["specs/infy.yaml", "specs/gcp.yaml"] {
        let mut canspec = Command::new(env!("CARGO_BIN_EXE_canspec"));
        let done = canspec.arg("compile").arg(root().join(spec)).arg("--out").arg(&source).status();
        assert!(done.expect("the command starts").success(), "{spec}");
    }
    let runtime = root().join("runtime").canonicalize().expect("the runtime has a folder");
    let manifest = format!(
        "[package]\nname = \"winding\"\nversion = \"0.1.0\"\nedition = \"2024\"\n\
         [dependencies]\ncanspec-runtime = {{ path = {runtime:?} }}\n[workspace]\n"
    );
    fs::write(folder.path().join("Cargo.toml"), manifest).expect("the folder can be written");
    for (visibility, is_quiet) in [("pub ", true), ("", false)] {
        let main = format!(
            "{visibility}mod gcp;\n{visibility}mod infy;\n\n\
             fn main() {{\n    println!(\"{{}} {{}}\", gcp::BIT_RATES[0], infy::BIT_RATES[0]);\n}}\n"
        );
        fs::write(source.join("main.rs"), main).expect("the folder can be written");
        let mut cargo = Command::new(env!("CARGO"));
        let call = cargo.args(["check", "--quiet", "--offline", "--target-dir"]).arg(env!("CARGO_TARGET_TMPDIR"));
        let done = call.current_dir(folder.path()).output().expect("cargo starts");
        assert!(done.status.success(), "{}", String::from_utf8_lossy(&done.stderr));
        assert_eq!(done.stderr.is_empty(), is_quiet, "{}", String::from_utf8_lossy(&done.stderr));
    }
}

/// Returns language and text of each block of a page; of the README those about a crate of one's own.
fn blocks(page: &str) -> Vec<(String, String)> {
    let text = read(&root().join(page));
    let section = text.split_once(README_SECTION).and_then(|(_, after)| after.split("\n## ").next());
    let fenced = section.unwrap_or(&text).split("```").skip(1).step_by(2);
    fenced.filter_map(|block| block.split_once('\n')).map(|(language, block)| (language.into(), block.into())).collect()
}

fn root() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("..")
}

fn downstream() -> PathBuf {
    root().join("tests/downstream")
}

fn read(path: &Path) -> String {
    fs::read_to_string(path).unwrap_or_else(|error| panic!("{}: {error}", path.display()))
}
