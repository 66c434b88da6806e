#!/bin/sh
# The mesh error that bough static states, within 1/3 and 3 of the error found: the difference to 384 segments, of tips
# and root moments of single rods and of channels of a whole turbine. A modal body's is not estimated.
# test_static_shares.sh BOUGH SOURCE
set -e
bough=$1 source=$2
out=$(mktemp -d)
trap 'rm -rf "$out"' EXIT
check() { # what, estimate, value, value of the fine mesh (three numbers each, or one)
    echo "$1: $2: $3: $4" | awk -F ': ' -v exact=1e-7 '{
        n = split($3, a, " ")
        split($4, b, " ")
        for (i = 1; i <= n; i++) { sum += (a[i] - b[i]) ^ 2; size += b[i] ^ 2 }
        print $1 ": estimate " $2 ", found " sqrt(sum)
        if ($2 < exact * sqrt(size) && sqrt(sum) < exact * sqrt(size)) exit 0 # as the moment of the weight
        exit !($2 > sqrt(sum) / 3 && $2 < 3 * sqrt(sum))
    }'
}
tip() { tail -n 1 "$out/$1/static.csv" | cut -d, -f3-5 | tr , ' '; }
moment() { sed -n 's/^root .* moment \(.*\) N m$/\1/p' "$out/$1.log"; }
estimate() { sed -n "s/^mesh error .*$2 \([^ ]*\) $3.*/\1/p" "$out/$1.log"; }
rod() { # name, scene, checks the moment, too?, settings
    name=$1 scene=$2 full=$3
    shift 3
    for n in 384 12 48; do
        "$bough" static "$source/apps/beams/$scene.yaml" --out "$out/$n" --set "bodies[0].rod.segments=$n" "$@" >"$out/$n.log"
        [ "$n" = 384 ] && continue
        check "$name, tip, $n" "$(estimate "$n" u m,)" "$(tip "$n")" "$(tip 384)"
        [ "$full" = no ] || check "$name, moment, $n" "$(estimate "$n" moment 'N m')" "$(moment "$n")" "$(moment 384)"
    done
}
rod 'blade, tip force' blade yes --set 'loads[0].force=[50 kN, 0, 0]'
rod 'blade, weight' blade yes --set 'gravity=[9.80665, 0, 0]'
rod 'blade, line' blade no --set 'loads=[{body: blade, along: [20 m, 45 m], force: [2000, 500, 0], moment: [0, 0, 1000]}]'
rod 'blade, follower' blade yes --set 'loads=[{body: blade, along: [0 m, 61.5 m], frame: follower, force: [2000, 500, 0]}]'
rod arc arc yes
rod princeton princeton no
rod short short no
whole() { sed -n "s/^$2,[^,]*,\([^,]*\),\(.*\)/\\$3/p" "$out/$1/static-channels.csv"; }
for n in 384 12 24; do
    "$bough" static "$source/apps/turbine/land.yaml" --out "$out/land$n" --set "bodies[4-6].rod.segments=$n" \
        --set "bodies[0].rod.segments=$n" >"$out/land$n.log"
    for channel in OoPDefl1 TwstDefl2 RootMyb3 RootFzb1 TwrBsMyt; do
        [ "$n" = 384 ] || check "land, $channel, $n" "$(whole "land$n" $channel 2)" "$(whole "land$n" $channel 1)" \
            "$(whole land384 $channel 1)"
    done
done
"$bough" static "$source/apps/beams/blade.yaml" --out "$out/modal" --set bodies[0].fidelity=modal >"$out/modal.log"
grep -q '^mesh error: not estimated: blade is a modal body' "$out/modal.log"
# A four-bar that can rest in two positions, in several directions: the mesh's error is that of the position found.
for turn in 'y -72.6 deg, rotate x 83.1 deg, rotate z -2.2 deg' 'z 1 deg' 'x 60 deg, rotate z 40 deg'; do
    sed -e 's/: ground/: base/g' -e 's/speed: 2 rad.s//' -e "s/^bodies:/&\n  - {name: base, fidelity: rigid, mass: 1, \
joint: {kind: fixed, parent: ground, placement: [rotate $turn]}}/" "$source/tests/data/scenes/closed.yaml" >"$out/closed.yaml"
    for n in 4 8 16; do
        "$bough" static "$out/closed.yaml" --out "$out/closed" --set "bodies[arm].rod.segments=$n" >"$out/closed.log"
        awk '/^crankPos:/ { sub(",", "", $2); print; known = $NF < 1e-4 } END { exit !known }' "$out/closed.log"
    done
done
