#!/bin/sh
# A run that is killed and resumed, as a user meets it: test_checkpoint.sh PROGRAM SOURCE_FOLDER
set -u
bough=$1
bar=$2/apps/beams/rubber-bar.yaml
turbine=$2/apps/turbine/runup.yaml
. "$(dirname "$0")/scratch.sh"

# Waits for a checkpoint that is not the one of `seen`; false when the process ends before.
await() {
    while kill -0 "$1" 2>/dev/null; do
        now=$(cksum cut/checkpoint.bin 2>/dev/null)
        [ -n "$now" ] && [ "$now" != "$seen" ] && seen=$now && return 0
        sleep 0.02
    done
    return 1
}

# killed SCENE INTERVAL ARGUMENT...: whole/ without a break, cut/ killed again and again, each time
# somewhere behind another checkpoint, and resumed with other numbers of threads.
killed() {
    scene=$1
    interval=$2
    shift 2
    set -- "$@" --set simulation.output.binary=true
    rm -rf whole cut
    expect 0 run "$scene" "$@" --checkpoint "$interval" --out whole --quiet
    [ ! -e whole/checkpoint.bin ] || fail "$said: a complete run leaves no checkpoint"
    seen=
    deaths=0
    first="--checkpoint $interval"
    for pause in 0 0.03 0.01 0.07; do
        # shellcheck disable=SC2086 # two words
        "$bough" run "$scene" "$@" $first --out cut --quiet >stdout 2>stderr </dev/null &
        process=$!
        await $process && sleep $pause && kill -s KILL $process 2>/dev/null && deaths=$((deaths + 1))
        wait $process 2>/dev/null
        [ -e cut/checkpoint.bin ] || break
        first="--resume --threads $((deaths + 1))"
    done
    [ -e cut/checkpoint.bin ] && expect 0 run "$scene" "$@" --resume --out cut --quiet
    [ $deaths -ge 1 ] || fail "$said: it was never killed"
    cmp whole/channels.out cut/channels.out || fail "$scene: the continued run differs"
    diff -r whole/frames cut/frames >stdout || fail "$scene: frames differ: $(head -n 3 stdout)"
    cmp whole/channels.outb cut/channels.outb || fail "$scene: the binary rows differ"
    cmp whole/frames.pvd cut/frames.pvd || fail "$scene: the list of frames differs"
    for folder in whole cut; do
        grep -v '_s": \|real_time_factor\|_bytes"\|"threads"' $folder/summary.json >$folder.json
    done
    [ "$(wc -l <whole.json)" -gt 100 ] || fail "$scene: a summary of $(wc -l <whole.json) lines"
    diff whole.json cut.json >stdout || fail "$scene: summaries differ: $(head -n 5 stdout)"
}

# One checkpoint of a run that was killed, in kept/.
keep_one() {
    rm -rf cut kept
    seen=
    said="bough run, killed"
    "$bough" run "$bar" --set 'simulation.duration=1000 s' --checkpoint 10ms --out cut --quiet &
    process=$!
    await $process || fail "$said: no checkpoint"
    kill -s KILL $process
    wait $process 2>/dev/null
    mv cut kept
    rm kept/running.lock
}

