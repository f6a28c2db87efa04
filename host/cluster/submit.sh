#!/usr/bin/env bash
# Computes a table as a Slurm job array with one task per shard, and submits a job that merges the complete shards:
#
#   submit.sh SCENE FILE.nc SHARDS [option of dolp table]...
#
# A task that fails is queued again, up to three times, and continues where it stopped. Wrong input (exit status 2) ends
# the task at once. Prints the numbers of the two jobs.
# Environment: DOLP, the program (default dolp); SBATCH_PARTITION, SBATCH_TIMELIMIT and other variables of sbatch.
set -euo pipefail

if (($# < 3)); then
  sed -n '4p' "${BASH_SOURCE[0]}" >&2
  exit 2
fi
scene=$1 file=$2 shards=$3
here=$(cd "$(dirname "${BASH_SOURCE[0]}")" && pwd)
tasks=$(sbatch --parsable --requeue --open-mode=append --array="1-$shards" --job-name=dolp-table \
  --output="$file.%a.log" "$here/shard.sh" "$scene" "$file" "${@:4}")
merge=$(sbatch --parsable --dependency="afterok:$tasks" --kill-on-invalid-dep=yes --job-name=dolp-merge \
  --output="$file.merge.log" "$here/merge.sh" "$file" "$shards")
echo "$tasks $merge"
