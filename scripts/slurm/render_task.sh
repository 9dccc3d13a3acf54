#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# One task of scripts/slurm/render.sh: its share of the samples, in whole packs of 8.
set -euo pipefail

scene="$1" parts="$2" spp="$3" shards="$4" checkpoint="$5"
shift 5
task="$SLURM_ARRAY_TASK_ID"
packs=$(((spp + 7) / 8))
# shellcheck disable=SC2017 # rounding down to whole packs is what is wanted
first=$((packs * task / shards * 8))
# shellcheck disable=SC2017
last=$((packs * (task + 1) / shards * 8))
((last <= spp)) || last="$spp"

exec "$SPECTRACE_SLURM/or_requeue.sh" "$SPECTRACE" "$scene" --samples "$first:$last" -o "$parts/$task.exr" \
  --checkpoint "$checkpoint" --resume --threads "${SLURM_CPUS_PER_TASK:-1}" --progress plain "$@"
