#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# Install, build, test. Arguments go to ctest, for example: scripts/test.sh -L unit
# The long tests, those that start a Slurm and those that denoise stay out unless asked for (docs/validation.md): scripts/test.sh -L long
set -euo pipefail
cd "$(dirname "$0")/.."

scripts/install_packages.sh
export SPECTRACE_DATA="${SPECTRACE_DATA:-$PWD/../shared/data}"
cmake --preset release -DSPECTRACE_BUILD_TESTS=ON >/dev/null
cmake --build --preset release

selection=("$@")
if ((${#selection[@]} == 0)); then
  selection=(-LE 'long|slurm|denoise')
fi
if [[ " ${selection[*]} " == *" reader "* ]]; then
  tests/spectral_reader.py --install --environment build/release/reader
fi
if [[ " ${selection[*]} " == *" metrics "* ]]; then
  tests/metrics_against_scikit.py --install build/release/scikit
fi
if [[ " ${selection[*]} " == *" denoise "* ]]; then
  tests/denoise_test.py --install --environment build/release/denoise
fi
if [[ " ${selection[*]} " == *" browser "* ]]; then
  scripts/install_packages.sh chromium chromium-driver
fi
if [[ " ${selection[*]} " == *" slurm "* ]]; then
  scripts/install_packages.sh slurm-wlm munge
fi
exec ctest --test-dir build/release --output-on-failure -j "$(nproc)" "${selection[@]}"
