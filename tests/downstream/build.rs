//! Compiles every spec of `specs/`.

fn main() {
    canspec_codegen::Builder::new().folder("specs").build();
}
