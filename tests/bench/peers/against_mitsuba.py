#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Renders the same scenes with spectrace and Mitsuba 3, in turns, and compares means, noise and time.

Usage: against_mitsuba.py SPECTRACE [--data FOLDER] [--resolution N] [--spp N] [--runs N] [--reference-spp N]
                          [--scenes NAME ...] [--samplers NAME ...] [--json FILE] [--keep FOLDER]

Needs Python's `mitsuba` module (PyPI) and, for it, an LLVM library (DRJIT_LIBLLVM_PATH). Scenes: the diffuse ball of
scenes/sphere_checkerboard.json, the same with a ball of gold (GGX 0.25) or of a measured paint, and the Cornell box.
Each scene is spectrace's own JSON; what Mitsuba gets is translated from it here, so that both render one description.

Efficiency = 1 / (relMSE x seconds of rendering), relMSE = mean((t - r)^2 / (r^2 + 1e-2)) against that renderer's own
picture of --reference-spp samples with another seed. Mitsuba renders each scene once before it is timed, so that its
kernels are compiled. The means compared are those of the references, channel by channel.
"""
import argparse
import json
import os
import re
import statistics
import subprocess
import sys
import tempfile
import time
from pathlib import Path

import numpy

try:
    import mitsuba
except ImportError:
    sys.exit("needs the Python module mitsuba: pip install mitsuba")

SCENES = Path(__file__).resolve().parents[3] / "scenes"
GOLD = "metals/Au_Johnson.yml"
MEASURED = "epfl_uplifted/cc_nothern_aurora_spec.bsdf"


def read_scene(file):
    """Our JSON, whose comments start with // at the beginning of a line."""
    text = re.sub(r"^\s*//.*$", "", file.read_text(), flags=re.MULTILINE)
    return json.loads(text)


def ball_scene(material):
    scene = read_scene(SCENES / "sphere_checkerboard.json")
    scene["materials"] = [material if m["name"] == "ball" else m for m in scene["materials"]]
    return scene


def gold(file):
    """Rows of micrometres, n and k in a file of refractiveindex.info."""
    rows = re.findall(r"^\s+([0-9.]+) ([0-9.]+) ([0-9.]+)$", file.read_text(), flags=re.MULTILINE)
    nm = [1000 * float(row[0]) for row in rows]
    table = lambda column: {"wavelengths_nm": nm, "values": [float(row[column]) for row in rows]}
    return {"name": "ball", "type": "conductor", "roughness": 0.25, "eta": table(1), "k": table(2)}


def scenes(data, spectrace, folder):
    """name: (spectrace's scene, Mitsuba's scene is translated from this one)."""
    diffuse, box = read_scene(SCENES / "sphere_checkerboard.json"), read_scene(SCENES / "cornell_box.json")
    found = {"diffuse": (diffuse, diffuse), "cornell_box": (box, box)}
    if data and (data / GOLD).exists():
        scene = ball_scene(gold(data / GOLD))
        found["ggx"] = (scene, scene)
    if data and (data / MEASURED).exists():
        raw = ball_scene({"name": "ball", "type": "measured", "file": str(data / MEASURED)})
        separated = folder / "ball.sep"
        subprocess.run([spectrace, "separate", data / MEASURED, "-o", separated], check=True, capture_output=True)
        compact = ball_scene({"name": "ball", "type": "separated", "file": str(separated)})
        found["measured"] = (raw, raw)
        found["measured, compact .sep"] = (compact, raw)
    return found


# ---- Translation --------------------------------------------------------------------------------------------------


def spectrum(value):
    if isinstance(value, (int, float)):
        return {"type": "uniform", "value": float(value)}
    if "rgb" in value:
        return {"type": "rgb", "value": value["rgb"]}
    wavelengths, values = value["wavelengths_nm"], value["values"]
    # Ours holds its end values, Mitsuba's is 0 outside.
    wavelengths = [min(300, wavelengths[0] - 1)] + wavelengths + [max(900, wavelengths[-1] + 1)]
    values = [values[0]] + values + [values[-1]]
    table = lambda numbers: ", ".join(f"{x:.9g}" for x in numbers)
    return {"type": "irregular", "wavelengths": table(wavelengths), "values": table(values)}


