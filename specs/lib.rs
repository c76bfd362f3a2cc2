//! The protocol specs that canspec ships, embedded as text: every `*.yaml` file of this folder.

/// A spec file.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Spec {
    /// The file's name without its ending, by which it is asked for.
    pub name: &'static str,
    /// The file's name without folders.
    pub file: &'static str,
    /// The file's content.
    pub text: &'static str,
}

/// All specs, sorted by name.
pub const SPECS: &[Spec] = include!(concat!(env!("OUT_DIR"), "/specs.rs"));

/// The folder of the spec files, for build scripts that compile them.
pub const FOLDER: &str = env!("CARGO_MANIFEST_DIR");

/// Finds a spec by its name.
pub fn find(name: &str) -> Option<&'static Spec> {
    SPECS.iter().find(|spec| spec.name == name)
}

#[cfg(test)]
mod tests {
    use super::{SPECS, find};

    #[test]
    fn every_spec_is_found_by_its_name() {
        for spec in SPECS {
            assert_eq!(find(spec.name), Some(spec));
            assert_eq!(format!("{}.yaml", spec.name), spec.file);
        }
    }

    #[test]
    fn no_spec_has_no_name() {
        assert_eq!(find(""), None);
    }
}
