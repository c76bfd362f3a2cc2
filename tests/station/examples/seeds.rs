//! Runs a station for hours while its modules fail: `seeds COUNT [FIRST] [MINUTES]`.
//!
//! It prints how often what happened, and fails with the first seed at which the station breaks a promise. It also fails if
//! something happens less often than once in ten minutes, on average of many runs.

#[path = "../tests/bus/mod.rs"]
mod bus;
#[path = "../tests/seeds/mod.rs"]
mod seeds;

use std::process::ExitCode;
use std::{env, thread};

use seeds::{Counts, run};

/// Returns the numbers of a call: how many seeds, the first one, and the minutes of each. What is left out is as usual.
fn numbers(words: &[String]) -> Result<[u64; 3], String> {
    let mut numbers = [200, 0, 120];
    if words.len() > numbers.len() {
        return Err(format!("there are {} numbers: call it as `seeds COUNT [FIRST] [MINUTES]`", words.len()));
    }
    for (number, word) in numbers.iter_mut().zip(words) {
        *number = word.parse().map_err(|_| format!("`{word}` is no whole number from 0 on"))?;
    }
    Ok(numbers)
}

#[expect(clippy::print_stdout, reason = "people read what happened")]
fn main() -> ExitCode {
    let words: Vec<_> = env::args().skip(1).collect();
    let [count, first, minutes] = match numbers(&words) {
        Ok(numbers) => numbers,
        Err(wrong) => {
            eprintln!("seeds: {wrong}");
            return ExitCode::from(2);
        }
    };
    let end = u32::try_from(minutes * 60_000).unwrap_or(u32::MAX / 2);
    let cores = thread::available_parallelism().map_or(1, |cores| cores.get() as u64);
    let runs = thread::scope(|scope| {
        let part = |core: u64| {
            move || {
                (first..first + count).filter(|seed| seed % cores == core).try_fold(
                    Counts::default(),
                    |mut sum, seed| {
                        sum += run(seed, end).map_err(|wrong| (seed, wrong))?;
                        Ok(sum)
                    },
                )
            }
        };
        let parts: Vec<_> = (0..cores).map(|core| scope.spawn(part(core))).collect();
        parts
            .into_iter()
            .map(|part| part.join().expect("a run does not panic"))
            .collect::<Vec<Result<Counts, (u64, String)>>>()
    });
    let mut sum = Counts::default();
    let mut wrong = None;
    for run in runs {
        match run {
            Ok(counts) => sum += counts,
            Err(other) => wrong = wrong.filter(|known: &(u64, String)| known.0 < other.0).or(Some(other)),
        }
    }
    if let Some((seed, wrong)) = wrong {
        println!("seed {seed}: {wrong}");
        return ExitCode::FAILURE;
    }
    println!("{sum}");
    // A few minutes may lack one of them.
    if let Some(fault) = sum.too_rare().filter(|_| count * minutes >= 1000) {
        println!("too seldom: {fault}");
        return ExitCode::FAILURE;
    }
    ExitCode::SUCCESS
}
