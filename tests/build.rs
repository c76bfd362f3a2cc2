//! Generates codecs of the feature specs, of made-up devices and of whole protocols that do not
//! ship. Each is also generated with every option. Those that ship, too, are generated in whole
//! steps. Lists name the protocols.

use std::fmt::Write as _;
use std::path::{Path, PathBuf};
use std::{env, fs};

use canspec_codegen::emit::{Goal, Options, Scaled, Switch};
use canspec_codegen::{Bases, Generated};

fn main() {
    let root = PathBuf::from(env::var("CARGO_MANIFEST_DIR").expect("cargo sets it"));
    let out = PathBuf::from(env::var("OUT_DIR").expect("cargo sets it"));
    let mut list = Protocols::default();
    let steps = Options { scaled: Scaled::Steps, ..Options::default() };
    for (name, path) in specs(&root.join("../specs")) {
        let module = format!("canspec_protocols::{name}");
        let visited = visit(&module, &path);
        list.visits.push_str(&visited);
        list.switched.push_str(&visited);
        let code = generate(&path, &Options::default()).code;
        list.signals(&module, &code);
        list.implementations(&module, &path, &code);
        let module = format!("{name}_in_steps");
        list.generated(&out, &module, &generate(&path, &steps));
        list.in_steps.push_str(&visit(&module, &path));
    }
    // A whole protocol may have numbers that single precision misses.
    let folders = [
        ("features", "specs/features", Scaled::F32),
        ("devices", "specs/devices", Scaled::F32),
        ("unshipped", "specs", Scaled::F64),
    ];
    for (kind, folder, scaled) in folders {
        for (name, path) in specs(&root.join(folder)) {
            let module = format!("{kind}_{name}");
            let [switched, in_steps] = ["switched", "in_steps"].map(|ending| format!("{module}_{ending}"));
            let every = [(&module, Options::default()), (&switched, every_option(scaled)), (&in_steps, steps.clone())];
            for (module, options) in every {
                list.generated(&out, module, &generate(&path, &options));
            }
            list.visits.push_str(&visit(&module, &path));
            list.switched.push_str(&visit(&switched, &path));
            list.in_steps.push_str(&visit(&in_steps, &path));
            list.implementations(&switched, &path, &generate(&path, &every_option(scaled)).code);
        }
    }
    fs::write(out.join("protocols.rs"), list.finish()).expect("OUT_DIR can be written");
}

/// Returns the specs of a folder by protocol, in order.
fn specs(folder: &Path) -> Vec<(String, PathBuf)> {
    println!("cargo::rerun-if-changed={}", folder.display());
    let entries = fs::read_dir(folder).expect("the folder exists").flatten().map(|entry| entry.path());
    let yaml = entries.filter(|path| path.extension().is_some_and(|ending| ending == "yaml"));
    let mut specs: Vec<_> = yaml
        .map(|path| (path.file_stem().map(|stem| stem.to_string_lossy().into_owned()).unwrap_or_default(), path))
        .collect();
    specs.sort();
    for (_, path) in &specs {
        println!("cargo::rerun-if-changed={}", path.display());
    }
    specs
}

/// Compiles a feature spec; a wrong one stops the build with its diagnostics.
fn generate(path: &Path, options: &Options) -> Generated {
    match Bases::default().read(path).and_then(|source| canspec_codegen::generate(source, options)) {
        Ok(generated) => generated,
        Err(diagnostics) => panic!("{}", diagnostics.concise()),
    }
}

fn every_option(scaled: Scaled) -> Options {
    Options { scaled, goal: Goal::Speed, serde: Switch::Always, defmt: Switch::Always, arbitrary: Switch::Always }
}

/// Shows a protocol to a visitor.
fn visit(module: &str, path: &Path) -> String {
    format!("    visitor.visit::<{module}::Message>(\"{}\");\n", path.display())
}

