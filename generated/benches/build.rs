//! Lets dbc-codegen compile the DBC of the same messages.

use std::{env, fs, path::Path};

use dbc_codegen::Config;

fn main() {
    dbc("infy");
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
    let folder = env::var_os("OUT_DIR").expect("cargo sets it");
    fs::write(Path::new(&folder).join(format!("{name}_dbc.rs")), code).expect("the folder can be written");
}
