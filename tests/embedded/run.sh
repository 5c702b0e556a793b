#!/usr/bin/env bash
# The same bits everywhere: builds the scenes of `src` for boards, WebAssembly and this machine, runs them in
# emulators and compares what they print. Each target is compiled at another optimisation level.
#
# usage: tests/embedded/run.sh [all]
#
# `all` adds all levels on this machine and AArch64, and prints what the standard library's pow, ln and expm1 change.
# What is missing is installed by apt-get, where that can be: an emulator and, unless rustup has the targets, Debian's
# Rust, which brings the sources of `core`.
set -euo pipefail
cd "$(dirname "$0")"
which=${1:-few}
target=${CARGO_TARGET_DIR:-$PWD/target}
out=$(mktemp -d)
trap 'rm -rf "$out"' EXIT

# Is the program there, or can the package be installed?
need() {
    command -v "$1" >/dev/null || [ -e "$1" ] || missing+=("$2")
}
missing=()
need qemu-system-arm qemu-system-arm
need qemu-system-riscv32 qemu-system-misc
need node nodejs
need ld.lld lld
has_target() { [ -d "$(rustc --print sysroot)/lib/rustlib/$1/lib" ]; }
triples=(thumbv7em-none-eabihf riscv32imac-unknown-none-elf wasm32-unknown-unknown thumbv6m-none-eabi)
[ "$which" != all ] || triples+=(aarch64-unknown-none)
for triple in "${triples[@]}"; do
    has_target "$triple" && continue
    need /usr/bin/rustc rustc-web
    need /usr/bin/cargo cargo-web
    need /usr/lib/rustlib/src/rust/library/core rust-web-src
    break
done
if [ ${#missing[@]} -gt 0 ]; then
    sudo=''
    [ "$(id -u)" = 0 ] || sudo=sudo
    $sudo apt-get update -qq
    $sudo env DEBIAN_FRONTEND=noninteractive apt-get install -y -qq --no-install-recommends "${missing[@]}" >/dev/null
fi

lld='-Clinker=ld.lld -Clinker-flavor=ld.lld'
# build <level> <triple> <program> <linker> [its arguments]: with rustup's target, or `core` from Debian's sources.
build() {
    local level=$1 triple=$2 program=$3 flags=$4
    shift 4
    for argument; do flags+=" -Clink-arg=$argument"; done
    local cargo=(cargo build --quiet)
    if ! has_target "$triple"; then
        cargo=(env RUSTC=/usr/bin/rustc RUSTC_BOOTSTRAP=1 /usr/bin/cargo build --quiet -Zbuild-std=core)
    fi
    RUSTFLAGS=$flags CARGO_PROFILE_RELEASE_OPT_LEVEL=$level \
        CARGO_TARGET_DIR=$target/bare "${cargo[@]}" --release --target "$triple" --features "$program" \
        --bin "$program"
    image=$target/bare/$triple/release/$program
}

# board <level> <triple> <address of code> <address of data> <emulator> [arguments]
board() {
    local level=$1 triple=$2 rom=$3 ram=$4
    shift 4
    build "$level" "$triple" board "$lld" -Tboard.ld --gc-sections --defsym=rom="$rom" --defsym=ram="$ram"
    timeout 600 "$@" -icount shift=0 -nographic -semihosting-config enable=on,target=native -kernel "$image" \
        >"$out/said"
    # The table of costs, and what has to be the same.
    sed -n 's/^# //p' "$out/said"
    sed -i '/^# /d' "$out/said"
    same "$triple, level $level"
}

# silent <level> <triple>: what has too little memory for all scenes is linked, searched for what a panic needs, and weighed.
silent() {
    CARGO_PROFILE_RELEASE_CODEGEN_UNITS=1 build "$1" "$2" silent "$lld" --gc-sections
    nm "$image" | grep 'piezobeam' >/dev/null || {
        echo "$2: no solve in $image" >&2
        exit 1
    }
    if nm "$image" | grep -E 'panicking|_fail|rust_begin_unwind' >&2; then
        echo "$2, level $1: this can panic" >&2
        exit 1
    fi
    echo "$2, level $1: links, nothing can panic, $(size "$image" | awk 'NR == 2 { print $1 + $2 }') bytes of all kinds of solves"
}

same() {
    diff "$out/want" "$out/said" >"$out/diff" || {
        echo "$1: other bits than on this machine" >&2
        cat "$out/diff" >&2
        exit 1
    }
    echo "$1: the same bits"
}

# host <level> [arguments of cargo]
host() {
    local level=$1
    shift
    CARGO_PROFILE_RELEASE_OPT_LEVEL=$level CARGO_TARGET_DIR=$target cargo build --quiet --release --bin host "$@"
    "$target/release/host" >"$out/said"
}

host 3
cp "$out/said" "$out/want"
tail -n 1 "$out/want"
board 3 thumbv7em-none-eabihf 0 0x20000000 qemu-system-arm -M mps2-an386 -cpu cortex-m4
board s riscv32imac-unknown-none-elf 0x80000000 0x80000000 qemu-system-riscv32 -M virt -bios none
build z wasm32-unknown-unknown page "-Clinker=wasm-ld" --no-entry --export=run
node page.mjs "$image.wasm" >"$out/said"
same 'wasm32-unknown-unknown, level z'
silent s thumbv6m-none-eabi
if [ "$which" = all ]; then
    for level in 0 1 2 s z; do
        host "$level"
        same "this machine, level $level"
    done
    board 1 aarch64-unknown-none 0x40080000 0x40080000 qemu-system-aarch64 -M virt -cpu cortex-a53 -nic none
    host 3 --no-default-features --features std
    echo 'other bits with pow, ln and expm1 of the standard library:'
    diff "$out/want" "$out/said" | grep '^>' || true
else
    host 0
    same 'this machine, level 0'
fi
