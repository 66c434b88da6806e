#!/bin/sh
# Imports of decks and turbines as a user meets them: test_imports.sh PROGRAM SOURCE_FOLDER
set -u
bough=$1
folder=$2
. "$(dirname "$0")/work.sh"

# A foreign model as a scene, and the message for a bad one.
imported() {
    expect 0 import openfast "$folder/tests/data/decks/main.fst" --out out
    has ../stdout '^scene: out/scene.yaml$'
    has out/import.txt '^left out:$'
    expect 0 check out/scene.yaml
    rm -r out
    sed 's/CompHydro/CompHydra/; s/CompElast/CompPlast/' "$folder/tests/data/decks/main.fst" >../bad.fst
    refused "bad.fst: no 'CompElast': expected a line" import openfast ../bad.fst --out out
    refused "cannot read 'none.fst'" import openfast none.fst --out out
    refused 'cannot open the wind file none.bts' \
        import openfast "$folder/tests/data/decks/main.fst" --wind none.bts --out out
    refused 'the controller cannot be loaded' \
        import openfast "$folder/tests/data/decks/main.fst" --controller ./none.so --out out
    refused 'missing KIND FILE' import openfast
    expect 0 import windio "$folder/tests/data/decks/turbine-2.yaml" --out out
    has ../stdout '^scene: out/scene.yaml$'
    expect 0 check out/scene.yaml
    rm -r out
    sed 's/^control:/control:\n  region2_k: 0.1/' "$folder/tests/data/decks/turbine-2.yaml" >../gain.yaml
    expect 0 import windio ../gain.yaml --out out
    has out/scene.yaml 'optimal_gain: 0.091189' # 0.1 N m/rpm2 of the rotor, over the square of the ratio 10
    rm -r out
    sed -i 's/region2_k: 0.1/region2_k: 10/' ../gain.yaml
    expect 0 import windio ../gain.yaml --out out
    has out/import.txt 'region2_k: would exceed rated power'
    rm -r out
    sed -i 's/region2_k: 10/region2_k: -1/' ../gain.yaml
    refused 'gain.yaml:[0-9]*:[0-9]*: .*region2_k: expected a value above 0' import windio ../gain.yaml --out out
    while IFS='|' read -r change message; do
        sed "$change" "$folder/tests/data/decks/turbine-2.yaml" >../bad.yaml
        refused "bad.yaml:[0-9]*:[0-9]*: $message" import windio ../bad.yaml --out out
    done <<'END'
s/: upwind/: sideways/|rotor_orientation: expected upwind or downwind, got 'sideways'
s/rated_power: 5000/rated_power: -5000/|rated_power: expected 0 to 1e+09, got -5000
s/uptilt: [0-9.]*/uptilt: 500/|uptilt: expected -80 to 80 deg, got 500
s/cone_angle: [0-9.]*/cone_angle: 500/|cone_angle: expected -80 to 80 deg, got 500
s/optimal_tsr: 7/optimal_tsr: -7/|optimal_tsr: expected 0 to 100, got -7
s/mass: 1000}/mass: -1000}/|mass: expected 0 to 1e+09, got -1000
s/^airfoils:/environment: {shear_exp: -0.2}\nairfoils:/|shear_exp: expected 0 to 1, got -0.2
END
    sed "s/gear_ratio: 10, //; s/'2.1'/'3.0'/" "$folder/tests/data/decks/turbine-2.yaml" >../direct.yaml
    expect 0 import windio ../direct.yaml --out out
    has out/import.txt 'the file has no gear_ratio: 1 is taken'
    has out/import.txt 'windIO_version 3.0: read in the layout of version 2'
    rm -r out
    # a bent reference line of many points is smooth: a parabola between two of its points, which are 0.0016 m beside their chord
    sed 's/^        x: {grid: .*/        x: {grid: [0, 0.125, 0.25, 0.375, 0.5, 0.625, 0.75, 0.875, 1], values: [0, -0.00625, -0.025, -0.05625, -0.1, -0.15625, -0.225, -0.30625, -0.4]}/' \
        "$folder/tests/data/decks/turbine-1.yaml" >../bent.yaml
    expect 0 import windio ../bent.yaml --out out --hub-mass 1000 --nacelle-mass 1000
    sed -n 's/^ *- \[5.625, [^[]*\[\(-[0-9.]*\), .*/\1/p' out/blade-structure.yaml |
        awk '{ found = 1; exit !($1 > -0.1269 && $1 < -0.1262) } END { if (!found) exit 1 }' ||
        fail "a smooth line: $(grep '\[5.6' out/blade-structure.yaml)"
    rm -r out
    refused 'main.fst:[0-9]*:[0-9]*: unexpected' import windio "$folder/tests/data/decks/main.fst" --out out
    refused "unknown kind 'adams'" import adams main.cmd --out out
    refused 'unexpected argument' import openfast main.fst more --out out
}

