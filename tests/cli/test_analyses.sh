#!/bin/sh
# Equilibria, modes and sensors as a user meets them: test_analyses.sh PROGRAM SOURCE_FOLDER
set -u
bough=$1
folder=$2
scenes=$2/tests/data/scenes
blade=$scenes/blade.yaml
beam=$scenes/example-beam.yaml
turbine=$2/apps/turbine/runup.yaml
. "$(dirname "$0")/work.sh"

# near FILE PATTERN N VALUE TOLERANCE: word N of the line that matches.
near() {
    grep -e "$2" "$1" | awk -v n="$3" -v want="$4" -v by="$5" \
        '{ d = $n - want; if (d < 0) d = -d; if (d <= by) good = 1 } END { exit !good }' ||
        fail "$said: word $3 of '$(grep -e "$2" "$1")' is not $4"
}

# A cantilever under a force at its tip: the moment at a place is the force times what is left.
sensed() {
    cat >../bar.yaml <<'EOF'
gravity: [0, 0, 0]
simulation: {duration: 10 ms, macro_step: 10 ms, initial: equilibrium, output: {channels: ['*Spn*']}}
bodies:
  - name: bar
    fidelity: rod
    joint: {kind: fixed, parent: ground}
    rod: {length: 2 m, segments: 8, stiffness: [1e8, 1e8, 3e8, 20e3, 20e3, 15e3], mass: [1, 0, 0, 1e-4, 1e-4, 0]}
sensors: [{body: bar, at: [0, 0.6 m, 2 m]}]
loads: [{body: bar, at: tip, force: [10, 0, 7]}]
EOF
    expect 0 run ../bar.yaml --out sensed
    awk '/^ *Time/ { for (i = 1; i <= NF; i++) at[$i] = i }
        $1 + 0 > 0.005 { for (name in at) print name, $at[name] }' sensed/channels.out >../sensed
    [ "$(wc -l <../sensed)" -eq 37 ] || fail "$said: 36 channels and the time"
    near ../sensed '^barSpn1MLy ' 2 0.0199907 1e-6 # 10 N times 2 m, less 7 N times the deflection
    near ../sensed '^barSpn2MLy ' 2 0.0139918 1e-6
    near ../sensed '^barSpn3MLy ' 2 0 1e-8
    near ../sensed '^barSpn1FLx ' 2 0.01 1e-9
    near ../sensed '^barSpn2FLz ' 2 0.0070051 1e-7 # turned with the section by 0.029 deg
    near ../sensed '^barSpn3TDx ' 2 0.0013328 1e-6 # F L^3 / 3 EI
    rm -r sensed
    refused "bodies\[0\]\|sensors\[0\].body: there is no body 'b'" run ../bar.yaml --set 'sensors[0].body=b'
    refused "3 m is beyond the end of 'bar', at 2 m" run ../bar.yaml --set 'sensors[0].at=[3 m]'
    expect 2 run ../bar.yaml --set 'simulation.output.channels=[Rot*]'
    has ../stderr "simulation.output.channels\[0\]: no channel matches 'Rot\*'"
    sed 's/^simulation: {/&output: {channels: [beamTipZ, beamTipQ]}, /' "$beam" >../named.yaml
    expect 2 check ../named.yaml
    has ../stderr "error: \.\./named\.yaml:3:44: simulation.output.channels\[1\]: no channel matches 'beamTipQ' (did you mean 'beamTip.'?)"
    expect 0 check ../bar.yaml --set 'bodies[bar].rod.segments=4'
    has ../stdout '^body bar: .* 4 segments'
    refused "there is no item with 'name: baz' in that list (did you mean 'bar'?)" check ../bar.yaml --set 'bodies[baz].rod.segments=4'
    # the same wrench from both sides of the cut
    expect 0 run "$folder/apps/turbine/land.yaml" --set 'simulation.duration=0.1 s' --out sensed \
        --set 'sensors=[{body: blade1, at: [0]}, {body: tower, at: [0, 87.6 m]}]'
    awk '/^ *Time/ { for (i = 1; i <= NF; i++) at[$i] = i }
        $1 + 0 > 0.095 { for (name in at) print name, $at[name] }' sensed/channels.out >../sensed
    value() { sed -n "s/^$1 //p" ../sensed; }
    # the table begins with a twist of 13.308 deg, as in OpenFAST
    near ../sensed "^Spn1MLyb1 " 2 "$(awk "BEGIN { t = 13.308 / 57.29578; print cos(t) * $(value RootMyb1) + sin(t) * $(value RootMxb1) }")" 1e-3
    near ../sensed "^Spn1MLxb1 " 2 "$(awk "BEGIN { t = 13.308 / 57.29578; print cos(t) * $(value RootMxb1) - sin(t) * $(value RootMyb1) }")" 1e-3
    near ../sensed '^TwHt1MLyt ' 2 "$(value TwrBsMyt)" 1e-3
    near ../sensed '^TwHt2FLzt ' 2 "$(value YawBrFzp)" 1
    # the tower's two interfaces
    [ "$(grep -A 1 '"body": "tower"' sensed/summary.json | grep -c '"place": "end"')" -eq 1 ] || fail "$said: one end"
    near ../sensed '^RotTorq ' 2 59.5 1e-3 # 11.9 MN m at a two hundredth of the ramp
    rm -r sensed
}

