//! Keeps the start-up code and the libraries of the operating system out.

/// What `compiler_builtins` has on targets without an operating system, and leaves to the C library on the others.
const MEMORY: [&str; 5] = ["bcmp", "memcmp", "memcpy", "memmove", "memset"];

fn main() {
    println!("cargo::rerun-if-changed=build.rs");
    let is_hosted = std::env::var_os("CARGO_CFG_TARGET_OS").is_some_and(|system| system != "none");
    if is_hosted {
        println!("cargo::rustc-link-arg=-nostartfiles");
        println!("cargo::rustc-link-arg=-nostdlib");
        println!("cargo::rustc-link-arg=-no-pie");
        for name in MEMORY {
            println!("cargo::rustc-link-arg=-Wl,--defsym={name}=0");
        }
    }
}
