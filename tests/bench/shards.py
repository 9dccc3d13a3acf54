#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""What docs/scaling.md says of shards: a render in 1, 2, 4 (and more) of them, their merge, and the size of parts.

Shards have one thread each and run as many at a time as there are cores. With --measurements a folder of .bsdf files is separated
by scripts/slurm/separate.sh too, as arrays of 1, 2 and 4 tasks, on a Slurm that this script starts (root; tests/slurm_test.py).
"""

import argparse
import os
import subprocess
import sys
import tempfile
import time
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path

from unused_effects import ROOT, small_copy

sys.path.insert(0, str(ROOT / "tests"))
LEAF = 8  # samples that ranges are multiples of


def run(*command: object) -> tuple[float, int]:
    """Wall seconds, and the most memory held [bytes]."""
    start = time.perf_counter()
    child = subprocess.Popen([str(word) for word in command], stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
    _, status, usage = os.wait4(child.pid, 0)
    child.returncode = os.waitstatus_to_exitcode(status)
    if child.returncode != 0:
        raise SystemExit(f"exit code {child.returncode}: {' '.join(map(str, command))}")
    return time.perf_counter() - start, 1024 * usage.ru_maxrss


def shard(program: Path, scene: Path, folder: Path, spp: int, shards: int, index: int) -> Path:
    first, last = spp * index // shards, spp * (index + 1) // shards
    run(program, scene, "--samples", f"{first}:{last}", "--threads", 1, "-o", folder / f"{shards}-{index}.exr")
    return folder / f"{shards}-{index}.partial"


def measure_shards(program: Path, scene: Path, folder: Path, spp: int, counts: list[int]) -> None:
    cores = len(os.sched_getaffinity(0))
    print(f"{scene.stem}, {spp} samples, shards of one thread, {cores} at a time")
    print(f"{'shards':>8}{'wall [s]':>10}{'over one':>10}{'merge [s]':>11}{'memory [MB]':>13}{'read [MB]':>11}")
    alone, merges = 0.0, []
    for count in counts:
        start = time.perf_counter()
        with ThreadPoolExecutor(cores) as pool:
            parts = list(pool.map(lambda i, n=count: shard(program, scene, folder, spp, n, i), range(count)))
        wall = time.perf_counter() - start
        alone = alone or wall
        seconds, memory = min(run(program, "merge", *parts, "-o", folder / "merged.exr") for _ in range(3))
        size = sum(part.stat().st_size for part in parts)
        merges.append((seconds, size))
        print(f"{count:>8}{wall:>10.2f}{alone / wall:>10.2f}{seconds:>11.2f}{memory / 1e6:>13.0f}{size / 1e6:>11.0f}", flush=True)
    (few, few_bytes), (many, many_bytes) = merges[-2:]
    if many > few:
        print(f"from {counts[-2]} to {counts[-1]} parts the merge reads {(many_bytes - few_bytes) / (many - few) / 1e6:.0f} MB/s")


def measure_parts(program: Path, scene: Path, folder: Path, pixels: int) -> None:
    for aovs in ("none", "lobes", "denoise", "all"):
        run(program, scene, "--samples", "0:8", "--aovs", aovs, "-o", folder / f"{aovs}.exr")
        size = (folder / f"{aovs}.partial").stat().st_size
        print(f"{aovs:<10}{size / pixels:>8.1f} bytes a pixel, {size / 1e6:.1f} MB", flush=True)


def measure_separations(program: Path, measurements: Path, folder: Path, options: list[str]) -> None:
    import slurm_test

    os.environ["SPECTRACE"] = str(program)
    with slurm_test.Cluster(folder) as cluster:
        alone = 0.0
        for tasks in (1, 2, 4):
            start = time.perf_counter()
            cluster.run(str(ROOT / "scripts/slurm/separate.sh"), str(measurements), str(folder / f"separated-{tasks}"), "--tasks",
                        str(tasks), "--wait", "--", *options)
            wall = time.perf_counter() - start
            alone = alone or wall
            made = len(list((folder / f"separated-{tasks}").glob("*.sep")))
            print(f"separation of {made} measurements, {tasks} tasks: {wall:.1f} s, {alone / wall:.2f} times as fast", flush=True)


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("spectrace", type=Path, help="the program")
    parser.add_argument("--scene", default="cornell_box")
    parser.add_argument("--size", type=int, default=512)
    parser.add_argument("--spp", type=int, default=128)
    parser.add_argument("--shards", type=int, nargs="+", default=[1, 2, 4, 16])
    parser.add_argument("--measurements", type=Path, help="folder of .bsdf files to separate as Slurm arrays")
    parser.add_argument("--separate-options", default="", help="of spectrace separate")
    arguments = parser.parse_args()
    for count in arguments.shards:
        if arguments.spp % (LEAF * count) != 0:
            parser.error(f"--spp {arguments.spp}: in {count} shards, each needs a multiple of {LEAF} samples")
    program = arguments.spectrace.resolve()
    with tempfile.TemporaryDirectory() as temporary:
        folder = Path(temporary)
        if arguments.measurements:
            measure_separations(program, arguments.measurements.resolve(), folder, arguments.separate_options.split())
            return
        scene = small_copy(ROOT / "scenes" / f"{arguments.scene}.json", arguments.size, folder)
        measure_shards(program, scene, folder, arguments.spp, arguments.shards)
        measure_parts(program, scene, folder, arguments.size ** 2)


if __name__ == "__main__":
    main()