# A swept cantilever under a small load along it, whose vertices lie on or just behind the stations: the twist of
# the polygon, integral of moments over stiffness, is 5.470e-4 deg at the tip.
swept() {
    cat >../swept.yaml <<'EOF'
gravity: [0, 0, 0]
simulation: {duration: 50 ms, initial: equilibrium, output: {channels: [bSpn*RDz]}}
bodies: [{name: b, fidelity: rod, joint: {kind: fixed, parent: ground}, rod: {table: swept-table.yaml, segments: 24}}]
loads: [{body: b, along: [0, 25], force: [8, 0, 0]}]
sensors: [{body: b, at: [25]}]
EOF
    awk 'BEGIN {
        print "length: 25\ndamping: [.01, .01, .01, .01, .01, .01]"
        print "stations:\n  columns: [span, axis, stiffness, mass]\n  rows:"
        for (i = 0; i < 25; i++) printf "    - [%.8f, [0, %.8f], [2e8, 2e8, 2e9, 1.2e9, 3.6e8, 3.6e7], [80, 0, 0, 5, 1, 0]]\n",
            25 * i / 24, 0.75 * (i / 24) ^ 2
    }' >../swept-table.yaml
    for segments in 12 24 48; do
        expect 0 run ../swept.yaml --out swept --set "bodies[b].rod.segments=$segments"
        near swept/channels.out '^ *5\.0.*E-02' 2 -5.470e-4 "$(awk "BEGIN { print 1e-5 * 12 / $segments }")"
        ! grep -q '^warning' ../stdout || fail "$said: forces by rounding at the tip: $(cat ../stdout)"
        rm -r swept
    done
}

