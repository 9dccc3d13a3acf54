#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Holds the two rules of ADR 0001: an include only points left, and each third party has one door.

Usage: check_layers.py [PROJECT_ROOT]. Prints one line a fault, `file:line: what`, and exits 1 if there is any.
"""
import re
import sys
from pathlib import Path

# What each layer may include besides itself.
LAYERS = {
    "core": set(),
    "materials": {"core"},
    "separation": {"core", "materials"},
    "renderer": {"core", "materials"},
    "cli": {"core", "materials", "separation", "renderer"},
}

# Third party: the include that gives it away, and the files that may have it.
DOORS = {
    "nlohmann/json": (r"nlohmann/", r"core/base/[^/]+\.cpp"),
    "OpenEXR": (r"OpenEXR/|Imath/|Imf|Imath|Iex|half\.h", r"core/image/[^/]+\.cpp"),
    "OpenImageIO": (r"OpenImageIO/", r"core/image/[^/]+\.cpp"),
    "Embree": (r"embree\d*/", r"renderer/accel_embree\.cpp"),
    "Ceres": (r"ceres/|glog/", r"separation/.+\.cpp"),
    "Eigen": (r"Eigen/|unsupported/Eigen/", r"separation/.+"),
    "tinyobjloader": (r"tiny_obj_loader", r"renderer/obj_file\.cpp"),
    "oneTBB": (r"tbb/|oneapi/", r"(separation|renderer)/.+\.cpp"),
    "Zstandard": (r"zstd", r"materials/packed_table\.cpp"),
    "CLI11": (r"CLI/", r"cli/.+"),
    "fmt": (r"fmt/", r".+\.cpp"),
}

# Of the platform, not third parties: system calls and intrinsics.
PLATFORM = re.compile(r"(sys|linux)/\w+\.h|(unistd|fcntl|signal|poll|netdb|spawn|dirent|errno|[a-z]*intrin)\.h")
STANDARD = re.compile(r"[a-z_0-9]+")
INCLUDE = re.compile(r'^\s*#\s*include\s*([<"])([^>"]+)[>"]')


def project_include_fault(layer, name):
    if "/" not in name:
        return None  # written by the build: the commit, tables
    target = name.split("/")[0]
    if target not in LAYERS:
        return f'"{name}" is in no layer ({", ".join(LAYERS)})'
    if target != layer and target not in LAYERS[layer]:
        return f'{layer} may not include "{name}": an include only points left'
    return None


def system_include_fault(file, name):
    for party, (pattern, door) in DOORS.items():
        if re.match(pattern, name):
            return None if re.fullmatch(door, file) else f"<{name}>: the door to {party} is {door}"
    if PLATFORM.fullmatch(name) or STANDARD.fullmatch(name):
        return None
    return f"<{name}> is of no known third party: docs/dependencies.md, then a door in {Path(__file__).name}"


def faults_of(root, path):
    file = path.relative_to(root).as_posix()
    for number, line in enumerate(path.read_text(encoding="utf-8").splitlines(), 1):
        match = INCLUDE.match(line)
        if not match:
            continue
        kind, name = match.groups()
        third_party = any(re.match(pattern, name) for pattern, _ in DOORS.values())
        if kind == '"' and not third_party:
            fault = project_include_fault(file.split("/")[0], name)
        else:
            fault = system_include_fault(file, name)
        if fault:
            yield f"{file}:{number}: {fault}"


def check(root):
    """All faults below `root`, one line each, and the number of files read."""
    paths = sorted(p for layer in LAYERS for p in (root / layer).rglob("*") if p.suffix in {".h", ".cpp"})
    return [fault for path in paths for fault in faults_of(root, path)], len(paths)


def main():
    root = Path(sys.argv[1] if len(sys.argv) > 1 else Path(__file__).parent.parent).resolve()
    faults, files = check(root)
    print("\n".join(faults) if faults else f"{files} files: every include points left, every third party has its door")
    if not files:
        print(f"{root}: no sources there")
    sys.exit(1 if faults or not files else 0)


if __name__ == "__main__":
    main()
