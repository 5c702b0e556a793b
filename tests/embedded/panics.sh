#!/usr/bin/env bash
# No panic in a solve: links solves and nothing else into an image and looks for what a panic would need. What the
# compiler proves away does not get there; nothing is linked dynamically that could hide one.
#
# usage: tests/embedded/panics.sh [level ...]
#
# Levels are those of the optimiser, all but 0 if none is given. For the machine that builds (x86-64 or AArch64, Linux).
set -euo pipefail
cd "$(dirname "$0")"
[ $# -gt 0 ] || set -- 1 2 3 s z
target=${CARGO_TARGET_DIR:-$PWD/target}
host=$(rustc -vV | sed -n 's/host: //p')
image=$target/$host/release/silent
# There is no C runtime, and nothing that unwinds: `core` asks for the personality only where it is linked.
flags='-Crelocation-model=static -Clink-arg=-no-pie -Clink-arg=-nostartfiles -Clink-arg=-lc'
flags+=' -Clink-arg=-Wl,--gc-sections -Clink-arg=-Wl,--defsym=rust_eh_personality=0'
root=$(cd ../.. && pwd)
# What panics, or calls it.
panics='core::panicking::[a-z_:]+|core::[a-z:_]+_fail(ed)?|arrayvec::.*_panic|.*rust_begin_unwind'
bad=0
for level; do
    RUSTFLAGS=$flags CARGO_TARGET_DIR=$target CARGO_PROFILE_RELEASE_OPT_LEVEL=$level \
        CARGO_PROFILE_RELEASE_CODEGEN_UNITS=1 CARGO_PROFILE_RELEASE_DEBUG=line-tables-only \
        cargo build --quiet --release --target "$host" --features silent --bin silent
    # The check itself is checked: the image has solves in it.
    nm --demangle "$image" | grep 'piezobeam::newton' >/dev/null || {
        echo "level $level: no solve in $image" >&2
        exit 1
    }
    found=$(nm --demangle "$image" | grep -E " ($panics)\$" || true)
    if [ -z "$found" ]; then
        echo "level $level: nothing can panic"
        continue
    fi
    bad=1
    echo "level $level: this can panic" >&2
    objdump --disassemble --demangle --no-show-raw-insn "$image" |
        sed -nE "s/^ *([0-9a-f]+):.*(call|jmp|bl|b) .*<($panics)>\$/\1 \3/p" |
        while read -r address what; do
            place=$(addr2line -e "$image" -i "0x$address" | grep -v /rustc/ | grep -m 1 . | sed "s|^$root/||" || true)
            echo "    $what: $place"
        done | sort | uniq -c >&2
done
exit $bad
