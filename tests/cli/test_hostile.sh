#!/bin/bash
# Input meant to harm: every file is refused with exit code 2 and a message, in bounded memory and
# processor time. test_hostile.sh BOUGH SOURCE
set -u
bough=$1 source=$2
failures=0
scratch=$(mktemp -d)
trap 'rm -rf "$scratch"' EXIT
cp "$source"/tests/data/scenes/example-*.yaml "$scratch"
cd "$scratch" || exit 1
export OPENBLAS_NUM_THREADS=1

# A sanitizer reserves more addresses than any bound; it counts pages itself.
memory=400000
(ulimit -v $memory && "$bough" --version >/dev/null 2>&1) || memory=unlimited
export ASAN_OPTIONS=hard_rss_limit_mb=1200:detect_leaks=0

# refused MESSAGE ARGUMENT...
refused() {
    message=$1
    shift
    (
        ulimit -t 20
        ulimit -v $memory
        "$bough" "$@" >stdout 2>stderr
    )
    code=$?
    if [ $code -ne 2 ] || ! grep -q -e "$message" stderr || [ "$(wc -c <stderr)" -gt 100000 ]; then
        echo "FAILED: bough $*: exit code $code, expected 2 and '$message':"
        head -c 400 stderr
        failures=$((failures + 1))
    fi
}

repeat() { yes "$2" 2>/dev/null | head -n "$1" | tr -d '\n'; } # N TEXT

# What every file in YAML must withstand, given as scene, study, foreign turbine, and table of a scene.
yaml() { # MESSAGE FILE
    refused "$1" check "$2"
    refused "$1" study "$2"
    refused . import windio "$2" --out imported
    for key in aero.blade aero.polars 'bodies[3].rod.table'; do
        refused "$1" check example-turbine.yaml --set "$key=$2"
    done
}
repeat 100000 '[' >nest.yaml
yaml 'nesting is deeper' nest.yaml
{
    echo 'a0: &a0 [x, x, x, x, x, x, x, x, x, x]'
    for i in 1 2 3 4 5 6 7 8 9; do
        k=$((i - 1))
        echo "a$i: &a$i [*a$k, *a$k, *a$k, *a$k, *a$k, *a$k, *a$k, *a$k, *a$k, *a$k]"
    done
} >bomb.yaml
yaml 'aliases expand to more than' bomb.yaml
printf 'title: a\0b\n' >nul.yaml
yaml 'control character' nul.yaml
head -c 104857600 /dev/zero >large.yaml # a hole where the file system has them
yaml 'larger than 16 MB' large.yaml
seq -f 'k%.0f: 1' 200000 >keys.yaml
yaml 'unknown key' keys.yaml
{ printf 'title: '; head -c 8000000 /dev/zero | tr '\0' 'x'; } >line.yaml
yaml 'error' line.yaml
printf 'bodies: [{name: "a' >cut.yaml
yaml 'the text that this quote opens has no end' cut.yaml

# A few lines that ask for much.
rod='joint: {kind: fixed, parent: ground}, rod: {length: 1, segments: 10000, stiffness: [1, 1, 1, 1, 1, 1], mass: [1, 0, 0, 1, 1, 0]}'
{
    echo 'simulation: {duration: 1 s, macro_step: 10 ms}'
    echo "bodies: [{name: a, fidelity: rod, repeat: 10000, $rod}]"
} >much.yaml
refused 'expected at most 10000 bodies and 1000000 segments' check much.yaml

# Numbers that nobody waits for.
beam=example-beam.yaml
for times in 'duration=1e15' 'macro_step=1e-10' 'macro_step=1e-300' 'macro_step=1e6' 'micro.step=1e6' \
    'output.frames=1e-300' 'output.interval=1e-300'; do
    refused "simulation.${times%%=*}: " check $beam --set "simulation.$times"
done
refused 'longer than the run' run $beam --checkpoint '1e300 s' --out endless
[ ! -e endless ] || { echo 'FAILED: --checkpoint 1e300 wrote something'; failures=1; }

