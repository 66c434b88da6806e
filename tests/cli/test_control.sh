#!/bin/sh
# Controllers, their events and the wind that they see as a user meets them: test_control.sh PROGRAM SOURCE_FOLDER
set -u
bough=$1
folder=$2
. "$(dirname "$0")/scratch.sh"

# last CHANNEL: its last value in out/.
last() {
    awk -v channel="$1" '/^ *Time/ { for (i = 1; i <= NF; i++) if ($i == channel) at = i } { last = $at } END { print last }' \
        out/channels.out
}

# is CHANNEL VALUE TOLERANCE: the last value of the channel.
is() {
    last "$1" | awk -v want="$2" -v by="$3" '{ exit !($1 - want <= by && want - $1 <= by) }' ||
        fail "$said: $1 is $(last "$1") at the end, not $2"
}

cat >rotor.yaml <<'EOF'
gravity: [0, 0, 0]
simulation: {duration: 20 s, macro_step: 20 ms, error_estimate: none}
turbine:
  blades: 3
  tower_height: 100 m
  overhang: 5 m
  hub_radius: 2 m
  pitch: controlled
  speed: 12 rpm
  hub: {mass: 1000 kg, inertia: [3e7, 2e7, 2e7]}
  nacelle: {mass: 1 t}
  blade:
    fidelity: rigid
    rod: {length: 50 m, segments: 8, stiffness: [1e9, 1e9, 1e10, 1e9, 1e9, 1e9], mass: [1, 0, 0, 1e-3, 1e-3, 0]}
loads: [{joint: hub, torque: 5 MN m}]
control: {kind: variable-speed}
EOF

# Whichever blade of a symmetric rotor has the fault, the others go on.
for blade in 1 2; do
    expect 0 run rotor.yaml --out out --quiet --set "control.events=[{kind: pitch-stuck, blade: $blade, at: 2 s}]"
    is BldPitch$blade 2.5099 1e-3
    is BldPitch$((3 - blade)) 52.376 1e-2
    is BldPitch3 52.376 1e-2
done

# A stop pitches to its angle, whatever its sign.
for angle in -60 0 20 auto; do
    unit=' deg' final=$angle
    [ "$angle" = auto ] && unit='' final=90
    expect 0 run rotor.yaml --out out --quiet --set "control.events=[{kind: emergency-stop, at: 2 s, angle: $angle$unit}]"
    is BldPitch2 "$final" 1e-6
done

# A start takes the torque up at its rate, 15 kN m/s, from rest.
expect 0 run rotor.yaml --out out --quiet --set 'control.events=[{kind: start, at: 1 s}]' --set 'simulation.duration=1.2 s'
is GenTq 3 0.31

# A steady operation above rated wind with rigid blades, whose pitch alone changes the air.
expect 0 run "$folder/apps/turbine/power.yaml" --out out --quiet --set 'bodies[3-5].fidelity=rigid' \
    --set simulation.initial=operation --set aero.ramp=null --set 'aero.wind={kind: uniform, speed: 14 m/s}' \
    --set 'simulation.duration=0.2 s'
is RotSpeed 12.1 0.1

# The error at an emergency stop, whose sudden pitch the air does not expect, is stated within a factor of 3.
stop() {
    out=$1
    shift
    expect 0 run "$folder/apps/turbine/power.yaml" --out "$out" --quiet --set 'bodies[3-5].fidelity=rigid' --set aero.ramp=null \
        --set simulation.initial=operation --set 'simulation.duration=2 s' --set 'simulation.output.interval=20 ms' \
        --set 'control.rate=50' --set 'control.events=[{kind: emergency-stop, at: 1 s}]' "$@"
}
stop out --set simulation.error_estimate=companion
stop fine --set 'simulation.macro_step=2.5 ms' --set 'aero.rate=400 Hz' --set simulation.accuracy=1e-4 --set simulation.coupling=null \
    --set simulation.master=null --set simulation.error_estimate=none
error=$("$bough" diff out fine | awk '$1 == "blade1Trq" { print $2 }')
sed -n 's/^ *"blade1Trq": \([0-9.e+-]*\),*$/\1/p' out/summary.json | head -n 1 |
    awk -v error="$error" '{ found = 1; exit !(3 * $1 > error && error > 0) } END { if (!found) exit 1 }' ||
    fail "$said: blade1Trq errs by $error"

# A wind that veers through north turns the shorter way.
printf '0 10 350 0 0 0 0 0\n1 10 10 0 0 0 0 0\n' >north.wnd
expect 0 run "$folder/tests/data/scenes/example-turbine.yaml" --out out --quiet --set 'simulation.duration=0.5 s' \
    --set "aero.wind={kind: wnd, file: $PWD/north.wnd, reference_height: 20 m, reference_length: 10 m}"
