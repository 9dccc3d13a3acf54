#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Holds docs/denoising.md to Open Image Denoise: what a denoised picture gains, and that the lobes apart earn their keep.

Renders material_ball and glass_and_coats with "aovs": "denoise" at 16 samples and converged pictures with another seed, runs
scripts/denoise.py on them and reads its figures. Each way of each scene must have at most a fifth of the noisy picture's relMSE;
where highlights lie on textures, the lobes apart must have at least the PSNR of the whole. Takes minutes. Exits with 77 (skipped)
without the environment of scripts/denoise.py, which --install makes.

Usage: denoise_test.py --install, then denoise_test.py SPECTRACE
"""
from __future__ import annotations

import argparse
import json
import shutil
import subprocess
import sys
import tempfile
from pathlib import Path

SKIPPED = 77
ROOT = Path(__file__).resolve().parent.parent
SPP, SEED_OF_REFERENCE = 16, 7
LEAST_GAIN = 5  # of relMSE, over the noisy picture: the promise
REFERENCE_SPP = {"material_ball": 1024, "glass_and_coats": 1024}
HIGHLIGHTS_ON_TEXTURES = "glass_and_coats"


def copy_of_scenes(spectrace: str, folder: Path) -> Path:
    """With the measurement that material_ball shows beside them, where it looks for it."""
    shutil.copytree(ROOT / "scenes", folder / "scenes")
    (folder / "demo-out").mkdir()
    subprocess.run([spectrace, "acquire", folder / "scenes/materials/pearlescent.json", "-o",
                    folder / "demo-out/pearlescent.bsdf"], check=True, stdout=subprocess.DEVNULL)
    return folder / "scenes"


def figures_of(spectrace: str, scene: Path, environment: Path, folder: Path) -> dict[str, dict[str, float]]:
    """Of each picture that scripts/denoise.py makes: its metrics."""
    noisy, converged = folder / f"{scene.stem}.exr", folder / f"{scene.stem}-converged.exr"
    for options in (["--aovs", "denoise", "--spp", str(SPP), "-o", noisy],
                    ["--spp", str(REFERENCE_SPP[scene.stem]), "--seed", str(SEED_OF_REFERENCE), "-o", converged]):
        subprocess.run([spectrace, scene, *options], check=True, stdout=subprocess.DEVNULL)
    out = folder / f"{scene.stem}-denoised"
    subprocess.run([sys.executable, ROOT / "scripts/denoise.py", noisy, "--reference", converged, "-o", out, "--venv", environment],
                   check=True, stdout=subprocess.DEVNULL)
    return json.loads((out / "figures.json").read_text())["metrics"]


def failures(scene: str, metrics: dict[str, dict[str, float]]) -> list[str]:
    noisy, found = metrics["noisy"]["relmse"], []
    for name, m in metrics.items():
        gain = noisy / m["relmse"]
        print(f"{scene:<18}{name:<8}relMSE {m['relmse']:.3e} ({gain:.1f} times lower), PSNR {m['psnr']:.2f} dB, SSIM {m['ssim']:.4f}",
              flush=True)
        if name != "noisy" and gain < LEAST_GAIN:
            found.append(f"{scene}, {name}: relMSE is {gain:.2f} times lower, not {LEAST_GAIN}")
    if scene == HIGHLIGHTS_ON_TEXTURES and metrics["lobes"]["psnr"] < metrics["joint"]["psnr"]:
        found.append(f"{scene}: the lobes apart have less PSNR than the whole")
    return found


def main() -> int:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("spectrace", nargs="?", help="the program")
    parser.add_argument("--environment", type=Path, default=ROOT / "build/denoise", help="of scripts/denoise.py")
    parser.add_argument("--install", action="store_true", help="make the environment, from PyPI; no test")
    arguments = parser.parse_args()
    environment = arguments.environment.resolve()
    if arguments.install:
        return subprocess.run([sys.executable, ROOT / "scripts/denoise.py", "--install", "--venv", environment], check=False).returncode
    if arguments.spectrace is None:
        parser.error("name the program")
    if not (environment / "bin/python").exists():
        print(f"skipped: no Open Image Denoise in {environment} (--install)")
        return SKIPPED
    spectrace = str(Path(arguments.spectrace).resolve())
    found: list[str] = []
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        scenes = copy_of_scenes(spectrace, folder)
        for scene in REFERENCE_SPP:
            found += failures(scene, figures_of(spectrace, scenes / f"{scene}.json", environment, folder))
    print("".join(f"FAILED: {line}\n" for line in found), end="")
    return 1 if found else 0


if __name__ == "__main__":
    sys.exit(main())
