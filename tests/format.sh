#!/usr/bin/env bash
# Checks or formats the C++ files that differ from a commit, with clang-format 14: format.sh [--fix] [COMMIT]
#
# COMMIT is the commit before the change. The default is origin/main, or the last commit if there is no origin/main.
# --fix formats the files. Without --fix the script lists badly formatted files and exits with 1 if there are any. It also
# exits with 1 if clang-format has another version, because other versions break lines differently.
set -euo pipefail

version=14
for program in clang-format-$version clang-format none; do
  [[ $("$program" --version 2>/dev/null) != *"version $version."* ]] || break
done
if [[ $program == none ]]; then
  echo "format.sh: nothing is checked; it takes clang-format $version, the package clang-format of Debian 12" >&2
  exit 1
fi

mode=(--dry-run -Werror)
if [[ ${1:-} == --fix ]]; then
  mode=(-i)
  shift
fi
cd "$(dirname "${BASH_SOURCE[0]}")/.."
commit=${1:-$(git rev-parse -q --verify origin/main || git rev-parse HEAD)}
base=$(git merge-base "$commit" HEAD)
[[ $base != "$(git rev-parse HEAD)" || -n $(git status --porcelain) ]] || base=$(git rev-parse -q --verify HEAD~1 || echo "$base")
git diff --name-only --diff-filter=d "$base" -- '*.cpp' '*.hpp' | xargs -r "$program" "${mode[@]}"
