# SPDX-License-Identifier: Apache-2.0
"""A headless Chromium for tests of pages."""

import base64
import json
import shutil
import socket
import subprocess
import sys
import time
import urllib.error
import urllib.request
from pathlib import Path

SKIPPED = 77
ELEMENT = "element-6066-11e4-a52e-4f735466cecf"  # the key that W3C's WebDriver gives to elements


def skip_without_browser() -> None:
    if missing := [name for name in ("chromium", "chromedriver") if shutil.which(name) is None]:
        print(f"skipped: not installed: {', '.join(missing)}")
        sys.exit(SKIPPED)


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

    def press_at(self, element: dict, x: int, y: int) -> None:
        """x, y: pixels from the element's centre."""
        self.evaluate("arguments[0].scrollIntoView({block: 'center'})", element)
        actions = [{"type": "pointerMove", "origin": element, "x": x, "y": y, "duration": 50},
                   {"type": "pointerDown", "button": 0}, {"type": "pointerUp", "button": 0}]
        self.ask("POST", f"{self.session}/actions", {"actions": [{"type": "pointer", "id": "mouse", "actions": actions}]})

    def choose(self, selector: str) -> None:
        self.ask("POST", f"{self.session}/element/{self.find(selector)[ELEMENT]}/click")

    def errors(self) -> list[str]:
        entries = self.ask("POST", f"{self.session}/se/log", {"type": "browser"})
        return [entry["message"] for entry in entries if entry["level"] == "SEVERE"]

    def picture(self) -> bytes:
        return base64.b64decode(self.ask("GET", f"{self.session}/screenshot"))
