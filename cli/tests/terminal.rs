//! What people read on a terminal is as wide as that, and its words are whole.
#![cfg(target_os = "linux")]

use std::process::{Command, Stdio};

/// Returns what a terminal of some width shows of a call, and what the call writes elsewhere.
fn shown(width: usize, arguments: &str) -> [String; 2] {
    let canspec = env!("CARGO_BIN_EXE_canspec");
    let call = format!("stty rows 24 cols {width}; '{canspec}' {arguments}");
    let terminal = Command::new("script").args(["-qec", &call, "/dev/null"]).stdin(Stdio::null()).output();
    let other = Command::new(canspec).args(arguments.split(' ')).output();
    let text = |output: std::io::Result<std::process::Output>| {
        String::from_utf8(output.expect("every Linux has `script`").stdout).expect("it is text")
    };
    [text(terminal).replace("\r\n", "\n"), text(other)]
}

#[test]
fn lists_and_documents_keep_to_the_width_of_a_terminal_and_part_no_word() {
    let calls = [
        "list",
        "list --protocol infy",
        "list --protocol infy --full",
        "list --protocol gbt27930 --full",
        "examples --protocol infy",
        "rules",
        "rules file",
    ];
    for arguments in calls {
        for width in [60, 100] {
            let [on_terminal, elsewhere] = shown(width, arguments);
            let words = |text: &str| text.split_whitespace().map(str::to_owned).collect::<Vec<_>>();
            assert_eq!(words(&on_terminal), words(&elsewhere), "{arguments} at {width}");
            // A word alone may be wider.
            let too_wide = |line: &&str| line.chars().count() > width && line.trim().contains(' ');
            assert_eq!(on_terminal.lines().find(too_wide), None, "{arguments} at {width}");
        }
    }
}
