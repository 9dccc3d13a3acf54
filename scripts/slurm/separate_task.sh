#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# One task of scripts/slurm/separate.sh: every tasks-th file. All are tried; the exit code is that of the first that failed.
set -euo pipefail

input="$1" output="$2" tasks="$3"
shift 3
files=("$input"/*.bsdf)
failed=0
for ((i = SLURM_ARRAY_TASK_ID; i < ${#files[@]}; i += tasks)); do
  name="$(basename "${files[i]}" .bsdf)"
  [[ -e "$output/$name.sep" ]] && continue
  code=0
  "$SPECTRACE_SLURM/or_requeue.sh" "$SPECTRACE" separate "${files[i]}" -o "$output/$name.sep" \
    --threads "${SLURM_CPUS_PER_TASK:-1}" "$@" || code=$?
  ((failed != 0)) || failed="$code"
done
exit "$failed"