# The blade under 100 kN at its tip: reference of a geometrically exact beam by shooting.
statics() {
    expect 0 static "$blade" --set 'loads=[{body: blade, at: tip, force: [100 kN, 0, 0]}]'
    has ../stdout '^rods one by one: [0-9]* steps$'
    has ../stdout '^rod blade: 48 segments, 61.5 m$'
    near ../stdout '^tip blade: u ' 4 7.68969 0.0015
    near ../stdout '^tip blade: u ' 5 -0.414706 0.0015
    near ../stdout '^tip blade: u ' 6 -1.122878 0.0015
    near ../stdout '^root blade: force ' 4 100000 0.01
    has ../stdout '^out: out/blade$'
    empty ../stderr
    [ "$(wc -l <out/blade/static.csv)" -eq 50 ] || fail "$said: static.csv has not 50 lines"
    has out/blade/static.csv '^rod,span (m),ux (m),'
    has out/blade/static.csv '^blade,61.5,7.6'
    has out/blade/static-channels.csv '^bladeTipX,m,7.6.*,[0-9.e-]*[1-9]'
    rm -r out
    expect 0 static "$blade" --set 'loads=[{body: blade, at: tip, force: [100 kN, 0, 0]}]' \
        --set bodies[0].fidelity=segmented-modal --set bodies[0].modal.pieces=24 --out pieces
    near ../stdout '^modal blade: tip moved by ' 6 7.68969 0.02
    rm -r pieces
    expect 0 static "$turbine" --out turning
    has ../stdout '^whole scene: .* steps, .* samples of the air, loads at 20 s$'
    has ../stdout '^joint hub: revolute 0 deg, keeps its speed of 0.5 rad/s$'
    [ "$(wc -l <turning/static.csv)" -eq 76 ] || fail "$said: static.csv has not 76 lines"
    has turning/static-channels.csv '^channel,unit,value'
    has turning/static-channels.csv '^RtAeroMxh,N-m,[0-9]'
    rm -r turning
    expect 3 static "$turbine" --set bodies[2].joint.speed=0 --out failed
    has ../stderr 'no equilibrium found in .* nothing but loads holds the joint of .hub.: it needs a spring, a speed or a motion'
    ! grep -q -e --path ../stderr || fail "$said: $(cat ../stderr)" # there is none with air
    refused "'x' is not\|there is no body 'x'" static "$blade" \
        --set 'loads=[{body: x, at: tip, force: [1, 0, 0]}]'
    # a load along the rod within its segments: 0.529485 N m with 24 and more of them
    expect 0 static "$scenes/dead-load.yaml" --out along
    near ../stdout '^ *1.3750 .* 2.6449[0-9]* ' 5 0.529485 1e-5
    rm -r along
    # a driven joint has the position and the speed that it has when no load grows any more
    expect 0 static "$folder/apps/beams/spin-up.yaml" --out driven
    has ../stdout '^joint hub: revolute 2578.31 deg$'
    has driven/static-channels.csv '^RotSpeed,rpm,57.29577951,0$'
    rm -r driven
    # a ramped load beyond buckling counts in full: 1.9862 /s by `bough modes`
    expect 0 static "$folder/apps/beams/buckling.yaml" --out buckled
    has ../stderr 'unstable: motions from it grow at 1.99 1/s$'
    rm -r buckled
    # a slack line from above its clamp, which the rod's own search loses at 99 % of the load
    expect 0 static "$blade" --out slack --set 'bodies=[{name: line, fidelity: rod, joint: {kind: fixed, parent: ground,
        placement: [rotate y 60 deg]}, rod: {length: 100 m, segments: 40, stiffness: [1e6, 1e6, 3e6, 1e4, 1e4, 1e4],
        mass: [1, 0, 0, 1e-3, 1e-3, 0]}}]' --set 'loads=[{body: line, at: tip, force: [-100, 50, -1000]}]' \
        --set 'gravity=[0, 0, -9.80665]'
    has ../stdout '^whole scene: [0-9]* steps'
    rm -r slack
    # a thin cable on a clamp that bends it by 60 degrees: what the rod's own search finds is unstable
    expect 0 static "$blade" --out thin --set 'bodies=[{name: line, fidelity: rod, joint: {kind: fixed, parent: ground,
        placement: [rotate y 120 deg]}, rod: {length: 1 m, segments: 30, stiffness: [3e3, 3e3, 1e4, 1e-4, 1e-4, 1e-4],
        mass: [1, 0, 0, 1e-6, 1e-6, 0]}}]' --set 'loads=null' --set 'gravity=[0, 0, -9.80665]'
    ! grep -q unstable ../stderr || fail "$said: $(cat ../stderr)"
    near ../stdout '^lineTipZ: ' 2 -0.99926 0.0001
    rm -r thin
    # a shaft that turns and slides: the spring of 200 N/m holds its weight
    expect 0 static "$blade" --out slides --set 'bodies=[{name: r, fidelity: rigid, mass: 2, inertia: [1, 1, 1],
        joint: {kind: cylindrical, parent: ground, axis: z, angular_speed: 3 rad/s}}]' --set 'gravity=[0, 0, -10]' \
        --set 'springs=[{name: s, from: ground, to: r, from_point: [0, 0, -1], stiffness: 200, length: 1}]' \
        --set 'loads=null'
    near ../stdout '^rPos: ' 2 -0.1 1e-9
    rm -r slides
    # a damper holds nothing
    expect 3 static "$blade" --out failed --set 'bodies=[{name: r, fidelity: rigid, mass: 2, inertia: [1, 1, 1],
        joint: {kind: prismatic, parent: ground, axis: z, damping: 5}}]' --set 'loads=null' --set 'gravity=[0, 0, -10]'
    has ../stderr "no equilibrium found .*nothing but loads holds the joint of 'r'"
    expect 3 static "$blade" --set 'bodies[0].rod.segments=4' --out failed \
        --set 'loads=[{body: blade, at: tip, moment: [0, 1e9, 0]}]'
    has ../stderr '^bough: error: blade: no equilibrium found .*: the rod folds, .* none found with up to 16 times the segments'
    nothing_written
}

