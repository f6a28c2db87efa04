#!/usr/bin/env bash
# Installs missing packages, builds everything, and runs the test suite on lavapipe, a Vulkan driver that uses the CPU.
#
# Environment:
#   DOLP_BUILD_TYPE   Release (default) builds in build/release, Debug in build/debug, AsanUbsan in build/asan-ubsan.
#                     Tsan builds in build/tsan and runs only tests of host threads: drivers are not instrumented.
#   DOLP_TEST_DEVICE  part of the file name of another Vulkan driver (in vulkan/icd.d), e.g. nvidia or radeon
#   DOLP_VALIDATION   1 (default): a message of the Vulkan validation layers fails a test; 0: no validation layers
# Passes arguments to ctest, e.g. -R Eval. With AsanUbsan the suite contains a minute of fuzzing (-L fuzz). To fuzz for
# an hour after that, run `bash tests/fuzz/run.sh build/asan-ubsan 3600`.
set -euo pipefail

root=$(cd "$(dirname "${BASH_SOURCE[0]}")/.." && pwd)
build_type=${DOLP_BUILD_TYPE:-Release}
driver=${DOLP_TEST_DEVICE:-lvp}

fail() {
  echo "tests/run.sh: $1" >&2
  exit 1
}

case $build_type in
  Release) build=$root/build/release ;;
  Debug) build=$root/build/debug ;;
  AsanUbsan) build=$root/build/asan-ubsan ;;
  Tsan) build=$root/build/tsan ;;
  *) fail "DOLP_BUILD_TYPE is $build_type; it must be Release, Debug, AsanUbsan or Tsan" ;;
esac

bash "$root/host/tools/install_packages.sh" build picture bench test

# Names the driver explicitly, because the Vulkan loader would prefer a GPU.
shopt -s nullglob
driver_files=({/usr/share,/usr/local/share,/etc}/vulkan/icd.d/*"$driver"*.json)
((${#driver_files[@]} > 0)) || fail "there is no Vulkan driver file vulkan/icd.d/*$driver*.json"
driver_file=${driver_files[0]}
export VK_DRIVER_FILES=$driver_file VK_ICD_FILENAMES=$driver_file
export DOLP_VALIDATION=${DOLP_VALIDATION:-1}
# Mesa and the validation layers do not free all memory. A suppression cannot name them, because they are unloaded first.
export ASAN_OPTIONS=${ASAN_OPTIONS:-detect_leaks=0}

cmake -S "$root" -B "$build" -G Ninja -DCMAKE_BUILD_TYPE="$build_type" -DBUILD_TESTING=ON -DDOLP_BENCH=ON \
  -DDOLP_WERROR=ON
if [[ $build_type == Tsan ]]; then
  cmake --build "$build" --target core_test compute_test explore_test lib_test
  threads='ParallelRanges|PlannedMoments|Grids.*/Cpu|MuellerRun|MuellerPoints|PointEntries|EvaluateScene_'
  threads+='|RunsOfModel|Edits|SceneToml|Measured|Exports|ExploreWorker|ExploreSession'
  exec ctest --test-dir "$build" --output-on-failure -j2 -R "$threads" "$@"
fi
cmake --build "$build"
"$build/dolp" devices || fail "no usable Vulkan device through $driver_file"
ctest --test-dir "$build" --output-on-failure --timeout 600 -j2 "$@"  # the timeout is for tests that hang
