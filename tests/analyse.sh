#!/usr/bin/env bash
# Static analysis of all C++ sources by clang-tidy: analyse.sh [BUILD]
#
# BUILD, build/release when not given, is a configured build folder with its generated headers. Prints what is found; the
# exit status is not 0 then. The checks are in .clang-tidy. Needs the package clang-tidy-16.
set -euo pipefail

root=$(cd "$(dirname "${BASH_SOURCE[0]}")/.." && pwd)
build=$(cd "${1:-$root/build/release}" && pwd)
cd "$root"
# clang cannot read the text of the shaders: aggregates initialised with parentheses.
git ls-files 'host/*.cpp' 'bench/*.cpp' 'tests/*.cpp' | grep -vE '/text/|text_[a-z]*\.cpp$' |
  xargs -P "$(nproc)" -n 1 clang-tidy-16 -p "$build" --quiet --warnings-as-errors='*' 2> /dev/null
