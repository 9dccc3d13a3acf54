#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""What a thousand lamps cost: noise and time of a scene of many small lamps against those of the few that matter.

Usage: many_lights.py SPECTRACE... [--lights N] [--near N] [--resolution N] [--spp N] [--reference-spp N] [--runs N]
                      [--keep FOLDER]

The scene: a floor with boxes and balls on it; over what the camera sees, --near lamps (spheres and squares that face
down, of mixed size and power); all around, up to 200 m away, the others, of the same kinds. `many` has them all, `few`
those near alone. Every picture is compared with its own scene's reference of another seed.

Noise-time = relMSE x user CPU seconds. Runs of all programs and scenes take turns, each with its own seed; medians are
given. Several programs (builds) may be named to be compared with each other.
"""
import argparse
import json
import math
import random
import resource
import statistics
import subprocess
import tempfile
from pathlib import Path

REACH = 200  # metres to the last lamp


def lamp(kind, position, size, radiance):
    x, y, z = position
    emission = {"illuminant": "A", "scale": radiance}
    if kind == "sphere":
        return {"type": "sphere", "material": "black", "center": position, "radius": size / 2, "emission": emission}
    return {"type": "quad", "material": "black", "corner": [x - size / 2, y - size / 2, z],
            "edge_u": [0, size, 0], "edge_v": [size, 0, 0], "emission": emission}


def lamps(count, near, seed=1):
    rng = random.Random(seed)
    found = []
    for i in range(count):
        if i < near:  # over the stage
            x, y = rng.uniform(-2, 2), rng.uniform(-2, 2)
        else:  # as many on each square metre of a ring
            radius, angle = math.sqrt(rng.uniform(15**2, REACH**2)), rng.uniform(0, 2 * math.pi)
            x, y = radius * math.cos(angle), radius * math.sin(angle)
        size = rng.uniform(0.05, 0.2)
        watt = rng.uniform(4, 16)
        found.append(lamp(rng.choice(["sphere", "quad"]), [x, y, rng.uniform(2, 3)], size, watt / size**2))
    return found


def scene(lights, resolution, spp):
    rng = random.Random(2)
    shapes = [{"type": "quad", "material": "floor", "corner": [-300, -300, 0], "edge_u": [600, 0, 0],
               "edge_v": [0, 600, 0]}]
    for _ in range(6):
        radius = rng.uniform(0.2, 0.5)
        shapes.append({"type": "sphere", "material": rng.choice(["paint", "gold"]), "radius": radius,
                       "center": [rng.uniform(-1.8, 1.8), rng.uniform(-1.8, 1.8), radius]})
    return {
        "camera": {"origin": [0, -5, 6], "target": [0, 0, 0], "up": [0, 0, 1], "fov_deg": 35},
        "film": {"width": resolution, "height": resolution}, "sampler": {"spp": spp},
        "integrator": {"max_depth": 4},
        "materials": [{"name": "floor", "type": "lambert", "reflectance": 0.5},
                      {"name": "black", "type": "lambert", "reflectance": 0},
                      {"name": "paint", "type": "plastic", "eta": 1.5, "reflectance": {"rgb": [0.6, 0.2, 0.1]}, "roughness": 0.2},
                      {"name": "gold", "type": "conductor", "metal": "Au", "roughness": 0.3}],
        "shapes": shapes + lights}


def render(spectrace, file, output, spp, seed):
    before = resource.getrusage(resource.RUSAGE_CHILDREN).ru_utime
    subprocess.run([spectrace, file, "-o", output, "--spp", str(spp), "--seed", str(seed), "--aovs", "none"], check=True,
                   capture_output=True)
    return resource.getrusage(resource.RUSAGE_CHILDREN).ru_utime - before


def relmse(spectrace, reference, image, folder):
    figures = folder / "figures.json"
    subprocess.run([spectrace, "compare", reference, image, "--json", figures], check=True, capture_output=True)
    return json.loads(figures.read_text())


def find(tree, key):
    """The first value of `key`, however deep."""
    if isinstance(tree, dict):
        if key in tree:
            return tree[key]
        tree = list(tree.values())
    if isinstance(tree, list):
        for part in tree:
            if (value := find(part, key)) is not None:
                return value
    return None


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("spectrace", nargs="+")
    parser.add_argument("--lights", type=int, default=1000)
    parser.add_argument("--near", type=int, default=10)
    parser.add_argument("--resolution", type=int, default=128)
    parser.add_argument("--spp", type=int, default=64)
    parser.add_argument("--reference-spp", type=int, default=8192)
    parser.add_argument("--runs", type=int, default=5)
    parser.add_argument("--keep", type=Path, help="folder for scenes and references")
    options = parser.parse_args()
    with tempfile.TemporaryDirectory() as name:
        folder = options.keep or Path(name)
        folder.mkdir(exist_ok=True)
        everything = lamps(options.lights, options.near)
        files = {}
        for which, lights in {"many": everything, "few": everything[: options.near]}.items():
            files[which] = folder / f"{which}.json"
            files[which].write_text(json.dumps(scene(lights, options.resolution, options.spp)))
            if not (folder / f"{which}-reference.exr").exists():
                render(options.spectrace[0], files[which], folder / f"{which}-reference.exr", options.reference_spp, 999)
        found = {}
        for run in range(options.runs):
            for program in options.spectrace:
                for which, file in files.items():
                    image = folder / f"{which}.exr"
                    seconds = render(program, file, image, options.spp, run)
                    figures = relmse(program, folder / f"{which}-reference.exr", image, folder)
                    found.setdefault((program, which), []).append((find(figures, "relmse"), seconds))
        for program in options.spectrace:
            print(program)
            product = {}
            for which in files:
                error, seconds = (statistics.median(column) for column in zip(*found[program, which]))
                product[which] = error * seconds
                print(f"  {which:5s} relMSE {error:.3e}  user CPU {seconds:.2f} s  noise-time {product[which]:.3e}")
            print(f"  {options.lights} lights / {options.near} that matter: {product['many'] / product['few']:.2f}")


if __name__ == "__main__":
    main()
