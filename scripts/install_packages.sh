#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# Installs the Debian packages that building and testing need, and those named beside; nothing where all are there.
# Why each: docs/dependencies.md.
set -euo pipefail

packages=(
  g++ cmake ninja-build pkg-config git ca-certificates
  libembree-dev libopenexr-dev libopenimageio-dev openimageio-tools libtinyobjloader-dev
  libeigen3-dev libceres-dev libtbb-dev
  libcli11-dev nlohmann-json3-dev libfmt-dev libzstd-dev
  libgtest-dev libbenchmark-dev librapidcheck-dev libvalijson-dev python3 fonts-dejavu-core
  "$@"
)

missing=()
for package in "${packages[@]}"; do
  dpkg-query -W -f='${db:Status-Status}' "$package" 2>/dev/null | grep -qx installed || missing+=("$package")
done
if ((${#missing[@]} == 0)); then
  exit 0
fi

as_root=()
if ((EUID != 0)); then
  command -v sudo >/dev/null || { echo "install_packages.sh: run as root, or install sudo" >&2; exit 1; }
  as_root=(sudo)
fi
echo "Installing ${#missing[@]} packages: ${missing[*]}"
"${as_root[@]}" apt-get update -qq
"${as_root[@]}" env DEBIAN_FRONTEND=noninteractive apt-get install -y -qq --no-install-recommends "${missing[@]}" >/dev/null
