#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# Submits the separation of every measurement in a folder as a Slurm job array.
set -euo pipefail

usage() {
  cat <<'TEXT'
scripts/slurm/separate.sh FOLDER OUTPUT [options] [-- options of spectrace separate]

  --tasks N         of the array; default: one a file. Task i takes files i, i + N, i + 2N, ...
  --threads N       of each task (default 1)
  --sbatch OPTIONS  for the jobs, for example --sbatch "--partition=long --time=4:00:00"
  --wait            return when all are done; exit code of the array

Writes OUTPUT/NAME.sep for each FOLDER/NAME.bsdf, and N.log of task N. Files that are there already are left alone, so
that the command may be given again. The program is $SPECTRACE, else build/release/cli/spectrace.
TEXT
}

here="$(cd "$(dirname "${BASH_SOURCE[0]}")" && pwd)"
tasks="" threads=1 wait=() sbatch=() folders=() options=()
while (($# > 0)); do
  case "$1" in
    -h | --help) usage; exit 0 ;;
    --tasks) tasks="$2"; shift 2 ;;
    --threads) threads="$2"; shift 2 ;;
    --sbatch) read -ra sbatch <<<"$2"; shift 2 ;;
    --wait) wait=(--wait); shift ;;
    --) shift; options=("$@"); break ;;
    -*) echo "separate.sh: unknown option $1" >&2; exit 2 ;;
    *) folders+=("$1"); shift ;;
  esac
done
if ((${#folders[@]} != 2)); then
  usage >&2
  exit 2
fi
input="$(realpath -e "${folders[0]}")"
mkdir -p "${folders[1]}"
output="$(realpath -e "${folders[1]}")"
shopt -s nullglob
files=("$input"/*.bsdf)
if ((${#files[@]} == 0)); then
  echo "separate.sh: $input: no .bsdf files" >&2
  exit 3
fi
tasks="${tasks:-${#files[@]}}"
export SPECTRACE="${SPECTRACE:-$(realpath -e "$here/../../build/release/cli/spectrace")}" SPECTRACE_SLURM="$here"
sbatch "${wait[@]}" "${sbatch[@]}" --job-name=spectrace-separate --array="0-$((tasks - 1))" --requeue \
  --open-mode=append --cpus-per-task="$threads" --output="$output/%a.log" \
  "$here/separate_task.sh" "$input" "$output" "$tasks" "${options[@]}"
