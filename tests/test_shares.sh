#!/bin/sh
# The shares of mesh and air that a run tells, within 1/2 and 2 of what is found: the difference to a mesh of
# 96 segments, of coarse blades, too, and of two runs with short steps, the air at 50 and 400 Hz. What was not asked
# for is not estimated; what exceeds the bound ends the run. A tower with an arm, a closed loop with a bending arm, a tower in two parts: within 1/3 and 3 of the
# difference to 48 segments. test_shares.sh BOUGH SOURCE
set -e
bough=$1 source=$2
out=$(mktemp -d)
trap 'rm -rf "$out"' EXIT
run() { # segments, folder, more settings
    n=$1 folder=$2
    shift 2
    "$bough" run "$source/apps/turbine/runup.yaml" --quiet --threads 1 --out "$out/$folder" \
        --set "simulation.duration=4 s" --set "bodies[3-5].rod.segments=$n" "$@" >"$out/$folder.log"
}
compare() { # share, folder of the run that tells it, two folders whose difference is it
    told=$(sed -n "s/^OoPDefl1_$1_error: \([^ ]*\) m\$/\1/p" "$out/$2.log")
    paste "$out/$3/channels.out" "$out/$4/channels.out" |
        awk -v told="$told" -v what="$1 of $2" '
            $1 == "Time" { for (i = 1; i <= NF; i++) if ($i == "OoPDefl1") column[++n] = i }
            $1 ~ /^[0-9]/ && n == 2 {
                error = $column[1] - $column[2]
                if (error < 0) error = -error
                if (error > largest) largest = error
            }
            END {
                print what ": told " told " m, found " largest " m"
                exit !(told > largest / 2 && told < 2 * largest)
            }'
}
run 96 fine
grep -q '^mesh error: not estimated' "$out/fine.log"
for n in 12 24; do
    run $n $n --set simulation.error_shares=true
    compare mesh $n $n fine
done
for rate in 50 400; do
    run 24 $rate --set "aero.rate=$rate Hz" --set "simulation.macro_step=$((1000000 / rate)) us" \
        --set 'simulation.coupling.scheme=monolithic' --set 'simulation.master.rtol=1e-6' \
        --set 'simulation.output.interval=20 ms' --set 'simulation.error_estimate=none'
done
compare air 24 50 400

family() { # scene, its rods, channel
    for n in 12 48; do
        "$bough" run "$source/tests/scenes/$1.yaml" --quiet --threads 1 --out "$out/$1$n" \
            --set "bodies[$2].rod.segments=$n" --set simulation.master.rtol=1e-8 --set simulation.micro.rtol=1e-8 \
            --set "simulation.error_shares=$([ $n = 12 ] && echo true || echo false)" >"$out/$1$n.log"
    done
    told=$(sed -n "s/^$3_mesh_error: \([^ ]*\) .*/\1/p" "$out/${1}12.log")
    paste "$out/${1}12/channels.out" "$out/${1}48/channels.out" | awk -v told="$told" -v what="$1" -v name="$3" '
        $1 == "Time" { for (i = 1; i <= NF; i++) if ($i == name) column[++n] = i }
        $1 ~ /^[0-9]/ && n == 2 {
            error = $column[1] - $column[2]
            if (error < 0) error = -error
            if (error > largest) largest = error
        }
        END {
            print what ": told " told ", found " largest
            exit !(told > largest / 3 && told < 3 * largest)
        }'
}
family tower 0 mastTipX
family closed 3 crankPos
family tower-in-parts 0-1 lowerTipX

# What is told decides: a noticeable mesh error warns, one above the bound ends with exit code 3. The finer
# mesh need not suit the scene's coupling.
free() { # bound, folder, exit code
    code=0
    "$bough" run "$source/tests/scenes/free-rod.yaml" --quiet --out "$out/$2" --set simulation.error_shares=true \
        --set "simulation.error_bound=$1" >"$out/$2.log" 2>&1 || code=$?
    [ $code -eq "$3" ] || { echo "free rod, bound $1: exit code $code"; exit 1; }
}
free 0.1 warned 0
grep -q '^warning: barOmegaX errs by .*; cause: the mesh; try rod.segments, 2.[12] times as many' "$out/warned.log"
grep -q '"warning": "barOmegaX errs' "$out/warned/summary.json"
free 0.02 ended 3
grep -q 'the error bound 0.02 is exceeded: .*; cause: the mesh' "$out/ended.log"
grep -q '"status": "failed"' "$out/ended/summary.json"
