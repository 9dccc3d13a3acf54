#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# The last job of scripts/slurm/render.sh. `merge` itself refuses parts that leave samples out.
set -euo pipefail

out="$1" parts="$2" shards="$3"
files=()
for ((task = 0; task < shards; ++task)); do
  files+=("$parts/$task.partial")
done
"$SPECTRACE" merge "${files[@]}" -o "$out"
rm -f -- "${files[@]}" "$parts"/*.exr "$parts"/*.png
