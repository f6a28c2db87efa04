#!/usr/bin/env bash
# Static analysis: cppcheck of host/, clang-tidy of all C++ sources: analyse.sh
#
# Configures build/analysis without unity builds. Prints all findings, and exits with a status other than 0 if there are
# any. .clang-tidy lists the checks of clang-tidy. Needs cppcheck and clang-tidy 16 or later (package clang-tidy-16 in
# Debian 12, clang-tidy in Debian 13).
set -euo pipefail

root=$(cd "$(dirname "${BASH_SOURCE[0]}")/.." && pwd)
build=$root/build/analysis
cd "$root"
cmake -S . -B "$build" -G Ninja -DCMAKE_UNITY_BUILD=OFF -DBUILD_TESTING=ON -DDOLP_BENCH=ON >/dev/null
# Leaves out the kernel source, whose aggregates in parentheses neither program can read, and fuzzers, which are not built.
sources=$(git ls-files 'host/*.cpp' 'bench/*.cpp' 'tests/*.cpp' | grep -vE '/kernel/|/fuzz/')

# False findings of cppcheck 2.10: braces that choose a size, copy a range or hold a lambda; references to statics; an
# assignment after an if; an iterator after an erase up to itself; two calls that may differ; "name"_a = flag.
suppressed=(containerOutOfBounds:host/reference/hemisphere.cpp danglingTempReference:tests/tools/calibrate/hold_out.cpp
  returnTempReference:host/compute/plan/rule.cpp invalidContainer:host/lib/fit/search.cpp cppcheckError
  literalWithCharPtrCompare:host/programs/explore/readout.cpp containerOutOfBounds:host/core/table/table_lookup.cpp
  passedByValue:host/support/base/python_picture.cpp
  incorrectLogicOperator:host/programs/explore/window/controls_panel.cpp assignBoolToPointer:host/python/native.cpp
  useInitializationList missingInclude unmatchedSuppression)
grep '^host/' <<<"$sources" | cppcheck --std=c++20 --language=c++ --enable=warning,performance,portability --quiet \
  -j"$(nproc)" --error-exitcode=1 -I shaders $(printf -- '-I host/%s ' include support core compute reference/include lib programs) \
  "${suppressed[@]/#/--suppress=}" --file-list=-

# -Wno-unused-command-line-argument: Clang does not know all options of GCC.
tidy=$(command -v clang-tidy-16 || echo clang-tidy)
xargs -P "$(nproc)" -n 1 "$tidy" --extra-arg=-Wno-unused-command-line-argument -p "$build" --quiet \
  --warnings-as-errors='*' 2>/dev/null <<<"$sources"
