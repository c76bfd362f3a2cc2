//! Standard output.

use std::io::{self, StdoutLock};

/// Returns standard output.
///
/// # Errors
///
/// It was closed before the command began. The standard library would replace it by `/dev/null`,
/// which takes everything.
pub fn output() -> io::Result<StdoutLock<'static>> {
    if closed::at_start() { Err(io::Error::other("it is closed")) } else { Ok(io::stdout().lock()) }
}

/// Returns how many characters a line of the terminal has, if standard output is one.
pub fn width() -> Option<usize> {
    let (terminal_size::Width(width), _) = terminal_size::terminal_size_of(io::stdout())?;
    Some(width.into()).filter(|width| *width > 0)
}

#[cfg(target_os = "linux")]
mod closed {
    use std::path::Path;
    use std::sync::atomic::{AtomicBool, Ordering};

    static CLOSED: AtomicBool = AtomicBool::new(false);

    /// Runs before the standard library replaces a closed standard output.
    #[used]
    #[expect(unsafe_code, reason = "nothing else runs that early")]
    #[unsafe(link_section = ".init_array")]
    static LOOK: extern "C" fn() = look;

    extern "C" fn look() {
        let files = Path::new("/proc/self/fd");
        CLOSED.store(files.exists() && !files.join("1").is_symlink(), Ordering::Relaxed);
    }

    pub fn at_start() -> bool {
        CLOSED.load(Ordering::Relaxed)
    }
}

#[cfg(not(target_os = "linux"))]
mod closed {
    pub fn at_start() -> bool {
        false
    }
}
