#!/bin/sh
# Counts the instructions of one solve by valgrind's callgrind. The difference of two runs with 1 and 11 solves is ten
# solves: starting, checking and laying out the mesh are in both. Where memory comes to lie changes a count by a tenth
# of a per cent at most, by how it is copied.
#
# usage: benches/count.sh <scene> <elements>     (scenes: examples/left_out.rs)
# prints instructions, element visits, bytes per element
set -eu
cd "$(dirname "$0")/.."
command -v valgrind >/dev/null || {
    echo 'benches/count.sh: valgrind is missing; apt-get install valgrind' >&2
    exit 1
}
# Counts are those of a plain build.
unset RUSTFLAGS CARGO_ENCODED_RUSTFLAGS
cargo build --quiet --release --example left_out
program=${CARGO_TARGET_DIR:-target}/release/examples/left_out
log=$(mktemp)
trap 'rm -f "$log"' EXIT

# Instructions of a run with $2 solves of the scene $1 on $3 elements.
instructions() {
    valgrind --tool=callgrind --callgrind-out-file=/dev/null "$program" "$1" "$2" "$3" >/dev/null 2>"$log" || {
        cat "$log" >&2
        exit 1
    }
    sed -n 's/.*Collected *: *//p' "$log" | tr -d ' '
}

few=$(instructions "$1" 1 "$2")
many=$(instructions "$1" 11 "$2")
said=$("$program" "$1" 11 "$2")
echo "$(((many - few) / 10)) $said"
