//! Plants mistakes in copies of the client and the station, and prints by which seed each is found: `mistakes [WORD]`.
//!
//! A word chooses among the mistakes by their names. Each must be found within 1,000 seeds, of ten minutes each.
#![expect(clippy::print_stdout, reason = "people read what was found")]

use std::path::{Path, PathBuf};
use std::process::{Command, ExitCode};
use std::{env, fs, io};

/// How many seeds may run until a mistake is found, and for how many minutes each.
const SEEDS: &str = "1000";
const MINUTES: &str = "10";

/// A mistake: its name, and what stands in a file instead of what.
struct Mistake {
    name: &'static str,
    file: &'static str,
    right: &'static str,
    wrong: &'static str,
}

const ENTRY: &str = "runtime/src/client/entry.rs";
const ORDER: &str = "runtime/src/client/order.rs";
const ROUND: &str = "runtime/src/station/round.rs";

const MISTAKES: &[Mistake] = &[
    Mistake {
        name: "a switch-on that is lost in a restart does not come again",
        file: ORDER,
        right: "    fn be_led(&mut self, sent: Option<u32>) {\n",
        wrong: "    fn be_led(&mut self, sent: Option<u32>) {\n        if self.begun != self.round {\n            return;\n        }\n",
    },
    Mistake {
        name: "what is held is not renewed",
        file: "runtime/src/client/hold.rs",
        right: "Some(round(refresh).ok_or(NotHeld::Period)?)",
        wrong: "Some(round(refresh.max(u32::MAX / 2)).ok_or(NotHeld::Period)?)",
    },
    Mistake {
        name: "nothing is sent again",
        file: ENTRY,
        right: "if !is_done && self.leader.is_none() && self.tries < self.pace.tries {",
        wrong: "if !is_done && self.leader.is_none() && self.tries < self.pace.tries.min(1) {",
    },
    Mistake {
        name: "a late answer is taken for a new one",
        file: ENTRY,
        right: "if is_answered { [self.pace.wait, self.pace.late] } else { [0, 0] };",
        wrong: "if is_answered { [self.pace.wait, self.pace.late / 8] } else { [0, 0] };",
    },
    Mistake {
        name: "requests come too fast",
        file: "runtime/src/client.rs",
        right: "self.busy = Some(now.wrapping_add(entry.pace.gap))",
        wrong: "self.busy = Some(now.wrapping_add(entry.pace.gap / 2))",
    },
    Mistake {
        name: "a switch-on does not wait for its set-point",
        file: ORDER,
        right: "self.leader.is_some_and(|leader| leader.is_awaited)",
        wrong: "self.leader.is_some_and(|leader| leader.is_awaited && leader.is_wanted)",
    },
    Mistake {
        name: "a switch-on comes again without its set-point",
        file: ENTRY,
        right: "        self.wait_for_leader();\n        self.tries",
        wrong: "        self.tries",
    },
    Mistake {
        name: "a silent module is assumed to be as it was",
        file: "runtime/src/station/known.rs",
        right: "(!has_lasted(self.at, valid.saturating_add(1), now)).then_some(self.value)",
        wrong: "(!has_lasted(self.at, valid.saturating_mul(9), now)).then_some(self.value)",
    },
    Mistake {
        name: "modules are fed too seldom",
        file: ROUND,
        right: "self.client.every(round, request, now)",
        wrong: "self.client.every(5 * round, request, now)",
    },
    Mistake {
        name: "a lost request is not reported",
        file: ENTRY,
        right: "None => Step::Lost(ticket),",
        wrong: "None => return None,",
    },
    Mistake {
        name: "a repeated answer counts again",
        file: ENTRY,
        right: "if has_one_answer(&self.request) {",
        wrong: "if has_one_answer(&self.request) && self.pace.tries == 0 {",
    },
    Mistake {
        name: "a module is not told of the stop of its group",
        file: ROUND,
        right: "(Task::Stop, _) | (Task::AsFound, Found::Off) => return Goal::Off,",
        wrong: "(Task::Stop, _) | (Task::AsFound, Found::Off) => return Goal::Read,",
    },
    Mistake {
        name: "a refusal is taken for an answer",
        file: ENTRY,
        right: "if is_refusal { Heard::Refusal { ticket, received } } else",
        wrong: "if is_refusal && self.hold.is_some() { Heard::Refusal { ticket, received } } else",
    },
    Mistake {
        name: "what was not heard for long is read first",
        file: ROUND,
        right: "(goal, None) => self.probe(place, goal, target, now),",
        wrong: "(goal, None) => self.probe(place, if goal == Goal::Off { Goal::Read } else { goal }, target, now),",
    },
    Mistake {
        name: "what another controller has switched on stays on",
        file: "runtime/src/station/hear.rs",
        right: "            self.stop_anew();\n",
        wrong: "",
    },
    Mistake {
        name: "a clock that goes back stops the station",
        file: "runtime/src/clock.rs",
        right: "        self.ahead = self.ahead.wrapping_add(back);\n",
        wrong: "",
    },
    Mistake {
        name: "what waits since the last round is sent, too",
        file: ROUND,
        right: "        module.once.take().into_iter().for_each(|ticket| self.client.cancel(ticket));\n",
        wrong: "",
    },
    Mistake {
        name: "a group has more current than it may",
        file: ROUND,
        right: "let current = current.min(share);",
        wrong: "let current = current.min(share.max(i32::MAX));",
    },
    Mistake {
        name: "a current rises at once",
        file: ROUND,
        right: "current.min(module.step(limits.rise_ma, round, now))",
        wrong: "current.max(module.step(limits.rise_ma, round, now))",
    },
    Mistake {
        name: "what is taken back from another controller has its old current at once",
        file: "runtime/src/station/hear.rs",
        right: "                module.due = None;\n                module.rise_anew();\n",
        wrong: "                module.due = None;\n",
    },
];

