//! The command as people meet it: each file of `tests/commands` holds calls with their whole output and exit status.
//!
//! `TRYCMD=overwrite` writes down what the command says now, to be read before it is believed.

#[test]
fn the_command_answers_as_written() {
    trycmd::TestCases::new().case("../tests/commands/*.md").case("../tests/commands/*.toml").run();
}
