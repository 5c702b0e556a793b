#!/usr/bin/env bash
# The public interface against docs/api.txt, where each change of it shows in review.
#
# usage: scripts/api.sh [--store]
#
# Needs a nightly toolchain and cargo-public-api (cargo install cargo-public-api). Nothing is published yet, so there is
# no version that cargo-semver-checks could compare with; from the first one on: cargo semver-checks.
set -euo pipefail
cd "$(dirname "$0")/.."
stored=docs/api.txt
command -v cargo-public-api >/dev/null || { echo 'cargo-public-api is missing: cargo install cargo-public-api' >&2 && exit 2; }
list() { cargo +nightly public-api --omit blanket-impls,auto-trait-impls,auto-derived-impls 2>/dev/null; }
case ${1:-} in
    --store) list >"$stored" ;;
    '') list | diff "$stored" - || {
        echo "the public interface is not that of $stored; where it has to change: scripts/api.sh --store" >&2
        exit 1
    } ;;
    *)
        sed -n '4s/^# //p' "$0" >&2
        exit 2
        ;;
esac
