#!/bin/sh
# coverage.sh BUILD: lines that the tests ran since BUILD was built by the preset `coverage`, for each folder, then
# for each file of core, flexbody, aero and cosim below 85 %. Of a kernel, which is compiled for each level of the
# instruction set, the level that ran most counts.
set -eu
cd "$1"
find . -path '*/CMakeFiles/bough_*.dir/*' -name '*.c.gcno' ! -path './tests/*' ! -path '*/bough_fmu.dir/*' |
    sort | while read -r notes; do
    gcov -n "$notes" 2> /dev/null | awk -v file="${notes#*.dir/}" '
        BEGIN { sub(/\.gcno$/, "", file) }
        /^File/ { own = index($0, "/" file "\x27") > 0 }
        /^Lines executed/ && own { split($0, part, /[:% ]+/); print file, part[3], part[5]; exit }'
done | awk '
    !($1 in of) || $2 > percent[$1] { percent[$1] = $2; of[$1] = $3 }
    END { for (file in of) print file, percent[file], of[file] }' | sort | awk '
    { folder = $1; sub(/\/[^\/]*$/, "", folder); lines[folder] += $3; ran[folder] += $2 * $3 / 100 }
    { all += $3; hit += $2 * $3 / 100 }
    $2 < 85 && $1 !~ /^apps/ { low[++n] = sprintf("%-45s %6d %7.1f %%\n", $1, $3, $2) }
    END {
        for (folder in lines) {
            printf "%-45s %6d %7.1f %%\n", folder, lines[folder], 100 * ran[folder] / lines[folder] | "sort"
        }
        close("sort")
        printf "%-45s %6d %7.1f %%\n", "all", all, 100 * hit / all
        for (i = 1; i <= n; i++) printf "%s", low[i]
    }'