fn main() -> ExitCode {
    let word = env::args().nth(1).unwrap_or_default();
    let root = Path::new(env!("CARGO_MANIFEST_DIR")).join("../..");
    let wanted: Vec<_> = MISTAKES.iter().filter(|mistake| mistake.name.contains(&word)).collect();
    if wanted.is_empty() {
        println!("no name of a mistake has `{word}` in it; the names are:");
        for mistake in MISTAKES {
            println!("  {}", mistake.name);
        }
        return ExitCode::from(2);
    }
    let mut are_found = true;
    for mistake in wanted {
        match verdict(mistake, &root, &root.join("target/mistakes")) {
            Ok(Some(found)) => println!("{}: {found}", mistake.name),
            Ok(None) => {
                println!("{}: **nothing**", mistake.name);
                are_found = false;
            }
            Err(error) => {
                println!("{}: {error}", mistake.name);
                are_found = false;
            }
        }
    }
    if are_found { ExitCode::SUCCESS } else { ExitCode::FAILURE }
}

/// Plants a mistake, and returns what finds it.
fn verdict(mistake: &Mistake, root: &Path, copy: &Path) -> io::Result<Option<String>> {
    for file in sources(root)? {
        let (from, to) = (root.join(&file), copy.join(&file));
        let right = fs::read(&from)?;
        let text = if file == Path::new(mistake.file) { planted(mistake, right)? } else { right };
        if fs::read(&to).ok().as_ref() != Some(&text) {
            to.parent().map_or(Ok(()), fs::create_dir_all)?;
            fs::write(&to, text)?;
        }
    }
    let mut seeds = Command::new(env!("CARGO"));
    seeds.args(["run", "--quiet", "--release", "--package", "canspec-station", "--example", "seeds", "--"]);
    let output = seeds.args([SEEDS, "0", MINUTES]).current_dir(copy).env_remove("CARGO_TARGET_DIR").output()?;
    let said = String::from_utf8_lossy(&output.stdout).trim().to_owned();
    match (output.status.success(), said.starts_with("seed ")) {
        (true, _) => Ok(None),
        (false, true) => Ok(Some(said)),
        (false, false) => Err(io::Error::other(format!("{said}\n{}", String::from_utf8_lossy(&output.stderr)))),
    }
}

fn planted(mistake: &Mistake, right: Vec<u8>) -> io::Result<Vec<u8>> {
    let text = String::from_utf8(right).map_err(io::Error::other)?;
    if text.matches(mistake.right).count() != 1 {
        return Err(io::Error::other(format!("`{}` does not stand once in {}", mistake.right, mistake.file)));
    }
    Ok(text.replace(mistake.right, mistake.wrong).into_bytes())
}

/// Returns the files of the workspace.
fn sources(root: &Path) -> io::Result<Vec<PathBuf>> {
    let output = Command::new("git")
        .args(["ls-files", "--cached", "--others", "--exclude-standard"])
        .current_dir(root)
        .output()?;
    Ok(String::from_utf8_lossy(&output.stdout)
        .lines()
        .map(PathBuf::from)
        .filter(|file| root.join(file).is_file())
        .collect())
}
