#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# Runs a command within a Slurm job. Where it is killed or interrupted, the job is queued again, to go on from its last
# checkpoint; Slurm does so by itself for nodes that die only. What fails for a reason of its own (usage, bad input,
# an internal error) would fail again: its exit code ends the job. A job that somebody cancels stays cancelled.
set -euo pipefail

readonly most_restarts=5 interrupted=5

# Slurm's warning before the time limit (--signal=B:TERM@...) comes to this script alone. Passed on, the program writes a
# checkpoint and ends with $interrupted.
"$@" &
child=$!
trap 'kill -TERM "$child" 2>/dev/null || true' TERM
code=0
wait "$child" || code=$?
while kill -0 "$child" 2>/dev/null; do # it was the trap that ended the wait
  code=0
  wait "$child" || code=$?
done
if ((code != interrupted && code <= 128)); then
  exit "$code"
fi

job="$SLURM_JOB_ID"
if [[ -n "${SLURM_ARRAY_JOB_ID:-}" ]]; then
  job="${SLURM_ARRAY_JOB_ID}_${SLURM_ARRAY_TASK_ID}"
fi
state="$(squeue --noheader --jobs="$job" --format=%T 2>/dev/null || true)"
if [[ "$state" != RUNNING ]]; then
  echo "exit code $code, and the job is ${state:-gone}: not queued again" >&2
  exit "$code"
fi
restarts="${SLURM_RESTART_COUNT:-0}"
if ((code != interrupted && restarts >= most_restarts)); then # interrupted, it has come further each time
  echo "exit code $code, and queued again $restarts times already: given up" >&2
  exit "$code"
fi
echo "exit code $code: queued again" >&2
scontrol requeue "$job"
sleep 600 # Slurm ends this script; to leave first would tell it that the job is done
