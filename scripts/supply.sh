#!/usr/bin/env bash
# What the crate is made of and what it ships: licences, duplicates and sources of the dependencies, the least versions
# that Cargo.toml promises, the oldest compiler as far as lints know it, and the package.
#
# usage: scripts/supply.sh [deny | least | msrv | package ...]     all of them if none is given
#
# `deny` needs cargo-deny (cargo install cargo-deny), `least` a nightly toolchain for its resolver. Advisories need the
# RustSec database from the network: cargo deny check advisories.
set -euo pipefail
cd "$(dirname "$0")/.."
[ $# -gt 0 ] || set -- deny least msrv package
scratch=$(mktemp -d)
trap 'rm -rf "$scratch"' EXIT

deny() {
    cargo fetch --locked --quiet
    cargo deny --offline check licenses bans sources
}

# Direct dependencies at the versions that Cargo.toml names, in a copy: the lock file is left alone.
least() {
    git archive HEAD | tar -x -C "$scratch"
    (
        cd "$scratch"
        cargo +nightly update --quiet -Z direct-minimal-versions
        export CARGO_TARGET_DIR=$scratch/target
        cargo check --quiet --locked --lib --no-default-features --features libm
        cargo check --quiet --locked --lib
        cargo check --quiet --locked --features cli,parquet
    )
    echo 'least versions: core and command line compile'
}

# Clippy knows since when the standard library has what is used; only the toolchain itself could prove more.
msrv() {
    cargo clippy --quiet --all-targets --features cli,parquet -- -D clippy::incompatible-msrv
    echo "oldest compiler: nothing newer than $(sed -n 's/^rust-version = "\(.*\)"/\1/p' Cargo.toml) is used, by clippy's list"
}

# What users download: no build products, no corpora, and it compiles by itself.
package() {
    local list bytes
    list=$(cargo package --list --allow-dirty 2>/dev/null)
    if grep -E '^(target|fuzz|\.ci)/|\.(profraw|rlib|o|orig\.rs)$|/(corpus|artifacts|seeds)/' <<<"$list"; then
        echo 'package: the files above have no place in it' >&2
        return 1
    fi
    for needed in Cargo.lock LICENSE-MIT LICENSE-APACHE README.md CHANGELOG.md src/lib.rs; do
        grep -qx "$needed" <<<"$list" || { echo "package: $needed is missing" >&2 && return 1; }
    done
    cargo package --quiet --allow-dirty --target-dir "$scratch/package" 2>/dev/null
    bytes=$(stat -c %s "$scratch"/package/package/*.crate)
    echo "package: $(wc -l <<<"$list") files, $((bytes / 1024)) KiB, and it compiles by itself"
}

for what; do "$what"; done
