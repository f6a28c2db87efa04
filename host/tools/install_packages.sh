#!/usr/bin/env bash
# Installs the packages of Debian 12, Debian 13 or Ubuntu 24.04 that are missing: install_packages.sh SET...
#
#   build    the program, its window and its Python package
#   picture  host/plot_table.py and host/tools/paper_figure.py
#   bench    dolp-bench and its figures
#   test     the test suite
#
# If all packages are installed, the script changes nothing and needs no root. Otherwise it runs apt-get, with sudo if needed.
set -euo pipefail

declare -A packages
need() { packages[$1]+=" ${*:2}"; }
need build g++ cmake ninja-build
need build glslang-tools spirv-tools                # compile, optimise and check the shaders
need build libvulkan-dev mesa-vulkan-drivers        # run the kernels, on GPUs of all makers and on the processor
need build libglm-dev                               # GLSL's vector types in C++, for the CPU build of the shaders
need build libboost-dev                             # special functions, Gauss-Kronrod nodes, short lists
need build libeigen3-dev                            # small matrices of dolp fit
need build libnetcdf-dev                            # table files
need build libtomlplusplus-dev libyaml-cpp-dev      # scenes, material records
need build libcli11-dev libfmt-dev nlohmann-json3-dev  # command line, messages, JSON reports
need build libglfw3-dev libimgui-dev libstb-dev pkg-config fonts-dejavu-core  # the window
need build pybind11-dev python3-dev python3-numpy python3-xarray python3-netcdf4  # the Python package
need picture python3 python3-matplotlib python3-netcdf4 python3-numpy
need bench libcubature-dev libgsl-dev python3-scipy  # methods to compare with
need bench python3 python3-matplotlib python3-numpy
need test libgtest-dev libclang-rt-dev clang-format  # test framework, fuzzing, code format
need test vulkan-validationlayers                    # finds misuse of Vulkan
need test spirv-cross                                # translates shaders to the languages of Metal and Direct3D
need test netcdf-bin octave octave-netcdf python3-scipy python3 python3-netcdf4 python3-numpy  # other readers of tables
need test x11-utils xvfb xauth xdotool               # a display with mouse and keyboard
need test slurmctld slurmd slurm-client munge        # a cluster of one node
need test dpkg-dev file fish zsh python3-pip python3-yaml  # check packages, shell completions, the workflow

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

fail() {
  echo "install_packages.sh: $1" >&2
  exit 1
}
systems="Debian 12, Debian 13 and Ubuntu 24.04"
command -v apt-get >/dev/null || fail "this is for $systems, and here is no apt-get; README.md, Start, says what else works"
as_root=()
if ((EUID != 0)); then
  command -v sudo >/dev/null || fail "missing packages, and neither root nor sudo to install them: ${missing[*]}"
  as_root=(sudo)
fi
echo "installing: ${missing[*]}"
"${as_root[@]}" env DEBIAN_FRONTEND=noninteractive apt-get -q update
"${as_root[@]}" env DEBIAN_FRONTEND=noninteractive apt-get -q install -y --no-install-recommends "${missing[@]}" ||
  fail "apt-get cannot install them all; the packages have the names of $systems"