# The blade's frequencies at rest: beam finite elements converged at 800 elements.
# Modes of bodies that spin about free axes, of more bodies alike than a search has starting vectors, and slow ones.
spinning() {
    cat >../disc.yaml <<'EOF'
gravity: [0, 0, 0]
simulation: {duration: 1 s}
bodies:
  - {name: disc, fidelity: rigid, mass: 2 kg, inertia: [0.1, 0.1, 0.2],
     joint: {kind: planar, parent: ground, axis: z, angular_speed: 3 rad/s}}
bushings: [{name: b, from: ground, to: disc, stiffness: [200, 200, 200]}]
EOF
    # 10 rad/s in ground axes is 10 -+ 3 in those of the disc
    expect 0 modes ../disc.yaml --set 'modes={of: scene}' --out disc
    near ../stdout '^ *1 ' 2 1.114085 1e-5
    near ../stdout '^ *2 ' 2 2.069014 1e-5
    # a top: J = 1.1, C = 0.05 kg m^2 and m g h = 9.81 N m; the growth rate is the root of mgh/J - (C 20/2J)^2
    cat >../top.yaml <<'EOF'
gravity: [0, 0, -9.81]
simulation: {duration: 1 s}
bodies:
  - {name: top, fidelity: rigid, mass: 1 kg, centre_of_mass: [0, 0, 1], inertia: [0.1, 0.1, 0.05],
     joint: {kind: spherical, parent: ground, angular_velocity: [0 rpm, 0 rpm, 20 rad/s]}}
EOF
    expect 0 modes ../top.yaml --set 'modes={of: scene}' --out top
    has ../stdout 'unstable: mode 1 grows at 2.95154 /s'
    expect 2 modes ../top.yaml --set 'modes={of: scene}' --out top --sensitivity 1
    has ../stderr 'sensitivities are not computed where bodies turn'
    {
        echo 'gravity: [0, 0, 0]'
        echo 'simulation: {duration: 1 s}'
        echo 'bodies:'
        for i in 1 2 3 4 5 6 7; do
            echo "  - {name: a$i, mass: 1, fidelity: rigid, joint: {kind: prismatic, parent: ground, axis: x, stiffness: 100}}"
        done
        echo '  - {name: slow, mass: 1, fidelity: rigid, joint: {kind: prismatic, parent: ground, axis: x, stiffness: 1e-8}}'
    } >../alike.yaml
    expect 0 modes ../alike.yaml --set 'modes={of: scene, count: 10}' --out alike
    [ "$(grep -c '^ *[1-9] *1.59155 ' ../stdout)" -eq 7 ] || fail "$said: not 7 equal modes"
    near ../stdout '^ *1 ' 2 1.59155e-5 1e-10
    has ../stdout '^8 of the 10 modes asked for'
    rm -r disc top alike
}

