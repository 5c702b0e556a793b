#!/bin/sh
# What a scene lacks costs nothing: instructions of a solve from nothing, by valgrind's callgrind, for scenes
# with more and more in them. The difference of two runs with 1 and 11 solves is ten solves: starting,
# checking and laying out the mesh are in both.
#
# usage: benches/left_out.sh [elements]
set -eu
cd "$(dirname "$0")/.."
elements=${1:-1000}
target=${CARGO_TARGET_DIR:-target}
cargo build --quiet --release --example left_out
program=$target/release/examples/left_out
log=$(mktemp)
trap 'rm -f "$log"' EXIT

# Instructions of a run with $2 solves of the scene $1.
instructions() {
    valgrind --tool=callgrind --callgrind-out-file=/dev/null "$program" "$1" "$2" "$elements" >/dev/null 2>"$log" || {
        cat "$log" >&2
        exit 1
    }
    sed -n 's/.*Collected *: *//p' "$log" | tr -d ' '
}

echo '| scene | instructions per solve | element visits | instructions per visit | bytes per element |'
echo '|---|--:|--:|--:|--:|'
for scene in bending contact stretching full; do
    case $scene in
        bending) name='bending only' ;;
        contact) name='+ contact' ;;
        stretching) name='+ stretching' ;;
        full) name='full: + potential, piezoelectricity, conduction' ;;
    esac
    few=$(instructions $scene 1)
    many=$(instructions $scene 11)
    said=$("$program" $scene 1 "$elements")
    visits=${said% *}
    bytes=${said#* }
    solve=$(((many - few) / 10))
    echo "| $name | $solve | $visits | $((solve / visits)) | $bytes |"
done
