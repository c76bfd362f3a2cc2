//! Programs without the standard library, which cannot be linked if they can panic.

mod binary;
mod by_hand;
mod calls;
mod others;

use std::fs::{File, TryLockError};
use std::num::NonZero;
use std::path::{Path, PathBuf};
use std::process::Command;
use std::sync::LazyLock;
use std::{env, fs, io, thread};

use canspec_codegen::emit::{self, Goal, Options, Scaled};
use canspec_codegen::model::Protocol;
use proc_macro2::TokenStream;
use quote::{format_ident, quote};

pub use binary::{Binary, Size};
use calls::Module;
pub use others::Others;

/// The codecs that a program has, and what it calls of them.
#[derive(Clone, Debug)]
pub struct Program {
    name: String,
    modules: String,
}

/// One protocol in generated code.
#[derive(Clone, Debug)]
pub struct Codec {
    name: String,
    protocol: Protocol,
    code: String,
}

impl Codec {
    /// Generates the codecs of all specs in a folder of the workspace.
    ///
    /// # Panics
    ///
    /// If a spec is wrong.
    pub fn all(folder: &str, scaled: Scaled, goal: Goal) -> Vec<Self> {
        let options = Options { scaled, goal, ..Options::default() };
        crate::specs(folder).iter().map(|path| Self::new(path, &options)).collect()
    }

    /// Generates the codecs in whole steps of the specs in a folder, where they differ from those in floats.
    pub fn all_in_steps(folder: &str, goal: Goal) -> Vec<Self> {
        let floats = Self::all(folder, Scaled::F64, goal);
        let pairs = Self::all(folder, Scaled::Steps, goal).into_iter().zip(floats);
        pairs.filter(|(steps, floats)| steps.code != floats.code).map(|(steps, _)| steps).collect()
    }

    fn new(path: &Path, options: &Options) -> Self {
        let name = path.file_stem().map(|stem| stem.to_string_lossy().into_owned()).unwrap_or_default();
        let protocol = crate::protocol(path);
        let code = emit::rust(&protocol, options);
        Self { name, protocol, code }
    }

    /// Returns the name of the spec's file.
    pub fn name(&self) -> &str {
        &self.name
    }

    /// Returns the protocol as the compiler knows it.
    pub fn protocol(&self) -> &Protocol {
        &self.protocol
    }

    /// Adds an indexing expression to the first decoder.
    ///
    /// # Panics
    ///
    /// If there is no such decoder.
    #[must_use]
    pub fn with_index(mut self) -> Self {
        let decoder = self.code.find("const DECODE").expect("the decoder of a message");
        let start = decoder + self.code[decoder..].find("(data)").expect("a signal is taken out of the data");
        self.code.replace_range(start..start + "(data)".len(), "(&[data[usize::from(data[0])]; 8])");
        self
    }

    /// Returns the struct of the message that [`Program::one_message`] uses.
    pub fn one_message(&self) -> Option<String> {
        Module::new(&self.code).one_message().map(|(owner, _)| owner)
    }

    /// Returns the structs of all messages.
    pub fn messages(&self) -> Vec<String> {
        Module::new(&self.code).layouts().collect()
    }
}

impl Program {
    /// Returns the program that does nothing.
    pub fn empty() -> Self {
        Self::of("empty", [])
    }

    /// Returns the program that calls every function of all these codecs.
    pub fn everything(codecs: &[Codec]) -> Self {
        Self::of("everything", codecs.iter().map(|codec| module(codec, Module::everything)))
    }

    /// Returns the program that calls every function of all these codecs, but has no client and no simulator. They have
    /// one code for all protocols.
    pub fn codecs(codecs: &[Codec]) -> Self {
        Self::of("codecs", codecs.iter().map(|codec| module(codec, Module::codec)))
    }

    /// Returns the program that does with all these codecs what a driver does: it recognises frames, encodes others,
    /// builds every request and reads its replies.
    pub fn traffic(codecs: &[Codec]) -> Self {
        Self::of("traffic", codecs.iter().map(|codec| module(codec, Module::traffic)))
    }

    /// Returns the program that recognises a frame.
    pub fn decode(codec: &Codec) -> Self {
        let name = format!("{}_decode", codec.name);
        Self::of(&name, [module(codec, |_| quote!(calls::decode::<Message>();))])
    }

    /// Returns the program that recognises a frame and shows its signals.
    pub fn visit(codec: &Codec) -> Self {
        let name = format!("{}_visit", codec.name);
        Self::of(&name, [module(codec, |_| quote!(calls::visit::<Message>();))])
    }

    /// Returns the program that builds the requests of every message.
    pub fn encode(codec: &Codec) -> Self {
        let name = format!("{}_encode", codec.name);
        Self::of(&name, [module(codec, Module::requests)])
    }

