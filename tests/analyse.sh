#!/usr/bin/env bash
# Static analysis: cppcheck of host/, clang-tidy of all C++ sources: analyse.sh
#
# Configures build/analysis, where each source has a separate compile command. Prints all findings; with findings the exit
# status is not 0. The checks of clang-tidy are in .clang-tidy. Needs cppcheck and clang-tidy 16 or later: the package
# clang-tidy-16 of Debian 12, clang-tidy of Debian 13.
set -euo pipefail

root=$(cd "$(dirname "${BASH_SOURCE[0]}")/.." && pwd)
build=$root/build/analysis
cd "$root"
cmake -S . -B "$build" -G Ninja -DCMAKE_UNITY_BUILD=OFF -DBUILD_TESTING=ON -DDOLP_BENCH=ON >/dev/null
# Neither can read the kernel source: aggregates initialised with parentheses. Fuzzers are not in this build.
sources=$(git ls-files 'host/*.cpp' 'bench/*.cpp' 'tests/*.cpp' | grep -vE '/kernel/|/fuzz/')

# What cppcheck 2.10 takes for an error: braces that choose a size or copy a range or hold a lambda, references to statics,
# an assignment that an if precedes, an iterator after an erase up to itself, two calls that may differ, "name"_a = flag.
suppressed=(containerOutOfBounds:host/reference/hemisphere.cpp danglingTempReference:tests/calibrate/hold_out.cpp
  returnTempReference:host/compute/plan/rule.cpp invalidContainer:host/lib/fit/search.cpp cppcheckError
  literalWithCharPtrCompare:host/programs/explore/readout.cpp constStatement:host/programs/explore/window/commands.cpp
  incorrectLogicOperator:host/programs/explore/window/actions.cpp assignBoolToPointer:host/python/native.cpp
  useInitializationList missingInclude unmatchedSuppression)
grep '^host/' <<<"$sources" | cppcheck --std=c++20 --language=c++ --enable=warning,performance,portability --quiet \
  -j"$(nproc)" --error-exitcode=1 -I shaders $(printf -- '-I host/%s ' include support core compute reference/include lib programs) \
  "${suppressed[@]/#/--suppress=}" --file-list=-

# Its compiler does not know all options of GCC.
tidy=$(command -v clang-tidy-16 || echo clang-tidy)
xargs -P "$(nproc)" -n 1 "$tidy" --extra-arg=-Wno-unused-command-line-argument -p "$build" --quiet \
  --warnings-as-errors='*' 2>/dev/null <<<"$sources"
