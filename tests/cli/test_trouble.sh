#!/bin/bash
# What a machine can do to a run: a full disk, a folder that cannot be written, input that vanishes,
# signals, memory that ends. Each ends with its exit code and a reason, and what was there before stays.
# test_trouble.sh BOUGH SOURCE
set -u
bough=$1 source=$2
bar=$source/apps/beams/rubber-bar.yaml
blade=$source/tests/data/scenes/blade.yaml
. "$(dirname "$0")/scratch.sh"
trap 'umount -q "$scratch/disk" 2>/dev/null; chmod -R u+w "$scratch"; rm -rf "$scratch"' EXIT

# same FOLDER: it is as it was when its copy was made, but for what was never finished.
keep() { rm -rf kept && cp -r "$1" kept; }
same() { diff -r -x '*.partial' -x frames "$1" kept >differ || fail "$2: $1 changed: $(head -n 3 differ)"; }

# small_study SCENE
small_study() {
    cat <<END
kind: work-precision
scene: $1
reference: {simulation.coupling.scheme: monolithic}
grid:
  simulation.macro_step: [1 ms, 2 ms, 4 ms, 5 ms, 10 ms, 20 ms]
common: {simulation.duration: 0.5 s, simulation.output.interval: 20 ms, "bodies[0].rod.segments": 8}
measures:
  - {name: tip, channels: [barTipX, barTipZ]}
END
}

# What writes results, each into a folder of its own that holds those of an earlier, shorter call.
long='simulation.duration=0.3 s'
declare -A command=(
    [run]="run $bar --set $long"
    [frames]="run $bar --set simulation.output.frames=1e-3 --set $long"
    [checkpoint]="run $bar --set $long --checkpoint 10ms"
    [static]="static $blade --set bodies[0].rod.segments=200"
    [modes]="modes $blade --set modes.shapes=true"
    [study]="study bar.yaml"
    [import]="import openfast $source/tests/data/decks/main.fst"
)
small_study "$bar" >bar.yaml

