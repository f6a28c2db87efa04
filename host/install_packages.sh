#!/usr/bin/env bash
# Installs the Debian 12 packages that are missing: install_packages.sh SET...
#
#   build    the program and its lookup tables
#   picture  host/plot_table.py and host/paper_figure.py
#   bench    dolp-bench and its figures
#   test     the test suite
#
# Nothing is changed, and no root is needed, when everything is there. Otherwise apt-get runs, through sudo when needed.
set -euo pipefail

declare -A packages=(
  [build]="g++ cmake ninja-build glslang-tools spirv-tools libvulkan-dev mesa-vulkan-drivers libglm-dev libboost-dev libceres-dev
           libcli11-dev libeigen3-dev libfmt-dev libhdf5-dev libtomlplusplus-dev libyaml-cpp-dev nlohmann-json3-dev
           pybind11-dev python3-dev python3-numpy python3-xarray python3-netcdf4
           libglfw3-dev libimgui-dev libstb-dev pkg-config fonts-dejavu-core"
  [picture]="python3 python3-matplotlib python3-netcdf4 python3-numpy"
  [bench]="libcubature-dev libgsl-dev python3 python3-matplotlib python3-numpy python3-scipy"
  [test]="dpkg-dev file fish zsh libclang-rt-14-dev libgtest-dev libnetcdf-dev netcdf-bin python3 python3-netcdf4 python3-numpy
          octave octave-netcdf vulkan-validationlayers x11-utils xvfb xauth xdotool slurmctld slurmd slurm-client munge"
)

missing=()
for set in "$@"; do
  if [[ -z ${packages[$set]:-} ]]; then
    echo "install_packages.sh: no set '$set'; the sets are ${!packages[*]}" >&2
    exit 2
  fi
  for package in ${packages[$set]}; do
    state=$(dpkg-query -W -f '${db:Status-Status}' "$package" 2>/dev/null || true)
    [[ $state == installed ]] || missing+=("$package")
  done
done
((${#missing[@]} > 0)) || exit 0

as_root=()
if ((EUID != 0)); then
  if ! command -v sudo >/dev/null; then
    echo "install_packages.sh: missing packages, and neither root nor sudo to install them: ${missing[*]}" >&2
    exit 1
  fi
  as_root=(sudo)
fi
echo "installing: ${missing[*]}"
"${as_root[@]}" env DEBIAN_FRONTEND=noninteractive apt-get -q update
"${as_root[@]}" env DEBIAN_FRONTEND=noninteractive apt-get -q install -y --no-install-recommends "${missing[@]}"
