#!/bin/bash
# A load set on a real Slurm, started here for the test: one controller, two nodes of this machine, an
# array of tasks, one of them killed. Skipped where Slurm is not installed: exit code 77.
# test_slurm.sh BOUGH SOURCE
set -u
bough=$1 source=$2
for program in munged slurmctld slurmd sbatch squeue; do
    command -v $program >/dev/null || PATH=$PATH:/usr/sbin:/sbin
    command -v $program >/dev/null || { echo "skipped: no $program (Debian: slurm-wlm munge)"; exit 77; }
done
[ "$(id -u)" -eq 0 ] || { echo "skipped: slurmd starts tasks as root only"; exit 77; }
slurmd -V >/dev/null 2>&1 || { echo "skipped: slurmd does not start"; exit 77; }

scratch=$(mktemp -d)
chmod 755 "$scratch"
daemons=()
finish() {
    [ -s "$scratch/slurm.conf" ] && scancel --state=RUNNING --quiet 2>/dev/null
    for ((i = ${#daemons[@]} - 1; i >= 0; i--)); do kill "${daemons[i]}" 2>/dev/null; done
    wait 2>/dev/null
    rm -rf "$scratch"
}
trap finish EXIT
fail() {
    echo "FAILED: $*"
    tail -n 20 "$scratch"/*.log "$scratch"/slurm-*.out 2>/dev/null
    exit 1
}

# -- a cluster -------------------------------------------------------------------------------------

host=$(hostname -s)
base=$((20000 + $$ % 20000))
mkdir "$scratch/munge" "$scratch/state" "$scratch/spool-one" "$scratch/spool-two"
head -c 1024 /dev/urandom >"$scratch/munge/key"
chmod 700 "$scratch/munge"
chmod 400 "$scratch/munge/key"
munged --foreground --force --key-file="$scratch/munge/key" --socket="$scratch/munge/socket" \
    --pid-file="$scratch/munge/pid" --log-file="$scratch/munge.log" --seed-file="$scratch/munge/seed" \
    >"$scratch/munged.log" 2>&1 &
daemons+=($!)

export SLURM_CONF=$scratch/slurm.conf
cat >"$SLURM_CONF" <<END
ClusterName=test
SlurmctldHost=$host(127.0.0.1)
SlurmUser=root
SlurmctldPort=$base
AuthType=auth/munge
AuthInfo=socket=$scratch/munge/socket
CryptoType=crypto/munge
StateSaveLocation=$scratch/state
SlurmdSpoolDir=$scratch/spool-%n
SlurmctldPidFile=$scratch/slurmctld.pid
SlurmdPidFile=$scratch/slurmd-%n.pid
SlurmctldLogFile=$scratch/slurmctld.log
SlurmdLogFile=$scratch/slurmd-%n.log
ProctrackType=proctrack/linuxproc
TaskPlugin=task/none
JobAcctGatherType=jobacct_gather/none
AccountingStorageType=accounting_storage/none
SelectType=select/cons_tres
SelectTypeParameters=CR_CPU
SchedulerType=sched/backfill
SchedulerParameters=batch_sched_delay=0,sched_interval=1,sched_min_interval=100000,requeue_delay=0
SwitchType=switch/none
MpiDefault=none
ReturnToService=2
MinJobAge=300
NodeName=one NodeHostname=$host NodeAddr=127.0.0.1 Port=$((base + 1)) CPUs=2 RealMemory=1000 State=UNKNOWN
NodeName=two NodeHostname=$host NodeAddr=127.0.0.1 Port=$((base + 2)) CPUs=2 RealMemory=1000 State=UNKNOWN
PartitionName=all Nodes=one,two Default=YES MaxTime=INFINITE State=UP
END
sleep 0.5
slurmctld -D >"$scratch/ctl.log" 2>&1 &
daemons+=($!)
for node in one two; do
    slurmd -D -N $node >"$scratch/$node.log" 2>&1 &
    daemons+=($!)
done
for ((i = 0; i < 100; i++)); do
    [ "$(sinfo -h -o %D -t idle 2>/dev/null)" = 2 ] && break
    sleep 0.2
done
[ "$(sinfo -h -o %D -t idle 2>/dev/null)" = 2 ] || fail "the nodes are not up: $(sinfo 2>&1)"

# -- an array, one task of it killed ---------------------------------------------------------------

cat >"$scratch/set.yaml" <<END
title: on Slurm
kind: load-set
scene: $source/apps/turbine/power.yaml
from: 1 s
channels: [RotSpeed, RootMyb1]
slopes: [4, 10]
wind: {average: 10 m/s}
common: {simulation.duration: 20 s, aero.wind.kind: iec, aero.wind.condition: ntm,
         aero.wind.reference_height: 90, aero.wind.points: 5, aero.wind.time_step: 0.2}
cases:
  - name: DLC1.2
    weibull: 1
    grid: {aero.wind.speed: [6, 10, 14], aero.wind.seed: [1, 2, 3, 4]}
END
export BOUGH=$bough OPENBLAS_NUM_THREADS=1
cd "$scratch" || exit 1
submit() { sbatch --parsable --chdir="$scratch" --output="$scratch/slurm-%A_%a.out" --export=ALL "$@" \
    "$source/apps/loads/slurm.sh" "$scratch/set.yaml" "$scratch/out"; }
drain() {
    for ((i = 0; i < 600; i++)); do
        [ -z "$(squeue -h)" ] && return
        sleep 0.2
    done
    fail "the queue does not empty: $(squeue)"
}
job=$(submit --array=1-4) || fail "sbatch: $job"
for ((i = 0; i < 300; i++)); do
    ls out/cases/*.case >/dev/null 2>&1 && break
    sleep 0.1
done
scancel --signal=KILL "${job}_2" || echo "note: the task to kill had already ended"
drain
before=$(ls out/cases/*.case | wc -l)
[ "$before" -lt 12 ] || echo "note: the killed task had already ended"
SHARES=4 submit --array=2 >/dev/null || fail "the killed task cannot be sent again"
drain
[ "$(ls out/cases/*.case | wc -l)" -eq 12 ] || fail "$(ls out/cases) of 12 cases"
"$bough" study set.yaml --out out --quiet >last 2>&1 || fail "tables: $(cat last)"
grep -q '^ran' last && fail "cases were run again: $(cat last)"
"$bough" study set.yaml --out alone --quiet >/dev/null || fail "the same without Slurm"
for table in equivalent.csv extremes.csv cases.csv ranges.csv levels.csv; do
    cmp out/$table alone/$table || fail "Slurm gives another $table"
done
echo "$before of 12 cases before the killed task was sent again, then all; tables as computed at once"
