//! What a program needs on a board: a start, memory for the bus, and an end that QEMU takes.

use cortex_m_rt::entry;
use cortex_m_semihosting::debug::{EXIT_SUCCESS, exit};
use embedded_alloc::LlffHeap;
// It prints what went wrong, and ends QEMU with a failure.
use panic_semihosting as _;

/// The bus keeps what it has sent; a station alone needs no heap.
#[global_allocator]
static HEAP: LlffHeap = LlffHeap::empty();

#[entry]
fn main() -> ! {
    #[expect(unsafe_code, reason = "it is called once, before anything is allocated")]
    unsafe {
        embedded_alloc::init!(HEAP, 0x10_0000);
    }
    super::tell();
    loop {
        exit(EXIT_SUCCESS);
    }
}
