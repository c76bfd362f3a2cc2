//! The command as users meet it: each file of `tests/commands` holds calls with their whole output and exit status.

#[test]
fn the_command_answers_as_written() {
    trycmd::TestCases::new().case("../tests/commands/*.md").case("../tests/commands/*.toml").run();
}
