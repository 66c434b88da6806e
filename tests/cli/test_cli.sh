#!/bin/sh
# The command line as a user meets it: test_cli.sh PROGRAM SOURCE_FOLDER VERSION
# Every check that fails says so in one line; the exit code is the test's.
set -u
bough=$1
folder=$2
scenes=$2/tests/data/scenes
bar=$2/apps/beams/rubber-bar.yaml
mechanisms=$2/apps/mechanisms
beam=$2/tests/data/scenes/example-beam.yaml
turbine=$2/apps/turbine/runup.yaml
version=$3
. "$(dirname "$0")/work.sh"

count() { tr -cd "$1" <"$2" | wc -c; }

# Shape of JSON as far as grep sees it: brackets pair, no comma before a closing one, no NaN.
json() {
    exists "$1"
    [ "$(count '{' "$1")" -eq "$(count '}' "$1")" ] || fail "$said: braces in $1"
    [ "$(count '[' "$1")" -eq "$(count ']' "$1")" ] || fail "$said: brackets in $1"
    tr -d ' \n' <"$1" | grep -q '^{.*}$' || fail "$said: $1 is not one object"
    tr -d ' \n' <"$1" | grep -q ',[]}]' && fail "$said: stray comma in $1"
    grep -qi ': *-\{0,1\}\(nan\|inf\)' "$1" && fail "$said: not a JSON number in $1"
    missing "$1.partial"
}

usage() {
    "$bough" >../stdout 2>../stderr
    [ $? -eq 2 ] || fail "no argument: exit code should be 2"
    said=bough
    has ../stderr 'bough run SCENE'
    empty ../stdout
    refused "unknown command 'rnu' (did you mean 'run'?)" rnu
    refused 'known: run, check, static' frobnicate
    refused "unknown option '--treads' (did you mean '--threads'?)" run "$bar" --treads 2
    refused "unknown option '--thread' (did you mean '--threads'?)" run "$bar" --thread 2
    refused "unknown option '--thread=2' (did you mean '--threads'?)" run "$bar" --thread=2
    refused "unknown option '-x'" run -x "$bar"
    refused "unknown option '--out'" check "$bar" --out x
    refused '\-\-quiet takes no value' run "$bar" --quiet=1
    refused '\-\-set needs a value: --set KEY=VALUE' run "$bar" --set
    refused 'missing SCENE' run
    refused "unexpected argument 'more'" run "$bar" more
    refused "unexpected argument 'more'" run -- "$bar" more
    for n in 0 65 -1 2x '' 99999999999999999999; do
        refused 'whole number from 1 to 64' run "$bar" --threads "$n"
    done
    POSIXLY_CORRECT=1 refused "unknown option '--bogus'" run "$bar" --bogus
    refused "unknown topic 'scen' (did you mean 'scene'?)" help scen
}

help() {
    expect 0 --version
    has ../stdout "^bough $version\$"
    for form in help --help -h; do
        expect 0 $form
        has ../stdout 'bough check SCENE'
        empty ../stderr
    done
    expect 0 help scene
    has ../stdout 'macro_step: (number.* s'
    expect 0 help channels
    has ../stdout '^| RootMyb{a} | kN-m |'
    expect 0 help study
    has ../stdout '^- equivalent_cycles: '
    refused "json-schema: of 'scene' or 'study', got 'coupling'" help coupling --json-schema
    expect 0 help coupling
    has ../stdout '^ *ramp '
    for form in 'help run' 'run --help' 'run -h'; do
        # shellcheck disable=SC2086 # two words
        expect 0 $form
        has ../stdout '^usage: bough run SCENE \[--set KEY=VALUE\]\.\.\. \[--out DIR\]'
    done
    nothing_written
    "$bough" help >/dev/full 2>../stderr && fail 'bough help >/dev/full: should fail'
    has ../stderr 'cannot write to the standard output'
}

