#!/bin/bash
# Makes the pictures of the window for its manual, without a display: host/tools/window_pictures.sh [BUILD]
set -euo pipefail
cd "$(dirname "$0")/../.."
build=${1:-build/release}
picture() {  # NAME VIEW SCENE OPTIONS...
  local name=$1 view=$2 scene=$3
  shift 3
  xvfb-run -a -s "-screen 0 1440x900x24" "$build/dolp" explore "host/scenes/$scene.toml" --view "$view" "$@" \
    --frames 10 --screenshot "bench/results/$name.png" > /dev/null
}
picture explore map night_paint --set emission.bracket=true
picture explore_slopes slopes night_paint
picture explore_material material night_paint --set "surface.material='water 25C'"
picture explore_pbrdf pBRDF night_paint
picture explore_sphere sphere night_paint
picture explore_sky sky glint
picture explore_camera camera mwir_glint
picture explore_smooth smooth paint_on_metal --tolerance 1e-3
picture explore_spectrum spectrum oxide_on_aluminium
