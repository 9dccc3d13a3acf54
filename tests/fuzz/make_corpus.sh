#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# Small files of every kind, made by the program itself, and truncated ones: tests/fuzz/make_corpus.sh PROGRAM FOLDER
set -euo pipefail
cd "$(dirname "$0")/../.."

spectrace="$(realpath "$1")" corpus="$2"
mkdir -p "$corpus"/{bsdf,scattered,sep,scene,partial,exr,mesh}
small="$(mktemp -d)"
trap 'rm -rf "$small"' EXIT

for material in pearlescent glossy; do
  "$spectrace" acquire "scenes/materials/$material.json" -o "$corpus/bsdf/$material.bsdf" --elevations 4 --table 4 >/dev/null
  "$spectrace" separate "$corpus/bsdf/$material.bsdf" -o "$corpus/sep/$material.sep" --grid 6x5x6 >/dev/null
  "$spectrace" separate "$corpus/bsdf/$material.bsdf" -o "$corpus/sep/$material-plain.sep" --grid 6x5x6 --full >/dev/null
done
printf '%s\n' '30 0 30 180 0.2 0.3 0.4' '30 0 45 170 0.1 0.2 0.3' '60 0 60 180 0.5 0.4 0.3' >"$corpus/scattered/three.brdf"
printf '\x5a\0\0\0\x5a\0\0\0\xb4\0\0\0' >"$corpus/scattered/header.binary"

for scene in scenes/*.json; do
  [[ "$scene" == *schema* ]] || cp "$scene" "$corpus/scene/"
done
cat >"$small/all.json" <<'JSON'
{"camera": {"type": "thin_lens", "origin": [0, -4, 1], "target": [0, 0, 0], "up": [0, 0, 1], "lens_radius": 0.1},
 "film": {"width": 8, "height": 8, "spectral": {"bins": 4}},
 "materials": [{"name": "a", "type": "dielectric", "eta": {"cauchy": {"a": 1.5, "b_um2": 0.004}}}, {"name": "b", "type": "lambert", "reflectance": 0.5}],
 "shapes": [{"type": "sphere", "material": "a"}, {"type": "quad", "corner": [-2, -2, -1], "edge_u": [4, 0, 0],
   "edge_v": [0, 4, 0], "material": "b"}],
 "lights": [{"type": "environment", "radiance": 1}]}
JSON
cp "$small/all.json" "$corpus/scene/"
"$spectrace" "$small/all.json" -o "$small/all.exr" --samples 0:8 --aovs denoise >/dev/null
cp "$small"/*.partial "$corpus/partial/"
cp "$small"/*.exr "$corpus/exr/"
"$spectrace" "$small/all.json" -o "$small/plain.exr" --samples 8:24 --aovs none >/dev/null
cp "$small/plain.partial" "$corpus/partial/"

printf 'v 0 0 0\nv 1 0 0\nv 0 1 0\nvn 0 0 1\nvt 0 0\nf 1/1/1 2/1/1 3/1/1\n' >"$corpus/mesh/one.obj"
printf 'ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\nproperty float z\nelement face 1\nproperty list uchar int vertex_indices\nend_header\n0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n' >"$corpus/mesh/one.ply"

for file in "$corpus"/*/*; do
  [[ "$file" == *.half ]] || head -c $(($(stat -c %s "$file") / 2)) "$file" >"$file.half"
done