    /// Returns the program that decodes and requests one message only.
    pub fn one_message(codec: &Codec) -> Self {
        let name = format!("{}_one_message", codec.name);
        Self::of(&name, [module(codec, |module| module.one_message().map(|(_, calls)| calls).unwrap_or_default())])
    }

    fn of(name: &str, modules: impl IntoIterator<Item = (String, TokenStream)>) -> Self {
        let (names, modules): (Vec<_>, Vec<_>) = modules.into_iter().unzip();
        let names = names.iter().map(|name| format_ident!("{name}"));
        let program = quote!(fn program() { #(#names::program::program();)* });
        let modules = modules.into_iter().chain([program]).map(|tokens| tokens.to_string());
        Self { name: name.to_owned(), modules: modules.collect::<Vec<_>>().join("\n") }
    }
}

/// Returns the module of a codec, with a function that calls something of it.
fn module(codec: &Codec, calls: impl FnOnce(&Module) -> TokenStream) -> (String, TokenStream) {
    let module = Module::new(&codec.code);
    let name = format_ident!("{}", codec.name);
    let code: TokenStream = codec.code.parse().expect("generated code is Rust");
    let (unknown_values, calls) = (module.unknown_values(), calls(&module));
    let tokens = quote! {
        mod #name {
            #code

            pub mod program {
                use super::*;
                use crate::{calls, stations};
                use crate::unknown::unknown;

                #unknown_values

                pub fn program() { #calls }
            }
        }
    };
    (codec.name.clone(), tokens)
}

/// Tests whether the toolchain has a target.
pub fn is_installed(target: &str) -> bool {
    let folder = Command::new("rustc").args(["--print", "target-libdir", "--target", target]).output();
    folder.is_ok_and(|folder| PathBuf::from(String::from_utf8_lossy(&folder.stdout).trim()).is_dir())
}

/// How a program is compiled.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Settings<'a> {
    /// A profile of `tests/bare/Cargo.toml`: the optimization.
    pub profile: &'a str,
    /// The target, if it is not this machine.
    pub target: Option<&'a str>,
}

impl Program {
    /// Compiles and links the program in a folder, as many at a time as there are processors; returns it, or what cargo
    /// says.
    ///
    /// # Errors
    ///
    /// If files cannot be written, or cargo does not start.
    pub fn link(&self, folder: &Path, settings: Settings<'_>) -> io::Result<Result<Binary, String>> {
        VERSIONS.as_ref().map_err(|error| io::Error::new(error.kind(), error.to_string()))?;
        let (folder, _lock) = free(&folder.join(settings.profile))?;
        let source = folder.join(format!("{}.rs", self.name));
        fs::write(&source, &self.modules)?;
        let target = settings.target.map(|target| ["--target", target]);
        let output = cargo()
            .args(["build", "--offline", "--locked", "--quiet", "--profile", settings.profile])
            .args(target.into_iter().flatten())
            .arg("--target-dir")
            .arg(&folder)
            .env("CANSPEC_PROGRAM", &source)
            .env_remove("RUSTFLAGS")
            .output()?;
        if !output.status.success() {
            return Ok(Err(String::from_utf8_lossy(&output.stderr).into_owned()));
        }
        let path = folder.join(settings.target.unwrap_or_default()).join(settings.profile).join("bare");
        Binary::read(&path).map(Ok)
    }
}

/// Gives the programs the versions of this workspace. They are on the machine already.
static VERSIONS: LazyLock<io::Result<()>> = LazyLock::new(|| {
    fs::copy(root().join("Cargo.lock"), bare().join("Cargo.lock"))?;
    cargo().args(["update", "--workspace", "--offline", "--quiet"]).status().map(drop)
});

/// Calls cargo for the programs.
fn cargo() -> Command {
    let mut command = Command::new(env::var_os("CARGO").unwrap_or_else(|| "cargo".into()));
    command.current_dir(bare());
    command
}

/// Takes one of the folders in which no program is compiled now, one for each processor, until the lock is dropped. It
/// waits for the last one if all are taken.
fn free(folder: &Path) -> io::Result<(PathBuf, File)> {
    let count = thread::available_parallelism().map_or(1, NonZero::get);
    let mut taken = None;
    for place in 0..count {
        let folder = folder.join(place.to_string());
        fs::create_dir_all(&folder)?;
        let lock = File::create(folder.join("lock"))?;
        match lock.try_lock() {
            Ok(()) => return Ok((folder, lock)),
            Err(TryLockError::WouldBlock) => taken = Some((folder, lock)),
            Err(TryLockError::Error(error)) => return Err(error),
        }
    }
    let (folder, lock) = taken.ok_or(io::ErrorKind::NotFound)?;
    lock.lock()?;
    Ok((folder, lock))
}

/// Returns the folder of the crate that every program is.
fn bare() -> PathBuf {
    root().join("tests/bare")
}

/// Returns the root of the workspace.
fn root() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("..")
}
