#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# Runs a command within a Slurm job. Where it is killed or interrupted, the job is queued again, to go on from its last
# checkpoint; Slurm does so by itself for nodes that die only. What fails for a reason of its own (usage, bad input,
# an internal error) would fail again: its exit code ends the job.
set -euo pipefail

readonly most_restarts=5 interrupted=5

code=0
"$@" || code=$?
if ((code != interrupted && code <= 128)); then
  exit "$code"
fi
restarts="${SLURM_RESTART_COUNT:-0}"
if ((restarts >= most_restarts)); then
  echo "exit code $code, and queued again $restarts times already: given up" >&2
  exit "$code"
fi
job="$SLURM_JOB_ID"
if [[ -n "${SLURM_ARRAY_JOB_ID:-}" ]]; then
  job="${SLURM_ARRAY_JOB_ID}_${SLURM_ARRAY_TASK_ID}"
fi
echo "exit code $code: queued again" >&2
scontrol requeue "$job"
sleep 600 # Slurm ends this script; to leave first would tell it that the job is done
