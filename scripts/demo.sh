#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# Install, build, then the whole main job on a material of the project's own: measure it with the virtual
# goniophotometer, separate it, render it raw and with each model, compare, and lay the pictures side by side.
# Everything lands in demo-out/. Another scene: scripts/demo.sh SCENE.json (its measured materials are separated).
set -euo pipefail
cd "$(dirname "$0")/.."

scripts/install_packages.sh
cmake --preset release -DSPECTRACE_BUILD_TESTS=OFF >/dev/null
cmake --build --preset release --target spectrace
spectrace=build/release/cli/spectrace

out=demo-out
mkdir -p "$out"
scene=${1:-scenes/material_ball.json}
models=(sun fresnel diffraction residual)

step() { printf '\n== %s\n' "$*"; }

if (($# == 0)) && [[ ! -e $out/pearlescent.bsdf || scenes/materials/pearlescent.json -nt $out/pearlescent.bsdf ]]; then
  step "Measure scenes/materials/pearlescent.json"
  "$spectrace" acquire scenes/materials/pearlescent.json -o "$out/pearlescent.bsdf"
fi

# --paired: all pictures share their random directions, so that what is compared is the material, not the noise.
step "Render $scene: the measurement itself"
"$spectrace" "$scene" --paired --cache "$out/separated" -o "$out/raw.exr"
for model in "${models[@]}"; do
  step "Render it separated (once, kept in $out/separated), model $model"
  "$spectrace" "$scene" --separate "$model" --paired --cache "$out/separated" -o "$out/$model.exr"
done

step "How close is each model to the measurement?"
"$spectrace" compare "$out/raw.exr" "$out"/{sun,fresnel,diffraction,residual}.exr

step "The pictures"
"$spectrace" sheet "$out/contact_sheet.png" "$out"/{raw,sun,fresnel,diffraction,residual}.exr \
  --labels "measured,sun,fresnel,diffraction,residual"
echo
ls -1 "$out"/*.exr "$out"/*.png "$out"/separated/*.sep
