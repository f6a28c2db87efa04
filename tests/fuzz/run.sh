#!/usr/bin/env bash
# Runs fuzzers on the corpus beside this script: run.sh FUZZER SECONDS [LIBFUZZER_OPTION...]
#
# FUZZER is a program or a build folder. In a folder all fuzzers run, and each gets an equal part of SECONDS. Inputs that
# break a reader are stored as crash-*, leak-*, oom-* or timeout-* in the current folder. Other new inputs are deleted.
set -euo pipefail

here=$(cd "$(dirname "${BASH_SOURCE[0]}")" && pwd)
fuzzers=("$1")
[[ -d $1 ]] && fuzzers=("$1"/tests/fuzz/fuzz_*[a-z])
seconds=$(($2 / ${#fuzzers[@]}))
shift 2
# UBSan ends the program at a finding, so that libFuzzer stores the input.
export UBSAN_OPTIONS=abort_on_error=1:print_stacktrace=1
found=$(mktemp -d)
trap 'rm -r "$found"' EXIT
for fuzzer in "${fuzzers[@]}"; do
  name=${fuzzer##*/fuzz_}
  mkdir "$found/$name"
  "$fuzzer" "$found/$name" "$here/corpus/$name" -max_total_time="$seconds" -timeout=10 -rss_limit_mb=2048 \
    -max_len=65536 -print_final_stats=1 -verbosity=0 "$@"
done
