#!/usr/bin/env bash
# Changes the core in one place at a time and runs tests that should notice. What they do not notice is listed as missed.
#
# usage: scripts/mutants.sh K/N [arguments of cargo mutants]     the shard K of N, counted from 0
#
# Needs cargo-mutants (cargo install cargo-mutants). Mutants of all files are spread over the shards; the whole core is
# some thousands of builds. Tests are those that take seconds; the command line and the naive oracle are left out.
set -euo pipefail
[ $# -gt 0 ] || { sed -n '4s/^# //p' "$0" >&2 && exit 2; }
cd "$(dirname "$0")/.."
shard=$1
shift
tests=()
for test in closed_forms convergence statuses words profiles history batch memory suite coupled; do
    tests+=(--test "$test")
done
# Quick to build, and tests stay short.
export CARGO_PROFILE_TEST_OPT_LEVEL=1 CARGO_PROFILE_TEST_DEBUG=false
exec cargo mutants --shard "$shard" --sharding round-robin --exclude 'src/bin/**' --exclude 'src/sweep/oracle.rs' \
    --timeout 300 --build-timeout 900 "$@" -- --lib "${tests[@]}"
