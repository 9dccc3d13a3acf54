#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Opens the page of `spectrace cost` in a headless Chromium: points to what was measured, changes the metric, takes a picture.

Needs Debian's packages chromium and chromium-driver (`scripts/test.sh -L browser` installs them); exits with 77 otherwise.
"""

import argparse
import base64
import json
import shutil
import socket
import subprocess
import sys
import tempfile
import time
import urllib.error
import urllib.request
from pathlib import Path

SKIPPED = 77
ELEMENT = "element-6066-11e4-a52e-4f735466cecf"  # the key that W3C's WebDriver gives to elements
SCENE = """{"camera": {"origin": [0, -4, 1], "target": [0, 0, 0], "up": [0, 0, 1]}, "film": {"width": 32, "height": 32},
"materials": [{"name": "m", "type": "lambert", "reflectance": {"checkerboard": {"even": 0.2, "odd": 0.6}}}],
"shapes": [{"type": "sphere", "material": "m"}], "lights": [{"type": "environment", "radiance": 1}]}"""


class Browser:
    """A session of chromedriver, by WebDriver's own protocol."""

    def __init__(self) -> None:
        with socket.socket() as s:
            s.bind(("127.0.0.1", 0))
            port = s.getsockname()[1]
        self.driver = subprocess.Popen(["chromedriver", f"--port={port}"], stdout=subprocess.DEVNULL,
                                       stderr=subprocess.DEVNULL)
        self.root = f"http://127.0.0.1:{port}"
        self.wait_until_ready()
        arguments = ["--headless=new", "--no-sandbox", "--disable-gpu", "--window-size=1300,1000"]
        wanted = {"capabilities": {"alwaysMatch": {"browserName": "chrome", "goog:chromeOptions": {"args": arguments},
                                                   "goog:loggingPrefs": {"browser": "ALL"}}}}
        self.session = "/session/" + self.ask("POST", "/session", wanted)["sessionId"]

    def __enter__(self) -> "Browser":
        return self

    def __exit__(self, *_: object) -> None:
        self.ask("DELETE", self.session)
        self.driver.terminate()
        self.driver.wait(20)

    def ask(self, method: str, path: str, body: dict | None = None):
        data = json.dumps(body if body is not None else {}).encode() if method == "POST" else None
        request = urllib.request.Request(self.root + path, data, {"Content-Type": "application/json"}, method=method)
        with urllib.request.urlopen(request, timeout=60) as answer:
            return json.load(answer)["value"]

    def wait_until_ready(self) -> None:
        end = time.monotonic() + 30
        while True:
            try:
                if self.ask("GET", "/status")["ready"]:
                    return
            except (urllib.error.URLError, ConnectionError):
                if time.monotonic() > end:
                    raise
            time.sleep(0.1)

    def open(self, page: Path) -> None:
        self.ask("POST", f"{self.session}/url", {"url": page.as_uri()})

    def evaluate(self, script: str, *arguments):
        return self.ask("POST", f"{self.session}/execute/sync", {"script": script, "args": list(arguments)})

    def find(self, selector: str) -> dict:
        return self.ask("POST", f"{self.session}/element", {"using": "css selector", "value": selector})

    def point_at(self, element: dict) -> None:
        self.evaluate("arguments[0].scrollIntoView({block: 'center'})", element)
        move = {"type": "pointerMove", "origin": element, "x": 0, "y": 0, "duration": 50}
        self.ask("POST", f"{self.session}/actions", {"actions": [{"type": "pointer", "id": "mouse", "actions": [move]}]})

    def choose(self, selector: str) -> None:
        self.ask("POST", f"{self.session}/element/{self.find(selector)[ELEMENT]}/click")

    def errors(self) -> list[str]:
        entries = self.ask("POST", f"{self.session}/se/log", {"type": "browser"})
        return [entry["message"] for entry in entries if entry["level"] == "SEVERE"]

    def picture(self) -> bytes:
        return base64.b64decode(self.ask("GET", f"{self.session}/screenshot"))


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
    if missing := [name for name in ("chromium", "chromedriver") if shutil.which(name) is None]:
        print(f"skipped: not installed: {', '.join(missing)}")
        sys.exit(SKIPPED)
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
