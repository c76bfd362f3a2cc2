//! Lets canspec compile the spec of the supply, and dbc-codegen the DBC of each protocol.

use std::{env, fs, path::Path};

use dbc_codegen::Config;

fn main() {
    canspec_codegen::Builder::new().spec("supply.yaml").build();
    write("names.rs", names());
    dbc("infy");
    dbc("supply");
}

/// Returns a macro that hands on the names of the supply's registers and signals, in both generated codecs.
fn names() -> String {
    let lists = [("Register", 1..=20, 0), ("Register", 21..=40, 0), ("Signal", 1..=60, 0x100)].map(|(word, numbers, base)| {
        let snake = word.to_lowercase();
        let names = numbers.map(|number: u32| {
            let on_bus = base + number;
            format!("({on_bus} {word}{number} M{on_bus} {word}sNumberM{on_bus} {snake}_{number} set_{snake}_{number} set_m{on_bus})")
        });
        format!("[{}]", names.collect::<String>())
    });
    format!("macro_rules! names {{ ($then:ident) => {{ $then! {{ {} }} }}; }}\nuse names;", lists.concat())
}

/// Compiles a DBC beside this file.
fn dbc(name: &str) {
    let file = format!("{name}.dbc");
    println!("cargo::rerun-if-changed={file}");
    let dbc = fs::read_to_string(&file).expect("the DBC stands beside this file");
    let mut code = Vec::new();
    Config::builder()
        .dbc_name(&file)
        .dbc_content(&dbc)
        .allow_dead_code(true)
        .build()
        .write(&mut code)
        .expect("the DBC has no errors");
    write(&format!("{name}_dbc.rs"), code);
}

/// Writes a file for the crate to include.
fn write(name: &str, code: impl AsRef<[u8]>) {
    let folder = env::var_os("OUT_DIR").expect("cargo sets it");
    fs::write(Path::new(&folder).join(name), code).expect("the folder can be written");
}
