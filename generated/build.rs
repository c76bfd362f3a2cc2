//! Compiles every spec of `canspec-specs`.

use canspec_codegen::emit::Switch::Gated;

fn main() {
    let [serde, defmt, arbitrary] = ["serde", "defmt", "arbitrary"].map(|feature| Gated(feature.to_owned()));
    canspec_codegen::Builder::new()
        .folder(canspec_specs::FOLDER)
        .serde(serde)
        .defmt(defmt)
        .arbitrary(arbitrary)
        .build();
}
