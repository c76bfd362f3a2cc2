# What people run. `.ci/run` runs the same things, but for what takes long.

# What most changes break first.
quick:
    cargo fmt --all --check
    cargo test --quiet --package canspec-runtime --package canspec-codegen --lib -- --skip random_programs --skip on_a_bus_with_faults
    cargo test --quiet --package canspec-tests --test snapshots --test diagnostics --test prose --test markdown
    cargo test --quiet --package canspec --test commands

# Every test of the workspace.
test:
    cargo test --workspace

# What a change must pass.
ci:
    .ci/run

# What takes too long for each change, and is run before an issue is closed.
deep: (programs "200000") (random-specs "2000") sweep (seeds "1000")
    CANSPEC_DEEP=1 cargo test --package canspec-tests --test links
    cargo run --quiet --bin canspec-mutants -- --at-most 60

# A table of how many bytes generated code takes, and the codec by hand; words choose among the rows.
size *words:
    cargo run --quiet --bin size -- {{words}}

# Instructions of the generated codecs beside a hand-written one, dbc-codegen and cantools, with LTO and without; words choose among the protocols.
bench *words:
    cd generated/benches && cargo test --release --quiet && cargo run --release --quiet -- {{words}}

# What the command costs for specs of 10 to 10,000 messages.
growth:
    cargo bench --quiet -p canspec --bench growth

# What the command takes to decode a log, beside a program by hand and cantools.
logs:
    cargo bench --quiet -p canspec --bench logs

# Look for inputs that break `front_end` or `frames` for some seconds, guided by coverage.
fuzz target seconds="600":
    cargo run --quiet --bin seeds -- target/fuzz
    cd tests && cargo fuzz run --sanitizer none {{target}} ../target/fuzz/{{target}} -- -max_total_time={{seconds}}

# Every raw value of 32 bits, through each scale that the built-in specs give such a signal; takes minutes.
sweep:
    cargo run --quiet --release --bin sweep

# Compile `count` random specs and their Rust, from the seed `first` on.
random-specs count="10000" first="0":
    cargo run --quiet --bin random_specs -- {{count}} {{first}}

# Random programs on a bus that loses and delays replies: what the client says of them must be true, and in time.
programs count="200000":
    CANSPEC_PROGRAMS={{count}} cargo test --quiet --release --package canspec-runtime --lib random_programs -- --nocapture

# A station whose modules fail, for some virtual minutes by each seed, and how often what happened.
seeds count="10000" first="0" minutes="120":
    cargo run --quiet --release --package canspec-station --example seeds -- {{count}} {{first}} {{minutes}}

# Mistakes, planted in copies of the client and the station, and the seed by which each is found; a word chooses.
mistakes word="":
    cargo run --quiet --release --package canspec-station --example mistakes -- "{{word}}"

# A station and its modules on a Cortex-M4 under QEMU, and their size.
board:
    .ci/board

# The comparison with other people's programs.
peers:
    .ci/peers

# Completion, complaints and explanations of the YAML language server.
editor:
    .ci/editor

# Mistakes, planted one after the other in a copy of the sources, and the tests that find them; words choose among them.
mutants *words:
    cargo run --quiet --bin canspec-mutants -- {{words}}

# Rewrite the expected outputs: generated code, diagnostics, whole commands, public interfaces. Read the difference before you commit it.
bless:
    INSTA_UPDATE=always CANSPEC_BLESS=1 cargo test -p canspec-tests
    TRYCMD=overwrite cargo test -p canspec --test commands
    cargo run --quiet --bin public_api -- --bless
    git diff --stat
