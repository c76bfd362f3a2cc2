//! The functions of a part as they were, so that mistakes are planted in what has changed.

use std::collections::BTreeSet;
use std::io;
use std::path::Path;
use std::process::Command;

use super::part::Part;
use super::plant;

/// Returns the functions of a part at a revision.
pub fn functions(part: &Part, root: &Path, revision: &str) -> io::Result<BTreeSet<String>> {
    let list = ["ls-tree", "-r", "-z", "--name-only", revision, "--"];
    let listed = git(root, &[list.as_slice(), part.sources].concat())?;
    let mut functions = BTreeSet::new();
    for file in listed.split_terminator('\0').filter(|file| part.has(Path::new(file))) {
        let text = git(root, &["show", &format!("{revision}:{file}")])?;
        functions.extend(syn::parse_file(&text).iter().flat_map(wholes));
    }
    Ok(functions)
}

fn wholes(file: &syn::File) -> impl Iterator<Item = String> {
    plant::mistakes(file, "").into_iter().map(|mistake| mistake.whole)
}

fn git(root: &Path, arguments: &[&str]) -> io::Result<String> {
    let output = Command::new("git").args(arguments).current_dir(root).output()?;
    if !output.status.success() {
        return Err(io::Error::other(String::from_utf8_lossy(&output.stderr)));
    }
    String::from_utf8(output.stdout).map_err(io::Error::other)
}