# Errors stand one a line as file:line:col: error: path: text.
bad_scenes() {
    sed 's/^gravity:/gravty:/' "$bar" >../bad.yaml
    for command in run check; do
        expect 2 "$command" ../bad.yaml
        has ../stderr "^\.\./bad\.yaml:[0-9]*:1: error: .*gravty.*did you mean 'gravity'"
        [ "$(wc -l <../stderr)" -eq 1 ] || fail "$said: more than the one error"
        empty ../stdout
        nothing_written
    done
    refused 'error: simulation: unknown key .durration' run "$bar" --set simulation.durration=1
    printf 'kind: sweep\nscene: %s\ngrid:\n  simulation.durration: [1]\n' "$bar" >../sweep.yaml
    refused '^../sweep.yaml:4:26: error: simulation: unknown key .durration' study ../sweep.yaml
    refused "error: .*unit" run "$bar" --set 'simulation.duration=1 kg'
    refused "error: simulation.threads: must be in \[0, 1024\], got '3000000000'" run "$bar" --set simulation.threads=3000000000
    refused "error: aero.wind.seed: must be in \[-999999999, 999999999\], got '3000000000'" run "$folder/apps/turbine/power.yaml" \
        --set 'aero.wind={kind: iec, condition: ntm, reference_height: 90 m, speed: 9 m/s, seed: 3000000000}'
    refused 'error: aero.wind.period: the turbulence repeats .* give 720 s, got 700 s' check "$folder/apps/turbine/power.yaml" \
        --set 'aero.wind={kind: iec, condition: ntm, reference_height: 90 m, speed: 9 m/s, period: 700 s}'
    refused 'absent.yaml: error: ' run absent.yaml
    # what is found while the scene is built has its place, too
    built='simulation: {duration: 1 s}
bodies:
  - {name: a, fidelity: rigid, mass: 1, joint: {kind: revolute, axis: x, parent: ground}}
closures:
  - {name: pin, kind: revolute, axis: x, from: a, from_placement: [move z 1], to: ground, to_placement: [move z 2]}
markers:
  - {name: m, body: a}'
    echo "$built" >../built.yaml
    refused "^bough: error: ../built.yaml:3:5: bodies\[a\]: body 'a': its revolute joint moves no inertia" run ../built.yaml
    echo "$built" | sed 's/mass: 1/&, inertia: [1, 1, 1]/' >../built.yaml
    refused "^bough: error: ../built.yaml:5:5: closures\[pin\]: closure 'pin': its ends are 1 m apart" run ../built.yaml
    sed -i 's/move z 2/move z 1/; $a\  - {name: m, body: ground}' ../built.yaml
    refused "^bough: error: ../built.yaml:8:5: markers\[m\]: two output channels are named 'mX'" run ../built.yaml
    printf 'kind: sweep\nscene: x.yaml\n' >../study.yaml
    refused "study.yaml:1:7: error: kind: this is a study, not a scene: 'bough study ../study.yaml'" run ../study.yaml
    refused "this is a scene, not a study: 'bough run $bar' runs it" study "$bar"
}

