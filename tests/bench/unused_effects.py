#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""What effects cost that a scene does not have: instructions of its kernel, against a build in which the effect does not exist.

Builds the program once for each effect, in a folder of its own (only renderer/kernels.cpp differs), and counts the instructions
of render_tile() with callgrind: of small copies of scenes that do not use it. Then, with --full, every scene by its lean and by
the full kernel: instructions, and CPU seconds in turns.
"""

import argparse
import os
import re
import resource
import statistics
import subprocess
import tempfile
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
SPP = 8


def effects() -> dict[str, str]:
    """Name on the command line: name in Features."""
    text = (ROOT / "renderer/features.h").read_text()
    return {name: field for field, name in re.findall(r'\{&Features::(\w+), "([\w-]+)"', text)}


def build(folder: Path, without: str) -> Path:
    run = lambda *command: subprocess.run(command, cwd=ROOT, check=True, stdout=subprocess.DEVNULL)  # noqa: E731
    run("cmake", "-S", ".", "-B", str(folder), "-G", "Ninja", "-DCMAKE_BUILD_TYPE=Release", "-DSPECTRACE_BUILD_TESTS=OFF",
        f"-DSPECTRACE_WITHOUT_EFFECT={without}")
    run("cmake", "--build", str(folder), "--target", "spectrace")
    return folder / "cli/spectrace"


def small_copy(scene: Path, size: int, folder: Path) -> Path:
    text = re.sub(r'"width": \d+, "height": \d+', f'"width": {size}, "height": {size}', scene.read_text(), count=1)
    text = re.sub(r'"(\.\./demo-out/|meshes/|materials/)', lambda m: f'"{(ROOT / "scenes" / m[1]).resolve()}/', text)
    copy = folder / f"{scene.stem}-{size}.json"
    copy.write_text(text)
    return copy


def instructions(program: Path, scene: Path, folder: Path, *options: str) -> int:
    command = ["valgrind", "--tool=callgrind", "--callgrind-out-file=/dev/null", "--toggle-collect=*render_tile*", str(program),
               str(scene), "--spp", str(SPP), "--threads", "1", "-o", str(folder / "out.exr"), *options]
    done = subprocess.run(command, capture_output=True, text=True, check=True)
    return int(re.search(r"Collected : (\d+)", done.stderr)[1])


def used_effects(program: Path, scene: Path) -> dict:
    """Of the scene: kernel, and the names in prose of what it does not simulate."""
    text = subprocess.run([program, scene, "--effects"], capture_output=True, text=True, check=True).stdout
    return {"kernel": re.search(r"kernel: (.*)", text)[1],
            "skipped": dict(re.findall(r"^not simulated  ([^:]+): (.*)$", text, re.MULTILINE))}


def prose_names() -> dict[str, str]:
    text = (ROOT / "renderer/features.h").read_text()
    return dict(re.findall(r'\{&Features::\w+, "([\w-]+)", "([^"]+)"', text))


def cpu_seconds(program: Path, scene: Path, folder: Path, *options: str) -> float:
    before = resource.getrusage(resource.RUSAGE_CHILDREN)
    subprocess.run([program, scene, "--spp", "32", "-o", folder / "out.exr", *options], check=True, stdout=subprocess.DEVNULL,
                   stderr=subprocess.DEVNULL)
    after = resource.getrusage(resource.RUSAGE_CHILDREN)
    return after.ru_utime - before.ru_utime


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("spectrace", type=Path, help="the program")
    parser.add_argument("--build", type=Path, default=ROOT / "build/without", help="folder for the other builds")
    parser.add_argument("--effects", nargs="*", help="some of them; default: all")
    parser.add_argument("--scenes", nargs="+", default=["cornell_box", "sphere_checkerboard"])
    parser.add_argument("--full", action="store_true", help="every scene by the full kernel too")
    parser.add_argument("--runs", type=int, default=5, help="of --full")
    arguments = parser.parse_args()
    names, prose, program = effects(), prose_names(), arguments.spectrace.resolve()
    with tempfile.TemporaryDirectory() as temporary:
        folder = Path(temporary)
        scenes = [small_copy(ROOT / "scenes" / f"{name}.json", 24, folder) for name in arguments.scenes]
        if arguments.effects is None or arguments.effects:
            told = {scene: used_effects(program, scene) for scene in scenes}
            base = {scene: instructions(program, scene, folder) for scene in scenes}
            print(f"{'effect':<18}{'scene':<26}{'kernel':<12}{'in kernel':>10}{'more instructions [%]':>24}", flush=True)
        for name in names if arguments.effects is None else arguments.effects:
            cases = [scene for scene in scenes if prose[name] in told[scene]["skipped"]]
            stripped = build(arguments.build, names[name]) if cases else None
            for scene in cases:
                without = instructions(stripped, scene, folder)
                asks = "checks" in told[scene]["skipped"][prose[name]]
                print(f"{name:<18}{scene.stem:<26}{told[scene]['kernel']:<12}{'yes' if asks else 'no':>10}"
                      f"{100 * (base[scene] / without - 1):>24.3f}", flush=True)
        if not arguments.full:
            return
        force = [option for name in names if name != "specular-parts" for option in ("--force-effect", name)]
        print(f"{'scene':<22}{'lean kernel':<24}{'instructions':>14}{'CPU s':>10}   full over lean", flush=True)
        for scene in sorted((ROOT / "scenes").glob("*.json")):
            if scene.name == "scene.schema.json":
                continue
            tiny, larger = small_copy(scene, 24, folder), small_copy(scene, 192, folder)
            count = instructions(program, tiny, folder, *force) / instructions(program, tiny, folder)
            pairs = [(cpu_seconds(program, larger, folder), cpu_seconds(program, larger, folder, *force))
                     for _ in range(arguments.runs)]
            ratio = statistics.median(full / lean for lean, full in pairs)
            print(f"{scene.stem:<22}{used_effects(program, tiny)['kernel']:<24}{count:>14.3f}{ratio:>10.3f}", flush=True)


if __name__ == "__main__":
    os.environ.setdefault("SPECTRACE_DATA", str(ROOT.parent / "shared/data"))
    main()
