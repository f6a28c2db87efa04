#!/usr/bin/env bash
# Merges all shards into FILE.nc and then removes them: merge.sh FILE.nc SHARDS. It is the last job of submit.sh.
set -euo pipefail

file=$1 shards=$2
parts=()
for ((i = 1; i <= shards; ++i)); do parts+=("${file%.*}.$i-of-$shards.${file##*.}"); done
"${DOLP:-dolp}" merge "${parts[@]}" -o "$file"
rm -- "${parts[@]}"