# What is no plain file is refused at once, whoever should read it.
mkdir folder
mkfifo pipe
ln -s /dev/zero zero
for input in pipe zero folder; do
    yaml 'cannot be read\|holds no scene' $input
    refused 'cannot open the wind file\|cannot be read' check example-turbine.yaml --set "aero.wind={kind: bts, file: $input}"
    refused 'cannot open the wind file\|cannot be read' check example-turbine.yaml --set "aero.wind={kind: wnd, file: $input, reference_height: 90, reference_length: 126}"
    refused 'cannot read' import openfast $input --out imported
    refused 'cannot open the wind file' import openfast "$source/tests/data/decks/main.fst" --wind $input --out imported
    refused 'cannot be loaded' check "$source/apps/turbine/power.yaml" --set "control={kind: bladed, library: $PWD/$input}"
done
# A directory whose scenes are none, one of them a pipe that nobody writes to.
mkdir many
mkfifo many/pipe.yaml
refused "'many' holds no scene" check many
printf 'base: ../pipe\n' >many/scene.yaml
refused 'not a file to build on' check many/scene.yaml
mkdir ends
for own in channels.out checkpoint.bin channels.out.partial; do
    ln -s ../pipe "ends/$own"
    case $own in
    channels.out) words=(report ends) ;;
    checkpoint.bin) words=(run "$beam" --resume --out ends) ;;
    *) words=(run "$beam" --out ends) ;;
    esac
    timeout 20 "$bough" "${words[@]}" >stdout 2>stderr </dev/null
    code=$?
    [ $code -eq 1 ] || { echo "FAILED: ${words[*]}: exit code $code, expected 1: $(head -c 300 stderr)"; failures=1; }
    rm "ends/$own"
done

# Winds. A hub-height file of many rows, an endless line, bytes; a box that promises too much.
wind() { # MESSAGE KIND FILE
    refused "$1" check example-turbine.yaml --set "aero.wind={kind: $2, file: $3}"
}
seq -f '%.0f 8 0 0 0 0 0 0' 1000001 >rows.wnd
wind 'more than 1000000 rows' "wnd, reference_height: 90, reference_length: 126" rows.wnd
wind 'line is too long' "wnd, reference_height: 90, reference_length: 126" line.yaml
wind 'line is too long' "wnd, reference_height: 90, reference_length: 126" large.yaml
wind 'expected 8 or 9 numbers' "wnd, reference_height: 90, reference_length: 126" cut.yaml
printf '\010\000\377\377\377\000\377\377\377\000\000\000\000\000\377\377\377\000' >head.bts
{ cat head.bts; head -c 100 "$source/tests/fuzz/corpus/wind/plain.bts" | tail -c 82; } >promise.bts
wind 'is damaged\|out of range' bts promise.bts
wind 'is shorter than a head' bts head.bts
wind 'must begin with 7 or 8' bts large.yaml
head -c 200 "$source/tests/fuzz/corpus/wind/plain.bts" >cut.bts
wind 'is damaged' bts cut.bts

# A model of OpenFAST.
for file in large.yaml nul.yaml keys.yaml line.yaml; do
    refused . import openfast $file --out imported
done
cp -r "$source/tests/data/decks" model
refused . import openfast model/parts/blade.dat --out imported
head -c 300 "$source/tests/data/decks/parts/elasto.dat" >model/parts/elasto.dat
refused 'elasto.dat' import openfast model/main.fst --out imported
cp large.yaml model/parts/beam-blade.dat
cp "$source/tests/data/decks/parts/elasto.dat" model/parts
refused 'beam-blade.dat' import openfast model/main.fst --out imported
[ ! -e imported ] || { echo 'FAILED: a scene was written'; failures=1; }

# A results folder.
mkdir results
cp large.yaml results/channels.out
refused 'channels.out' report results
cp "$source/tests/fuzz/corpus/report/channels.out" results
printf '1e999\t1\t2\n' >>results/channels.out
refused 'not a row of its columns' report results
cp "$source/tests/fuzz/corpus/report/channels.out" results
echo '1' >>results/channels.out
refused 'not a row of its columns' report results
[ ! -e results/report.html ] || { echo 'FAILED: a report was written'; failures=1; }
[ $failures -eq 0 ] && echo "all refused within ${memory} kB"
exit $((failures > 0))
