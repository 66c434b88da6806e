#!/bin/sh
# Wind by name and load sets as a user meets them: test_loads.sh PROGRAM SOURCE_FOLDER CONTROLLER
set -u
bough=$1 source=$2 controller=$3
power=$source/apps/turbine/power.yaml
. "$(dirname "$0")/scratch.sh"

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

# -- sweeps and load sets --------------------------------------------------------------------------

# study CODE PATTERN ARGUMENT...: bough study, whose words are then in ./log
study() {
    code=$1 pattern=$2
    shift 2
    says "$code" "$pattern" study "$@" --quiet
    cat stdout stderr >log
}

# same FOLDER FOLDER: all that follows from the cases, to the bit.
same() {
    for table in cases.csv equivalent.csv extremes.csv ranges.csv levels.csv table.txt plot.svg; do
        cmp "$1/$table" "$2/$table" || fail "$1 and $2 differ in $table"
    done
}

cat >sweep.yaml <<END
title: two speeds
kind: sweep
scene: $power
common: {simulation.duration: 3 s}
from: 1 s
channels: [RotSpeed, GenPwr]
series: true
grid:
  aero.wind.speed: [8, 10 m/s]
  aero.air_density: [1.1, 1.225]
END
study 0 '4 runs, 0 failed' sweep.yaml --out sweep
head -n 1 sweep/cases.csv | grep -q '^case,aero.wind.speed,aero.air_density,outcome,RotSpeed min \[rpm\]' ||
    fail "head of cases.csv: $(head -n 1 sweep/cases.csv)"
# The estimate decides here, too.
sed 's/duration: 3 s/duration: 1.5 s, simulation.error_bound: 1e-9/' sweep.yaml >beyond.yaml
study 3 '4 of 4 runs failed' beyond.yaml --out beyond
grep -q 'error bound 1e-09 is exceeded' log || fail "cases beyond their error bound: $(cat log)"
# The statistics of a case are those of the same run alone.
"$bough" run "$power" --set simulation.duration="3 s" --set aero.wind.speed=10 --set aero.air_density=1.225 \
    --set simulation.output.from="1 s" --threads 1 --out alone --quiet >log || fail "run alone: $(cat log)"
