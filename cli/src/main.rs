//! The command `canspec`.

use std::process::ExitCode;

fn main() -> ExitCode {
    canspec::main()
}