# refused MESSAGE ARGUMENT...: resuming kept/ is refused and leaves it as it was.
refused() {
    message=$1
    shift
    cksum kept/* >before
    expect 2 run "$@" --resume --out kept --quiet
    has stderr "$message"
    cksum kept/* | cmp - before || fail "$said: changed the results"
}

# Byte N of the checkpoint becomes another one.
damage() {
    cp checkpoint.bin kept/checkpoint.bin
    old=$(od -An -tu1 -j "$1" -N1 kept/checkpoint.bin | tr -d ' ')
    # shellcheck disable=SC2059 # the format is the byte
    printf "\\$(printf %03o $(((old + 1) % 256)))" |
        dd of=kept/checkpoint.bin bs=1 seek="$1" conv=notrunc 2>dd.txt
}

wrong_checkpoints() {
    keep_one
    long='simulation.duration=1000 s'
    cp kept/checkpoint.bin checkpoint.bin
    size=$(wc -c <checkpoint.bin)
    for at in 16 24 32 40 48 56 $((size / 2)) $((size - 1)); do
        damage "$at"
        refused 'is damaged\|is of another' "$bar" --set "$long"
    done
    damage $((size / 2))
    refused "checkpoint 'kept/checkpoint.bin' is damaged" "$bar" --set "$long"
    damage 3
    refused 'not a checkpoint of this version' "$bar" --set "$long"
    head -c $((size - 9)) checkpoint.bin >kept/checkpoint.bin
    refused 'is damaged' "$bar" --set "$long"
    : >kept/checkpoint.bin
    refused 'is damaged' "$bar" --set "$long"
    cp checkpoint.bin kept/checkpoint.bin
    refused 'is of another scene or other settings' "$bar"
    refused 'is of another scene or other settings' "$turbine" --set "$long"
    grep -q avx2 /proc/cpuinfo &&
            refused 'is of another version of the program or of other --kernels' "$bar" --set "$long" --kernels v2
    refused 'has --checkpoint 0.01 s, not 0.02 s' "$bar" --set "$long" --checkpoint 20ms
    cp kept/channels.out.partial rows
    head -c 100 rows >kept/channels.out.partial
    refused 'lacks rows that the checkpoint needs' "$bar" --set "$long"
    cp rows kept/channels.out.partial
    rm kept/checkpoint.bin
    refused "nothing to resume: there is no 'kept/checkpoint.bin'" "$bar" --set "$long"
}

wrong_intervals() {
    rm -rf kept
    expect 2 run "$bar" --checkpoint 0.5ms --out kept
    has stderr 'not a multiple of the macro step 0.001 s'
    expect 2 run "$turbine" --set 'simulation.macro_step=10 ms' --checkpoint 30ms --out kept
    has stderr 'not a multiple of the 0.02 s between the samples'
    for time in 5kg -1s 0 s ''; do
        expect 2 run "$bar" --checkpoint "$time" --out kept
        has stderr '^bough: error: --checkpoint expects a time (in s, or with a unit, as .20 ms.) > 0, got'
    done
    [ ! -e kept ] || fail 'a refused run wrote something'
}

# A new run in the same folder forgets the checkpoint of the old one; an interrupted one goes on.
other_ends() {
    keep_one
    expect 0 run "$bar" --set 'simulation.duration=10 ms' --out kept --quiet
    [ ! -e kept/checkpoint.bin ] || fail "$said: the old checkpoint is still there"
    set -- --set 'simulation.duration=1 s' --set 'simulation.output.interval=7 ms'
    expect 0 run "$bar" "$@" --checkpoint '20 ms' --out whole --quiet
    rm -rf cut
    seen=
    "$bough" run "$bar" "$@" --checkpoint 20ms --out cut --quiet >stdout 2>stderr &
    process=$!
    await $process
    kill -s TERM $process
    wait $process
    [ $? -eq 130 ] || fail "SIGTERM: exit code should be 130"
    expect 0 run "$bar" "$@" --resume --out cut --quiet
    cmp whole/channels.out cut/channels.out || fail 'the run continued after SIGTERM differs'
}

killed "$bar" 20ms --set 'simulation.duration=1.5 s' --set 'simulation.output.interval=7 ms' \
    --set 'simulation.output.frames=50 ms'
killed "$turbine" 40ms --set 'simulation.duration=1 s' --set 'simulation.macro_step=2.5 ms' \
    --set 'simulation.output.interval=15 ms' --set 'simulation.output.frames=0.2 s'
killed "$turbine" 40ms --set 'simulation.duration=1 s' --set simulation.error_shares=true --set simulation.error_bound=1 \
    --set 'bodies[3-5].rod.segments=8' --set 'simulation.output.frames=0.2 s'
# the companion's methods are chosen by the steps since its start, which every checkpoint is
cat >../rotor.yaml <<'EOF'
gravity: [0, 0, -9.81]
simulation: {duration: 6.4 s, macro_step: 5 ms, error_bound: 0, coupling: {scheme: gauss-seidel}, output: {frames: 0.5 s}}
bodies:
  - {name: hub, fidelity: rigid, mass: 5, inertia: [0.5, 0.3, 0.3], joint: {kind: revolute, axis: x, parent: ground, speed: 3 rad/s}}
  - {name: a, fidelity: rod, joint: {kind: fixed, parent: hub, placement: [move z 0.2]},
     rod: &rod {length: 3, segments: 16, stiffness: [1e6, 1e6, 3e6, 300, 900, 200], mass: [1.5, 0.01, 0, 1e-3, 2e-3, 0],
                damping: [2e-3, 2e-3, 2e-3, 2e-3, 2e-3, 2e-3]}}
  - {name: b, fidelity: rod, joint: {kind: fixed, parent: hub, placement: [rotate x 180 deg, move z 0.2]}, rod: *rod}
loads: [{joint: hub, torque: -20, ramp: [0, 0.3]}, {body: a, at: tip, force: [5, 0, 0], ramp: [0.1, 0.3]}]
EOF
killed ../rotor.yaml 200ms
wrong_checkpoints
wrong_intervals
other_ends
# Two runs into one folder: the second names the process that has it. What a killed run leaves half-written goes
# with the next.
mkdir busy
"$bough" run "$bar" --out busy --quiet --set simulation.duration=2000 >stdout 2>stderr </dev/null &
process=$!
until [ -e busy/running.lock ] || ! kill -0 $process 2>/dev/null; do sleep 0.02; done
expect 1 run "$bar" --out busy --quiet
has stderr "process $process is writing results into 'busy'"
kill -s KILL $process
wait $process 2>/dev/null
mkdir -p busy/frames
touch busy/frames/000007.vtp.partial busy/channels.outb.partial
expect 0 run "$bar" --out busy --quiet --set 'simulation.duration=0.1 s'
[ -z "$(find busy -name '*.partial' -o -name '*.lock')" ] || fail "left in busy: $(ls -R busy)"

[ $failures -eq 0 ]
