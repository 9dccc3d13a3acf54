#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Large scenes: how much of Embree's speed is left, how much memory they take, what a second core brings.

Usage: scale.py SPECTRACE [--triangles N] [--copies N] [--resolution N] [--spp N] [--json FILE]

Makes a rough, matt landscape of N triangles as a binary PLY file, under an even sky and a lamp, and renders it with
`spectrace bench`. --copies: the same triangles in memory, placed N times by instances. Prints Embree's share
(render over raw), rays a second, peak memory and the speed-up of all cores over one.
"""
import argparse
import array
import json
import math
import random
import struct
import subprocess
import sys
import tempfile
from pathlib import Path

SIZE = 100.0  # metres a side


def write_landscape(file, triangles):
    """A grid of hills with noise in each vertex: rays that leave it are as incoherent as they come."""
    cells = max(1, round(math.sqrt(triangles / 2)))
    rng = random.Random(1)
    nodes = cells + 1
    header = (f"ply\nformat binary_{sys.byteorder}_endian 1.0\nelement vertex {nodes * nodes}\nproperty float x\n"
              "property float y\nproperty float z\n"
              f"element face {2 * cells * cells}\nproperty list uchar uint vertex_indices\nend_header\n")
    step, rough = SIZE / cells, 0.3 * SIZE / cells
    along = [step * i - SIZE / 2 for i in range(nodes)]
    hills_x = [3 * math.sin(0.31 * x) for x in along]
    with open(file, "wb") as out:
        out.write(header.encode())
        for y in along:
            hill_y = math.cos(0.27 * y)
            row = array.array("f")
            for x, hill_x in zip(along, hills_x):
                row.extend((x, y, hill_x * hill_y + rough * rng.random()))
            out.write(row.tobytes())
        face = struct.Struct("=BIIIBIII")
        for j in range(cells):
            below, above = j * nodes, (j + 1) * nodes
            out.write(b"".join(face.pack(3, below + i, below + i + 1, above + i, 3, below + i + 1, above + i + 1,
                                         above + i) for i in range(cells)))
    return 2 * cells * cells


def scene_of(mesh, copies, resolution, spp):
    ground = {"type": "mesh", "file": str(mesh), "material": "ground"}
    scene = {
        "camera": {"type": "pinhole", "origin": [0, -70, 45], "target": [0, -10, 0], "up": [0, 0, 1], "fov_deg": 50},
        "film": {"width": resolution, "height": resolution},
        "sampler": {"spp": spp, "seed": 0},
        "integrator": {"max_depth": 4, "roulette_depth": 8},
        "materials": [{"name": "ground", "type": "lambert", "reflectance": 0.5}],
        "lights": [{"type": "environment", "radiance": 0.3},
                   {"type": "point", "position": [-30, -40, 60], "intensity": 9000}],
    }
    if copies == 1:
        return {**scene, "shapes": [ground]}
    side = math.ceil(math.sqrt(copies))
    at = lambda i: [(i % side - (side - 1) / 2) * SIZE, (i // side) * SIZE, 0]
    return {**scene, "groups": [{"name": "land", "shapes": [ground]}],
            "shapes": [{"type": "instance", "group": "land", "transform": {"translate": at(i)}}
                       for i in range(copies)]}


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("spectrace")
    parser.add_argument("--triangles", type=float, default=1e6)
    parser.add_argument("--copies", type=int, default=1)
    parser.add_argument("--resolution", type=int, default=512)
    parser.add_argument("--spp", type=int, default=16)
    parser.add_argument("--json", type=Path)
    options = parser.parse_args()
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        triangles = write_landscape(folder / "land.ply", options.triangles)
        (folder / "scene.json").write_text(
            json.dumps(scene_of(folder / "land.ply", options.copies, options.resolution, options.spp)))
        report = options.json or folder / "bench.json"
        subprocess.run([options.spectrace, "bench", folder / "scene.json", "--json", report], check=True,
                       stdout=subprocess.DEVNULL)
        result = json.loads(Path(report).read_text())
    render, embree = result["render"], result["embree_alone"]
    print(f"{triangles} triangles x {options.copies}, {options.resolution}^2, {options.spp} samples")
    print(f"  render over raw Embree {embree['render_over_raw']:.3f} ({render['million_rays_per_second']:.2f} of "
          f"{max(embree['packets_million_rays_per_second'], embree['single_million_rays_per_second']):.2f} million "
          f"rays/s, {render['rays_per_path']:.2f} rays a path)")
    print(f"  peak memory {render['peak_memory_mb']:.0f} MB; {render['threads']} threads "
          f"{render['speedup_of_threads']:.2f} times one; {1e6 * render['seconds_one_thread'] / render['paths']:.3f} "
          "microseconds a path")


if __name__ == "__main__":
    main()