# with NAME FOLDER [MORE]...: the words of a command; the duration has a blank.
with() {
    words=()
    for word in ${command[$1]//0.3 s/0.3_s}; do words+=("${word//_s/ s}"); done
    words+=(--out "$2" "${@:3}")
}

earlier() {
    for name in run static modes study import; do
        with $name "old-$name"
        says 0 '' "${words[@]}"
    done
    cp -r old-run old-checkpoint
    cp -r old-run old-frames
    mkdir old-report
    cp old-run/channels.out old-report
    says 0 '' report old-report
}

# A disk that is full from some byte on: a limit of a file's size, with the device's message.
full() {
    for name in "${!command[@]}"; do
        for blocks in 1 4 8; do
            rm -rf out
            cp -r "old-$name" out
            keep out
            with "$name" out
            before=$failures
            (ulimit -f $blocks && exec "$bough" "${words[@]}" >/dev/null 2>stderr)
            code=$?
            [ $code -eq 0 ] && break # the results are smaller
            [ $code -eq 1 ] || fail "$name, $blocks kB: exit code $code, expected 1"
            grep -q 'File too large' stderr || fail "$name, $blocks kB: $(head -c 300 stderr)"
            # These write besides the rows, and end them: so the rows of now are named.
            [ "$name" = checkpoint ] || [ "$name" = frames ] && continue
            # Tables are written anew from the runs, which are kept.
            [ "$name" = study ] && cp kept/table.* kept/plot.svg out
            same out "$name, $blocks kB"
            [ $failures -eq $before ] || break
        done
    done
    keep old-report
    (ulimit -f 8 && exec "$bough" report old-report >/dev/null 2>stderr)
    [ $? -eq 1 ] || fail 'report: exit code 1'
    same old-report report
    (ulimit -f 1 && exec "$bough" new turbine new >/dev/null 2>stderr)
    [ $? -eq 1 ] && grep -q 'File too large' stderr || fail "new: $(head -c 300 stderr)"
    [ -z "$(ls new)" ] || fail "new: $(ls new)"
}

# The same on a disk of its own, where one may be mounted; also read-only.
mounted() {
    mkdir disk
    mount -t tmpfs -o size=64k tmpfs disk 2>/dev/null || return 0
    for name in run import static; do
        rm -rf disk/*
        cp -r "old-$name" disk/out
        keep disk/out
        head -c 1000000 /dev/zero >disk/fill 2>/dev/null
        with $name disk/out
        says 1 'No space left on device' "${words[@]}"
        same disk/out "$name, full disk"
    done
    rm -rf disk/*
    cp -r old-run disk/out
    keep disk/out
    mount -o remount,ro disk
    with run disk/out
    says 1 'Read-only file system' "${words[@]}"
    same disk/out 'read-only disk'
    says 1 'Read-only file system' report disk/out
    umount disk
}

unwritable() {
    [ "$(id -u)" -ne 0 ] || return 0 # root may write anywhere
    mkdir -p locked
    chmod a-w locked
    says 1 'cannot write into the folder' run "$bar" --set "$long" --out locked
    says 1 'cannot create the folder' run "$bar" --set "$long" --out locked/below
}

await_result() { # PROCESS, a study that writes into part/
    for _ in $(seq 1000); do
        ls part/cases/*.case >/dev/null 2>&1 && return 0
        kill -0 "$1" 2>/dev/null || return 1
        sleep 0.02
    done
    return 1
}

# Runs are kept; the same command goes on once the scene is back, and ends as an undisturbed one.
vanished() {
    cp "$bar" scene.yaml
    small_study scene.yaml >study.yaml
    says 2 'cannot be read' run none.yaml
    says 2 'cannot be read' study none.yaml
    "$bough" study study.yaml --out part --threads 1 --quiet >/dev/null 2>stderr &
    process=$!
    await_result $process || fail 'the study began'
    mv scene.yaml away.yaml
    wait $process
    code=$?
    [ $code -eq 1 ] || fail "vanished scene: exit code $code, expected 1"
    grep -q 'has changed or disappeared' stderr || fail "vanished scene: $(head -c 300 stderr)"
    rm -rf kept
    cp -r part/cases kept
    grep -q '^outcome [1-9]' kept/*.case && fail 'vanished scene: stored as a result'
    mv away.yaml scene.yaml
    says 0 '' study study.yaml --out part --threads 1 --quiet
    for result in kept/*.case; do
        cmp "$result" "part/cases/${result#kept/}" || fail 'vanished scene: runs were lost'
    done
    [ "$(grep -l macro_step= part/cases/*.case | wc -l)" -eq 6 ] || fail 'vanished scene: six cells'
}

# TERM and INT end a study after its step, KILL at once; what was done is not done again.
signals() {
    small_study scene.yaml | sed 's/duration: 0.5 s/duration: 1 s/' >study.yaml # a second after its first run
    for signal in INT TERM KILL; do
        rm -rf part
        "$bough" study study.yaml --out part --threads 1 --quiet >/dev/null 2>stderr &
        process=$!
        await_result $process || fail "SIG$signal: the study began"
        sleep 0.1
        kill -s $signal $process
        wait $process 2>/dev/null
        code=$?
        [ $signal = KILL ] || [ $code -eq 130 ] || fail "SIG$signal: exit code $code, expected 130"
        [ $signal = KILL ] || grep -q 'interrupted after . of 6 runs, which are kept' stderr ||
            fail "SIG$signal: $(head -c 300 stderr)"
        [ ! -e part/table.txt ] || fail "SIG$signal: a table of half a study"
    done
    says 0 '' study study.yaml --out part --threads 1 --quiet
    [ -e part/table.txt ] || fail 'killed study: no table after going on'
}

# Each bound leaves room for a little more of the program.
memory() {
    ended=0
    for megabytes in 60 120 200 240 250 260 270 280 300 400 600 1000; do
        (ulimit -v $((1024 * megabytes)) && exec timeout -k 1 20 "$bough" run "$bar" \
            --set 'simulation.duration=1 ms' --set bodies[0].rod.segments=2000 \
            --out out-memory >/dev/null 2>stderr)
        code=$?
        case $code in
        0) break ;;
        1) grep -q 'memory' stderr || fail "$megabytes MB: $(head -c 300 stderr)"
           ended=$((ended + 1)) ;;
        127) ;; # not enough to load the libraries
        *) fail "$megabytes MB: exit code $code: $(head -c 300 stderr)" ;;
        esac
    done
    [ $code -eq 0 ] && [ $ended -gt 1 ] || fail "memory: exit code $code, ended $ended times"
}

earlier
full
mounted
unwritable
vanished
signals
# A sanitizer reserves more addresses than any bound; test_exhausted does what it can there.
(ulimit -v 400000 && "$bough" --version >/dev/null 2>&1) && memory
[ $failures -eq 0 ] && echo 'all ends were clear'
exit $((failures > 0))
