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

# `dolp verify` compares tables of each masking, of total reflection and of direct emission with the reference.
grid="{from=0, to=89, count=7}"
for settings in "masking=none" "masking=integral" "masking=smith" "masking=v-cavity" "distribution=gaussian" "n=0.7"; do
  "$dolp" table "$source/host/scenes/stainless_steel.toml" -o table.nc --quiet --set "surface.$settings" \
    --set "grid.theta_deg=$grid" --set "grid.sigma=[0.05, 0.3, 0.9]"
  "$dolp" verify table.nc --samples 20 > verify.txt || { cat verify.txt; fail "the table with $settings is wrong"; }
done
"$dolp" table "$source/host/scenes/clear_sky.toml" -o table.nc --quiet --set "grid.theta_deg=$grid"
"$dolp" verify table.nc --samples 5 > verify.txt || { cat verify.txt; fail "the table of a clear sky is wrong"; }
[[ $kind == swiftshader ]] || exit 0

status=0
"$dolp" table "$source/host/scenes/stainless_steel.toml" -o table.nc --set grid.theta_deg=[60] --set grid.sigma=[0.3] \
  --tolerance 1e-8 --strict > table.txt 2> strict.txt || status=$?
[[ $status == 1 ]] || fail "table --strict ends with $status"
expect "the device has no double precision: tolerances below 2e-06 are out of reach" table.txt
expect "--strict: the tolerance is not met everywhere" strict.txt