is Wind1VelX 10 1e-3

# The tower's influence on the wind stands where its body does.
for x in 0 500; do
    expect 0 run "$folder/apps/turbine/land.yaml" --out out --quiet --set "bodies[tower].joint.placement=[move x $x m]" \
        --set aero.tower.body=tower --set 'simulation.duration=0.1 s' --set simulation.error_estimate=none
    is RtVAvgxh 19.85599 1e-4
done

# Wind from behind is the mirror image of that from the front, for a rotor of symmetric, untwisted blades.
cat >polars.yaml <<'EOF'
polars:
  - name: symmetric
    table: {columns: [alpha deg, cl, cd, cm], rows: [[-180, 0, 0, 0], [-135, 1, 1, 0], [-90, 0, 2, 0], [-45, -1, 1, 0], [0, 0, 0, 0],
            [45, 1, 1, 0], [90, 0, 2, 0], [135, -1, 1, 0], [180, 0, 0, 0]]}
EOF
echo 'stations: {columns: [span, twist deg, chord, polar], rows: [[0, 0, 4, symmetric], [15, 0, 3, symmetric],
    [30, 0, 2, symmetric], [45, 0, 1, symmetric], [50, 0, 1, symmetric]]}' >blade.yaml
# thrust DURATION SETTINGS: adds the thrust at the end of a rotor at constant speed to `thrusts`.
thrust() {
    duration=$1
    shift
    expect 0 run rotor.yaml --out out --quiet --set control=null --set turbine.pitch=null --set turbine.speed=null --set loads=null \
        --set 'turbine.hub.joint={motion: {speed: 12 rpm}}' --set "simulation.duration=$duration s" \
        --set 'aero={blade: blade.yaml, polars: polars.yaml, hub_radius: 2 m, induction: {skew: pitt-peters}}' "$@"
    last RtAeroFxh | awk '{ printf "%.6g\n", $1 < 0 ? -$1 : $1 }' >>thrusts
}

# one_thrust: all of `thrusts` are equal.
one_thrust() {
    [ "$(uniq thrusts | wc -l)" -eq 1 ] || fail "$said: a thrust of $(cat thrusts)"
    rm thrusts
}

for direction in 30 150; do
    thrust 0.2 --set simulation.initial=equilibrium --set "aero.wind={kind: uniform, speed: 9, direction: $direction deg}"
done
one_thrust

# A wake, its lean and its delay follow the wind relative to the rotor: 9 and 5 m/s as wind or as motion of the tower.
for inflow in equilibrium oye; do
    thrust 2 --set simulation.initial=undeformed --set aero.induction.inflow=$inflow \
        --set 'aero.wind={kind: uniform, speed: 10.295630140987, direction: -29.054604099077 deg}'
    thrust 2 --set simulation.initial=undeformed --set aero.induction.inflow=$inflow --set 'aero.wind={kind: uniform, speed: 9}' \
        --set 'turbine.tower.joint={kind: prismatic, parent: ground, axis: y, motion: {speed: 5}}'
    one_thrust
done
# What the air and the bodies say of the rotor's place agree, or there is a warning. A period is some steps of the turbulence.
placed() {
    says "$1" "$2" run "$folder/apps/turbine/rotor.yaml" --out out --quiet --set 'simulation.duration=40 ms' \
        --set simulation.error_estimate=none --set "$3" --set "${4:-title=placed}"
}
placed 0 'blade1 at 0 s: it begins 1.499 m from the rotor.s axis, which aero.hub_radius contradicts' 'aero.hub_radius=2 m'
placed 0 'its blades reach .* m below the ground' 'turbine.tower_height=50 m' 'aero.wind={kind: power, speed: 8, reference_height: 90 m}'
placed 0 'it is 95 m beside aero.tower' 'turbine.tower.joint={kind: fixed, parent: ground, placement: [move x 100 m]}'
placed 2 'aero.wind.period: ' 'aero.wind={kind: iec, condition: ntm, speed: 8, reference_height: 90 m, period: 1e-12 s}'
# Joints of rigid blades carry the loads of the air from the first row on.
placed 0 '' title=rigid
awk '/^ *Time/ { for (i = 1; i <= NF; i++) if ($i == "RotTorq") at = i } /^ *0\.0/ { first = $at } { last = $at }
    END { exit !(first > 0.99 * last && last > 1000) }' out/channels.out || fail "the torque of a rigid rotor at the start"
[ $failures -eq 0 ]
