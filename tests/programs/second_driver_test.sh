#!/usr/bin/env bash
# Runs dolp on another kind of device: second_driver_test.sh swiftshader|gpu DOLP SOURCE FAULTS
#
# swiftshader: SwiftShader is a Vulkan driver other than lavapipe. The test downloads Debian's package chromium-common,
# which contains it, and installs nothing. Exit status 77: the system has no such package.
# gpu: lavapipe says that it is a discrete GPU. FAULTS is the folder of libfail_vulkan.so.
set -euo pipefail
kind=$1
dolp=$2
source=$3
faults=$4
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
cd "$folder"

use_swiftshader() {
  has_package() { apt-cache show chromium-common >/dev/null 2>&1; }
  has_package || apt-get -qq update 2>/dev/null || true  # the package lists may be missing
  has_package || exit 77
  apt-get -qq download chromium-common 2>/dev/null
  dpkg-deb --fsys-tarfile chromium-common_*.deb | tar -x ./usr/lib/chromium/libvk_swiftshader.so
  cat > driver.json <<JSON
{"file_format_version": "1.0.0",
 "ICD": {"library_path": "$folder/usr/lib/chromium/libvk_swiftshader.so", "api_version": "1.3.0"}}
JSON
  export VK_DRIVER_FILES=$folder/driver.json VK_ICD_FILENAMES=$folder/driver.json
  export DOLP_COMPILATION_LIMIT_S=600  # SwiftShader compiles slowly on a busy machine
}

fail() {
  echo "second_driver_test.sh: $1" >&2
  exit 1
}
expect() {  # expect TEXT FILE: fails if FILE does not contain TEXT
  grep -qF -- "$1" "$2" || { cat "$2"; fail "\"$1\" is not in $2"; }
}

if [[ $kind == swiftshader ]]; then
  use_swiftshader
else
  export LD_PRELOAD=$faults/libfail_vulkan.so DOLP_VULKAN_WITHOUT=processor
fi
"$dolp" devices > devices.txt
expect "   usable" devices.txt
if [[ $kind == swiftshader ]]; then
  expect "double precision no (tolerances below 2e-06 are out of reach)" devices.txt
  expect "SwiftShader driver, Vulkan" devices.txt
else
  expect "discrete GPU" devices.txt
fi

# check_table NAME SCENE OPTION...: `dolp verify` compares the table of the scene with the reference. Each table has
# another kernel, because some drivers compile a kernel for a quarter of a minute.
grid="{from=0, to=89, count=7}"
check_table() {
  "$dolp" table "$source/host/scenes/$2.toml" -o table.nc --set "grid.theta_deg=$grid" "${@:3}" > table.txt 2> errors.txt || status=$?
  "$dolp" verify table.nc --samples 20 > verify.txt || { cat verify.txt; fail "the table with $1 is wrong"; }
}
status=0
sigma=(--set "grid.sigma=[0.05, 0.3, 0.9]")
check_table "Gaussian slopes and v-cavity" stainless_steel "${sigma[@]}" --set surface.masking=v-cavity --set surface.distribution=gaussian
check_table "a clear sky and smith" clear_sky
[[ $status == 0 ]] || fail "a table ended with the exit status $status"
[[ $kind == swiftshader ]] && strict=(--tolerance 1e-8 --strict) || strict=()
check_table "integral and total reflection" stainless_steel "${sigma[@]}" --set surface.n=0.7 "${strict[@]}"
[[ $kind == swiftshader ]] || exit $status
[[ $status == 1 ]] || fail "table --strict ends with $status"
expect "the device has no double precision: tolerances below 2e-06 are out of reach" table.txt
expect "--strict: the tolerance is not met everywhere" errors.txt