modes() {
    expect 0 modes "$blade" --set 'modes={count: 6, shapes: true}'
    has ../stdout '^rod blade: 48 segments, 61.5 m, root held$'
    near ../stdout '^ *1 ' 2 0.68582 0.0005
    near ../stdout '^ *2 ' 2 1.08057 0.0005
    has ../stdout '^ *6 .* torsion '
    empty ../stderr
    [ "$(wc -l <out/blade/modes.csv)" -eq 7 ] || fail "$said: modes.csv has not 7 lines"
    [ "$(wc -l <out/blade/shapes.csv)" -eq 295 ] || fail "$said: shapes.csv has not 295 lines"
    has out/blade/modes.csv '^rod,mode,frequency (Hz),'
    expect 0 modes "$turbine" --set 'modes={count: 2, speed: 12.1 rpm}' --out turning
    has ../stdout '^rod blade3: .* turning at 12.1 rpm about (0.996195, 0, -0.0871557)'
    near ../stdout '^ *1 ' 2 0.7349 0.001
    missing turning/shapes.csv
    expect 0 modes "$turbine" --set 'modes={count: 3, of: scene, at: undeformed}' --out campbell \
        --sweep 'gravity=[0, 0, -9], [0, 0, 0]' --sweep 'simulation.output={channels: ["Tip*"]}, null' \
        --sweep 'title="calm, light", b'
    [ "$(wc -l <campbell/campbell.csv)" -eq 7 ] || fail "$said: campbell.csv has not 7 lines"
    has campbell/campbell.csv '^1,"\[0, 0, -9\]","{channels: \[""Tip\*""\]}",'
    has campbell/campbell.csv '^2,"\[0, 0, 0\]",null,b,'
    has campbell/campbell.svg '^</svg>'
    rm -r campbell
    expect 0 modes "$turbine" --set 'modes={count: 3, at: undeformed, shapes: true}' --out whole
    has ../stdout '^whole scene: .*, rotor at 4.77465 rpm, seen by an observer at rest, rotor free to turn; the air'
    has ../stdout '^ *1 .* blades .* flap .* backward '
    has ../stdout '^no mode changes by more than 0.0'
    has ../stdout '^largest residual of a mode: [0-9.]*e-1[0-9] of its eigenvalue'
    has whole/modes.json '"eigenvalues_converged": 11'
    has whole/shapes.csv '^body,mode,span (m),ux (m),'
    [ "$(wc -l <whole/shapes.csv)" -eq 235 ] || fail "$said: shapes.csv has not 235 lines"
    has whole/modes.csv '^mode,frequency (Hz),.*,decrement (-),residual (-),.*,pattern,collective (-),forward (-),backward (-),tower'
    rm -r whole
    expect 0 modes "$blade" --set 'modes={of: scene, count: 2}' --set 'bodies[0].rod.segments=4' --sensitivity 1 --out depends
    has depends/modes.json '"name": "[^"]*: bending stiffness about [xy]"'
    rm -r depends
    expect 0 modes "$folder/apps/iea22/rotor.yaml" --set 'modes={of: scene, air: dynamic, count: 3}' \
        --set 'bodies[3-5].rod.segments=6' --out inexact
    has ../stdout '^not compared with half the segments: mode 1'
    rm -r inexact
    expect 0 modes "$beam" --set 'loads=[{body: beam, at: tip, force: [0, 0, -3 kN], frame: follower}]'
    has ../stdout '^unstable beam: mode [23] grows at '
    rm -r out turning
    refused 'no revolute joint carries it' modes "$blade" --set 'modes.speed=1 rad/s'
    refused "'b=1' has 1 values, the first 2" modes "$turbine" --sweep 'a=1, 2' --sweep 'b=1'
    refused "expects KEY=V1, V2" modes "$turbine" --sweep 'gravity'
    # two sliders whose frequencies cross: each is one branch, on a line of its own
    expect 0 modes "$folder/apps/mechanisms/pendulum.yaml" --set 'markers=[]' --out crossing --set 'modes.count=2' \
        --set 'bodies=[{name: a, fidelity: rigid, mass: 1, joint: {kind: prismatic, parent: ground, axis: z, stiffness: 50}},
        {name: b, fidelity: rigid, mass: 1, joint: {kind: prismatic, parent: ground, axis: z, stiffness: 100}}]' \
        --sweep 'bodies[a].joint.stiffness=60, 90, 99, 101, 140'
    [ "$(grep -c ',1,a z,.*,a,z,' crossing/campbell.csv)" -eq 5 ] || fail "$said: a is not line 1 at all points"
    [ "$(grep -c ',2,b z,.*,b,z,' crossing/campbell.csv)" -eq 5 ] || fail "$said: b is not line 2 at all points"
    rm -r crossing
    # a pendulum that stands on its head falls without an oscillation
    expect 0 modes "$folder/apps/mechanisms/pendulum.yaml" --out falling --set modes.at=undeformed \
        --set 'bodies[bob].joint.angle=90 deg' --set 'bodies[bob].inertia=[0.1, 0.1, 0.1]'
    has ../stdout '^   1  *0[.][0-9]*  *0  *-100[.]00000  *-  bob '
    rm -r falling
    refused 'the linear system changes by' modes "$turbine" --set 'bodies[blade1].pitch=7 deg'
    expect 0 modes "$blade" --set 'modes={of: scene, count: 9}' --set 'bodies[0].rod.segments=6' --out mesh
    has ../stdout '^warning: changed by more than 1 % with half the segments: mode [2-9]'
    rm -r mesh
    refused "needs a --sweep" modes "$turbine" --until unstable
    refused "expects unstable, got 'stable'" modes "$turbine" --sweep 'a=1' --until stable
    # Goland's wing: 137.25 m/s as published, 137.34 m/s and 69.35 rad/s in strips
    expect 0 modes "$scenes/goland.yaml" --out flutter --until unstable \
        --sweep 'aero.wind.speed=120 m/s, 130 m/s, 150 m/s, 170 m/s'
    has ../stdout '^unstable from aero.wind.speed=137.[234][0-9]* m/s on, mesh +- 0.1[0-9]*: line 2, 11.0[0-9]* Hz'
    [ "$(wc -l <flutter/campbell.csv)" -eq 7 ] || fail "$said: campbell.csv has not 7 lines"
    expect 0 modes "$scenes/goland.yaml" --out flutter --until unstable \
        --sweep 'aero.wind.speed=100 m/s, 120 m/s'
    has ../stdout '^nothing grows up to aero.wind.speed=120 m/s among the [0-9]* modes followed'
    # mass on the elastic axis, a quarter of the stiffness: pi/2L sqrt(2 GJ/(rho c a d)) = 126.14 m/s
    expect 0 modes "$scenes/goland.yaml" --out flutter --until unstable \
        --set 'bodies[1].rod.mass=[35.71, 0, 0, 8.64, 1e-3, 0]' \
        --set 'bodies[1].rod.stiffness=[1e9, 1e9, 1e10, 9.77e8, 9.77e6, 0.24675e6]' \
        --sweep 'aero.wind={kind: uniform, speed: 120 m/s}, {kind: uniform, speed: 140 m/s}'
    has ../stdout '^unstable from aero.wind={kind: uniform, speed: 126.1[0-9]* m/s} on, mesh +- .* of the step: .*divergence, wing '
    # Beck's column without damping: P L2/EI = 20.0509, L = 1.41602 m
    expect 0 modes "$folder/apps/beams/beck.yaml" --out flutter --until unstable --sweep 'bodies[0].rod.length=1.2 m, 1.3 m, 1.5 m'
    has ../stdout '^unstable from bodies.0..rod.length=1.41[56][09][0-9]* m on, mesh +- [1-9].*e-0[56]: line 1, '
    rm -r flutter
    refused "modes.about: the joint of 'nacelle' must be revolute" modes "$turbine" \
        --set 'modes.about=nacelle'
    refused 'rod tower carries the body nacelle.*: take modes.of: scene' modes "$folder/apps/turbine/land.yaml" \
        --set modes.of=rods
    refused "modes.speed: only used with 'of: rods'" modes "$turbine" \
        --set 'modes={of: scene, speed: 12.1 rpm}'
    refused "modes.axis: only used without 'about'" modes "$turbine" \
        --set 'modes={about: hub, axis: [1, 0, 0]}'
}