# A setting that is read by no part of the run is named, at its place, unless the command line has replaced
# the choice that it belongs to.
unused_settings() {
    unused="warning: simulation.coupling.order: not used with 'scheme: ramp', only with extrapolated, iterated"
    expect 0 check "$turbine"
    empty ../stderr
    expect 0 check "$turbine" --set simulation.coupling.order=2
    has ../stderr "^--set: $unused\$"
    expect 0 check "$turbine" --set simulation.coupling.scheme=monolithic
    empty ../stderr
    sed "s/^simulation: {/&coupling: {scheme: ramp, order: 2}, master: {solver: ida, rho: 0.5}, /" "$beam" >../unused.yaml
    expect 0 check ../unused.yaml
    has ../stderr "^\.\./unused\.yaml:3:46: $unused\$"
    has ../stderr "^\.\./unused\.yaml:3:77: warning: simulation.master.rho: not used with 'solver: ida'\$"
    [ "$(wc -l <../stderr)" -eq 2 ] || fail "$said: more than the two warnings"
    expect 0 check "$bar" --set 'simulation.micro.rtol=1e-5' --set simulation.step_control.tolerance=1e-3 \
        --set 'bodies[bar].micro.rtol=1e-5' --set simulation.coupling.scheme=monolithic
    has ../stderr "^--set: warning: simulation.micro: not used with 'scheme: monolithic', only with frozen"
    has ../stderr "^--set: warning: simulation.step_control: not used with 'scheme: monolithic', only"
    has ../stderr "^--set: warning: body 'bar': micro: not used with 'scheme: monolithic'\$"
    # every key of the coupling that only some schemes read, with one that does not
    for key in order=1 exchange=waveform accelerator=aitken relaxation=0.5 tolerance=1e-5 iterations=5; do
        expect 0 check "$turbine" --set "simulation.coupling.$key"
        has ../stderr "warning: simulation.coupling.${key%%=*}: not used with 'scheme: ramp', only with .*iterated"
    done
    expect 0 check "$bar" --set simulation.coupling.theta=0.6
    has ../stderr "warning: simulation.coupling.theta: not used with 'scheme: monolithic', only with ramp"
    # keys of control, air and estimate that their choice does not use
    power=$folder/apps/turbine/power.yaml
    unused() { # WARNING SETTING...: with these settings together
        warning=$1
        shift
        for setting in "$@"; do set -- "$@" --set "$setting"; shift; done
        expect 0 check "$power" "$@"
        has ../stderr "^--set: warning: $warning"
        [ "$(wc -l <../stderr)" -eq 1 ] || fail "$said: more than the one warning: $(cat ../stderr)"
    }
    unused "control.law.corner: not used with 'kind: external', only with variable-speed" 'control={kind: external, law: {corner: 1 rad/s}}'
    unused "control.law.integral: not used with 'pitch: false', only with true" control.pitch=false control.law.integral=0.01
    wind='kind: iec, reference_height: 90 m, speed: 9 m/s'
    unused "aero.wind.seed: not used with 'condition: eog', only with ntm|etm|ewm" "aero.wind={$wind, condition: eog, seed: 2}"
    unused "aero.wind.shear: not used with 'condition: edc', only with ews" "aero.wind={$wind, condition: edc, shear: vertical}"
    unused "aero.tower.drag: not used, only with 'influence: bak'" 'aero.tower.drag=[0.5]'
    unused "simulation.error_bound: not used with 'error_estimate: none'" simulation.error_estimate=none simulation.error_bound=0.1
    unused 'simulation.step_control.min: not used without' simulation.coupling.scheme=iterated 'simulation.step_control={min: 1 ms}'
    # not where a file or the command line replaces the choice of the file below it
    printf 'base: %s\naero: {tower: {drag: [0.5]}, wind: {%s, condition: ntm, seed: 2}}\n' "$power" "$wind" >../ntm.yaml
    printf 'base: ntm.yaml\naero: {tower: {influence: bak}, wind: {condition: eog}}\n' >../eog.yaml
    expect 0 check ../eog.yaml
    empty ../stderr
    nothing_written
}

