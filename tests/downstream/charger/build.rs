//! Compiles the spec of the modules.

use canspec_codegen::Builder;

fn main() {
    Builder::new().spec("../../../specs/infy.yaml").build();
}
