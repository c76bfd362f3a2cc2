//! What a program costs.

use std::io;
use std::process::{Command, Stdio};
use std::time::{Duration, Instant};

use wait4::Wait4;

/// What a call takes.
pub struct Cost {
    /// Time of all processors.
    pub time: Duration,
    /// Time that somebody waits.
    pub wait: Duration,
    /// The most memory at a time, in bytes.
    pub memory: u64,
}

impl Cost {
    /// Runs a program, and returns what it takes and whether it finds no error.
    pub fn of(command: &mut Command) -> io::Result<(Self, bool)> {
        let start = Instant::now();
        let used = command.stderr(Stdio::null()).spawn()?.wait4()?;
        let time = used.rusage.utime + used.rusage.stime;
        Ok((Self { time, wait: start.elapsed(), memory: used.rusage.maxrss }, used.status.success()))
    }
}

/// Returns how many instructions a program takes, unless there is no valgrind.
pub fn instructions(program: &Command) -> Option<u64> {
    let output = Command::new("valgrind")
        .args(["--tool=cachegrind", "--cache-sim=no", "--cachegrind-out-file=/dev/null"])
        .arg(program.get_program())
        .args(program.get_args())
        .stdout(Stdio::null())
        .output()
        .ok()?;
    let text = String::from_utf8(output.stderr).ok()?;
    let line = text.lines().find(|line| line.contains("refs:"))?;
    line.rsplit(' ').next()?.replace(',', "").parse().ok()
}