checks() {
    expect 0 check "$bar" --set 'bodies[0].rod.segments=8'
    has ../stdout '^body bar: rod; revolute about y on ground: 1 degree of freedom; 8 segments, 104 states'
    has ../stdout '^tree: 2 states'
    has ../stdout '^states: 106$'
    has ../stdout '^macro_steps: 1000$'
    has ../stdout '^aero: not built: no aero block$'
    has ../stdout '^model_bytes: [1-9]'
    empty ../stderr
    expect 0 check "$turbine" --set 'bodies[3].rod.segments=8' --set 'bodies[4].rod.segments=8' \
        --set 'bodies[5].rod.segments=8' --set 'bodies[5].fidelity=rigid'
    has ../stdout '^states: 210$'
    has ../stdout '^body nacelle: rigid; fixed to tower and so to ground: no states'
    has ../stdout '^body blade1: rod; fixed to hub: .*104 states.*mass 168.* length 61.5 m'
    has ../stdout '^body blade3: rigid, with mass and inertia of its rod; '
    has ../stdout '^joints: 1 moving, 5 fixed$'
    has ../stdout '^ports: 2,'
    has ../stdout '^coupling: ramp, theta 0.5'
    has ../stdout '^aero: built, 3 blades of '
    has ../stdout '^rotor: 3 blades, radius 62.94 m, hub height 90 m, tilt 5 deg, overhang 5.0191 m upwind'
    has ../stdout '^blade blade2: pitch 6.5 deg, cone 2.5 deg, root at 1.5 m'
    has ../stdout '^wind: uniform, 20 m/s, to 0 deg from x, 0 m/s upwards; at the hub at 0 s \[20, 0, 0\]'
    has ../stdout '^control: not built'
    has ../stdout '^load on joint hub: -1.19e+07 N m, ramp from 0 to 20 s$'
    has ../stdout '^results: 2001 rows of 51 columns, 1.84 MB$'
    expect 0 check "$folder/apps/turbine/rotor.yaml" --set "aero.wind={kind: bts, file: turbulence.bts}"
    has ../stdout '^wind: box file .*turbulence.bts, mean .* m/s, .* s.*: covers the rotor'
    expect 0 check "$folder/apps/turbine/land-operation.yaml"
    has ../stdout '^control: built, variable-speed law, 25 Hz, gear ratio 97, generator torque and pitch, 0 ev'
    expect 0 check "$folder/apps/turbine/land-operation.yaml" --set control.pitch=false
    has ../stdout '^control: built, .* generator torque only'
    expect 2 check "$turbine" --set 'control={kind: variable-speed}'
    has ../stderr "error: control: the joint of 'blade1' cannot pitch it: .*'pitch: false'"
    expect 0 check "$turbine" --set 'control={kind: variable-speed, pitch: false}'
    has ../stdout '^control: built, .* generator torque only'
    sed 's/^    mass: .*/&\n    inertia: [5.1e6, 1e3, 1e3]/' "$mechanisms/pendulum.yaml" >../odd.yaml
    expect 0 check ../odd.yaml
    has ../stderr "^../odd.yaml:[0-9]*:[0-9]*: warning: body '.*': no mass distribution has the inertia"
    mkdir ../drives
    cp "$folder"/apps/templates/turbine/*.yaml ../drives
    sed -i 's/0.88, 0.009/0.88, -0.009/' ../drives/airfoils.yaml
    expect 0 check ../drives
    has ../stderr "^../drives/airfoils.yaml:23:11: warning: polar 'section': the drag coefficient is negative, -0.009 at 4 deg"
    expect 0 check "$folder/apps/templates/turbine/scene.yaml" --set control.law.rated_power=null
    has ../stderr "warning: control.law: rated_power not given: the values of the NREL 5 MW turbine, .* 97, not 25"
    expect 0 check "$folder/apps/templates/turbine/scene.yaml" --set control.gear_ratio=97 --set control.law=null
    [ ! -s ../stderr ] || fail "a warning for the turbine of the defaults"
    refused 'control.efficiency: must be in (0, 1\]' check "$folder/apps/turbine/power.yaml" --set control.efficiency=0
    refused 'control.efficiency: must be in (0, 1\]' check "$folder/apps/turbine/power.yaml" --set control.efficiency=1.1
    refused 'mass: must be in \[0, 1e12\] kg' run "$mechanisms/pendulum.yaml" --set 'bodies[0].mass=1e300 t'
    refused "error: aero.wind.speed: must be in \[0, 150\] m/s, got '300'" check "$turbine" --set aero.wind.speed=300
    refused "solver: expected one of .*, got 'cvode' (did you mean 'cvode-bdf'?)" check "$bar" --set simulation.micro.solver=cvode
    for key in interval from frames; do
        expect 0 check "$bar" --set "simulation.output.$key=1000 s"
        has ../stderr "^--set: warning: simulation.output.$key: 1000 s is longer than the run, 1 s\$"
    done
    refused "error: --set: control.library: the controller cannot be loaded: .*no.so" check \
        "$folder/apps/turbine/power.yaml" --set 'control={kind: bladed, library: no.so}'
    refused "error: --set: aero.wind.file: cannot open the wind file .*no.bts" check "$turbine" --set 'aero.wind={kind: bts, file: no.bts}'
    expect 0 check "$beam" --set 'bodies[beam].rod.segments=1'
    has ../stdout '^warning: beam at 0 s: a rod of one segment bends by a third too little'
    couple='force: [1, 0, 0], moment: [0, 60, 0], frame: follower}]'
    expect 0 check "$beam" --set 'bodies[beam].rod.segments=10' --set "loads=[{body: beam, at: 0.3 m, $couple"
    has ../stderr "^--set: warning: body 'beam': the direction of this follower errs by about 0.006 rad"
    expect 0 check "$beam" --set 'bodies[beam].rod.segments=10' --set "loads=[{body: beam, at: 0.4 m, $couple"
    [ ! -s ../stderr ] || fail "a warning for a follower on a vertex"
    refused 'error: base: bases are read before' check "$bar" --set base=none.yaml
    refused 'at most 1e+09 are taken' check "$bar" --set 'simulation.duration=1e30 s'
    expect 0 check "$scenes/joints.yaml"
    has ../stdout '^body fork: rigid; universal about x and y on ground: 2 degrees of freedom'
    has ../stdout '^body piston: rigid; cylindrical along and about z on fork: 2 degrees'
    has ../stdout '^body puck: rigid; planar normal to z on ground: 3 degrees of freedom'
    has ../stdout '^joints: 3 moving, 0 fixed$'
    expect 0 check "$scenes/springs.yaml"
    has ../stdout '^body slider: .* 1 degree of freedom, spring 50 N/m, damper 0.5 N s/m, stops 3000 N/m'
    expect 0 check "$scenes/motion.yaml"
    has ../stdout '^body table: .* 1 degree of freedom, 1 of them prescribed'
    expect 0 check "$mechanisms/elastic-pendulum.yaml"
    has ../stdout '^springs: 1$'
    expect 0 check "$bar" --set 'simulation.coupling={scheme: extrapolated, order: 2}' \
        --set 'simulation.duration=10 ms' --set 'simulation.macro_step=2.5 ms'
    has ../stdout '^coupling: extrapolated, order 2 '
    has ../stdout '^macro_steps: 4$'
    # as short as the default macro step of such a run
    expect 0 check "$bar" --set 'simulation.duration=2 us' --set 'simulation.macro_step=20 ns'
    has ../stdout '^macro_steps: 100$'
    refused 'simulation.duration: must be >= 1e-7 s' check "$bar" --set 'simulation.duration=99 ns'
    expect 0 check "$bar" --set 'simulation.coupling={scheme: iterated, accelerator: aitken}' \
        --set 'simulation.coupling.tolerance=1e-5'
    has ../stdout '^coupling: iterated, order 1, accelerator aitken, tolerance 1e-05 in at most 30 '
    nothing_written
}

# The times of the rows in ms.
row_times() { sed '1,/^ *(s)/d' "$1" | awk '{print $1 * 1000}' | tr '\n' ' '; }

complete_run() {
    expect 0 run "$bar" --set 'simulation.duration=22 ms' --set 'simulation.output.interval=5 ms' \
        --threads 2
    out=out/rubber-bar
    has ../stdout '^results: 6 rows of 6 columns, 0.000654 MB$'
    has ../stdout '^status: complete$'
    has ../stdout '^run: 0.022 s of .*rubber-bar.yaml, simulation.duration=22 ms, simulation.output.interval=5 ms$'
    has ../stdout '^speed: [0-9.]* s, [0-9.]* times real time, [0-9]* MB$'
    has ../stdout '^channel  *unit  *mean  *min  *max  *end  *error$'
    has ../stdout '^barTipY  *m  *0  *0  *0  *0 '
    has ../stdout '^largest errors: bar[A-Za-z]* [0-9].* of its range'
    has ../stdout "^out: $out\$"
    has ../stdout "^next: bough report $out\$"
    empty ../stderr
    json $out/summary.json
    has $out/summary.json '"bough_version": "'"$version"'"'
    has $out/summary.json '"simulation.duration=22 ms"'
    has $out/summary.json '"status": "complete"'
    has $out/summary.json '"diagnosis": null'
    has $out/summary.json '"time": 0.022,'
    has $out/summary.json '"macro_steps": 22,'
    has $out/summary.json '"threads": 2,'
    has $out/summary.json '"kernels": "v'
    has $out/summary.json '"states": 522,'
    for key in scheme order theta macro_step wall_s cpu_s build_s real_time_factor bodies joints \
        peak_memory_bytes model_bytes defect_max defect_rms energy_residual energy_exchanged \
        interfaces error_estimate; do
        has $out/summary.json "\"$key\": "
    done
    for key in name kind; do
        [ "$(grep -c "\"$key\": " $out/summary.json)" -eq 2 ] || fail "$said: $key of 2 subsystems"
    done
    # the monolithic scheme's integrator of the whole beside them
    for key in solver steps derivatives jacobians factorisations iterations starts; do
        [ "$(grep -c "\"$key\": " $out/summary.json)" -eq 3 ] || fail "$said: $key of 2 and the whole"
    done
    [ "$(grep -o '"solver": .*' $out/summary.json | sort -u | wc -l)" -eq 1 ] || fail "$said: solvers that did not run"
    missing $out/channels.out.partial
    has $out/channels.out '^Complete: 6 rows'
    # t = 0, each interval, and the end that is no multiple of it
    row_times $out/channels.out >../times
    has ../times '^0 5 10 15 20 22 $'
    expect 0 run "$bar" --set 'simulation.duration=20 ms' --set 'simulation.output.interval=10 ms'
    row_times $out/channels.out >../times
    has ../times '^0 10 20 $'
    missing $out/channels.outb
    expect 0 run "$bar" --set 'simulation.duration=20 ms' --set simulation.output.binary=true
    [ "$(od -A n -t d2 -N 2 $out/channels.outb)" -eq 4 ] || fail "$said: format 4"
    expect 0 run "$bar" --set 'simulation.duration=20 ms'
    missing $out/channels.outb # an older one does not stand beside new rows
    rm -r out
}

failed_run() {
    expect 3 run "$bar" --set simulation.coupling.scheme=frozen --set 'simulation.macro_step=5 ms' \
        --out failed
    has ../stderr '^bough: error: .*macro step 0.005 s.*try '
    has ../stdout '^status: failed$'
    json failed/summary.json
    has failed/summary.json '"status": "failed"'
    has failed/summary.json '"diagnosis": ".*macro step 0.005 s.*try '
    has failed/channels.out '^INCOMPLETE: [1-9][0-9]* rows, then '
    rm -r failed
}

# start_long [WORD]...: starts a run that would take hours, in the background, behind the words, and waits
# until it steps.
start_long() {
    rm -rf long
    mkdir long
    echo earlier >long/summary.json
    echo earlier >long/channels.out
    said="bough run ... --out long"
    "$@" "$bough" run "$beam" --set 'simulation.duration=1000000 s' --out long >../stdout 2>../stderr &
    long=$!
    waited=0
    while [ ! -e long/channels.out.partial ] && [ $waited -lt 20 ]; do
        sleep 1
        waited=$((waited + 1))
    done
    sleep 1
}

interrupted_run() {
    for signal in TERM INT HUP XCPU; do
        start_long
        kill -s $signal $long
        [ $signal != XCPU ] || kill -s $signal $long 2>/dev/null # it comes every second
        wait $long
        code=$?
        [ $code -eq 130 ] || fail "SIG$signal: exit code $code, expected 130"
        has ../stderr '^bough: interrupted at [0-9]'
        has ../stdout '^status: interrupted$'
        json long/summary.json
        has long/summary.json '"status": "interrupted"'
        has long/channels.out '^INCOMPLETE: [1-9][0-9]* rows, then interrupted'
        rows=$(sed '1,/^ *(s)/d' long/channels.out | wc -l)
        has long/summary.json "\"rows\": $rows,"
    done
    start_long nohup
    kill -s HUP $long
    sleep 1
    kill -0 $long || fail "$said: a run behind nohup ended with SIGHUP"
    kill -s KILL $long
    wait $long 2>/dev/null
    has long/summary.json '^earlier$' # what was there stays until the new run can replace it
    has long/channels.out '^earlier$'
    has long/channels.out.partial '^INCOMPLETE'
    rm -r long
}

# Whatever standard streams are closed, no file of results has the number of one.
closed_streams() {
    short='simulation.duration=5 ms'
    expect 0 run "$bar" --set "$short" --set simulation.output.frames=1e-3 --out open
    for closed in '<&-' '>&-' '2>&-' '<&- >&-' '>&- 2>&-' '<&- >&- 2>&-'; do
        said="bough run ... $closed"
        (eval "exec $closed" && exec "$bough" run "$bar" --set "$short" \
            --set simulation.output.frames=1e-3 --out closed) >/dev/null 2>&1
        code=$?
        [ $code -eq 0 ] || fail "$said: exit code $code"
        json closed/summary.json
        diff -r -x summary.json -x stdout open closed >../differ || fail "$said: $(head -n 3 ../differ)"
        rm -rf closed
    done
    rm -r open
}

bad_output() {
    short='simulation.duration=5 ms'
    echo mine >taken
    for out in taken taken/below; do
        expect 1 run "$bar" --set "$short" --out $out
        has ../stderr '^bough: error: .*taken.* is a file'
        empty ../stdout
    done
    has taken '^mine$'
    expect 1 run "$bar" --set "$short" --out /proc/no-folder-can-be-made-here
    has ../stderr '^bough: error: cannot create the folder'
    expect 2 run "$bar" --set "$short" --out ''
    expect 2 run "$bar" --set "$short" --kernels v9
    has ../stderr '^bough: error: --kernels expects v2, v3 or v4, on this processor at most v[234], got '"'v9'"'$'
    expect 0 run "$bar" --set "$short" --kernels v2 --out v2 --quiet
    has v2/summary.json '"kernels": "v2"'
    rm -r v2
    mkdir full
    ln -s /dev/full full/summary.json.partial
    expect 1 run "$bar" --set "$short" --out full
    has ../stderr '^bough: error: .*No space left'
    has ../stdout '^status: failed$'
    grep '^next:' ../stdout && fail "$said: a report of results that were not written"
    missing full/summary.json
    rm -r full/*
    ln -s /dev/full full/channels.out.partial
    expect 1 run "$bar" --set "$short" --out full
    has ../stderr '^bough: error: .*No space left'
    rm -r full taken
}

# Frames at the times asked for, the rod's axis in each, and a page of all.
shown() {
    expect 0 run "$bar" --set 'simulation.duration=20 ms' --set 'simulation.output.frames=5 ms' --out out
    [ "$(grep -c '<DataSet ' out/frames.pvd)" -eq 5 ] || fail "$said: five frames"
    has out/frames.pvd 'timestep="0.02" file="frames/000004.vtp"'
    [ "$(grep -c '^[-0-9.e]* [-0-9.e]* [-0-9.e]*$' out/frames/000004.vtp)" -ge 40 ] ||
        fail "$said: the points of the rod"
    expect 0 report out
    has ../stdout '^report: out/report.html$'
    has out/report.html 'data.summary = '
    has ../stdout '^picture: out/shape.svg$'
    has out/shape.svg '^<text .*>0.02 s, to scale'
    expect 0 report out --at '9 ms'
    has out/shape.svg '^<text .*>0.01 s, to scale' # the nearest
    expect 0 report out --at 0s
    # the bar is still straight: the dashed line ends where the bar does
    sed -n 's/.*stroke-dasharray.*L\(.*\)".*/\1/p' out/shape.svg >../straight
    sed -n 's/.*stroke-width.* d="M.*L\(.*\)".*/\1/p' out/shape.svg | tail -n 1 | cmp -s - ../straight ||
        fail "$said: the end of the bar: $(cat ../straight)"
    [ "$(grep -c '<path stroke-width' out/shape.svg)" -eq 40 ] || fail "$said: a line for each segment"
    for time in 21ms -1s; do
        expect 2 report out --at "$time"
        has ../stderr '^bough: error: --at: out/frames.pvd holds frames from 0 s to 0.02 s, not '
    done
    expect 2 report out --at '1 kg'
    has ../stderr "--at expects a time (in s, or with a unit, as '20 ms'), got '1 kg'"
    touch out/frames/mine.vtp
    expect 0 run "$bar" --set 'simulation.duration=20 ms' --set 'simulation.output.frames=10 ms' --out out
    [ "$(find out/frames | wc -l)" -eq 5 ] || fail "$said: three frames and what is not ours"
    missing out/report.html # of the run before
    missing out/shape.svg
    rm out/frames/mine.vtp
    expect 0 run "$bar" --set 'simulation.duration=10 ms' --out other
    expect 0 report out other
    has ../stdout '^report: out/report.html$'
    has out/report.html '^{name: "other", channels: '
    mkdir nothing
    expect 2 report out nothing
    has ../stderr "'nothing' holds no run's results"
    rm -r other nothing
    expect 0 run "$bar" --set 'simulation.duration=20 ms' --out out
    missing out/frames
    missing out/frames.pvd
    expect 2 report out --at 10ms
    has ../stderr '^bough: error: --at: out holds no frames; run with simulation.output.frames$'
    rm -r out
    refused 'holds no results' report .
    refused "there is no folder 'nowhere'" report nowhere
}

