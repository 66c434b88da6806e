#!/bin/sh
# Spreads a study of kind stability over processes or machines that share a file system.
#   apps/studies/spread.sh STUDY N DIR        N workers on this machine (GNU parallel where there is one)
#   sbatch --array=1-N apps/studies/spread.sh STUDY N DIR
#                                             one worker for each task of a Slurm array; afterwards
#                                             `bough study STUDY --out DIR` collects
# BOUGH names the program, build/release/bough unless set. Workers run whole groups of cells that share
# a reference, with one thread each, and may be stopped and started again.
set -eu
[ $# -eq 3 ] || { sed -n '2,9s/^# \{0,1\}//p' "$0"; exit 2; }
study=$1 n=$2 dir=$3
bough=${BOUGH:-build/release/bough}

if [ -n "${SLURM_ARRAY_TASK_ID:-}" ]; then
    exec "$bough" study "$study" --out "$dir" --threads 1 --quiet --part "$SLURM_ARRAY_TASK_ID/$n"
fi
if command -v parallel >/dev/null 2>&1; then
    seq "$n" | parallel --jobs "$n" \
        "$bough" study "$study" --out "$dir" --threads 1 --quiet --part "{}/$n"
else
    pids=
    for k in $(seq "$n"); do
        "$bough" study "$study" --out "$dir" --threads 1 --quiet --part "$k/$n" &
        pids="$pids $!"
    done
    for pid in $pids; do wait "$pid"; done
fi
exec "$bough" study "$study" --out "$dir"
