#!/bin/sh
# What a scene lacks costs nothing: instructions of a solve from nothing, for scenes with more and more in them.
#
# usage: benches/left_out.sh [elements]
set -eu
elements=${1:-1000}
echo '| scene | instructions per solve | element visits | instructions per visit | bytes per element |'
echo '|---|--:|--:|--:|--:|'
for scene in bending contact stretching full; do
    case $scene in
        bending) name='bending only' ;;
        contact) name='+ contact' ;;
        stretching) name='+ stretching' ;;
        full) name='full: + potential, piezoelectricity, conduction' ;;
    esac
    counted=$("$(dirname "$0")/count.sh" "$scene" "$elements")
    # Instructions, visits, bytes.
    set -- $counted
    echo "| $name | $1 | $2 | $(($1 / $2)) | $3 |"
done
