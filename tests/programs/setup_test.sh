#!/usr/bin/env bash
# Tests that the scripts report in one line what an unsuitable system lacks: setup_test.sh SOURCES
set -euo pipefail

sources=$1
folder=$(mktemp -d)
trap 'rm -r "$folder"' EXIT

# expect NAME STATUS TEXT COMMAND...: fails unless COMMAND prints one line with TEXT and exits with STATUS.
expect() {
  local out status=0
  out=$("${@:4}" 2>&1) || status=$?
  if [[ $status != "$2" || $out != *"$3"* || $out == *$'\n'* ]]; then
    echo "$1: status $status, not $2, or not one line with '$3': $out" >&2
    exit 1
  fi
}

bash=$(command -v bash)
expect "no apt-get" 1 "for Debian 12, Debian 13 and Ubuntu 24.04, and here is no apt-get" \
  env PATH="$folder" "$bash" "$sources/host/tools/install_packages.sh" build

printf '#!%s\necho "clang-format version 19.1.7"\n' "$bash" > "$folder/clang-format"
chmod +x "$folder/clang-format"
for command in git dirname; do ln -s "$(command -v $command)" "$folder/"; done
expect "another clang-format" 1 "it takes clang-format 14" env PATH="$folder" "$bash" "$sources/tests/format.sh"

# A compiler that claims to be GCC 11.
printf '#!%s\nexec c++ -U__GNUC__ -D__GNUC__=11 -Wno-builtin-macro-redefined "$@"\n' "$bash" > "$folder/c++-11"
chmod +x "$folder/c++-11"
out=$(cmake -S "$sources" -B "$folder/build" -G Ninja -DCMAKE_CXX_COMPILER="$folder/c++-11" 2>&1) && exit 1
[[ $(tr -s ' \n' ' ' <<<"$out") == *"it must be GCC 12, Clang 19 or later"* ]] || { echo "GCC 11: $out" >&2; exit 1; }
