#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Holds `spectrace compare` to scikit-image (PSNR, SSIM) and numpy (the others).

Usage: metrics_against_scikit.py SPECTRACE [VENV] [--if-installed]. Makes the virtual environment VENV (default build/scikit)
with scikit-image and OpenEXR from PyPI where it is absent, compares images of several kinds, sizes and settings, prints the
largest relative deviation of each metric, and exits 1 if any is above 1e-6. With --if-installed it exits with 77 (skipped)
where VENV is absent; metrics_against_scikit.py --install VENV makes it, and ends.
"""
import json
import subprocess
import sys
import tempfile
import venv
from pathlib import Path

TOLERANCE = 1e-6
SKIPPED = 77
PACKAGES = ["numpy", "scikit-image", "OpenEXR"]


def install(folder):
    python = folder / "bin" / "python"
    if not python.exists():
        venv.create(folder, with_pip=True)
        subprocess.run([python, "-m", "pip", "install", "--quiet", *PACKAGES], check=True)
    return python


def inside_venv(folder, spectrace):
    """Runs this very script again with the environment's Python, which has the packages."""
    return subprocess.run([install(folder), __file__, spectrace, "--inside"], check=False).returncode


def image_pairs():
    """Name, reference, test: height x width x 3, float32."""
    import numpy as np

    rng = np.random.default_rng(1)
    y, x = np.mgrid[0:120, 0:177] / 50.0
    smooth = np.stack([1 + np.sin(x + y), 2 + np.cos(3 * x * y), 0.1 + x], axis=-1)
    hdr = np.exp(rng.normal(0, 2, (64, 96, 3)))
    for name, reference, test in [
        ("smooth, noise", smooth, smooth + 0.02 * rng.normal(size=smooth.shape)),
        ("smooth, bias", smooth, 1.01 * smooth + 0.003),
        ("high range", hdr, hdr * np.exp(rng.normal(0, 0.1, hdr.shape))),
        ("with negative values", smooth - 1, smooth - 1 + 0.1 * rng.normal(size=smooth.shape)),
        ("least size", hdr[:11, :11], hdr[1:12, 3:14]),
        ("unrelated", hdr[:, :48], hdr[:, 48:]),
        ("dim", 1e-5 * smooth, 1e-5 * (smooth + 0.02 * rng.normal(size=smooth.shape))),
    ]:
        yield name, reference.astype(np.float32), test.astype(np.float32)


def expected_metrics(reference, test, data_range, epsilon, mape_floor):
    import numpy as np
    from skimage.metrics import mean_squared_error, peak_signal_noise_ratio, structural_similarity

    r, t = reference.astype(np.float64), test.astype(np.float64)
    return {
        "mse": mean_squared_error(r, t),
        "psnr": peak_signal_noise_ratio(r, t, data_range=data_range),
        "ssim": structural_similarity(r, t, data_range=data_range, channel_axis=2, gaussian_weights=True, sigma=1.5,
                                      use_sample_covariance=False),
        "mae": np.mean(np.abs(t - r)),
        "relmse": np.mean((t - r) ** 2 / (r ** 2 + epsilon)),
        "mape": np.mean(np.abs(t - r) / (np.abs(r) + mape_floor)),
        "maxabs": np.max(np.abs(t - r)),
    }


def write_exr(file, image):
    import OpenEXR

    channels = {name: image[..., i].copy() for i, name in enumerate("RGB")}
    header = {"compression": OpenEXR.ZIP_COMPRESSION, "type": OpenEXR.scanlineimage}
    with OpenEXR.File(header, channels) as out:
        out.write(str(file))


def found_metrics(spectrace, folder, options):
    figures = folder / "figures.json"
    subprocess.run([spectrace, "compare", folder / "r.exr", folder / "t.exr", "--json", figures, *options], check=True,
                   stdout=subprocess.DEVNULL)
    return json.loads(figures.read_text())["layers"][0]


def main(spectrace):
    import skimage

    worst = {}
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        for kind, reference, test in image_pairs():
            write_exr(folder / "r.exr", reference)
            write_exr(folder / "t.exr", test)
            for given, epsilon, floor in [(None, 1e-2, 1e-2), (1.0, 1e-3, 0.5), (255.0, 1.0, 1e-4)]:
                options = ["--epsilon", str(epsilon), "--mape-floor", str(floor)]
                options += ["--data-range", str(given)] if given else []
                data_range = given or float(reference.max())
                found = found_metrics(spectrace, folder, options)
                for metric, value in expected_metrics(reference, test, data_range, epsilon, floor).items():
                    deviation = abs(found[metric] - value) / abs(value)
                    worst[metric] = max(worst.get(metric, (0, "")), (deviation, f"{kind}, data range {data_range:g}"))
    print(f"scikit-image {skimage.__version__}: largest relative deviations")
    for metric, (deviation, where) in worst.items():
        print(f"{metric:8}{deviation:10.2e}  {where}")
    sys.exit(1 if max(deviation for deviation, _ in worst.values()) > TOLERANCE else 0)


if __name__ == "__main__":
    options = {word for word in sys.argv[1:] if word.startswith("--")}
    words = [word for word in sys.argv[1:] if word not in options]
    if not words or options - {"--inside", "--install", "--if-installed"}:
        sys.exit(__doc__)
    if "--inside" in options:
        main(words[0])
    environment = Path("build/scikit" if len(words) == 1 and "--install" not in options else words[-1]).resolve()
    if "--install" in options:
        install(environment)
    elif "--if-installed" in options and not (environment / "bin" / "python").exists():
        print(f"skipped: no {environment} (--install)")
        sys.exit(SKIPPED)
    else:
        sys.exit(inside_venv(environment, words[0]))