awk -F, '$1 == 4 { printf "%.8g %.8g %.8g %.8g\n", $5, $6, $7, $8 }' sweep/cases.csv >of-sweep
awk '/"statistics"/ { on = 1 } on && /"RotSpeed"/ { found = 1 }
    found && /"(min|max|mean|std)"/ { gsub(/[",]/, ""); printf "%s%.8g", n++ ? " " : "", $2 }
    n == 4 { print ""; exit }' alone/summary.json >of-run
# eight digits of each
paste -d' ' of-sweep of-run |
    awk 'NF == 8 { good = 1; for (i = 1; i <= 4; i++) if (($i / $(i + 4) - 1) ^ 2 > 1e-14) good = 0 }
        END { exit !good }' ||
    fail "statistics: $(cat of-sweep) in the sweep, $(cat of-run) alone"
cmp sweep/cases/000004/channels.out alone/channels.out >/dev/null
tail -n 1 sweep/cases/000004/channels.out >a && tail -n 1 alone/channels.out >b && cmp a b || fail "series differ"
# A binary series stands in place of the text and has the same rows.
sed 's/duration: 3 s/duration: 3 s, simulation.output.binary: true/; s/\[8, 10 m/[10 m/; s/\[1.1, /[/' sweep.yaml >binary.yaml
study 0 '1 runs, 0 failed' binary.yaml --out binary
[ ! -e binary/cases/000001/channels.out ] || fail "a binary series leaves the text"
"$bough" run "$power" --set simulation.duration="3 s" --set aero.wind.speed=10 --set aero.air_density=1.225 \
    --set simulation.output.binary=true --threads 1 --out alone --quiet >log || fail "binary alone: $(cat log)"
tail -c 4096 binary/cases/000001/channels.outb >a && tail -c 4096 alone/channels.outb >b && cmp a b ||
    fail "binary series differ"
"$bough" report sweep >log || fail "report of a sweep: $(cat log)"

cat >set.yaml <<END
title: a small load set
kind: load-set
scene: $power
from: 1 s
channels: [RotSpeed, RootMyb1, RootMxb1]
slopes: [4, 10]
wind: {average: 10 m/s}
common: {simulation.duration: 3 s, aero.wind.kind: iec, aero.wind.reference_height: 90,
         aero.wind.points: 5, aero.wind.time_step: 0.2}
cases:
  - name: DLC1.2
    set: {aero.wind.condition: ntm}
    weibull: 0.95
    grid: {aero.wind.speed: [8, 12, 16], aero.wind.seed: [1, 2]}
  - name: DLC1.3
    set: {aero.wind.condition: etm}
    grid: {aero.wind.speed: [8, 16]}
  - name: DLC1.5
    set: {aero.wind.condition: ews, aero.wind.start: 1 s}
    events: 100
    factor: 1.1
    grid: {aero.wind.shear: [vertical, horizontal], aero.wind.speed: [16]}
END
study 0 '10 cases' set.yaml --out whole
study 0 'simulated hours per core hour' set.yaml --out one --threads 1
same whole one
for part in 2 3 1; do study 0 "part $part of 3: " set.yaml --out parts --part $part/3; done
study 0 '10 cases' set.yaml --out parts
grep -q 'ran ' log && fail "cases of parts were run again"
same whole parts
if parallel --version 2>/dev/null | grep -q 'GNU parallel'; then
    seq 3 | parallel -j 2 "$bough" study set.yaml --out jobs --threads 1 --quiet --part {}/3 >log 2>&1 ||
        fail "GNU parallel: $(cat log)"
    study 0 '10 cases' set.yaml --out jobs
    grep -q 'ran ' log && fail "cases of GNU parallel's jobs were run again"
    same whole jobs
fi

# The one case in twenty with a companion, the first, states errors; companions change no load.
grep -q '^errors estimated from the companions of 1 case' whole/table.txt || fail "errors: $(head -n 4 whole/table.txt)"
sed 's/^from/companions: none\n&/' set.yaml >unknown.yaml
study 0 'errors not estimated: companions: none' unknown.yaml --out unknown
loads() { cut -d, -f1-4,7 "$1/equivalent.csv"; }
[ "$(loads whole)" = "$(loads unknown)" ] || fail "companions change equivalent loads: $(loads whole; loads unknown)"
[ "$(awk -F, 'NR > 1 && $5 == "nan" && $6 == "nan"' unknown/equivalent.csv | wc -l)" -eq 3 ] ||
    fail "errors without companions: $(cat unknown/equivalent.csv)"

# Errors of equivalent loads, estimated by companions of all cases, beside a solution with a third of the segments' length,
# a quarter of the step and half the sampling time.
errors_of() {
    cat <<END
kind: load-set
scene: $power
from: 4 s
companions: $1
channels: [RootMyb1, RootMxb1, RootMzb1]
slopes: [4, 10]
wind: {average: 10 m/s}
common: {simulation.duration: 16 s, simulation.output.interval: 20 ms, simulation.master.rtol: 4.5e-3,
         aero.wind: {kind: iec, condition: ntm, reference_height: 90, points: 5, time_step: 0.2}, $2}
cases:
  - name: DLC1.2
    weibull: 0.95
    grid: {aero.wind.speed: [8, 16], aero.wind.seed: [1, 2]}
END
}
errors_of all '"bodies[3-5].rod.segments": 12, simulation.master.step: 20 ms' >coarse.yaml
errors_of none '"bodies[3-5].rod.segments": 36, simulation.master.step: 5 ms, simulation.macro_step: 10 ms,
    aero.rate: 100 Hz' >fine.yaml
study 0 'errors estimated from the companions of 4 cases' coarse.yaml --out coarse
study 0 '' fine.yaml --out fine
paste -d, coarse/equivalent.csv fine/equivalent.csv | awk -F, '
    NR > 1 { for (k = 3; k <= 4; k++) {
        true = $k - $(k + 7); if (true < 0) true = -true
        if (!($(k + 2) > true / 3 && $(k + 2) < 10 * true)) { bad = 1; print $1, "estimate", $(k + 2), "true", true > "/dev/stderr" } } }
    END { exit bad }' || fail "errors of equivalent loads"

# -- what a file says decides, not its name --------------------------------------------------------

# A controller whose gain is in its input file: results of another gain are not reused.
cp "$controller" law.so
cp "$source"/apps/turbine/*.yaml .
for gain in a b; do echo "100 ! gain" >$gain.in; done
controlled='{kind: bladed, library: law.so, input: a.in, pitch: false}'
cat >gains.yaml <<END
kind: sweep
scene: power.yaml
common: {simulation.duration: 0.5 s, control: $controlled}
channels: [GenTq]
grid:
  control.input: [a.in, b.in]
END
cat >errors.yaml <<END
kind: work-precision
scene: power.yaml
reference: {simulation.coupling.scheme: ramp}
common: {simulation.duration: 0.5 s, simulation.output.interval: 0.1 s, control: $controlled}
grid:
  control.input: [a.in, b.in]
measures: [{name: torque, channels: [GenTq]}]
END
for study in gains errors; do study 0 '' $study.yaml --out $study; done
case1=$(ls -l --time-style=full-iso gains/cases | grep 000001.case)
same_gains=$(cut -d, -f4- gains/cases.csv | sed -n 2p)
[ "$same_gains" = "$(cut -d, -f4- gains/cases.csv | sed -n 3p)" ] || fail "one gain, two results"
echo "200 ! gain" >b.in
for study in gains errors; do
    study 0 '' $study.yaml --out $study
    study 0 '' $study.yaml --out fresh-$study
done
cmp gains/cases.csv fresh-gains/cases.csv || fail "a sweep keeps results of another input file"
error() { awk -F, -v "row=$2" 'NR == 1 { for (i = 1; i <= NF; i++) if ($i ~ /^torque \[/) k = i } NR == row { print $k }' "$1/table.csv"; }
for row in 3 4; do
    [ "$(error errors $row)" = "$(error fresh-errors $row)" ] || fail "errors of run $((row - 2)) are of another input file"
done
[ "$(error errors 3)" != "$(error errors 4)" ] || fail "twice the gain changes no error"
[ "$case1" = "$(ls -l --time-style=full-iso gains/cases | grep 000001.case)" ] || fail "case 1 was run again"
[ "$same_gains" != "$(cut -d, -f4- gains/cases.csv | sed -n 3p)" ] || fail "twice the gain changes nothing"

# -- workers ---------------------------------------------------------------------------------------

# Two workers at once do each case once; one is killed, and the next goes on where it was.
"$bough" study set.yaml --out shared --threads 1 --quiet >first 2>&1 &
first=$!
"$bough" study set.yaml --out shared --threads 1 --quiet >second 2>&1
wait $first || fail "first worker: $(cat first)"
ran=$(sed -n 's/^ran \([0-9]*\) cases.*/\1/p' first second | awk '{ n += $1 } END { print n }')
[ "$ran" = 10 ] || fail "two workers ran $ran cases, not 10: $(cat first second)"
study 0 '10 cases' set.yaml --out shared
same whole shared
"$bough" study set.yaml --out killed --threads 1 --quiet >first 2>&1 &
first=$!
until [ -e killed/cases/000002.case ]; do sleep 0.05; done
kill -KILL $first
wait $first 2>/dev/null
study 0 '10 cases' set.yaml --out killed
ran=$(sed -n 's/^ran \([0-9]*\) cases.*/\1/p' log)
[ "$ran" -le 8 ] || fail "a killed worker's cases were run again: $ran"
same whole killed

# A damaged result is reported, not taken for a missing one.
cp -r whole damaged && head -n 5 whole/cases/000003.case >damaged/cases/000003.case
study 1 'cases/000003.case.*is damaged: remove it' set.yaml --out damaged
rm damaged/cases/000003.case
study 0 'ran 1 case,' set.yaml --out damaged
same whole damaged

# A case that fails is reported, the others go on, and the result says what it lacks.
sed 's/speed: \[8, 16\]/speed: [8], simulation.error_bound: [0, 1e-12]/;s/^from/companions: all\n&/' set.yaml >failing.yaml
study 3 'case 8 failed (DLC1.3, speed=8, error_bound=1e-12)' failing.yaml --out failing
grep -q "bough run .*--set aero.wind.speed=8 --set simulation.error_bound=1e-12" log || fail "no command line of the failed case: $(cat log)"
grep -q '1 of 10 cases failed: the lifetime result is incomplete' log || fail "not called incomplete: $(cat log)"
grep -q '^INCOMPLETE: 1 case failed' failing/table.txt || fail "table: $(head -n 4 failing/table.txt)"
[ "$(grep -c ',ok,' failing/cases.csv)" -eq 9 ] || fail "the other cases were not run"

# A case that passes a limit of the models is warned of, when it runs and when it is read again.
cat >pulse.yaml <<END
kind: sweep
scene: $power
common:
  simulation.duration: 2 s
  aero.wind: {kind: uniform, table: {times: [0, 1.021, 1.024, 1.027], speeds: [10, 10, 60, 10]}}
channels: [RotSpeed]
grid:
  aero.air_density: [1.1, 1.225]
END
for call in first second; do
    study 0 'case 2 (sweep, air_density=1.225): warning: .*the wind changes by 50 m/s and back between two samples' \
        pulse.yaml --out pulse
done
[ "$(grep -c 'the wind changes by' pulse/cases.csv)" -eq 2 ] || fail "warnings in cases.csv: $(cat pulse/cases.csv)"

# Bad input, before anything runs.
refused() {
    message=$1
    shift
    sed "$@" set.yaml >bad.yaml
    study 2 "$message" bad.yaml --out none
    [ -e none ] && fail "bad input wrote results: $*"
}
refused "'1' is given twice" 's/seed: \[1, 2\]/seed: [1, 2, 1]/'
refused 'expected a list of values' 's/seed: \[1, 2\]/seed: []/'
refused 'expected keys of the scene' 's/grid: {aero.wind.speed: \[8, 16\]}/grid: {}/'
refused "'DLC1.2' is given twice" 's/DLC1.3/DLC1.2/'
refused "did you mean 'RootMyb1'" 's/RootMyb1/RootMyb4/'
refused 'at least two rising speeds' 's/\[8, 12, 16\]/[12]/'
refused 'is not before the end' 's/from: 1 s/from: 5 s/'
refused "expected '1 in N'" 's/^from/companions: some\n&/'
refused 'unknown key' 's/wind.seed/wind.seeds/'
refused 'at most one of' 's/events: 100/events: 100, hours: 2/;s/    events: 100, /    events: 100\n    /'
study 2 "no load case 'DLC1.4' (did you mean 'DLC1.[2-5]'" set.yaml --out none --case DLC1.4
study 0 '' set.yaml --out chosen --case DLC1.5
[ "$(ls chosen/cases/*.case | wc -l)" -eq 2 ] || fail "--case ran $(ls chosen/cases)"

[ "$failures" -eq 0 ]
