#!/usr/bin/env bash
# Lines and branches of the library that the tests reach, and those that they do not.
#
# A line counts as reached, and a condition as true or false, where any instance of a generic function says so. (The
# tables of llvm-cov take each function's best instance, which knows nothing of the others.) Tests are not counted.
#
# usage: scripts/coverage.sh [arguments of cargo test, such as --lib --test suite]
#
# Needs a nightly toolchain, cargo-llvm-cov (cargo install cargo-llvm-cov), and the LLVM tools of that nightly's major
# version: `rustup component add llvm-tools --toolchain nightly`, or LLVM_COV and LLVM_PROFDATA, or Debian's llvm-NN.
set -euo pipefail
cd "$(dirname "$0")/.."
major=$(rustc +nightly -vV | sed -n 's/LLVM version: \([0-9]*\).*/\1/p')
if command -v "llvm-cov-$major" >/dev/null; then
    export LLVM_COV=${LLVM_COV:-llvm-cov-$major} LLVM_PROFDATA=${LLVM_PROFDATA:-llvm-profdata-$major}
fi
[ $# -gt 0 ] || set -- --lib --tests
out=$(mktemp -d)
trap 'rm -rf "$out"' EXIT
cargo +nightly llvm-cov --branch --no-report "$@"
cargo +nightly llvm-cov report --branch --ignore-filename-regex '(tests/|src/bin/|oracle\.rs|fault\.rs)' \
    --lcov --output-path "$out/lcov"
: >"$out/missed"
# DA:line,count of a line; BRDA:line,condition,number,count of its conditions: even numbers say true, odd ones false.
awk -F '[:,]' -v root="$PWD/" -v missed="$out/missed" '
    /^SF:/ {
        path = substr($0, 4); file = path; sub(root, "", file)
        # A file ends with its tests.
        for (end = 0; (getline text < path) > 0 && text !~ /^mod tests/;) source[++end] = text
    }
    /^(DA|BRDA):/ && $2 > end { next }
    /^DA:/ { lines++ }
    /^BRDA:/ { branches++ }
    /^DA:/ && $3 + 0 == 0 { bare++; text = "no test comes here" }
    /^BRDA:/ && $5 + 0 == 0 { untaken++; text = "condition " $3 + 1 " is never " ($4 % 2 ? "false" : "true") }
    /^(DA|BRDA):/ && $NF + 0 == 0 {
        code = source[$2]; sub(/^ */, "", code)
        print file ":" $2 ": " text ": " code > missed
    }
    END {
        printf "lines: %d of %d, %.1f %%\n", lines - bare, lines, 100 - 100 * bare / lines
        printf "branches: %d of %d, %.1f %%\n", branches - untaken, branches, 100 - 100 * untaken / branches
    }
' "$out/lcov" >"$out/figures"
sort -t: -k1,1 -k2,2n "$out/missed"
cat "$out/figures"
