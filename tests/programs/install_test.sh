#!/usr/bin/env bash
# Tests that an installation works in any folder and without the build: install_test.sh BUILD SOURCES
set -euo pipefail

build=$1
sources=$2
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
fail() {
  echo "install_test: $1" >&2
  exit 1
}

cmake --install "$build" --prefix "$work/first" > "$work/log"
prefix=$work/moved
mv "$work/first" "$prefix"
# The pattern matches only whole paths: with a checkout at /src, /usr/include/eigen3/Eigen/src is no path of the build.
! LC_ALL=C grep -rlaP "(?<![\w./-])(\Q$build\E|\Q$sources\E)/" "$prefix" || fail "files above hold paths of the build"
mkdir "$work/empty"
cd "$work/empty"

# The program, scenes and manual pages.
"$prefix/bin/dolp" table "$prefix/share/dolp/scenes/night_paint.toml" -o t.nc --quiet
"$prefix/bin/dolp" --cite | grep -q "cff-version" || fail "no citation"
grep -q '^\.SS dolp table' "$prefix/share/man/man1/dolp.1" || fail "the manual page lacks a command"
for section in DESCRIPTION FILES ENVIRONMENT "SEE ALSO"; do
  grep -q "^\.SH $section" "$prefix/share/man/man1/dolp.1" || fail "the manual page lacks $section"
done
# Prints "PAGE: LINK" for each link of the manuals to a file that is not installed.
find "$prefix/share/doc/dolp" -name '*.md' | sort | while read -r page; do
  { sed '/^```/,/^```/d' "$page" | grep -oP '\]\(\K[^)#\s]+' || true; } | while read -r link; do
    [[ $link =~ ^[a-z]+: || -e $(dirname "$page")/$link ]] || echo "${page#"$prefix"/}: $link"
  done
done > dead_links
[[ $(find "$prefix/share/doc/dolp" -name '*.md' | wc -l) -ge 14 ]] || fail "manuals are missing"
[[ ! -s dead_links ]] || fail "$(wc -l < dead_links) links lead to files that are not installed: $(head -3 dead_links)"
pages=$prefix/share
words=$(PATH=$prefix/bin:$PATH bash -c 'source "$1"; COMP_WORDS=(dolp tab); COMP_CWORD=1; _dolp; echo "${COMPREPLY[*]}"
                 COMP_WORDS=(dolp eval --evaluator c); COMP_CWORD=3; _dolp; echo "${COMPREPLY[*]}"
                 COMP_WORDS=(dolp table --res); COMP_CWORD=2; _dolp; echo "${COMPREPLY[*]}"
                 COMP_WORDS=(dolp table --set surface.masking = v); COMP_CWORD=5; _dolp; echo "${COMPREPLY[*]}"
                 COMP_WORDS=(dolp fit --vary surface.wi); COMP_CWORD=3; _dolp; echo "${COMPREPLY[*]}"' \
  bash "$pages/bash-completion/completions/dolp")
[[ $words == $'table\ncpu\n--resume\nv-cavity\nsurface.wind_m_s=' ]] || fail "bash completes $words"
zsh -n "$pages/zsh/vendor-completions/_dolp" || fail "zsh cannot read its completion"
fish --no-execute "$pages/fish/vendor_completions.d/dolp.fish" || fail "fish cannot read its completion"
completed=$(PATH=$prefix/bin:$PATH fish -c "source $pages/fish/vendor_completions.d/dolp.fish; complete -C 'dolp eval --evaluator c'")
[[ $completed == cpu* ]] || fail "fish completes $completed"

# The library, used by another CMake project.
mkdir "$work/outside"
cat > "$work/outside/CMakeLists.txt" <<'PROJECT'
cmake_minimum_required(VERSION 3.20)
project(outside CXX)
find_package(dolp CONFIG REQUIRED)
add_executable(outside outside.cpp)
target_link_libraries(outside PRIVATE dolp::dolp)
PROJECT
cat > "$work/outside/outside.cpp" <<'PROGRAM'
#include <dolp/dolp.hpp>
#include <cstdio>
int main(int, char** arguments) {
  const double theta_deg = 60;
  const auto results = dolp::Evaluator().evaluate(dolp::Scene::from_file(arguments[1]), {{"theta_deg", {&theta_deg, 1}}});
  std::printf("%.17g\n", results[dolp::Quantity::kDolp][0]);
}
PROGRAM
cmake -S "$work/outside" -B "$work/outside/build" -DCMAKE_PREFIX_PATH="$prefix" > "$work/log"
cmake --build "$work/outside/build" > "$work/log" || { cat "$work/log"; fail "a project outside does not build"; }
found=$("$work/outside/build/outside" "$prefix/share/dolp/scenes/night_paint.toml")
printf 'theta_deg\n60\n' > points.csv
"$prefix/bin/dolp" eval "$prefix/share/dolp/scenes/night_paint.toml" --points points.csv -o r.csv --quiet
expected=$(awk -F, '/^#/ { next } !column { for (i = 1; i <= NF; ++i) if ($i == "dolp") column = i; next } { print $column }' r.csv)
awk -v a="$found" -v b="$expected" 'BEGIN { exit a != b }' || fail "the library gives $found, the program $expected"

# The Python package, with the examples.
export PYTHONPATH=$prefix/lib/python3/dist-packages
for example in "$prefix"/share/dolp/examples/*.py; do
  /usr/bin/python3 -W error::DeprecationWarning "$example" > said || fail "$(basename "$example") fails"
  [[ -s said && -s $(basename "$example" .py).png ]] || fail "$(basename "$example") draws nothing"
done
echo "what is installed works in an empty folder"
