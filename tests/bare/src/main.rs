//! Calls generated code with unknown bytes. It is linked, never run.
//!
//! The test writes the codecs and the calls into a file, whose path is in `CANSPEC_PROGRAM`.
#![no_std]
#![no_main]
#![allow(dead_code, unused_imports, reason = "a program calls a part of the codecs")]

mod calls;
mod stations;
mod unknown;

include!(env!("CANSPEC_PROGRAM"));

unsafe extern "C" {
    /// Nobody defines it: what can panic cannot be linked.
    safe fn this_program_can_panic() -> !;
}

#[panic_handler]
fn panic(_: &core::panic::PanicInfo<'_>) -> ! {
    this_program_can_panic()
}

/// The entry of the program.
// SAFETY: nothing else has this name, because nothing else is linked.
#[unsafe(no_mangle)]
pub extern "C" fn _start() -> ! {
    program();
    loop {
        core::hint::spin_loop();
    }
}
