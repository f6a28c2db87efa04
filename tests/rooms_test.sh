#!/usr/bin/env bash
# Which room of host/ may include which: what the table allows compiles with the room's own include directories, all
# else does not. Arguments: the compiler, and a file with a line "ROOM|DIRECTORY DIRECTORY ..." for each room that the
# build has.
set -euo pipefail

compiler=$1
rooms_file=$2
host=$(cd "$(dirname "${BASH_SOURCE[0]}")/../host" && pwd)
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT

# Each room with a header of its own and the rooms it may see.
declare -A header sees
room() { header[$1]=$2 sees[$1]=" $1 ${*:3} "; }
room base base/progress.hpp
room device device/devices.hpp base
room model model/choices.hpp
room table table/axis_stencil.hpp base model
room scene scene/number_range.hpp base model
room spectrum spectrum/planck.hpp model scene
room plan plan/rule_nodes.hpp base model scene spectrum
room evaluate evaluate/evaluator.hpp base model
room evaluate/text evaluate/text/profile.hpp base model plan scene spectrum
room evaluate/cpu evaluate/cpu/cpu_evaluator.hpp base evaluate evaluate/text model plan scene spectrum
room evaluate/reference evaluate/reference/fresnel.hpp base evaluate model scene
room evaluate/vulkan evaluate/vulkan/vulkan_evaluator.hpp base device evaluate evaluate/text model plan scene spectrum
room evaluate/interpolation evaluate/interpolation/interpolating_evaluator.hpp base evaluate model plan scene spectrum
room evaluate/named evaluate/named/named_evaluator.hpp \
  base device evaluate evaluate/cpu evaluate/interpolation evaluate/reference evaluate/vulkan model plan scene spectrum
room radiometry radiometry/radiometry.hpp model scene spectrum
room run run/table_scene.hpp base evaluate evaluate/cpu evaluate/interpolation evaluate/text model plan radiometry scene spectrum table
room fit fit/parameter.hpp base evaluate model plan radiometry run scene spectrum table
room verify verify/stored_cases.hpp base evaluate evaluate/reference model plan radiometry run scene spectrum table
room report report/report.hpp \
  base device evaluate evaluate/text evaluate/vulkan fit model plan radiometry run scene spectrum table verify
room api api/translated.hpp \
  base device evaluate evaluate/cpu evaluate/named evaluate/vulkan fit model plan radiometry report run scene spectrum table verify
room terminal terminal/exit_status.hpp base
room calibrate calibrate/hold_out.hpp base evaluate evaluate/cpu evaluate/reference evaluate/text model plan scene spectrum
room explore explore/ticks.hpp base
room explore/window explore/window/area.hpp base device explore
room explore/program explore/program/program.hpp base device explore explore/window
room cli cli/options.hpp base explore/program terminal

# Libraries that stay in some rooms, by what their headers are called.
declare -A library=(
  ['<(vulkan|vk_mem_alloc)']="device evaluate/vulkan explore/window"
  ['<(GLFW|imgui)']="explore/window"
  ['<hdf5']="table"
  ['<toml']="scene"
  ['<yaml']="scene"
  ['<(ceres|glog)']="fit"
  ['<CLI/']="calibrate cli evaluate/reference")

failures=0
complain() {
  echo "rooms_test: $1" >&2
  failures=$((failures + 1))
}

# compiles DIRECTORIES HEADER...: whether a file that includes just these compiles; messages in $work/messages.
compiles() {
  local flags=(-DDOLP_BUILDS_THE_LIBRARY) directory  # as api is compiled
  for directory in $1; do flags+=(-I "$directory"); done
  printf '#include "%s"\n' "${@:2}" >"$work/probe.cpp"
  LC_ALL=C "$compiler" -std=c++20 -fsyntax-only "${flags[@]}" "$work/probe.cpp" 2>"$work/messages"
}

# finds DIRECTORIES HEADER: whether one of the include directories has it.
finds() {
  local directory
  for directory in $1; do
    [[ ! -e $directory/$2 ]] || return 0
  done
  return 1
}

seen=0
while IFS='|' read -r user directories; do
  [[ $user != bench ]] || continue
  [[ -v header[$user] ]] || { complain "room $user is not in the table"; continue; }
  seen=$((seen + 1))
  right=()
  for other in "${!header[@]}"; do
    if [[ ${sees[$user]} == *" $other "* ]]; then
      right+=("${header[$other]}")
    elif finds "$directories" "${header[$other]}"; then
      complain "$user may not see $other, but finds ${header[$other]}"
    fi
  done
  compiles "$directories" "${right[@]}" || complain "$user: $(head -n 1 "$work/messages")"
done <"$rooms_file"
((seen == ${#header[@]})) || complain "the table has ${#header[@]} rooms, the build $seen"

# A circle would show as two rooms that see each other.
for one in "${!header[@]}"; do
  for other in "${!header[@]}"; do
    [[ $one == "$other" || ${sees[$one]} != *" $other "* || ${sees[$other]} != *" $one "* ]] ||
      complain "$one and $other see each other"
  done
done

# Past the roots: an include through the folder of the file or by "..", and libraries that are another room's.
cd "$host"
mapfile -t sources < <(find "${!header[@]}" -maxdepth 1 \( -name '*.hpp' -o -name '*.cpp' \) | sort -u)
names=$(IFS='|'; echo "${!header[*]}")
while IFS= read -r line; do
  complain "an include that does not begin with a room: $line"
done < <(grep -nE '^#include "' "${sources[@]}" | grep -vE "#include \"($names|shaders)(/[a-z0-9_]+)+\.[a-z]+\"" || true)
for name in "${!library[@]}"; do
  while IFS= read -r file; do
    [[ " ${library[$name]} " == *" $(dirname "$file") "* ]] || complain "$file includes $name"
  done < <(grep -lE "^#include $name" "${sources[@]}" || true)
done

((failures == 0)) || exit 1
echo "$seen rooms see what they may and nothing else"
