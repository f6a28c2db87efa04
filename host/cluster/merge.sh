#!/usr/bin/env bash
# The last job that submit.sh makes: merge.sh FILE.nc SHARDS. Removes the shards when the table is complete.
set -euo pipefail

file=$1 shards=$2
parts=()
for ((i = 1; i <= shards; ++i)); do parts+=("${file%.*}.$i-of-$shards.${file##*.}"); done
"${DOLP:-dolp}" merge "${parts[@]}" -o "$file"
rm -- "${parts[@]}"
