#!/usr/bin/env bash
# Computes one shard, as one task of submit.sh's job array: shard.sh SCENE FILE.nc [option of dolp table]...
set -uo pipefail

most_attempts=4
wrong_input=2

"${DOLP:-dolp}" table "$1" -o "$2" --shard auto --resume "${@:3}"
status=$?
attempt=$((${SLURM_RESTART_COUNT:-0} + 1))
if ((status == 0 || status == wrong_input || attempt == most_attempts)); then exit "$status"; fi
echo "shard.sh: exit status $status in attempt $attempt of $most_attempts; queued again"
scontrol requeue "$SLURM_JOB_ID"
