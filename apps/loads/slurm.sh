#!/bin/sh
# A load set or sweep as a Slurm array: each task runs the cases of its share that nobody has run yet.
#   sbatch --array=1-40 apps/loads/slurm.sh STUDY DIR
#   bough study STUDY --out DIR          # when the array is done: the tables
# A share has many cases, so that the queue is not the cost. A task that was killed is sent again with the
# number of shares: SHARES=40 sbatch --array=7 apps/loads/slurm.sh STUDY DIR
# Without Slurm, by GNU parallel: seq 8 | parallel bough study STUDY --out DIR --threads 1 --part {}/8
#SBATCH --ntasks=1
#SBATCH --cpus-per-task=1
#SBATCH --mem-per-cpu=200M
#SBATCH --requeue
set -eu
exec "${BOUGH:-bough}" study "$1" --out "$2" --quiet --threads "${SLURM_CPUS_PER_TASK:-1}" \
    --part "$SLURM_ARRAY_TASK_ID/${SHARES:-$SLURM_ARRAY_TASK_MAX}"
