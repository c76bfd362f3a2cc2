# What people run; `.ci/run` runs the same things.

# Every test of the workspace.
test:
    cargo test --workspace

# What a change must pass.
ci:
    .ci/run

# Accept the generated code of the snapshots, after reading it.
bless:
    INSTA_UPDATE=always cargo test -p canspec-tests
    git diff --stat