# Two workers fill one folder, by themselves and as a Slurm array would start them.
spread() {
    cat >../spread.yaml <<END
kind: stability
scene: $bar
reference: {simulation.coupling.scheme: monolithic, simulation.macro_step: 1 ms}
grid:
  bodies[0].rod.segments: [8, 12]
  simulation.coupling.scheme: [monolithic]
  simulation.macro_step: [1 ms, 2 ms]
common: {simulation.duration: 4 ms, simulation.output.interval: 4 ms}
measures:
  - {name: tip, channels: [barTipX, barTipZ]}
END
    said="spread.sh"
    BOUGH=$bough "$folder/apps/studies/spread.sh" ../spread.yaml 2 out >../stdout 2>../stderr ||
        fail "spread.sh: $(cat ../stderr)"
    has ../stdout '^4 of 4 held, 0 stopped'
    [ "$(grep -l 'macro_step=' out/cases/*.case | wc -l)" -eq 4 ] || fail "$said: four cells"
    rm -r out
    for k in 1 2; do
        SLURM_ARRAY_TASK_ID=$k BOUGH=$bough "$folder/apps/studies/spread.sh" ../spread.yaml 2 out \
            >../stdout 2>../stderr || fail "spread.sh: $(cat ../stderr)"
    done
    has ../stdout ' 0 of 4 cells still missing'
    rm -r out
    refused 'expects K/N' study ../spread.yaml --part 3/2
    refused 'kind: expected one of work-precision' study "$folder/tests/verification/beams.yaml"
}

usage
help
bad_scenes
unused_settings
checks
complete_run
failed_run
interrupted_run
closed_streams
bad_output
shown
spread
[ $failures -eq 0 ]
