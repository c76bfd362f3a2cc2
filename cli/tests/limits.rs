//! The page on limits: its calls answer as it says, with the specs that it shows.

use std::fs;
use std::path::Path;
use std::process::Command;

#[test]
fn the_calls_with_limits_of_a_product_answer_as_the_page_shows() {
    let folder = tempfile::tempdir().expect("there is a folder for temporary files");
    for spec in blocks("yaml").into_iter().filter(|spec| spec.starts_with("canspec:")) {
        let name = spec.lines().find_map(|line| line.strip_prefix("protocol: ")).expect("a spec has a name");
        fs::write(folder.path().join(format!("{name}.yaml")), &spec).expect("the folder can be written");
    }
    let screens = blocks("console");
    let calls: Vec<_> = screens.iter().flat_map(|screen| screen.split("$ canspec ").skip(1)).collect();
    assert!(calls.len() > 4, "the page shows calls");
    for call in calls {
        let (arguments, answer) = call.split_once('\n').expect("a call has an answer");
        let mut command = Command::new(env!("CARGO_BIN_EXE_canspec"));
        let done = command.args(arguments.split(' ')).current_dir(folder.path()).output().expect("it was built");
        let said = [done.stderr, done.stdout].map(|bytes| String::from_utf8_lossy(&bytes).into_owned()).concat();
        assert_eq!(said, answer, "{arguments}");
    }
}

#[test]
fn the_specs_of_the_page_have_no_problem() {
    for spec in blocks("yaml").into_iter().filter(|spec| spec.starts_with("canspec:")) {
        let folder = tempfile::tempdir().expect("there is a folder for temporary files");
        fs::write(folder.path().join("own.yaml"), &spec).expect("the folder can be written");
        let mut command = Command::new(env!("CARGO_BIN_EXE_canspec"));
        let done = command.args(["check", "own.yaml"]).current_dir(folder.path()).output().expect("it was built");
        assert!(done.status.success(), "{}", String::from_utf8_lossy(&done.stderr));
        assert_eq!(String::from_utf8_lossy(&done.stderr).matches("warning").count(), 0, "{spec}");
    }
}

/// Returns the blocks of the page that have a language.
fn blocks(language: &str) -> Vec<String> {
    let page = Path::new(env!("CARGO_MANIFEST_DIR")).join("../docs/how-to/limits.md");
    let page = fs::read_to_string(page).expect("the page is there");
    let fenced = page.split("```").skip(1).step_by(2).filter_map(|block| block.split_once('\n'));
    fenced.filter(|(of, _)| *of == language).map(|(_, text)| text.to_owned()).collect()
}