/// The list of protocols as Rust.
#[derive(Default)]
struct Protocols {
    modules: String,
    visits: String,
    switched: String,
    in_steps: String,
    signals: String,
    addressed: String,
    long: String,
    parted: String,
    transferred: String,
}

impl Protocols {
    /// Writes a module to a file and lists it.
    fn generated(&mut self, out: &Path, name: &str, Generated { manual, code, .. }: &Generated) {
        self.module(name, manual);
        self.signals(name, code);
        fs::write(out.join(format!("{name}.rs")), code).expect("OUT_DIR can be written");
    }

    fn module(&mut self, name: &str, manual: &str) {
        let _ = writeln!(
            self.modules,
            "#[deny(warnings, missing_docs, unsafe_code)]\n\
             pub mod {name} {{\n{manual}canspec_runtime::include_protocol!(\"{name}\"); }}",
        );
    }

    /// Lists the signals of a module in the order of the spec, so that tests can write them.
    fn signals(&mut self, module: &str, code: &str) {
        let mut owner = "";
        let _ = write!(
            self.signals,
            "impl Signals for {module}::Message {{\n    const SIGNALS: &'static [&'static dyn KnownSignal] = &["
        );
        for line in code.lines() {
            if let Some(block) = line.strip_prefix("impl ").and_then(|rest| rest.strip_suffix(" {")) {
                owner = block;
            } else if let Some((name, _)) =
                line.strip_prefix("    pub const ").and_then(|rest| rest.split_once(": Signal<"))
            {
                let _ = write!(self.signals, "&{module}::{owner}::{name}, ");
            }
        }
        self.signals.push_str("];\n}\n");
    }

    /// Lists the types of a module that implement traits which only some modules have.
    fn implementations(&mut self, module: &str, path: &Path, code: &str) {
        let lists = [
            ("Addressed", &mut self.addressed),
            ("LongLayout", &mut self.long),
            ("Parted", &mut self.parted),
            ("Transferred", &mut self.transferred),
        ];
        for (implemented, list) in lists {
            let head = format!("impl {implemented} for ");
            let blocks = code.lines().filter_map(|line| line.strip_prefix(&head));
            for name in blocks.filter_map(|rest| rest.strip_suffix(" {")) {
                let _ = writeln!(list, "    visitor.visit::<{module}::{name}>(\"{}\");", path.display());
            }
        }
    }

    fn finish(self) -> String {
        format!(
            "{}\n{}\n/// Shows every protocol to a visitor, with the path of its spec.\n\
             pub fn visit(visitor: &mut impl Visitor) {{\n{}}}\n\
             \n/// Shows every protocol that has the optional traits to a visitor, with the path of its spec.\n\
             pub fn visit_switched(visitor: &mut impl SwitchedVisitor) {{\n{}}}\n\
             \n/// Shows every protocol in whole steps to a visitor, with the path of its spec.\n\
             pub fn visit_in_steps(visitor: &mut impl Visitor) {{\n{}}}\n\
             \n/// Shows every protocol with requests to a visitor, with the path of its spec.\n\
             pub fn visit_addressed(visitor: &mut impl AddressedVisitor) {{\n{}}}\n\
             \n/// Shows every message that is longer than a frame to a visitor, with the path of its spec.\n\
             pub fn visit_long(visitor: &mut impl LongVisitor) {{\n{}}}\n\
             \n/// Shows every message in parts to a visitor, with the path of its spec.\n\
             pub fn visit_parted(visitor: &mut impl PartedVisitor) {{\n{}}}\n\
             \n/// Shows every message that a transport carries to a visitor, with the path of its spec.\n\
             pub fn visit_transferred(visitor: &mut impl TransferredVisitor) {{\n{}}}\n",
            self.modules,
            self.signals,
            self.visits,
            self.switched,
            self.in_steps,
            self.addressed,
            self.long,
            self.parted,
            self.transferred
        )
    }
}
