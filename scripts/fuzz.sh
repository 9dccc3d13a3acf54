#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# Install, build with clang, fuzz every reader: scripts/fuzz.sh [SECONDS a target, default 60] [targets, default all]
# Exits with 1 where a target crashed, leaked, took over a second or a gigabyte; the input is left in build/fuzz/findings.
set -euo pipefail
cd "$(dirname "$0")/.."

seconds="${1:-60}"
(($# > 0)) && shift
scripts/install_packages.sh clang-14 llvm-14 libclang-rt-14-dev
cmake --preset release >/dev/null
cmake --build --preset release --target spectrace
targets=("$@")
if ((${#targets[@]} == 0)); then
  for source in tests/fuzz/*.cpp; do targets+=("$(basename "$source" .cpp)"); done
fi
cmake --preset fuzz >/dev/null
cmake --build --preset fuzz --target "${targets[@]/#/fuzz_}"

corpus=build/fuzz/corpus findings=build/fuzz/findings
mkdir -p "$findings"
tests/fuzz/make_corpus.sh build/release/cli/spectrace "$corpus"

failed=0
printf '%-12s%14s%12s%12s%12s  %s\n' target executions 'a second' coverage 'peak MB' findings
for target in "${targets[@]}"; do
  log="build/fuzz/$target.log"
  code=0
  # A second of the processor's time is the targets' own limit (fuzz_target.h); the timeout ends what never returns.
  # Allocations beyond what a file of its size may ask for are findings: malloc_limit_mb is for one of them.
  build/fuzz/tests/fuzz/fuzz_"$target" "$corpus/$target" -max_total_time="$seconds" -timeout=60 -rss_limit_mb=1024 \
    -malloc_limit_mb=512 -max_len=400000 -print_final_stats=1 -artifact_prefix="$findings/$target-" >"$log" 2>&1 || code=$?
  ((code == 0)) || failed=1
  statistic() { sed -n "s/^stat::$1: *//p" "$log"; }
  coverage="$(grep -o 'cov: [0-9]*' "$log" | tail -1 | cut -d' ' -f2 || true)"
  printf '%-12s%14s%12s%12s%12s  %s\n' "$target" "$(statistic number_of_executed_units)" \
    "$(statistic average_exec_per_sec)" "$coverage" "$(statistic peak_rss_mb)" \
    "$( ((code == 0)) && echo none || grep -m1 -E 'ERROR|runtime error' "$log" || echo "exit code $code")"
done
exit "$failed"