# A change of a deck that OpenFAST would refuse, too.
bad_decks() {
    cp -r "$folder/tests/data/decks" ../decks
    while IFS='|' read -r file change message; do
        cp "$folder/tests/data/decks/$file" ../decks/saved
        sed -i "$change" "../decks/$file"
        refused "$message" import openfast ../decks/main.fst --out out
        cp ../decks/saved "../decks/$file"
    done <<END
main.fst|/CompServo/d|main.fst: no 'CompServo'
main.fst|s/1    CompServo/7    CompServo/|main.fst:9: CompServo: expected a whole number from 0 to 1, got 7
main.fst|/Gravity/d|elasto.dat: no 'Gravity'
main.fst|s/9.81 /-9.81 /|main.fst:11: Gravity: expected 0 to 200, got -9.81
parts/aero.dat|s/2   WakeMod/5   WakeMod/|aero.dat:3: WakeMod: expected one of 0 1 2 3, got 5
parts/aero.dat|s/2   AFAeroMod/3   AFAeroMod/|aero.dat:4: AFAeroMod: expected one of 1 2, got 3
parts/aero.dat|s/1   TwrPotent/3   TwrPotent/|aero.dat:5: TwrPotent: expected one of 0 1 2, got 3
parts/aero.dat|s/0   TwrShadow/0.4   TwrShadow/|aero.dat:6: TwrShadow: expected one of 0 1 2, got 0.4
parts/aero.dat|s/2   SkewMod/-1   SkewMod/|aero.dat:9: SkewMod: expected one of 0 1 2, got -1
parts/aero.dat|s/1   DBEMT_Mod/9   DBEMT_Mod/|aero.dat:12: DBEMT_Mod: expected one of -1 0 1 2 3, got 9
parts/aero.dat|s/2.5   tau1/0   tau1/|aero.dat:13: tau1_const: expected a time above 0 s, got 0
parts/aero.dat|s/4   UAMod/99   UAMod/|aero.dat:14: UAMod: expected one of 0 1 2 3 4 5 6 7 8, got 99
parts/aero.dat|s/4   UAMod/0   UAMod/|aero.dat:14: UAMod: expected one of 1 to 8 with AFAeroMod 2, got 0
parts/servo.dat|s/0   PCMode/1   PCMode/|servo.dat:3: PCMode: expected one of 0 3 4 5, got 1
parts/servo.dat|s/1   VSContrl/2   VSContrl/|servo.dat:4: VSContrl: expected one of 0 1 3 4 5, got 2
parts/servo.dat|s/0   TimGenOn/-1   TimGenOn/|servo.dat:6: TimGenOn: expected 0 to
parts/servo.dat|s/1   VSContrl/9 GenModel\n0 VSContrl/|servo.dat:4: GenModel: expected one of 1 2 3, got 9
parts/elasto.dat|s/4.5    BlPitch(2)/450    BlPitch(2)/|elasto.dat:10: BlPitch(2): expected -180 to 180, got 450
parts/wind.dat|s/0.2    PLexp/-0.2    PLexp/|wind.dat:8: PLExp: expected 0 to 1, got -0.2
parts/wind.dat|s/0.2    PLexp/1.2    PLexp/|wind.dat:8: PLExp: expected 0 to 1, got 1.2
parts/wind.dat|s/21    RefHt/0    RefHt/|wind.dat:7: RefHt: expected a length above 0 m, got 0
END
}

# What a scene has no key for, and lines that are missing, are on the list.
left_of_decks() {
    rm -r ../decks
    cp -r "$folder/tests/data/decks" ../decks
    sed -i 's/3.01  TMax/0.01  TMax/' ../decks/main.fst
    sed -i '/GenEff/d; s/0   PCMode/5   PCMode/; s/1   VSContrl/5   VSContrl/' ../decks/parts/servo.dat
    cat >>../decks/parts/servo.dat <<END
"$(dirname "$bough")/tests/libsample_discon.so"  DLL_FileName
"other"  DLL_ProcName
0  TPitManS(3)
0  Ptch_Max
90  Ptch_Min
T  DLL_Ramp
2  BPCutoff
5  CCmode
END
    sed -i '/AdjFlSt/d; /AdjEdSt/d' ../decks/parts/blade.dat
    sed -i 's/2    CompElast/1    CompElast/' ../decks/main.fst
    sed -i '/AirDens/d; s/2   SkewMod/0   SkewMod/; s/4   UAMod/4   UAMod\nF  AoA34\n0.9  UAEndRad\n1.2  SkewModFactor/' ../decks/parts/aero.dat
    sed -i 's/1   NumTabs/1   NumTabs\nTrue InclUAdata/' ../decks/parts/foils/flat.dat
    printf '3 PtfmPitch\n2 PtfmSurge\nTrue PtfmSgDOF\n' >>../decks/parts/elasto.dat
    echo '1 SensorType' >>../decks/parts/wind.dat
    expect 0 import openfast ../decks/main.fst --out out
    while read -r line; do has out/import.txt "^  $line\$"; done <<'END'
TPitManS(3): the pitch manoeuvre of blade 3
DLL_ProcName other: the library's function DISCON is called
CCmode: cable control
PtfmPitch: the platform stands upright in its place
servo.dat has no GenEff: 100 is taken
aero.dat has no AirDens: that of the main file, or 1.225 is taken
blade.dat has no AdjFlSt, AdjEdSt: 1 is taken
SkewMod 0: the whole wind acts, not only its part along the shaft
AoA34 False: the angle of attack is that at three quarters of the chord
InclUAdata: constants of dynamic stall beside A1, A2, b1 and b2
UAEndRad: dynamic stall acts on all elements
Ptch_Min: this record is 0
DLL_Ramp: demands hold from call to call
BPCutoff 2 Hz: no filter of the pitch
PtfmSurge: the platform stands upright in its place
SensorType: the lidar
END
    sed -n '/^NOT THE MODEL/,/^taken/p' out/import.txt >../first
    has ../first PtfmPitch
    grep -q PtfmSurge ../first && fail "$said: PtfmSurge of a platform that moves is no other load case"
    has ../first CCmode
    expect 0 import openfast ../decks/main.fst --controller "$(dirname "$bough")/tests/libsample_discon.so" --out out
    has out/import.txt 'Ptch_Min: this record is 0'
    grep -q DLL_ProcName out/import.txt && fail "$said: DLL_ProcName of a library that is replaced"
    rm -r out
}

imported
bad_decks
left_of_decks
[ $failures -eq 0 ]
