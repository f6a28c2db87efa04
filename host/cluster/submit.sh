#!/usr/bin/env bash
# A table as a Slurm job array, one task a shard, and a job that merges the shards when all are there:
#
#   submit.sh SCENE FILE.nc SHARDS [option of dolp table]...
#
# A task that fails is queued again, up to three times, and goes on where it stopped; wrong input (exit status 2) ends
# it at once. Environment: DOLP, the program (dolp); SBATCH_..., what sbatch reads (SBATCH_PARTITION, SBATCH_TIMELIMIT).
# Prints the numbers of the two jobs.
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