def reflectance(value):
    if isinstance(value, dict) and "checkerboard" in value:
        board = value["checkerboard"]
        u, v = board["repeat"]
        # Mitsuba's repeats hold 2 x 2 checks.
        return {"type": "checkerboard", "color0": spectrum(board["even"]), "color1": spectrum(board["odd"]),
                "to_uv": mitsuba.ScalarTransform4f().scale([u / 2, v / 2, 1])}
    return spectrum(value)


def material(m):
    if m["type"] == "lambert":
        return {"type": "diffuse", "reflectance": reflectance(m["reflectance"])}
    if m["type"] == "conductor":
        return {"type": "roughconductor", "distribution": "ggx", "alpha": m["roughness"], "eta": spectrum(m["eta"]),
                "k": spectrum(m["k"])}
    return {"type": "measured", "filename": m["file"]}


def mesh(positions, triangles, bsdf, emitter):
    properties = mitsuba.Properties()
    properties["bsdf"] = bsdf
    if emitter:
        properties["emitter"] = emitter
    made = mitsuba.Mesh("mesh", len(positions), len(triangles), props=properties)
    parameters = mitsuba.traverse(made)
    parameters["vertex_positions"] = numpy.asarray(positions, dtype=numpy.float32).ravel()
    parameters["faces"] = numpy.asarray(triangles, dtype=numpy.uint32).ravel()
    parameters.update()
    return made


def quad(shape, bsdf, emitter):
    c, u, v = (numpy.array(shape[key], dtype=float) for key in ("corner", "edge_u", "edge_v"))
    matrix = numpy.eye(4)
    matrix[:3, 0], matrix[:3, 1], matrix[:3, 2], matrix[:3, 3] = u / 2, v / 2, numpy.cross(u, v), c + (u + v) / 2
    made = {"type": "rectangle", "to_world": mitsuba.ScalarTransform4f(matrix), "bsdf": bsdf}
    return {**made, "emitter": emitter} if emitter else made


def translate(scene, sampler, resolution, spp):
    camera, look = scene["camera"], mitsuba.ScalarTransform4f()
    sensor = {"type": "perspective", "fov_axis": "smaller", "fov": camera["fov_deg"],
              "to_world": look.look_at(camera["origin"], camera["target"], camera["up"]),
              "film": {"type": "hdrfilm", "width": resolution, "height": resolution, "rfilter": {"type": "box"},
                       "pixel_format": "rgb", "component_format": "float32"},
              "sampler": {"type": sampler, "sample_count": spp}}
    # Its depth counts rays and the light at their end, ours the bounces between.
    made = {"type": "scene", "sensor": sensor,
            "integrator": {"type": "path", "max_depth": scene["integrator"]["max_depth"] + 1,
                           "rr_depth": scene["integrator"]["roulette_depth"]}}
    bsdfs = {m["name"]: material(m) for m in scene["materials"]}
    for i, shape in enumerate(scene["shapes"]):
        bsdf = bsdfs[shape["material"]]
        emitter = {"type": "area", "radiance": spectrum(shape["emission"])} if "emission" in shape else None
        if shape["type"] == "mesh":
            made[f"shape{i}"] = mesh(shape["positions"], shape["triangles"], mitsuba.load_dict(bsdf), emitter)
        elif shape["type"] == "quad":
            made[f"shape{i}"] = quad(shape, bsdf, emitter)
        else:
            ball = {"type": "sphere", "center": shape["center"], "radius": shape["radius"], "bsdf": bsdf}
            made[f"shape{i}"] = {**ball, "emitter": emitter} if emitter else ball
    for i, light in enumerate(scene.get("lights", [])):
        made[f"light{i}"] = {"type": "constant", "radiance": spectrum(light["radiance"])}
    return mitsuba.load_dict(made)


# ---- Rendering ----------------------------------------------------------------------------------------------------


def render_mitsuba(scene, spp, seed):
    start = time.perf_counter()
    image = numpy.array(mitsuba.render(scene, spp=spp, seed=seed))
    return image[:, :, :3].astype(float), time.perf_counter() - start


def render_spectrace(program, scene, folder, spp, seed):
    out = folder / "picture.exr"
    done = subprocess.run([program, scene, "-o", out, "--spp", str(spp), "--seed", str(seed), "--aovs", "none"],
                          check=True, capture_output=True, text=True)
    seconds = float(re.search(r"a pixel, ([0-9.]+) s on", done.stdout + done.stderr).group(1))
    bitmap = mitsuba.Bitmap(str(out))
    channels = [field.name for field in bitmap.struct_()]
    picture = numpy.array(bitmap).astype(float)
    return picture[:, :, [channels.index(c) for c in "RGB"]], seconds


