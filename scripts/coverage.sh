#!/usr/bin/env bash
# Lines and branches of the library that the tests reach, and the lines that they do not.
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
ignored=(--ignore-filename-regex '(tests/|src/bin/|oracle\.rs)')
cargo +nightly llvm-cov --branch --no-report "$@"
cargo +nightly llvm-cov report --branch "${ignored[@]}" --summary-only
cargo +nightly llvm-cov report --branch "${ignored[@]}" --lcov --output-path "$out/lcov"
echo
echo 'lines without a test:'
awk -F '[:,]' -v root="$PWD/" '
    /^SF:/ { file = substr($0, 4); sub(root, "", file) }
    /^DA:/ && $3 == 0 { lines[file] = lines[file] " " $2 }
    END { for (file in lines) print file ":" lines[file] }
' "$out/lcov" | sort
