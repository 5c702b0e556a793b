#!/usr/bin/env bash
# Changes the core in one place at a time and runs tests that should notice. What they do not notice is listed as missed.
#
# usage: scripts/mutants.sh COUNT [SEED]
#
# Of the mutants that cargo-mutants lists (cargo install cargo-mutants), COUNT are drawn by SEED (1); 9999 are all. The first
# so many of a sample are a sample: an interrupted run counts, and the same command goes on with it. Generic code is
# compiled anew in each test, so that a build for each mutant takes most of a minute; here all are woven into one program
# (scripts/mutants/src/main.rs) that is compiled once and told by the environment which of them to be. Tests are run from
# the quick to the slow until one fails. Results are rows of target/mutants/SEED-COUNT/rows: number, outcome, what
# caught it, seconds, name. The command line and the naive oracle are left out.
set -euo pipefail
[ $# -gt 0 ] || { sed -n '4s/^# //p' "$0" >&2 && exit 2; }
cd "$(dirname "$0")/.."
count=$1 seed=${2:-1}
out=$PWD/target/mutants/$seed-$count tree=$PWD/target/mutants/tree
mkdir -p "$out" "$tree"
export CARGO_TARGET_DIR=$PWD/target/mutants/target RUSTFLAGS=-Awarnings CARGO_PROFILE_TEST_DEBUG=false
export RUST_TEST_THREADS=1 PROPTEST_MAX_SHRINK_ITERS=0
slow=(words memory convergence profiles history corners batch coupled global faults invariants accuracy methods
    sensitivity special_values)

cargo build --quiet --manifest-path scripts/mutants/Cargo.toml
cargo mutants --list --json --exclude 'src/bin/**' --exclude 'src/sweep/oracle.rs' >"$out/list"

# Weaves until what is woven compiles: errors are in lines that end with the number of their mutant.
: >"$out/unviable"
while :; do
    rm -rf "${tree:?}/src" "$tree/tests"
    cp -r Cargo.toml Cargo.lock src tests benches examples docs "$tree"
    mapfile -t unviable <"$out/unviable"
    "$CARGO_TARGET_DIR/debug/piezobeam-mutants" "$out/list" "$tree" "$seed" "$count" "${unviable[@]}" >"$out/plan"
    errors=$(cd "$tree" && cargo check --lib --message-format short 2>&1 | grep '^src.* error' || :)
    [ -n "$errors" ] || break
    found=$(while IFS=: read -r file line _; do
        sed -n "${line}s/.* mutant \([0-9]*\)\.\$/\1/p" "$tree/$file"
    done <<<"$errors")
    [ -n "$found" ] || { printf '%s\n' "$errors" >&2 && exit 1; }
    sort -un - "$out/unviable" <<<"$found" >"$out/more" && mv "$out/more" "$out/unviable"
done

# One program of all integration tests.
mkdir "$tree/tests/all"
{
    echo '#[path = "../common/mod.rs"] mod common;'
    for test in statuses suite closed_forms "${slow[@]}"; do
        sed 's/^mod common;/use crate::common;/' "$tree/tests/$test.rs" >"$tree/tests/all/$test.rs"
        echo "mod $test;"
    done
} >"$tree/tests/all/main.rs"
rm "$tree"/tests/*.rs
cd "$tree"
built() { cargo test --no-run "$@" --message-format json | sed -n 's/.*"executable":"\([^"]*\)".*/\1/p'; }
unit=$(built --lib) all=$(built --test all)

# Whether the tests pass, of the mutant in MUTANT: the seconds that they may take, and their names.
pass() {
    local seconds=$1
    shift
    (ulimit -v 8000000 && exec timeout -k 1 "$seconds" nice "$@" --quiet >/dev/null 2>&1)
}

# What becomes of a mutant of the file $1, and by what.
fate() {
    local stages=("10 $all statuses::" "15 $all suite:: --skip work_grows" "15 $all closed_forms::" "30 $unit")
    local own=${1#src/} stage words name status
    own=${own%%/*} own=${own%.rs}
    # Of the slow ones, first those that are named like the file.
    [[ " ${slow[*]} " != *" $own "* ]] || stages+=("300 $all $own::")
    for name in "${slow[@]}"; do
        stages+=("300 $all $name::")
    done
    stages+=("60 $all work_grows")
    for stage in "${stages[@]}"; do
        read -ra words <<<"$stage"
        name=${words[2]:-unit}
        status=0
        pass "${words[@]}" || status=$?
        case $status in
            0) ;;
            124 | 137) printf 'timeout\t%s' "${name%::}" && return ;;
            *) printf 'caught\t%s' "${name%::}" && return ;;
        esac
    done
    printf 'missed\t-'
}

touch "$out/rows"
MUTANT=0 pass 600 "$unit" && MUTANT=0 pass 600 "$all" || { echo 'tests fail without a mutant' >&2 && exit 1; }
while IFS=$'\t' read -r number how name; do
    ! grep -q "^$number"$'\t' "$out/rows" || continue
    start=$EPOCHREALTIME
    [ "$how" = woven ] && fate=$(MUTANT=$number fate "${name%%:*}") || fate=$'alone\t-'
    seconds=$(awk "BEGIN { printf \"%.1f\", $EPOCHREALTIME - $start }")
    printf '%s\t%s\t%s\t%s\n' "$number" "$fate" "$seconds" "$name" | tee -a "$out/rows"
done <"$out/plan"
