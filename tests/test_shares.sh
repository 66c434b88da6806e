#!/bin/sh
# The share of the mesh that a run tells, against the difference to a mesh of 96 segments: within 1/2 and
# 2, of coarse blades, too. What was not asked for is not estimated. test_shares.sh BOUGH SOURCE
set -e
bough=$1 source=$2
out=$(mktemp -d)
trap 'rm -rf "$out"' EXIT
run() { # segments, folder, more settings
    n=$1 folder=$2
    shift 2
    "$bough" run "$source/apps/turbine/runup.yaml" --quiet --threads 1 --out "$out/$folder" \
        --set "simulation.duration=4 s" --set "bodies[3].rod.segments=$n" \
        --set "bodies[4].rod.segments=$n" --set "bodies[5].rod.segments=$n" "$@" >"$out/$folder.log"
}
run 96 fine
grep -q '^mesh error: not estimated' "$out/fine.log"
for n in 12 24; do
    run $n coarse --set simulation.error_shares=true
    grep -q '^OoPDefl1_air_error: ' "$out/coarse.log"
    told=$(sed -n 's/^OoPDefl1_mesh_error: \([^ ]*\) m$/\1/p' "$out/coarse.log")
    paste "$out/coarse/channels.out" "$out/fine/channels.out" |
        awk -v told="$told" -v segments="$n" '
            $1 == "Time" { for (i = 1; i <= NF; i++) if ($i == "OoPDefl1") column[++n] = i }
            $1 ~ /^[0-9]/ && n == 2 {
                error = $column[1] - $column[2]
                if (error < 0) error = -error
                if (error > largest) largest = error
            }
            END {
                print segments " segments: told " told " m, found " largest " m"
                exit !(told > largest / 2 && told < 2 * largest)
            }'
done
