#!/bin/sh
# Threads change no byte of the results, and under the thread sanitizer there is no race:
# test_threads.sh PROGRAM SOURCE_FOLDER. Every scheme, every sub-solver, what hangs on rods, the air.
set -u
bough=$1
turbine=$2/apps/turbine/runup.yaml
land=$2/apps/turbine/land.yaml
power=$2/apps/turbine/power.yaml
rod=$2/tests/data/scenes/free-rod.yaml
. "$(dirname "$0")/scratch.sh"
unset OMP_NUM_THREADS OMP_THREAD_LIMIT

# run OUT ARGUMENT...: whole runs only; a sanitizer's report makes the exit code another.
run() {
    out=$1
    shift
    "$bough" run "$@" --out "$out" --quiet >log 2>&1 && return
    fail "bough run $*"
    head -n 60 log
}

# same SCENE DURATION SET...: 1, 2, 3 and 8 threads write the same channels.
same() {
    scene=$1 duration=$2
    shift 2
    for set in "$@"; do
        shift
        set -- "$@" --set "$set"
    done
    for n in 1 2 3 8; do
        run out$n "$scene" --threads $n --set "simulation.duration=$duration" \
            --set simulation.error_bound=0 "$@"
        grep -q "\"threads\": $n," out$n/summary.json || fail "$n threads are not in the summary"
        cmp out1/channels.out out$n/channels.out || fail "1 and $n threads differ: $scene $*"
        for out in out1 out$n; do sed -n '/"error": {/,/"statistics_from"/p' $out/summary.json >$out/errors; done
        cmp out1/errors out$n/errors || fail "errors by 1 and $n threads differ: $scene $*"
    done
    [ "$(wc -l <out1/channels.out)" -ge 10 ] || fail "too few rows to compare: $scene $*"
}

few='bodies[3-5].rod.segments=16'
same "$turbine" '0.3 s'
schemes=$("$bough" help coupling | sed -n 's/^  \([a-z-]*\)  *[a-z].*/\1/p')
[ "$(echo "$schemes" | wc -w)" -ge 5 ] || fail "schemes: $schemes"
for scheme in $schemes; do
    same "$turbine" '20 ms' "$few" "simulation.coupling.scheme=$scheme" 'simulation.macro_step=1 ms' \
        'aero.rate=500 Hz'
done
for solver in ida cvode-bdf arkode-esdirk generalized-alpha rosenbrock; do
    same "$turbine" '40 ms' "$few" "simulation.master.solver=$solver" \
        'simulation.coupling.scheme=monolithic' 'simulation.macro_step=4 ms' 'aero.rate=250 Hz'
    same "$turbine" '0.1 s' "$few" "simulation.micro.solver=$solver" 'simulation.macro_step=10 ms' \
        'aero.rate=100 Hz'
done
same "$turbine" '40 ms' "$few" 'simulation.coupling={scheme: iterated, exchange: waveform,
    accelerator: interface-newton}' 'simulation.macro_step=4 ms' 'aero.rate=250 Hz'
same "$turbine" '0.2 s' "$few" 'simulation.step_control.tolerance=1e-3'
same "$turbine" '0.2 s' "$few" 'bodies[3].fidelity=modal' 'bodies[4].fidelity=segmented-modal'
same "$land" '0.2 s'
same "$power" '0.2 s' 'aero.dynamic_stall=hgm'

# A single rod: the companion beside it has a thread of its own.
same "$rod" '0.5 s'

# Where neither the scene nor the command says a number, OpenMP's environment does.
of_environment() {
    run out "$turbine" --set 'simulation.duration=40 ms' --set simulation.threads=0 --set simulation.error_bound=0
    grep -q "\"threads\": $1," out/summary.json || fail "the environment's number of threads, $1"
}
of_environment 1
export OMP_NUM_THREADS=3
of_environment 3
export OMP_THREAD_LIMIT=2
of_environment 2

# With places, which OpenMP takes from /sys, each of two threads is bound to its own; by themselves they are
# not bound.
places() {
    OMP_DISPLAY_AFFINITY=true OMP_AFFINITY_FORMAT='on %A' "$bough" run "$turbine" --quiet --out out \
        --set 'simulation.duration=40 ms' --set simulation.threads=0 2>&1 | grep '^on ' | sort -u | wc -l
}
unset OPENBLAS_NUM_THREADS
if [ "$(nproc)" -ge 2 ] && [ -d /sys/devices/system/cpu/cpu0/topology ]; then
    [ "$(places)" -eq 1 ] || fail "threads are bound although nobody asked"
    [ "$(OMP_PLACES=threads places)" -eq 2 ] || fail "two threads share a place of OMP_PLACES"
    # Not OMP_PROC_BIND alone: some runtimes then take cores as places, which two CPUs may share.
    [ "$(OMP_PLACES=threads OMP_PROC_BIND=primary places)" -eq 1 ] || fail "OMP_PROC_BIND changes no place"
fi

[ "$failures" -eq 0 ] || exit 1
echo "threads change nothing"
