//! What a shell and `man` get.

use std::process::{Command, Output};

const SHELLS: [&str; 5] = ["bash", "elvish", "fish", "powershell", "zsh"];

fn canspec(arguments: &[&str]) -> Output {
    Command::new(env!("CARGO_BIN_EXE_canspec")).args(arguments).output().expect("the command starts")
}

fn text(arguments: &[&str]) -> String {
    let output = canspec(arguments);
    assert!(output.status.success(), "{arguments:?}: {}", String::from_utf8_lossy(&output.stderr));
    String::from_utf8(output.stdout).expect("it is text")
}

/// Returns the subcommands that the help lists.
fn subcommands() -> Vec<String> {
    let help = text(&["-h"]);
    let rows = help.lines().skip_while(|line| *line != "Commands:").skip(1).take_while(|line| !line.is_empty());
    let names = rows.filter_map(|row| row.split_whitespace().next()).filter(|name| *name != "help");
    names.map(str::to_owned).collect()
}

#[test]
fn every_shell_learns_every_subcommand() {
    assert!(subcommands().len() >= 13);
    for shell in SHELLS {
        let script = text(&["completions", shell]);
        for name in subcommands() {
            assert!(script.contains(&name), "{name} for {shell}");
        }
    }
}

/// The scripts for elvish and PowerShell complete no values at all.
#[test]
fn shells_that_complete_values_know_the_built_in_protocols() {
    for shell in ["bash", "fish", "zsh"] {
        let script = text(&["completions", shell]);
        assert!(canspec_specs::SPECS.iter().all(|spec| script.contains(spec.name)), "{shell}");
    }
}

#[cfg(unix)]
#[test]
fn bash_completes_subcommands_and_options() {
    let completed = |words: &str, last: usize| {
        let call = format!(
            "source /dev/stdin; COMP_WORDS=({words}); COMP_CWORD={last}; \
             _canspec canspec \"${{COMP_WORDS[$COMP_CWORD]}}\" \"${{COMP_WORDS[$COMP_CWORD-1]}}\"; echo \"${{COMPREPLY[@]}}\""
        );
        let script = format!("'{}' completions bash | bash -c '{call}'", env!("CARGO_BIN_EXE_canspec"));
        let output = Command::new("bash").args(["-c", &script]).output().expect("there is bash");
        String::from_utf8(output.stdout).expect("it is text").trim_end().to_owned()
    };
    assert_eq!(completed("canspec ident", 1), "identify");
    assert_eq!(completed("canspec decode --sum", 2), "--summary");
    assert_eq!(completed("canspec decode --format cs", 3), "csv");
    for command in ["compile", "decode", "encode", "examples", "list"] {
        assert_eq!(completed(&format!("canspec {command} --protocol in"), 3), "infy", "{command}");
    }
    assert_eq!(completed("canspec export dbc --protocol m", 4), "megmeet mxr");
}

#[test]
fn every_subcommand_has_a_page_of_the_manual() {
    for name in subcommands() {
        let page = text(&["manual", &name]);
        assert!(page.contains(&format!(".TH canspec-{name} 1 ")), "{page}");
        assert!(page.contains(".SH OPTIONS"), "{name}");
        assert!(text(&["manual"]).contains(&format!("canspec\\-{name}(1)")), "{name}");
    }
    assert!(text(&["manual", "export", "dbc"]).contains("\\-\\-nodes"));
}

#[test]
fn a_page_that_is_not_there_is_answered_with_the_nearest() {
    let output = canspec(&["manual", "export", "dcb"]);
    assert_eq!(output.status.code(), Some(2));
    let told = String::from_utf8_lossy(&output.stderr);
    assert_eq!(told, "canspec: `canspec export` has no subcommand `dcb`; did you mean `dbc`?\n");
}
