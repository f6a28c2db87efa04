#!/usr/bin/env bash
# translation_test.sh FOLDER: translates all float modules in FOLDER to the shader languages of Metal and Direct3D.
# Vulkan on macOS (MoltenVK), and on Windows without a Vulkan driver (Dozen), makes such translations.
set -euo pipefail

readonly least_modules=11
count=0
for module in "$1"/*_float.spv; do
  metal=$(spirv-cross "$module" --msl --msl-version 20200)
  direct3d=$(spirv-cross "$module" --hlsl --shader-model 60)
  if [[ $metal != *"kernel void main0("* || $direct3d != *"[numthreads("* ]]; then
    echo "translation_test.sh: $module: a translation has no entry point" >&2
    exit 1
  fi
  count=$((count + 1))
done
if ((count < least_modules)); then
  echo "translation_test.sh: $count modules in $1, expected at least $least_modules" >&2
  exit 1
fi