def in_chunks(render, spp, chunk=1024):
    """The mean of renders of at most `chunk` samples: Mitsuba's wavefront holds all of one in memory."""
    images = [render(min(chunk, spp - first), 1000 + first)[0] for first in range(0, spp, chunk)]
    return sum(images) / len(images)


def rel_mse(image, reference):
    return float(numpy.mean((image - reference) ** 2 / (reference ** 2 + 1e-2)))


def measure(render, reference, spp, runs):
    times, errors = [], []
    for run in range(runs):
        image, seconds = render(spp, run + 1)
        times.append(seconds)
        errors.append(rel_mse(image, reference))
    error, seconds = statistics.median(errors), statistics.median(times)
    return {"relmse": error, "seconds": seconds, "efficiency": 1 / (error * seconds)}


def compare(name, ours, theirs, options, folder):
    ours = json.loads(json.dumps(ours))
    ours["film"] = {"width": options.resolution, "height": options.resolution}
    file = folder / "scene.json"
    file.write_text(json.dumps(ours))
    of_ours = lambda spp, seed: render_spectrace(options.spectrace, file, folder, spp, seed)
    reference = in_chunks(of_ours, options.reference_spp)
    result = {"scene": name, "resolution": options.resolution, "spp": options.spp,
              "spectrace": measure(of_ours, reference, options.spp, options.runs), "mitsuba": {}}
    for sampler in options.samplers:
        scene = translate(theirs, sampler, options.resolution, options.spp)
        of_theirs = lambda spp, seed: render_mitsuba(scene, spp, seed)
        of_theirs(options.spp, 0)
        their_reference = in_chunks(of_theirs, options.reference_spp, 256)
        result["mitsuba"][sampler] = measure(of_theirs, their_reference, options.spp, options.runs)
        result["mean_ratio"] = (reference.mean((0, 1)) / their_reference.mean((0, 1))).tolist()
        if options.keep:
            numpy.save(options.keep / f"{name}_mitsuba.npy", their_reference)
    if options.keep:
        numpy.save(options.keep / f"{name}_spectrace.npy", reference)
    best = max(r["efficiency"] for r in result["mitsuba"].values())
    result["efficiency_ratio"] = result["spectrace"]["efficiency"] / best
    return result


def report(result):
    print(f"{result['scene']}, {result['resolution']}^2, {result['spp']} samples")
    rows = [("spectrace", result["spectrace"])] + [(f"mitsuba {s}", r) for s, r in result["mitsuba"].items()]
    for name, r in rows:
        print(f"  {name:24} relMSE {r['relmse']:.3e}  {r['seconds']:7.2f} s  efficiency {r['efficiency']:8.1f}")
    means = ", ".join(f"{100 * (m - 1):+.3f} %" for m in result["mean_ratio"])
    print(f"  efficiency over Mitsuba's best sampler: {result['efficiency_ratio']:.2f}; means differ by {means}",
          flush=True)


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("spectrace")
    parser.add_argument("--data", type=Path, default=os.environ.get("SPECTRACE_DATA"))
    parser.add_argument("--resolution", type=int, default=256)
    parser.add_argument("--spp", type=int, default=64)
    parser.add_argument("--runs", type=int, default=3)
    parser.add_argument("--reference-spp", type=int, default=2048)
    parser.add_argument("--scenes", nargs="*", help="default: all")
    parser.add_argument("--samplers", nargs="*", default=["independent", "multijitter", "ldsampler", "orthogonal"])
    parser.add_argument("--variant", default="llvm_ad_spectral")
    parser.add_argument("--json", type=Path)
    parser.add_argument("--keep", type=Path, help="folder for the references as .npy")
    options = parser.parse_args()
    mitsuba.set_variant(options.variant)
    results = []
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        data = Path(options.data).resolve() if options.data else None
        for scene, (ours, theirs) in scenes(data, options.spectrace, folder).items():
            if options.scenes and scene not in options.scenes:
                continue
            results.append(compare(scene, ours, theirs, options, folder))
            report(results[-1])
    if options.json:
        options.json.write_text(json.dumps(results, indent=2) + "\n")


if __name__ == "__main__":
    main()
