#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Opens the page of `spectrace cost` in a headless Chromium: points to what was measured, changes the metric, takes a picture.

Needs Debian's packages chromium and chromium-driver (`scripts/test.sh -L browser` installs them); exits with 77 otherwise.
"""

import argparse
import subprocess
import tempfile
from pathlib import Path

from support.browser import Browser, skip_without_browser

SCENE = """{"camera": {"origin": [0, -4, 1], "target": [0, 0, 0], "up": [0, 0, 1]}, "film": {"width": 32, "height": 32},
"materials": [{"name": "m", "type": "lambert", "reflectance": {"checkerboard": {"even": 0.2, "odd": 0.6}}}],
"shapes": [{"type": "sphere", "material": "m"}], "lights": [{"type": "environment", "radiance": 1}]}"""


def visible_plots(browser: Browser) -> list[str]:
    return browser.evaluate("return [...document.querySelectorAll('[data-metric]')]"
                            ".filter(plot => plot.getClientRects().length > 0).map(plot => plot.dataset.metric)")


def point_in_sight(browser: Browser) -> dict:
    """Of the plot of relMSE, one that no other hides."""
    return browser.evaluate("""return [...document.querySelectorAll('[data-metric=rel_mse] [data-label]')].find(point => {
      point.scrollIntoView({block: 'center'});
      const box = point.getBoundingClientRect();
      return document.elementFromPoint(box.x + box.width / 2, box.y + box.height / 2) === point})""")


def check(browser: Browser, page: Path, metric: str) -> None:
    browser.open(page)
    told = "return document.getElementById('told').textContent"
    assert browser.evaluate(told) == "", "nothing is told before the pointer is somewhere"
    point = point_in_sight(browser)
    browser.point_at(point)
    label = browser.evaluate("return arguments[0].dataset.label", point)
    assert browser.evaluate(told) == label and "relMSE" in label, (browser.evaluate(told), label)
    assert visible_plots(browser) == ["rel_mse"], visible_plots(browser)
    browser.choose(f"#metric option[value={metric}]")
    assert visible_plots(browser) == [metric], visible_plots(browser)
    assert browser.evaluate("return [...document.images].every(i => i.complete && i.naturalWidth > 0)"), "a picture is missing"
    assert browser.errors() == [], browser.errors()


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("spectrace", type=Path, help="the program")
    parser.add_argument("--page", type=Path, help="a page made before, instead of one of a small scene")
    parser.add_argument("--screenshot", type=Path, help="PNG of the page to write")
    arguments = parser.parse_args()
    skip_without_browser()
    with tempfile.TemporaryDirectory() as folder:
        page = arguments.page
        if page is None:
            (Path(folder) / "ball.json").write_text(SCENE)
            subprocess.run([arguments.spectrace.resolve(), "cost", "ball.json", "-o", "report", "--budget", "3"],
                           cwd=folder, check=True, stdout=subprocess.DEVNULL)
            page = Path(folder) / "report/index.html"
        with Browser() as browser:
            for metric in ("psnr_db", "ciede2000"):
                check(browser, page.resolve(), metric)
            if arguments.screenshot:
                browser.choose("#metric option[value=rel_mse]")
                browser.point_at(point_in_sight(browser))
                arguments.screenshot.write_bytes(browser.picture())
    print("passed")


if __name__ == "__main__":
    main()
