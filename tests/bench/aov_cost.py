#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""What AOVs cost: whole runs with "denoise" and with "none" in turns, and with --instructions those of each name over none's.

"CPU of samples" leaves out what runs of one sample take: start, albedo tables, files.
--without-aovs builds the program a second time from a copy of the source in which not even the lines remain that a kernel
without AOVs still has (the count of extrapolated vertices, the pointer to the albedo tables), and tells what those cost.
--memory tells the most that runs of one sample a pixel hold, files written, at sizes of one's choice. Instructions are those of
render_tile() and all below it (callgrind), of small copies of the scenes.
"""

import argparse
import os
import re
import resource
import shutil
import statistics
import subprocess
import tempfile
import time
from pathlib import Path

from unused_effects import ROOT, instructions, small_copy

SPP = 64  # of the runs in turns
NAMES = ("lobes", "direct", "halves", "variance", "albedo", "normal", "depth", "position", "samples", "extrapolated", "crypto_object",
         "denoise", "all")
OF_NAME = {"direct": "diffuse_direct"}
# Of renderer/path_tracer.h: what is there, and what a program that knew no AOVs would have.
LINES = (
    (r"    if \(const Float last = scene_\.last_measured_cosine\[.*?\n    \}\n", ""),
    (r" *albedos_\(job\.albedos\),\n", ""),
    (r"  const AlbedoTables\* albedos_;\n", "  static constexpr const AlbedoTables* albedos_ = nullptr;\n"),
)


def timed(program: Path, scene: Path, folder: Path, aovs: str, threads: int, spp: int) -> tuple[float, float]:
    """Wall and CPU seconds of a whole run."""
    before, start = resource.getrusage(resource.RUSAGE_CHILDREN), time.perf_counter()
    subprocess.run([program, scene, "--spp", str(spp), "--threads", str(threads), "--aovs", aovs, "-o", folder / "out.exr"],
                   check=True, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
    wall, after = time.perf_counter() - start, resource.getrusage(resource.RUSAGE_CHILDREN)
    return wall, after.ru_utime + after.ru_stime - before.ru_utime - before.ru_stime


def in_turns(program: Path, scene: Path, folder: Path, pairs: int, threads: int) -> None:
    ratios = []
    for pair in range(pairs):
        order = ("none", "denoise") if pair % 2 == 0 else ("denoise", "none")
        whole = {aovs: timed(program, scene, folder, aovs, threads, SPP) for aovs in order}
        start = {aovs: timed(program, scene, folder, aovs, threads, 1) for aovs in order}
        (none_wall, none_cpu), (wall, cpu) = whole["none"], whole["denoise"]
        ratios.append((wall / none_wall, cpu / none_cpu, (cpu - start["denoise"][1]) / (none_cpu - start["none"][1])))
    for kind, values in zip(("wall", "CPU", "CPU of samples"), zip(*ratios)):
        print(f"{scene.stem:<24}denoise over none, {kind:<16}{statistics.median(values):>8.3f}   "
              f"(pairs: {', '.join(f'{x:.3f}' for x in sorted(values))})", flush=True)


def peak_memory(program: Path, scene: Path, folder: Path, aovs: str) -> int:
    """Bytes of one run, the files it writes included."""
    process = subprocess.Popen([program, scene, "--spp", "1", "--aovs", aovs, "-o", folder / "out.exr"], stdout=subprocess.DEVNULL,
                               stderr=subprocess.DEVNULL)
    _, status, usage = os.wait4(process.pid, 0)
    if status != 0:
        raise SystemExit(f"{scene}: {aovs}: status {status}")
    return 1024 * usage.ru_maxrss


def make_measurement(program: Path) -> None:
    """What material_ball shows."""
    measurement = ROOT / "demo-out/pearlescent.bsdf"
    if not measurement.exists():
        measurement.parent.mkdir(exist_ok=True)
        subprocess.run([program, "acquire", ROOT / "scenes/materials/pearlescent.json", "-o", measurement], check=True,
                       stdout=subprocess.DEVNULL)


def build_without_aovs(folder: Path) -> Path:
    source = folder / "source"
    shutil.copytree(ROOT, source, dirs_exist_ok=True, ignore=shutil.ignore_patterns("build", ".git", "demo-out"))
    file = source / "renderer/path_tracer.h"
    text = file.read_text()
    for pattern, replacement in LINES:
        text, count = re.subn(pattern, replacement, text, flags=re.DOTALL)
        if count != 1:
            raise SystemExit(f"{file}: {pattern!r} is there {count} times: adapt this script to the source")
    # What is left of the tables' use is never reached, and warned of.
    file.write_text('#pragma GCC diagnostic ignored "-Wnonnull"\n' + text)
    for command in (["cmake", "--preset", "release", "-DSPECTRACE_BUILD_TESTS=OFF"],
                    ["cmake", "--build", "--preset", "release", "--target", "spectrace"]):
        subprocess.run(command, check=True, stdout=subprocess.DEVNULL, cwd=source)
    return source / "build/release/cli/spectrace"


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("spectrace", type=Path, help="the program")
    parser.add_argument("--scenes", nargs="+", default=["cornell_box", "material_ball"])
    parser.add_argument("--pairs", type=int, default=7, help="of runs in turns (default %(default)s)")
    parser.add_argument("--size", type=int, default=256, help="pixels a side of the runs in turns (default %(default)s)")
    parser.add_argument("--threads", type=int, default=2)
    parser.add_argument("--instructions", action="store_true", help="of each name, over none's")
    parser.add_argument("--memory", nargs="+", type=int, default=[], metavar="SIZE", help="pixels a side")
    parser.add_argument("--without-aovs", type=Path, metavar="FOLDER", help="for the second build")
    arguments = parser.parse_args()
    program = arguments.spectrace.resolve()
    with tempfile.TemporaryDirectory() as temporary:
        folder = Path(temporary)
        make_measurement(program)
        scenes = [ROOT / "scenes" / f"{name}.json" for name in arguments.scenes]
        for scene in scenes if arguments.pairs > 0 else ():
            in_turns(program, small_copy(scene, arguments.size, folder), folder, arguments.pairs, arguments.threads)
        for scene in scenes:
            for size in arguments.memory:
                gigabytes = [peak_memory(program, small_copy(scene, size, folder), folder, aovs) / 1e9 for aovs in ("none", "denoise")]
                print(f"{scene.stem:<24}{size} x {size}, GB: none {gigabytes[0]:.3f}, denoise {gigabytes[1]:.3f}", flush=True)
        if not arguments.instructions and not arguments.without_aovs:
            return
        small = [small_copy(scene, 24, folder) for scene in scenes]
        none = {scene: instructions(program, scene, folder, "--aovs", "none") for scene in small}
        for scene in small if arguments.instructions else ():
            for name in NAMES:
                count = instructions(program, scene, folder, "--aovs", OF_NAME.get(name, name))
                print(f"{scene.stem:<24}{name:<18}{100 * (count / none[scene] - 1):>8.2f} % more instructions", flush=True)
        if arguments.without_aovs:
            bare = build_without_aovs(arguments.without_aovs.resolve())
            for scene in small:
                count = instructions(bare, scene, folder, "--aovs", "none")
                print(f"{scene.stem:<24}none, over a program without AOVs: {100 * (none[scene] / count - 1):.3f} % more instructions",
                      flush=True)


if __name__ == "__main__":
    os.environ.setdefault("SPECTRACE_DATA", str(ROOT.parent / "shared/data"))
    main()