# Loads on a part of a segment, at a point of one and at an end that carries a body: what lies beyond each section.
loaded() {
    cat >../loaded.yaml <<'EOF'
gravity: [0, 0, 0]
simulation: {duration: 10 ms, macro_step: 10 ms, initial: equilibrium}
bodies:
  - name: bar
    fidelity: rod
    joint: {kind: fixed, parent: ground}
    rod: {length: 2 m, segments: 5, stiffness: [1e9, 1e9, 1e9, 1e7, 1e7, 1e7], mass: [1, 0, 0, 1e-3, 1e-3, 0]}
  - {name: head, fidelity: rigid, mass: 5 kg, inertia: [1, 1, 1], joint: {kind: fixed, parent: bar}}
sensors: [{body: bar, at: [0.3, 0.6, 0.7, 1.25, 1.35, 1.9, 2]}]
loads:
  - {body: bar, along: [0.5, 0.9], force: [10, 0, 0]}
  - {body: bar, at: 1.3 m, force: [0, 0, -4], moment: [0, 2, 0], frame: follower}
  - {body: bar, at: tip, force: [3, 0, 0], frame: body}
EOF
    expect 0 run ../loaded.yaml --out loaded
    awk '/^ *Time/ { for (i = 1; i <= NF; i++) at[$i] = i }
        { for (name in at) last[name] = $at[name] } END { for (name in last) print name, last[name] }' loaded/channels.out >../loaded
    while read -r place x z y; do # forces, moment about y
        near ../loaded "^barSpn${place}FLx " 2 "$x" 1e-6
        near ../loaded "^barSpn${place}FLz " 2 "$z" 1e-6
        near ../loaded "^barSpn${place}MLy " 2 "$y" 1e-6
    done <<'EOF'
1 0.007 -0.004 0.0087
2 0.006 -0.004 0.00665
3 0.005 -0.004 0.0061
4 0.003 -0.004 0.00425
5 0.003 0 0.00195
6 0.003 0 0.0003
7 0.003 0 0
EOF
    rm -r loaded
    # rotation by a couple where the bending stiffness falls to a hundredth, M L/(EI - EI1) ln(EI/EI(s)), and the twist
    # of the sections has a kink within a segment
    cat >../taper.yaml <<'EOF'
length: 2
stations:
  - {span: 0, stiffness: [1e9, 1e9, 1e9, 1e4, 1e4, 1e4], mass: [1, 0, 0, 1e-3, 1e-3, 0]}
  - {span: 1.8, twist: 40 deg, stiffness: [1e9, 1e9, 1e9, 1090, 1090, 1090], mass: [1, 0, 0, 1e-3, 1e-3, 0]}
  - {span: 2, twist: 40 deg, stiffness: [1e9, 1e9, 1e9, 100, 100, 100], mass: [1, 0, 0, 1e-3, 1e-3, 0]}
EOF
    expect 0 static ../loaded.yaml --out loaded --set 'loads=[{body: bar, at: tip, moment: [0, 1, 0]}]' \
        --set 'bodies[bar].rod={table: taper.yaml, segments: 3}'
    near ../stdout '^barSpn4RDy:' 2 0.0111617 1e-5 # 1.25 m
    near ../stdout '^barSpn6RDy:' 2 0.0326618 5e-5 # 1.9 m
    near ../stdout '^barSpn6MLx:' 2 -0.000642788 1e-8 # -sin 40 deg
    rm -r loaded
}

