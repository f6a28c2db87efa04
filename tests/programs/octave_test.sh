#!/usr/bin/env bash
# Runs the code for Octave and MATLAB of README.md in Octave: octave_test.sh PROGRAM SOURCES
set -euo pipefail

program=$1
sources=$2
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
cd "$work"
"$program" table "$sources/host/scenes/night_paint.toml" -o grid.nc --quiet --set 'grid.sigma={ from = 0.05, to = 0.4, count = 36 }' \
  --set 'grid.q=[2,3,5]'
# Leaves out the lines that draw, because these need a display.
sed -n '/^```matlab$/,/^```$/p' "$sources/README.md" | grep -vE '^(```|plot)' > block.m
echo "printf('%.17g\n', between);" >> block.m
found=$(HOME=$work octave --no-gui --quiet --no-init-file block.m | tail -n 1)
printf 'theta_deg,sigma,q\n62.5,0.155,3\n' > points.csv
"$program" lookup grid.nc --points points.csv -o r.csv --quiet
/usr/bin/python3 - "$found" <<'END'
import csv, sys
row = next(csv.DictReader(line for line in open("r.csv") if not line.startswith("#")))
expected, found = float(row["dolp"]), float(sys.argv[1])
if not abs(found - expected) < 1e-3 * expected:
    sys.exit(f"octave_test: Octave interpolates {found}, dolp lookup computes {expected}")
print(f"Octave interpolates {found}, dolp lookup computes {expected}")
END
