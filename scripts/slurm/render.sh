#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# Submits a render as a Slurm job array, one task a range of samples, and a job that merges what they made.
set -euo pipefail

usage() {
  cat <<'TEXT'
scripts/slurm/render.sh SCENE.json OUT.exr --spp N --shards N [options] [-- options of spectrace]

  --spp N           samples a pixel of the whole image
  --shards N        tasks of the array, at most one a pack of 8 samples
  --threads N       of each task (default 1)
  --checkpoint S    seconds between checkpoints, from which a task that died goes on (default 60)
  --sbatch OPTIONS  for every job, for example --sbatch "--partition=long --time=4:00:00"
                    warned 120 s before such a time limit, a task writes a checkpoint and is queued again
  --wait            return when the merged image is written; exit code of the merge

The parts lie in OUT.parts/ until they are merged: OUT.parts/N.partial and N.log of task N. The program is
$SPECTRACE, else build/release/cli/spectrace. All nodes must see scene, program and output at the same paths.
TEXT
}

here="$(cd "$(dirname "${BASH_SOURCE[0]}")" && pwd)"
spp="" shards="" threads=1 checkpoint=60 wait=() sbatch=() files=() options=()
while (($# > 0)); do
  case "$1" in
    -h | --help) usage; exit 0 ;;
    --spp) spp="$2"; shift 2 ;;
    --shards) shards="$2"; shift 2 ;;
    --threads) threads="$2"; shift 2 ;;
    --checkpoint) checkpoint="$2"; shift 2 ;;
    --sbatch) read -ra sbatch <<<"$2"; shift 2 ;;
    --wait) wait=(--wait); shift ;;
    --) shift; options=("$@"); break ;;
    -*) echo "render.sh: unknown option $1" >&2; exit 2 ;;
    *) files+=("$1"); shift ;;
  esac
done
if ((${#files[@]} != 2)) || [[ ! "$spp" =~ ^[1-9][0-9]*$ || ! "$shards" =~ ^[1-9][0-9]*$ ]]; then
  usage >&2
  exit 2
fi
packs=$(((spp + 7) / 8))
if ((shards > packs)); then
  echo "render.sh: $shards shards of $packs packs of 8 samples" >&2
  exit 2
fi

scene="$(realpath -e "${files[0]}")"
out="$(realpath -m "${files[1]}")"
parts="${out%.exr}.parts"
export SPECTRACE="${SPECTRACE:-$(realpath -e "$here/../../build/release/cli/spectrace")}" SPECTRACE_SLURM="$here"
mkdir -p "$parts"

array="$(sbatch --parsable "${sbatch[@]}" --job-name=spectrace --array="0-$((shards - 1))" --requeue \
  --signal=B:TERM@120 --open-mode=append --cpus-per-task="$threads" --output="$parts/%a.log" \
  "$here/render_task.sh" "$scene" "$parts" "$spp" "$shards" "$checkpoint" "${options[@]}")"
echo "render: job $array, $shards tasks, logs in $parts"
sbatch "${wait[@]}" "${sbatch[@]}" --job-name=spectrace-merge --dependency="afterok:$array" --kill-on-invalid-dep=yes \
  --output="$parts/merge.log" "$here/merge_task.sh" "$out" "$parts" "$shards"
