#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Opens the page of `spectrace compare --html` in a headless Chromium and moves its slider between reference and test.

Needs Debian's packages chromium and chromium-driver (`scripts/test.sh -L browser` installs them); exits with 77 otherwise.
"""

import argparse
import subprocess
import tempfile
from pathlib import Path

from support.browser import Browser, skip_without_browser

SCENE = """{"camera": {"origin": [0, -4, 1], "target": [0, 0, 0], "up": [0, 0, 1]}, "film": {"width": 64, "height": 64},
"sampler": {"spp": 4}, "materials": [{"name": "m", "type": "lambert", "reflectance": 0.5}],
"shapes": [{"type": "sphere", "material": "m"}], "lights": [{"type": "environment", "radiance": 1}]}"""


def cut_of(browser: Browser) -> float:
    """How much of the test image is hidden under the reference [%]."""
    style = browser.evaluate("return getComputedStyle(document.querySelector('.ab img:last-child')).clipPath")
    assert style.startswith("inset(") and style.endswith("%)"), style
    return float(style.split()[-1].removesuffix("%)"))


def check(browser: Browser, page: Path) -> None:
    browser.open(page)
    pictures = browser.evaluate("return [...document.images].map(i => [i.alt, i.complete && i.naturalWidth > 0])")
    assert [alt for alt, _ in pictures[:2]] == ["reference", "test"], pictures
    assert len(pictures) >= 4 and all(there for _, there in pictures), pictures
    slider = browser.find(".views input[type=range]")
    half_width = browser.evaluate("return arguments[0].getBoundingClientRect().width / 2", slider)
    assert cut_of(browser) == 50, cut_of(browser)
    for share in (-0.8, 0.6):
        browser.press_at(slider, int(share * half_width), 0)
        # Ends of the track lie half a thumb inside the element: 10 % more than enough.
        assert abs(cut_of(browser) - 50 * (1 + share)) < 10, (share, cut_of(browser))
    assert browser.errors() == [], browser.errors()


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("spectrace", type=Path, help="the program")
    program = parser.parse_args().spectrace.resolve()
    skip_without_browser()
    with tempfile.TemporaryDirectory() as folder:
        (Path(folder) / "ball.json").write_text(SCENE)
        for seed in ("0", "1"):
            subprocess.run([program, "ball.json", "-o", f"{seed}.exr", "--seed", seed], cwd=folder, check=True,
                           stdout=subprocess.DEVNULL)
        subprocess.run([program, "compare", "0.exr", "1.exr", "--html", "page.html"], cwd=folder, check=True,
                       stdout=subprocess.DEVNULL)
        with Browser() as browser:
            check(browser, Path(folder) / "page.html")
    print("passed")


if __name__ == "__main__":
    main()
