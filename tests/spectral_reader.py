#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Reads the program's spectral images with readers that are not the program's, and holds them to docs/aovs.md.

Renders a small scene and asks OpenEXR's own Python module for the files' channels, types and attributes; colour-science's
tables of the CIE 1931 observer and of D65 make R, G, B of the bins, which must be those of the RGB image: in every pixel
where paths carry the bins' centres, in the image's mean where bins are means. Needs OpenEXR, numpy and colour-science:
from this Python, or from a virtual environment, which --install makes. Exits with 77 (skipped) where they are nowhere.

Usage: spectral_reader.py --install, then spectral_reader.py SPECTRACE
"""
from __future__ import annotations

import argparse
import importlib.util
import json
import re
import subprocess
import sys
import tempfile
import venv
import warnings
from pathlib import Path
from typing import Any

MODULES = {"numpy": "numpy", "OpenEXR": "OpenEXR", "colour": "colour-science"}
SKIPPED = 77
TOLERANCE = 1e-3  # of the RGB image: the promise
FILES = {"": "out.spectral.exr", "diffuse": "out.diffuse.spectral.exr", "specular": "out.specular.spectral.exr"}
FIRST_NM, LAST_NM = 360, 830
SIZE = 16

SCENE = {
    "camera": {"origin": [0, -5, 1], "target": [0, 0, 0], "up": [0, 0, 1], "fov_deg": 35},
    "spectrum": {"range_nm": [FIRST_NM, LAST_NM]},
    "sampler": {"spp": 512},
    "materials": [
        {"name": "glossy", "type": "glossy", "reflectance": {"rgb": [0.7, 0.15, 0.05]},
         "f0": {"rgb": [0.1, 0.2, 0.4]}, "roughness": 0.3},
        {"name": "floor", "type": "lambert", "reflectance": {"rgb": [0.1, 0.5, 0.2]}},
    ],
    "shapes": [
        {"type": "sphere", "material": "glossy"},
        {"type": "quad", "material": "floor", "corner": [-9, -9, -1], "edge_u": [18, 0, 0], "edge_v": [0, 18, 0]},
    ],
    "lights": [{"type": "environment", "radiance": {"illuminant": "D65"}}],
}


def python_with_modules(environment: Path) -> str | None:
    """The interpreter to use: this one, that of the environment, or none."""
    if all(importlib.util.find_spec(module) for module in MODULES):
        return sys.executable
    python = environment / "bin" / "python"
    return str(python) if python.exists() else None


def install(environment: Path) -> None:
    venv.create(environment, with_pip=True)
    subprocess.run([environment / "bin" / "python", "-m", "pip", "install", "--quiet", *MODULES.values()], check=True)


class Findings:
    """What was held to, and whether it held."""

    def __init__(self) -> None:
        self.failed = 0

    def expect(self, holds: bool, what: str) -> None:
        if not holds:
            print(f"FAILED: {what}")
            self.failed += 1


def render(spectrace: str, folder: Path, spectral: dict[str, Any]) -> None:
    scene = SCENE | {"film": {"width": SIZE, "height": SIZE, "spectral": spectral}}
    (folder / "scene.json").write_text(json.dumps(scene))
    subprocess.run([spectrace, "scene.json", "-o", "out.exr"], cwd=folder, check=True, stdout=subprocess.DEVNULL)


def read(file: Path) -> tuple[dict[str, Any], dict[str, Any]]:
    """Header, and pixels by channel."""
    import OpenEXR

    with OpenEXR.File(str(file), separate_channels=True) as opened:
        return dict(opened.header()), {name: channel.pixels.copy() for name, channel in opened.channels().items()}


def centres(bins: int) -> list[float]:
    width = (LAST_NM - FIRST_NM) / bins
    return [FIRST_NM + (i + 0.5) * width for i in range(bins)]


def check_layout(header: dict[str, Any], channels: dict[str, Any], bins: int, measure: str, findings: Findings) -> None:
    """Names, wavelengths, types and units, as promised."""
    import numpy as np

    name = re.compile(r"S0\.(\d+),(\d+)nm")
    found = {channel: name.fullmatch(channel) for channel in channels if channel not in ("R", "G", "B")}
    findings.expect(all(found.values()), f"channels are S0.<nm>,<decimals>nm: {sorted(channels)[:6]}")
    findings.expect(len(found) == bins and set("RGB") <= set(channels), f"{bins} bins beside R, G, B, not {len(found)}")
    read_nm = sorted(float(f"{match[1]}.{match[2]}") for match in found.values() if match)
    findings.expect(len(read_nm) == bins and np.allclose(read_nm, centres(bins), rtol=0, atol=1e-6),
                    f"wavelengths are the bins' centres: {read_nm[:3]}")
    findings.expect(all(pixels.dtype == np.float32 for pixels in channels.values()), "all channels are float32")
    findings.expect(all(np.isfinite(pixels).all() for pixels in channels.values()), "all pixels are finite")
    for key, value in {"spectralLayoutVersion": "1.0", "emissiveUnits": "W.m^-2.sr^-1", "spectrace:binMeasure": measure,
                       "spectrace:binWidthNm": (LAST_NM - FIRST_NM) / bins, "spectrace:binsMinNm": FIRST_NM,
                       "spectrace:binsMaxNm": LAST_NM}.items():
        findings.expect(header.get(key) == value, f"{key} is {value!r}, not {header.get(key)!r}")


def xyz_to_rgb() -> Any:
    """Primaries of IEC 61966-2-1; white: D65 as integrated."""
    import colour
    import numpy as np

    primaries = np.array([[0.64, 0.33, 0.03], [0.30, 0.60, 0.10], [0.15, 0.06, 0.79]]).T
    nm = np.arange(FIRST_NM, LAST_NM + 1)
    table = colour.SDS_ILLUMINANTS["D65"]
    d65 = np.interp(nm, table.wavelengths, table.values)
    white = observer(nm) @ d65
    return np.linalg.inv(primaries * np.linalg.solve(primaries, white / white[1]))


def observer(nm: Any) -> Any:
    """x̄, ȳ, z̄ at wavelengths, linear between whole nanometres."""
    import colour
    import numpy as np

    table = colour.MSDS_CMFS["CIE 1931 2 Degree Standard Observer"]
    return np.array([np.interp(nm, table.wavelengths, table.values[:, i]) for i in range(3)])


def rgb_of_bins(channels: dict[str, Any], bins: int, at_centres: bool) -> Any:
    """Height x width x 3."""
    import numpy as np

    width = (LAST_NM - FIRST_NM) / bins
    nm = np.arange(FIRST_NM, LAST_NM + 1)
    y_integral = observer(nm)[1].sum()
    if at_centres:
        weights = observer(np.array(centres(bins))) * width
    else:  # a hundred steps a bin: the observer's mean over it
        steps = (np.arange(bins * 100) + 0.5) * width / 100 + FIRST_NM
        weights = observer(steps).reshape(3, bins, 100).mean(axis=2) * width
    spectral = sorted((name for name in channels if name.startswith("S0.")),
                      key=lambda name: float(name[3:-2].replace(",", ".")))
    spectra = np.stack([channels[name] for name in spectral], axis=-1).astype(np.float64)
    return spectra @ weights.T / y_integral @ xyz_to_rgb().T


def rgb_of_image(channels: dict[str, Any], layer: str) -> Any:
    import numpy as np

    return np.stack([channels[f"{layer}.{c}" if layer else c] for c in "RGB"], axis=-1).astype(np.float64)


def check_mode(spectrace: str, bins: int, at_centres: bool, findings: Findings) -> None:
    import numpy as np

    measure = "W.m^-2.sr^-1.nm^-1 at the centre of the bin" if at_centres else "mean W.m^-2.sr^-1.nm^-1 over the bin"
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        render(spectrace, folder, {"bins": bins} | ({"measure": "centers"} if at_centres else {}))
        _, image = read(folder / "out.exr")
        for layer, file in FILES.items():
            header, channels = read(folder / file)
            check_layout(header, channels, bins, measure, findings)
            if findings.failed:
                return
            whole, beside = rgb_of_image(image, layer), rgb_of_image(channels, "")
            findings.expect(bool(whole.max() > 0), f"{file}: there is light")
            findings.expect(bool((whole == beside).all()), f"{file}: R, G, B are those of out.exr")
            integrated = rgb_of_bins(channels, bins, at_centres)
            mean = np.abs(integrated.mean(axis=(0, 1)) / whole.mean(axis=(0, 1)) - 1).max()
            scale = np.abs(whole).max(axis=2, keepdims=True)
            pixel = (np.abs(integrated - whole) / np.where(scale > 0, scale, 1)).max()
            print(f"{bins} bins, {'centres' if at_centres else 'means'}, {layer or 'beauty'}: integrated, R, G, B are off "
                  f"by at most {mean:.2e} in the image's mean, {pixel:.2e} in a pixel")
            findings.expect(bool((pixel if at_centres else mean) <= TOLERANCE), f"{file}: within {TOLERANCE}")


def main() -> int:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("spectrace", nargs="?", help="the program")
    parser.add_argument("--environment", type=Path, default=Path("build/reader"), help="default: %(default)s")
    parser.add_argument("--install", action="store_true", help="make the environment, from PyPI, where it is needed; no test")
    parser.add_argument("--inside", action="store_true", help=argparse.SUPPRESS)
    arguments = parser.parse_args()
    if not arguments.inside:
        python = python_with_modules(arguments.environment)
        if arguments.install:
            if python is None:
                install(arguments.environment)
            return 0
        if arguments.spectrace is None:
            parser.error("name the program")
        if python is None:
            print(f"skipped: no {', '.join(MODULES.values())} in {sys.executable} or {arguments.environment} (--install)")
            return SKIPPED
        return subprocess.run([python, __file__, arguments.spectrace, "--inside"], check=False).returncode
    warnings.simplefilter("ignore")  # of colour-science, about packages that it is not asked to use
    findings = Findings()
    spectrace = str(Path(arguments.spectrace).resolve())
    for bins, at_centres in [(94, True), (47, True), (188, False)]:
        check_mode(spectrace, bins, at_centres, findings)
    return 1 if findings.failed else 0


if __name__ == "__main__":
    sys.exit(main())
