# What people run; `.ci/run` runs the same things.

# Every test of the workspace.
test:
    cargo test --workspace

# What a change must pass.
ci:
    .ci/run

# Rewrite the expected outputs: generated code, diagnostics, whole commands. Read the difference before you commit it.
bless:
    INSTA_UPDATE=always CANSPEC_BLESS=1 cargo test -p canspec-tests
    TRYCMD=overwrite cargo test -p canspec --test commands
    git diff --stat
