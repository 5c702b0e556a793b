#!/usr/bin/env bash
# Flash that a solve takes on a Cortex-M4, per kind of scene, precision and optimisation level: an image with nothing
# else in it, code and constants. `run.sh` tells and installs what is needed.
set -euo pipefail
cd "$(dirname "$0")"
target=${CARGO_TARGET_DIR:-$PWD/target}/flash
triple=thumbv7em-none-eabihf
cargo=(cargo rustc)
if [ ! -d "$(rustc --print sysroot)/lib/rustlib/$triple/lib" ]; then
    cargo=(env RUSTC=/usr/bin/rustc RUSTC_BOOTSTRAP=1 /usr/bin/cargo rustc -Zbuild-std=core)
fi
echo '| entry | level s | level 3 |'
echo '|---|--:|--:|'
for level in s 3; do
    rm -rf "$target/$level/$triple/release/deps"
    RUSTFLAGS='-Clinker=ld.lld -Clinker-flavor=ld.lld' CARGO_TARGET_DIR=$target/$level \
        CARGO_PROFILE_RELEASE_CODEGEN_UNITS=1 CARGO_PROFILE_RELEASE_OPT_LEVEL=$level \
        "${cargo[@]}" --quiet --release --target "$triple" --features silent --bin silent -- --emit=obj,link
done
for entry in {bending,pressed,control,electric}_{f32,f64}; do
    line="| \`$entry\`"
    for level in s 3; do
        deps=$target/$level/$triple/release/deps
        ld.lld --gc-sections --entry="$entry" "$deps"/silent-*.o --start-group "$deps"/*.rlib --end-group \
            -o "$target/image"
        line+=" | $(size "$target/image" | awk 'NR == 2 { print $1 + $2 }')"
    done
    echo "$line |"
done
