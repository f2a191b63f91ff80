#!/usr/bin/env bash
# Tests what measures and audits: a workspace of its own, which `cargo test` at the root does not know.
set -euo pipefail
cd "$(dirname "$0")"
cargo test --workspace
cargo fmt --all --check
cargo clippy --workspace --all-targets -- -D warnings
RUSTDOCFLAGS="-D warnings" cargo doc --workspace --no-deps
cargo run --quiet --package stickslip-bench -- house
