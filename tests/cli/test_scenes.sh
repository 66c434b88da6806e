#!/bin/bash
# Every scene that is shipped runs for a second or, where its steps are short, a while:
# test_scenes.sh BOUGH SOURCE. Under the sanitizers a report ends the program with another code.
set -u
bough=$1
cd "$2" || exit 1
scratch=$(mktemp -d)
trap 'rm -rf "$scratch"' EXIT
export OPENBLAS_NUM_THREADS=1 UBSAN_OPTIONS=print_stacktrace=1

declare -A duration=(
    [apps/beams/elastica.yaml]='20 ms' [apps/beams/short.yaml]='20 ms'
    [apps/beams/follower.yaml]='50 ms' [apps/beams/helix.yaml]='50 ms'
    [apps/beams/roll-up.yaml]='0.2 s' [apps/beams/rubber-bar.yaml]='0.3 s'
    [apps/beams/composite-box.yaml]='0.1 s' [apps/mechanisms/squeezer.yaml]='30 ms'
)
failures=0 scenes=0

# try WORD...: the program's arguments
try() {
    "$bough" "$@" --out "$scratch/out" >"$scratch/log" 2>&1 && return
    echo "FAILED: exit code $?: bough $*"
    head -n 40 "$scratch/log"
    failures=$((failures + 1))
}

for scene in apps/*/*.yaml; do
    grep -qE '^(base|bodies|turbine):' "$scene" || continue
    scenes=$((scenes + 1))
    case $scene in
    # Their loads begin at once on the straight beam, whose steps are then microseconds.
    apps/beams/heavy.yaml | apps/beams/princeton.yaml) try static "$scene" ;;
    *) try run "$scene" --quiet --threads 1 --set "simulation.duration=${duration[$scene]:-1 s}" ;;
    esac
done
[ $scenes -ge 30 ] || { echo "FAILED: few scenes were found, $scenes"; failures=1; }
[ $failures -eq 0 ]
