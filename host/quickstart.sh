#!/usr/bin/env bash
# From a fresh machine to a lookup table: quickstart.sh [SCENE] [OUT]
#
# Installs the packages that are missing. Builds the program, its Python package and its manual pages in build/release,
# from which `cmake --install` works. Then writes the table of SCENE to OUT. If OUT ends in .nc, also draws the table
# into a picture of the same name with the suffix .png. Default SCENE: night_paint.toml with 36 values of sigma. Default
# OUT: dolp.nc in the current folder.
set -euo pipefail

root=$(cd "$(dirname "${BASH_SOURCE[0]}")/.." && pwd)
scene=${1:-$root/host/scenes/night_paint.toml}
settings=()
(($# > 0)) || settings=(--set 'grid.sigma={ from = 0.05, to = 0.4, count = 36 }')
table=${2:-dolp.nc}
build=$root/build/release

bash "$root/host/tools/install_packages.sh" build picture
cmake -S "$root" -B "$build" -G Ninja -DCMAKE_BUILD_TYPE=Release -DBUILD_TESTING=OFF -DDOLP_BENCH=OFF
cmake --build "$build" --target dolp dolp_python dolp_pages

echo
"$build/dolp" table "$scene" "${settings[@]}" -o "$table"
echo
echo "table:   $(realpath -- "$table")"
if [[ $table != *.nc ]]; then
  echo "picture: none; it is drawn from a table whose name ends in .nc"
  exit 0
fi
picture=${table%.nc}.png
# Uses Debian's Python, for which the packages above are installed. Another Python may come first in PATH.
/usr/bin/python3 "$root/host/plot_table.py" "$table" "$picture"
echo "picture: $(realpath -- "$picture")"
