#!/usr/bin/env bash
# Installs what is missing, builds everything and runs the whole test suite on lavapipe, Vulkan on the CPU.
#
# Environment:
#   DOLP_BUILD_TYPE   Release (default) in build/release, Debug in build/debug, AsanUbsan in build/asan-ubsan;
#                     Tsan in build/tsan has only the tests of the host's threads, because drivers are not instrumented
#   DOLP_TEST_DEVICE  a part of the file name of another Vulkan driver (in vulkan/icd.d), e.g. nvidia or radeon
#   DOLP_VALIDATION   1 (default): messages of the Vulkan validation layers fail a test; 0: without the layers
# Arguments go to ctest, e.g. -R Eval. With AsanUbsan the suite has a minute of fuzzing, `-L fuzz`; after that build,
# `bash tests/fuzz/run.sh build/asan-ubsan 3600` is an hour of it.
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

# The loader's search would prefer a GPU if there is one.
shopt -s nullglob
driver_files=({/usr/share,/usr/local/share,/etc}/vulkan/icd.d/*"$driver"*.json)
((${#driver_files[@]} > 0)) || fail "there is no Vulkan driver file vulkan/icd.d/*$driver*.json"
driver_file=${driver_files[0]}
export VK_DRIVER_FILES=$driver_file VK_ICD_FILENAMES=$driver_file
export DOLP_VALIDATION=${DOLP_VALIDATION:-1}
# Mesa and the validation layers keep memory until the end. They are unloaded before a suppression could use their names.
export ASAN_OPTIONS=${ASAN_OPTIONS:-detect_leaks=0}

cmake -S "$root" -B "$build" -G Ninja -DCMAKE_BUILD_TYPE="$build_type" -DBUILD_TESTING=ON -DDOLP_BENCH=ON \
  -DDOLP_WERROR=ON
if [[ $build_type == Tsan ]]; then
  cmake --build "$build" --target core_test compute_test explore_test lib_test
  threads='ParallelRanges|InterpolatingEvaluator|RandomGrids.*/Cpu|MuellerRun|MuellerPoints|PointEntries|EvaluateScene_'
  threads+='|RunsOfModel|Edits|SceneToml|Measured|Exports|ExploreWorker|ExploreSession'
  exec ctest --test-dir "$build" --output-on-failure -j2 -R "$threads" "$@"
fi
cmake --build "$build"
"$build/dolp" devices || fail "no usable Vulkan device through $driver_file"
ctest --test-dir "$build" --output-on-failure --timeout 600 -j2 "$@"  # the timeout ends a test that hangs
