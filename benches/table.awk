# A table of criterion's median times, in microseconds: benchmark groups down, their members across.
#
# usage: cargo bench --bench solve -- <filter> | awk -f benches/table.awk
BEGIN { us["ns"] = 1e-3; us["µs"] = us["us"] = 1; us["ms"] = 1e3; us["s"] = 1e6 }
# Not the comparison with an earlier run, which is in per cent.
/time:/ && !/%/ {
    # name, "time:", "[", low, median, high; a long name stands in the line before.
    sub(/ *time: */, "/ ")
    name = $0; sub(/\/ \[.*/, "", name); if (name == "") name = before
    sub(/.*\[/, ""); sub(/\]/, "")
    member = name; sub(/.*\//, "", member)
    group = name; sub(/\/[^\/]*$/, "", group)
    if (!(group in seen)) { seen[group]; groups[++rows] = group }
    if (!(member in known)) { known[member]; members[++columns] = member }
    time[group, member] = $3 * us[$4]
}
{ before = $0 }
END {
    printf "| us |"; for (j = 1; j <= columns; j++) printf " %s |", members[j]
    printf "\n|---|"; for (j = 1; j <= columns; j++) printf "--:|"
    for (i = 1; i <= rows; i++) {
        printf "\n| %s |", groups[i]
        for (j = 1; j <= columns; j++) {
            t = time[groups[i], members[j]]
            printf " %.*f |", t < 10 ? 2 : t < 100 ? 1 : 0, t
        }
    }
    print ""
}
