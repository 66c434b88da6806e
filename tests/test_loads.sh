#!/bin/sh
# Wind by name and load sets as a user meets them: test_loads.sh PROGRAM SOURCE_FOLDER
set -u
bough=$1 source=$2
power=$source/apps/turbine/power.yaml
failures=0
scratch=$(mktemp -d)
trap 'rm -rf "$scratch"' EXIT
cd "$scratch" || exit 1

fail() {
    echo "FAILED: $*"
    failures=$((failures + 1))
}

# A run of 2 s in that wind, into the folder.
blow() {
    to=$1 wind=$2
    shift 2
    "$bough" run "$power" --set "aero.wind=$wind" --set simulation.duration="2 s" --out "$to" --quiet "$@" \
        >log 2>&1 || fail "run in $wind: $(cat log)"
}

# -- wind by name ----------------------------------------------------------------------------------

ntm="{kind: iec, condition: ntm, speed: 12, reference_height: 90, points: 9, time_step: 0.1}"
"$bough" wind "$power" --set "aero.wind=$ntm" --out written >log || fail "bough wind: $(cat log)"
blow named "$ntm"
blow threads "$ntm" --threads 2
blow file "{kind: bts, file: $scratch/written/wind.bts}"
cmp named/channels.out file/channels.out || fail "a box that is written gives another run"
cmp named/channels.out threads/channels.out || fail "threads change the turbulence"
grep -q Wind1VelX named/channels.out || fail "no channel of the wind"
"$bough" wind "$power" --out none 2>log && fail "steady wind was written"
grep -q 'no turbulent wind' log || fail "steady wind: $(cat log)"
for bad in "{kind: iec, condition: ntm, reference_height: 90}" \
    "{kind: iec, condition: ewm, speed: 50, reference_height: 90}" \
    "{kind: iec, condition: gust, speed: 9, reference_height: 90}"; do
    "$bough" check "$power" --set "aero.wind=$bad" >log 2>&1
    [ $? -eq 2 ] || fail "$bad is not refused: $(cat log)"
done

[ "$failures" -eq 0 ]
