#!/usr/bin/env bash
# A campaign: each target for so many seconds, one after the other on one core.
#
#     scripts/fuzz.sh SECONDS [TARGET..]
#
# Needs a nightly compiler and cargo-fuzz (`cargo install cargo-fuzz`). What is found lies in fuzz/artifacts/TARGET; once
# mended it goes to fuzz/seeds/TARGET, where every replay runs it.
set -euo pipefail

if [ $# -lt 1 ]; then
    sed -n '2,7s/^# \{0,1\}//p' "$0"
    exit 2
fi
cd "$(dirname "$0")/../fuzz"
seconds=$1
shift
targets=("$@")
[ $# -gt 0 ] || targets=(differential recursion roots scene scene_file)

failed=0
for target in "${targets[@]}"; do
    mkdir -p "corpus/$target"
    # Scenes and chains are spelt by some hundred bytes, files by some thousand.
    case $target in
        scene_file) flags=(-max_len=8192 -dict=scene_file.dict) ;;
        *) flags=(-max_len=512) ;;
    esac
    printf '\n== %s, %s s\n' "$target" "$seconds"
    log=$(mktemp)
    # Comparisons of numbers and counts of loops lead nowhere here; to keep them is half the time.
    if cargo +nightly fuzz run -s none -O --no-trace-compares "$target" "corpus/$target" "seeds/$target" -- \
        "${flags[@]}" -max_total_time="$seconds" -len_control=0 -entropic=0 -use_counters=0 -timeout=20 \
        -rss_limit_mb=2048 -print_final_stats=1 >"$log" 2>&1; then
        found=nothing
    else
        found='a failure'
        failed=1
        tail -n 40 "$log"
    fi
    printf '%s: %s executions, found %s\n' "$target" \
        "$(sed -n 's/^stat::number_of_executed_units: *//p' "$log")" "$found"
    rm -f "$log"
done
exit "$failed"
