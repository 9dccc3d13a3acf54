#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Denoises a render with Open Image Denoise: as one picture, and its lobes apart.

Usage: denoise.py NOISY.exr [-o FOLDER] [--reference CONVERGED.exr] [--fixed] [--venv FOLDER]

NOISY.exr is a render with the layers diffuse, specular, emission and background; what "aovs": "denoise" adds is used where
it is there: albedo, diffuse_albedo and specular_albedo, normal, and the halves of the samples (diffuse_a, ...).
  joint    the beauty, guided by albedo and normal
  lobes    diffuse, specular and the rest (emission + background), each in the way that suits it, then summed
  mixed    of the two what the halves prefer, place by place; only where there are halves
Of each lobe several ways are tried: bare; guided by the normal and its own albedo, or the whole one; divided by its albedo; as
log(1 + x). Where there are halves, the way is chosen without a reference: one half is denoised, the other judges. Else, and
with --fixed, the way named first in WAYS that the layers allow is taken.

Written to FOLDER (default: NOISY's name without .exr, -denoised): joint.exr, lobes.exr (with the lobes as layers), mixed.exr,
PNGs, and figures.json; with a reference also relMSE, PSNR and SSIM as `spectrace compare` defines them.

Makes a virtual environment (default build/denoise) with pyoidn (Open Image Denoise 2, runs on any x86-64 or ARM processor; no
graphics card needed), OpenEXR and scikit-image from PyPI where it is absent.
"""
import argparse
import json
import subprocess
import sys
import time
import venv
from pathlib import Path

PACKAGES = ["numpy", "OpenEXR", "pyoidn", "scikit-image"]
LOBES = ("diffuse", "specular", "rest")
# The ways to denoise a lobe, the one for want of halves first.
WAYS = {
    "diffuse": ("own albedo", "whole albedo", "bare", "divided", "log"),
    "specular": ("whole albedo", "own albedo", "bare", "divided", "log"),
    "rest": ("as it is", "whole albedo", "bare"),
}
# Only to be measured. Divided, a lobe ends at the silhouette of what has it by a leap; the logarithm dims highlights, which
# relative errors hide (docs/denoising.md).
NEVER_TAKEN = ("divided", "log")
ALBEDO_FLOOR = 0.00316  # added before dividing: Bako et al. 2017, "Kernel-Predicting Convolutional Networks", section 5
EPSILON = 0.01  # of relMSE, as in `spectrace compare`
MIX_SIGMA = 8  # pixels: over which the halves' verdict is averaged; one pixel's is nearly all noise
WHITE_PERCENTILE = 98  # of the reference, or of the joint picture: white in the PNGs


def install(folder):
    python = folder / "bin" / "python"
    if not python.exists():
        venv.create(folder, with_pip=True)
        subprocess.run([python, "-m", "pip", "install", "--quiet", *PACKAGES], check=True)
    return python


def inside_venv(folder, arguments):
    """Runs this very script again with the environment's Python, which has the packages."""
    return subprocess.run([install(folder), __file__, *arguments, "--inside"], check=False).returncode


def read_layers(file):
    """Name -> height x width x 3 float32; R, G, B alone is "beauty". A layer of one channel is repeated."""
    import numpy as np
    import OpenEXR

    with OpenEXR.File(str(file), separate_channels=True) as exr:
        channels = {name: np.asarray(c.pixels, dtype=np.float32) for name, c in exr.channels().items()}
    layers = {}
    for layer in {name.rpartition(".")[0] for name in channels}:
        prefix = layer + "." if layer else ""
        for parts in ("RGB", "XYZ", "ZZZ"):
            if all(prefix + part in channels for part in parts):
                layers[layer or "beauty"] = np.stack([channels[prefix + part] for part in parts], axis=-1)
                break
    for needed in ("beauty", "diffuse", "specular"):
        if needed not in layers:
            sys.exit(f"{file}: has no layer \"{needed}\"")
    for suffix in ("", "_a", "_b"):
        if "emission" + suffix in layers and "background" + suffix in layers:
            layers["rest" + suffix] = layers["emission" + suffix] + layers["background" + suffix]
    # Whatever there is besides the lobes: then the sum is the beauty, as it must be.
    layers.setdefault("rest", layers["beauty"] - layers["diffuse"] - layers["specular"])
    for suffix in ("_a", "_b"):
        lobes = [layer + suffix for layer in ("beauty", "diffuse", "specular")]
        if "rest" + suffix not in layers and all(lobe in layers for lobe in lobes):
            layers["rest" + suffix] = layers[lobes[0]] - layers[lobes[1]] - layers[lobes[2]]
    return layers


def write_exr(file, layers):
    import OpenEXR

    channels = {}
    for layer, image in layers.items():
        prefix = "" if layer == "beauty" else layer + "."
        channels.update({prefix + part: image[..., i].copy() for i, part in enumerate("RGB")})
    with OpenEXR.File({"compression": OpenEXR.ZIP_COMPRESSION, "type": OpenEXR.scanlineimage}, channels) as exr:
        exr.write(str(file))


def write_png(file, image, exposure):
    import numpy as np
    from PIL import Image

    x = np.clip(image * exposure, 0, 1)
    srgb = np.where(x <= 0.0031308, 12.92 * x, 1.055 * np.power(x, 1 / 2.4) - 0.055)
    Image.fromarray(np.round(255 * srgb).astype(np.uint8)).save(file)


def oidn(color, albedo=None, normal=None, clean=False, hdr=True):
    import numpy as np
    import pyoidn

    # Negative and infinite colours are outside what the network knows.
    color = np.ascontiguousarray(np.clip(np.nan_to_num(color), 0, None), dtype=np.float32)
    if albedo is None:
        return pyoidn.denoise(color, hdr=hdr)
    guides = {"albedo": np.ascontiguousarray(albedo)}
    if normal is not None:
        guides["normal"] = np.ascontiguousarray(normal)
    return pyoidn.denoise(color, hdr=hdr, clean_aux=clean, **guides)


class Guides:
    """Features as guides: denoised first, each by itself, so that the filter may trust them (cleanAux)."""

    def __init__(self, layers):
        import pyoidn
        import numpy as np

        self.images, self.raw = {}, {}
        for name, low in (("albedo", 0), ("diffuse_albedo", 0), ("specular_albedo", 0), ("normal", -1)):
            if name not in layers:
                continue
            image = np.ascontiguousarray(np.clip(np.nan_to_num(layers[name]), low, 1))
            self.raw[name] = image
            # The filter for features is chosen by the name of the slot that holds one.
            self.images[name] = prefiltered(image, "normal" if name == "normal" else "albedo")

    def has(self, *names):
        return all(name in self.images for name in names)


def prefiltered(feature, slot):
    import numpy as np
    import pyoidn

    result = np.zeros_like(feature)
    with pyoidn.Device() as device:
        device.commit()
        with pyoidn.Filter(device, pyoidn.OIDN_FILTER_TYPE_RT) as flt:
            flt.set_image(slot, feature, pyoidn.OIDN_FORMAT_FLOAT3)
            flt.set_image(pyoidn.OIDN_IMAGE_OUTPUT, result, pyoidn.OIDN_FORMAT_FLOAT3)
            flt.commit()
            flt.execute()
        if error := device.get_error():
            sys.exit(f"Open Image Denoise: {error}")
    return result


def denoise_beauty(image, guides):
    if not guides.has("albedo"):
        return oidn(image)
    return oidn(image, guides.images["albedo"], guides.images.get("normal"), clean=True)


def denoise_lobe(image, lobe, way, guides):
    """One lobe in one way; nothing where its guides are missing."""
    import numpy as np

    own, normal = lobe + "_albedo", guides.images.get("normal")
    if way == "as it is":
        return image
    if way == "bare":
        return oidn(image)
    if way == "log" and not guides.has(own):
        return np.expm1(oidn(np.log1p(np.clip(image, 0, None))))
    needed = "albedo" if way == "whole albedo" else own
    if not guides.has(needed, "albedo"):
        return None
    if way == "log":
        return np.expm1(oidn(np.log1p(np.clip(image, 0, None)), guides.images[own], normal, clean=True))
    if way == "divided":
        # By the albedo of the very samples, so that what edges cover cancels; times the denoised one.
        ratio = oidn(image / (guides.raw[own] + ALBEDO_FLOOR), guides.images["albedo"], normal, clean=True)
        return ratio * (guides.images[own] + ALBEDO_FLOOR)
    return oidn(image, guides.images[needed], normal, clean=True)


HALVES = (("_a", "_b"), ("_b", "_a"))


def judged_by_halves(layers, lobe, ways, guides, weight):
    """Error of each way: one half denoised against the other, whose noise all ways share. Relative, as relMSE."""
    import numpy as np

    return {way: float(np.mean([
        np.mean((denoise_lobe(layers[lobe + a], lobe, way, guides) - layers[lobe + b]) ** 2 * weight) for a, b in HALVES
    ])) for way in ways}


def has_halves(layers):
    return all(lobe + half in layers for lobe in ("beauty", *LOBES) for half in ("_a", "_b"))


def denoise_lobes(layers, guides, weight, fixed):
    """Each lobe denoised, and what was done with it."""
    images, record = {}, {}
    for lobe in LOBES:
        tried = {way: denoise_lobe(layers[lobe], lobe, way, guides) for way in WAYS[lobe]}
        tried = {way: image for way, image in tried.items() if image is not None}
        record[lobe] = {"way": next(iter(tried)), "chosen_by": "order", "tried": tried}
        if not fixed and has_halves(layers):
            ways = [way for way in tried if way not in NEVER_TAKEN]
            errors = judged_by_halves(layers, lobe, ways, guides, weight)
            record[lobe].update(way=min(errors, key=errors.get), chosen_by="halves", half_errors=errors)
        images[lobe] = tried[record[lobe]["way"]]
    return images, record


def mix(layers, guides, joint, lobes, record, weight):
    """Joint or lobes, place by place: as one half of each, denoised, is nearer to the other half's noise."""
    import numpy as np
    from scipy.ndimage import gaussian_filter

    gain = 0
    for a, b in HALVES:
        apart = sum(denoise_lobe(layers[lobe + a], lobe, record[lobe]["way"], guides) for lobe in LOBES)
        together = denoise_beauty(layers["beauty" + a], guides)
        gain = gain + ((together - layers["beauty" + b]) ** 2 - (apart - layers["beauty" + b]) ** 2) * weight
    gain = gaussian_filter(gain.mean(axis=-1), MIX_SIGMA)
    share = 1 / (1 + np.exp(-gain / max(np.abs(gain).mean(), 1e-30)))[..., None]
    return (share * sum(lobes.values()) + (1 - share) * joint).astype(np.float32)


def metrics(reference, test):
    import numpy as np
    from skimage.metrics import structural_similarity

    r, t = reference.astype(np.float64), test.astype(np.float64)
    peak = r.max() if r.max() > 0 else 1.0
    mse = np.mean((t - r) ** 2)
    return {
        "relmse": float(np.mean((t - r) ** 2 / (r ** 2 + EPSILON))),
        "psnr": float(10 * np.log10(peak ** 2 / mse)) if mse > 0 else float("inf"),
        "ssim": float(structural_similarity(r, t, data_range=peak, channel_axis=2, gaussian_weights=True, sigma=1.5,
                                            use_sample_covariance=False)),
    }


def print_row(name, m):
    print(f"{name:<34}{m['relmse']:>12.4e}{m['psnr']:>10.3f}{m['ssim']:>10.5f}")


def report(reference, layers, pictures, record, figures):
    print(f"{'':<34}{'relMSE':>12}{'PSNR [dB]':>10}{'SSIM':>10}")
    figures["metrics"] = {name: metrics(reference["beauty"], image) for name, image in pictures.items()}
    for name, m in figures["metrics"].items():
        print_row(name, m)
    for lobe in LOBES:
        if lobe not in reference:
            continue
        tried = {"noisy": layers[lobe], **record[lobe]["tried"]}
        record[lobe]["metrics"] = {way: metrics(reference[lobe], image) for way, image in tried.items()}
        for way, m in record[lobe]["metrics"].items():
            print_row(f"  {lobe}, {way}" + (" (taken)" if way == record[lobe]["way"] else ""), m)
    noisy = figures["metrics"]["noisy"]["relmse"]
    gains = [f"{name} {noisy / m['relmse']:.1f} times" for name, m in figures["metrics"].items() if name != "noisy"]
    print("relMSE lower than the noisy picture's: " + ", ".join(gains))


def write_results(folder, pictures, lobes, reference, figures):
    import numpy as np

    folder.mkdir(parents=True, exist_ok=True)
    shown = {**pictures, **({"reference": reference["beauty"]} if reference else {})}
    exposure = 1 / max(np.percentile(shown.get("reference", pictures["joint"]), WHITE_PERCENTILE), 1e-12)
    for name, picture in {**shown, "diffuse": lobes["diffuse"], "specular": lobes["specular"]}.items():
        write_png(folder / f"{name}.png", picture, exposure)
    for name in ("joint", "mixed"):
        if name in pictures:
            write_exr(folder / f"{name}.exr", {"beauty": pictures[name]})
    write_exr(folder / "lobes.exr", {"beauty": pictures["lobes"], **lobes})
    (folder / "figures.json").write_text(json.dumps(figures, indent=2) + "\n")


def main(arguments):
    layers = read_layers(arguments.noisy)
    reference = read_layers(arguments.reference) if arguments.reference else None
    if reference and reference["beauty"].shape != layers["beauty"].shape:
        sys.exit(f"{arguments.reference}: of another size than {arguments.noisy}")
    start = time.perf_counter()
    guides = Guides(layers)
    joint = denoise_beauty(layers["beauty"], guides)
    seconds = {"joint": time.perf_counter() - start}
    weight = 1 / (joint.astype("float64") ** 2 + EPSILON)
    lobes, record = denoise_lobes(layers, guides, weight, arguments.fixed)
    pictures = {"noisy": layers["beauty"], "joint": joint, "lobes": sum(lobes.values())}
    if has_halves(layers):
        pictures["mixed"] = mix(layers, guides, joint, lobes, record, weight)
    seconds["all"] = time.perf_counter() - start
    figures = {"noisy": str(arguments.noisy), "reference": str(arguments.reference or ""),
               "guides": sorted(guides.images), "seconds": seconds}
    print(f"{arguments.noisy}; guides: {', '.join(figures['guides']) or 'none'}")
    if reference:
        report(reference, layers, pictures, record, figures)
    for entry in record.values():
        del entry["tried"]
    figures["lobes"] = record
    folder = arguments.output or arguments.noisy.with_name(arguments.noisy.stem + "-denoised")
    write_results(folder, pictures, lobes, reference, figures)
    print(", ".join(f"{lobe}: {record[lobe]['way']}" for lobe in LOBES) + f"; in {folder}")


if __name__ == "__main__":
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("noisy", type=Path, nargs="?")
    parser.add_argument("-o", "--output", type=Path)
    parser.add_argument("--reference", type=Path)
    parser.add_argument("--fixed", action="store_true", help="do not choose by halves")
    parser.add_argument("--venv", type=Path, default=Path(__file__).parent.parent / "build" / "denoise")
    parser.add_argument("--install", action="store_true", help="make the environment, and end")
    parser.add_argument("--inside", action="store_true", help=argparse.SUPPRESS)
    given = parser.parse_args()
    if given.install:
        install(given.venv.resolve())
    elif given.noisy is None:
        parser.error("name a picture")
    elif given.inside:
        main(given)
    else:
        sys.exit(inside_venv(given.venv.resolve(), sys.argv[1:]))
