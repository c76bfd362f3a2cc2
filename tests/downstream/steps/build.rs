//! Compiles the specs of the crate around, and one that ships, in whole steps.

use canspec_codegen::Builder;
use canspec_codegen::emit::Scaled;

fn main() {
    Builder::new().folder("../specs").spec("../../../specs/infy.yaml").scaled(Scaled::Steps).build();
}
