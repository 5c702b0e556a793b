#!/bin/sh
# The gate on instruction counts: fails where a solve takes more instructions than benches/instructions.txt allows.
#
# usage: benches/instructions.sh            compares
#        benches/instructions.sh --store    counts the same solves anew and stores them
#
# Counts are of one compiler for one kind of processor: with another nothing is compared, and that is said.
set -eu
cd "$(dirname "$0")"
stored=instructions.txt
# Per cent more than stored.
allowed=3
said=$(rustc -vV)
compiler="rustc $(echo "$said" | sed -n 's/^release: //p') $(echo "$said" | sed -n 's/^host: //p')"

case ${1:-} in
    '') ;;
    --store)
        new=$(mktemp)
        trap 'rm -f "$new"' EXIT
        {
            sed -n '/^#/p' $stored
            echo "compiler $compiler"
            sed -n '/^#/d; /^compiler/d; p' $stored | while read -r scene elements _; do
                counted=$(./count.sh "$scene" "$elements")
                echo "$scene $elements ${counted%% *}"
            done
        } >"$new"
        cat "$new" >$stored
        cat $stored
        exit
        ;;
    *)
        echo 'usage: benches/instructions.sh [--store]' >&2
        exit 2
        ;;
esac

of=$(sed -n 's/^compiler //p' $stored)
if [ "$of" != "$compiler" ]; then
    echo "NOT COMPARED: benches/$stored has the counts of $of, this is $compiler." >&2
    echo 'With this compiler on the commit before, store counts to compare with: benches/instructions.sh --store' >&2
    exit 0
fi

echo '| scene | elements | instructions per solve | stored | change |'
echo '|---|--:|--:|--:|--:|'
more=0
while read -r scene elements before; do
    case $scene in '#'* | compiler | '') continue ;; esac
    counted=$(./count.sh "$scene" "$elements")
    now=${counted%% *}
    change=$(awk "BEGIN { printf \"%+.1f %%\", 100 * ($now / $before - 1) }")
    echo "| $scene | $elements | $now | $before | $change |"
    [ $((now * 100)) -le $((before * (100 + allowed))) ] || more=$((more + 1))
done <$stored
if [ $more -gt 0 ]; then
    echo "$more of the solves above take over $allowed % more instructions than stored in benches/$stored." >&2
    echo 'If they have to: benches/instructions.sh --store, and say in the commit what they buy.' >&2
    exit 1
fi
