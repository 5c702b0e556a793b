#!/usr/bin/env bash
# A campaign: each target for so many seconds, or for so many executions.
#
#     scripts/fuzz.sh SECONDS [TARGET..]
#     scripts/fuzz.sh runs [TARGET=EXECUTIONS..]      (scripts/fuzz.sh runs: 1e8 in all)
#
# FUZZ_JOBS=2 runs two targets side by side. Needs a nightly compiler and cargo-fuzz (`cargo install cargo-fuzz`). Prints a
# table: executions, seconds on the clock and of the processor, findings. A finding does not end a target: all are
# in fuzz/artifacts/TARGET; once mended one goes to fuzz/seeds/TARGET, where every replay runs it.
set -euo pipefail

if [ $# -lt 1 ]; then
    sed -n '2,9s/^# \{0,1\}//p' "$0"
    exit 2
fi
cd "$(dirname "$0")/../fuzz"
limit=$1
shift
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT

case $limit in
    runs) [ $# -gt 0 ] || set -- differential=5e5 scene=4e6 units=4e6 recursion=1.6e7 roots=4e7 scene_file=4e7 ;;
    *) [ $# -gt 0 ] || set -- differential scene units recursion roots scene_file ;;
esac

# Comparisons of numbers and counts of loops lead nowhere here; to keep them is half the time.
built=(-s none -O --no-trace-compares)
target_of() { printf '%s' "${1%%=*}"; }
for asked in "$@"; do
    cargo +nightly fuzz build "${built[@]}" "$(target_of "$asked")" || exit
done

# What one run of the fuzzer, on $2, says of the target $1: executions, and whether it ended well.
once() {
    local target=$1
    shift
    # Scenes and chains are spelt by some hundred bytes, files by some thousand.
    local flags=(-max_len=512)
    [ "$target" != scene_file ] || flags=(-max_len=8192 -dict=scene_file.dict)
    cargo +nightly fuzz run "${built[@]}" "$target" "corpus/$target" "seeds/$target" -- "${flags[@]}" "$@" \
        -len_control=0 -entropic=0 -use_counters=0 -timeout=20 -rss_limit_mb=2048 -print_final_stats=1 \
        >"$work/$target.log" 2>&1
}

# The target until its seconds or executions are over: a finding is counted, and the rest is done by another run. One
# row of the table.
campaign() {
    local target seconds=0 runs=0 done=0 found=0 start=$EPOCHREALTIME
    target=$(target_of "$1")
    mkdir -p "corpus/$target"
    if [ "$limit" = runs ]; then runs=$(awk "BEGIN { printf \"%d\", ${1#*=} }"); else seconds=$limit; fi
    while :; do
        local left=() now good=1
        now=$(awk "BEGIN { printf \"%d\", $EPOCHREALTIME - $start }")
        if [ "$limit" = runs ]; then
            [ "$done" -lt "$runs" ] || break
            left=(-runs=$((runs - done)))
        else
            [ "$now" -lt "$seconds" ] || break
            left=(-max_total_time=$((seconds - now)))
        fi
        once "$target" "${left[@]}" || good=0
        local executed
        executed=$(sed -n 's/^stat::number_of_executed_units: *//p' "$work/$target.log")
        done=$((done + ${executed:-0}))
        if [ $good = 0 ]; then
            found=$((found + 1))
            tail -n 40 "$work/$target.log" >&2
        fi
        # What fails on its seeds, or does not start, would not end.
        [ "$found" -lt 20 ] && [ "${executed:-0}" -gt 0 ] || break
    done
    local clock processor
    clock=$(awk "BEGIN { printf \"%.0f\", $EPOCHREALTIME - $start }")
    # User and system time of all that this shell waited for, as 0m1.2s 0m3.4s in the second line.
    times >"$work/$target.times"
    processor=$(awk -F '[ms ]+' 'NR == 2 { printf "%.0f", 60 * ($1 + $3) + $2 + $4 }' "$work/$target.times")
    printf '| `%s` | %s | %s | %s | %s |\n' "$target" "$done" "$clock" "$processor" "$found" >"$work/$target.row"
    cat "$work/$target.row" >&2
}

for asked in "$@"; do
    while [ "$(jobs -rp | wc -l)" -ge "${FUZZ_JOBS:-1}" ]; do wait -n || true; done
    (campaign "$asked") &
done
wait

printf '\n| target | executions | seconds | processor | findings |\n|---|--:|--:|--:|--:|\n'
failed=0
for asked in "$@"; do
    row="$work/$(target_of "$asked").row"
    [ -s "$row" ] || { echo "no row of $asked" >&2 && failed=1 && continue; }
    cat "$row"
    grep -q '| 0 |$' "$row" || failed=1
done
exit "$failed"