# A scene without states: a spring between the ground and a body that is fixed to it.
still() {
    cat >../still.yaml <<'EOF'
simulation: {duration: 0.1 s, macro_step: 10 ms}
bodies:
  - {name: wall, fidelity: rigid, mass: 1 kg, inertia: [1, 1, 1], joint: {kind: fixed, parent: ground}}
springs: [{name: stay, from: ground, from_point: [3, 0, 4], to: wall, stiffness: 10, length: 2}]
EOF
    for scheme in monolithic iterated; do
        expect 0 run ../still.yaml --out still --set simulation.coupling.scheme=$scheme
        awk '/^ *Time/ { for (i = 1; i <= NF; i++) at[$i] = i }
            { last = $at["stayFrc"] } END { print "stayFrc", last }' still/channels.out >../still
        near ../still stayFrc 2 30 1e-9
        rm -r still
    done
}

# Three equal blades on a rotor that drives a tilting nacelle.
rotating() {
    cat >../rotor.yaml <<'EOF'
gravity: [0, 0, -9.81]
simulation: {duration: 1 s, macro_step: 10 ms}
modes: {count: 4, of: scene, at: undeformed}
bodies:
  - {name: nac, fidelity: rigid, mass: 10, inertia: [5, 5, 5], centre_of_mass: [0.95, 0, 0.5],
     joint: {kind: revolute, parent: ground, axis: y, stiffness: 3000}}
  - {name: hub, fidelity: rigid, mass: 5, inertia: [1, 0.5, 0.5],
     joint: {kind: revolute, parent: nac, axis: x, motion: {speed: 50 rad/s}, placement: [move x -0.5 m]}}
  - {name: shaft, fidelity: rigid, mass: 1, inertia: [0.1, 0.05, 0.05],
     joint: {kind: revolute, parent: nac, axis: x, motion: {speed: 97 rad/s}}}
  - {name: mass, fidelity: rigid, mass: 2, inertia: [0.1, 0.1, 0.1], joint: {kind: fixed, parent: hub}}
EOF
    for k in 0 1 2; do
        cat <<EOF
  - {name: b$k, fidelity: rod, joint: {kind: fixed, parent: hub, placement: [rotate x $((120 * k)) deg, move z 0.2 m]},
     rod: {length: 1, segments: 6, stiffness: [1e6, 1e6, 1e7, 1e3, 300, 300], mass: [1, 0, 0, 1e-3, 1e-3, 0]}}
EOF
    done >>../rotor.yaml
    echo 'turbine: {rotor: hub, blades: [b0, b1, b2]}' >>../rotor.yaml
    # a shaft at another speed leaves the system constant; an eccentric spring and a mass on springs do not
    expect 0 modes ../rotor.yaml --out rotor
    has ../stdout 'rotor at 477.465 rpm, seen by an observer at rest'
    rm -r rotor
    refused 'the linear system changes by 0' modes ../rotor.yaml \
        --set 'springs=[{name: s, from: ground, from_point: [0, 1, 3], to: hub, to_point: [0, 0.3, 0], stiffness: 2000, length: 1}]'
    refused 'the linear system changes by 0' modes ../rotor.yaml \
        --set 'bodies[mass].joint={kind: spherical, parent: hub, placement: [move z 1 m]}' \
        --set 'bushings=[{name: u, from: hub, to: mass, rotational_stiffness: [800, 800, 800]}]'
    # the nacelle falls over below a stiffness of m g h = 49.05, at any speed of the rotor, slowly near it
    expect 0 modes ../rotor.yaml --out rotor --until unstable --sweep 'bodies[nac].joint.stiffness=60, 52, 47'
    has ../stdout '^unstable from bodies.nac..joint.stiffness=49.0[45]'
    rm -r rotor
    # the nacelle's slow vibration on a soft spring is a mode whether or not the rotor turns freely
    for motion in 'motion: {speed: 50 rad/s}' 'speed: 50 rad/s'; do
        expect 0 modes ../rotor.yaml --out rotor --set 'gravity=[0, 0, 0]' --set 'bodies[nac].joint.stiffness=0.1' \
            --set "bodies[hub].joint={kind: revolute, parent: nac, axis: x, placement: [move x -0.5 m], $motion}"
        near ../stdout '^ *1 ' 2 0.007658 1e-6
        rm -r rotor
    done
    # a rotor out of balance on a stiff support
    cat >../stiff.yaml <<'EOF'
simulation: {duration: 1 s, macro_step: 10 ms}
modes: {count: 4, of: scene}
bodies:
  - {name: n, fidelity: rigid, mass: 1, inertia: [0.5, 0.5, 0.5], joint: {kind: revolute, parent: ground, axis: y, stiffness: 1e6}}
  - {name: r, fidelity: rigid, mass: 1, inertia: [1, 1.2, 0.3], joint: {kind: revolute, parent: n, axis: x, speed: 1 rad/s}}
EOF
    refused 'the linear system changes by 0' modes ../stiff.yaml
}

statics
sensed
swept
loaded
still
modes
spinning
rotating
[ $failures -eq 0 ]
