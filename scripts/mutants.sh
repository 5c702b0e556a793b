#!/usr/bin/env bash
# Changes the core in one place at a time and runs tests that should notice. What they do not notice is listed as missed.
#
# usage: scripts/mutants.sh K/N [arguments of cargo mutants]     the shard K of N, counted from 0
#
# Needs cargo-mutants (cargo install cargo-mutants). Mutants of all files are spread over the shards; the whole core is
# 6300 builds. Tests are those that take seconds: what they miss is to be tried with all (tests/{accuracy,methods,
# sensitivity}.rs among them) before it counts. The command line and the naive oracle are left out.
set -euo pipefail
[ $# -gt 0 ] || { sed -n '4s/^# //p' "$0" >&2 && exit 2; }
cd "$(dirname "$0")/.."
shard=$1
shift
tests=()
for test in closed_forms statuses words profiles batch suite; do
    tests+=(--cargo-arg=--test="$test")
done
# Quick to build, and tests stay short.
export CARGO_PROFILE_TEST_OPT_LEVEL=1 CARGO_PROFILE_TEST_DEBUG=false
exec cargo mutants --shard "$shard" --sharding round-robin --exclude 'src/bin/**' --exclude 'src/sweep/oracle.rs' \
    --timeout 300 --build-timeout 900 --cargo-arg=--lib "${tests[@]}" "$@"
