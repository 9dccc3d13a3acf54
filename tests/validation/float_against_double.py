#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""How far single precision is from double: every scene of scenes/ rendered by both builds of one source, at equal seeds.

    tests/validation/float_against_double.py [--spp N] [--shrink N] [--programs FLOAT DOUBLE] [--into docs/validation.md]

Builds the presets `release` and `double` (programs only) unless --programs names two. Both draw the same random numbers, so
that the pictures differ by rounding alone, and by paths that rounding sends elsewhere. Prints a table (Markdown), with --into
also in the place of the table there. Exits with 1 where the PSNR of the beauty lies below BOUND_DB.
"""
import argparse
import json
import pathlib
import re
import subprocess
import sys
import tempfile

from tables import replace_table

ROOT = pathlib.Path(__file__).resolve().parents[2]
BOUND_DB = 60
LAYERS = ("beauty", "diffuse", "specular")


def build() -> tuple[pathlib.Path, pathlib.Path]:
    for preset in ("release", "double"):
        for command in (["cmake", "--preset", preset], ["cmake", "--build", "--preset", preset, "--target", "spectrace"]):
            subprocess.run(command, cwd=ROOT, check=True, stdout=sys.stderr)
    return ROOT / "build/release/cli/spectrace", ROOT / "build/double/cli/spectrace"


def acquired(program: pathlib.Path, name: str, folder: pathlib.Path) -> pathlib.Path:
    """The measurement that scripts/demo.sh makes of a material of ours."""
    file = folder / f"{name}.bsdf"
    if not file.exists():
        subprocess.run([program, "acquire", ROOT / "scenes/materials" / f"{name}.json", "-o", file], check=True,
                       stdout=subprocess.DEVNULL)
    return file


def smaller(program: pathlib.Path, scene: pathlib.Path, shrink: int, folder: pathlib.Path) -> pathlib.Path:
    """The scene with its sides divided, in a folder of its own: what it names is found from there."""
    text = re.sub(r'"(width|height)": (\d+)', lambda m: f'"{m[1]}": {max(1, int(m[2]) // shrink)}', scene.read_text())
    text = re.sub(r'"\.\./demo-out/(\w+)\.bsdf"', lambda m: json.dumps(str(acquired(program, m[1], folder))), text)
    text = re.sub(r'"(\.\./[^"]*|meshes/[^"]*|materials/[^"]*)"', lambda m: json.dumps(str((scene.parent / m[1]).resolve())), text)
    copy = folder / scene.name
    copy.write_text(text)
    return copy


def render(program: pathlib.Path, scene: pathlib.Path, spp: int, output: pathlib.Path) -> None:
    subprocess.run([program, scene, "--spp", str(spp), "--seed", "0", "--aovs", "lobes", "-o", output], check=True,
                   stdout=subprocess.DEVNULL)


def psnr(program: pathlib.Path, reference: pathlib.Path, test: pathlib.Path, folder: pathlib.Path) -> dict[str, float | None]:
    """dB by layer; None where a layer is the same in both, as an empty one is. What is not finite ends the program."""
    report = folder / "compare.json"
    done = subprocess.run([program, "compare", reference, test, "--json", report], stdout=subprocess.DEVNULL, check=False)
    if done.returncode not in (0, 1):
        sys.exit(f"cannot compare {reference} and {test}: exit code {done.returncode}")
    layers = json.loads(report.read_text())["layers"]
    for layer in layers:
        if not layer["finite"] or (layer["psnr"] is None and layer["mse"] != 0):
            sys.exit(f"{test.name}: {layer['layer']} is not finite")
    return {layer["layer"]: layer["psnr"] for layer in layers}


def main() -> int:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--spp", type=int, default=64)
    parser.add_argument("--shrink", type=int, default=4, help="divisor of the scenes' width and height")
    parser.add_argument("--programs", type=pathlib.Path, nargs=2, metavar=("FLOAT", "DOUBLE"))
    parser.add_argument("--into", type=pathlib.Path, help="a document whose table is replaced")
    arguments = parser.parse_args()
    programs = [p.resolve() for p in arguments.programs or build()]

    table = "| scene | beauty, dB | diffuse | specular |\n|---|---|---|---|\n"
    low = []
    with tempfile.TemporaryDirectory() as scratch:
        folder = pathlib.Path(scratch)
        for scene in sorted((ROOT / "scenes").glob("*.json")):
            if scene.name == "scene.schema.json":
                continue
            copy = smaller(programs[0], scene, arguments.shrink, folder)
            images = [folder / "float.exr", folder / "double.exr"]
            for program, image in zip(programs, images):
                render(program, copy, arguments.spp, image)
            found = psnr(programs[0], images[1], images[0], folder)
            beauty = found.get("beauty")
            if beauty is None:
                sys.exit(f"{scene.stem}: the same to the bit, so that both programs have one precision")
            if beauty < BOUND_DB:
                low.append(scene.stem)
            row = f"| `{scene.stem}` | " + " | ".join(
                "-" if found.get(name) is None else f"{found[name]:.1f}" for name in LAYERS) + " |\n"
            print(row, end="", file=sys.stderr, flush=True)
            table += row
    print(table)
    if low:
        print(f"below {BOUND_DB} dB: {', '.join(low)}", file=sys.stderr)
    elif arguments.into:
        replace_table(arguments.into, "float against double", table)
    return 1 if low else 0


if __name__ == "__main__":
    sys.exit(main())
