"""The pictures of the tutorial on the live page: python docs/live_pictures.py

Needs chromium and playwright; the site is built with the pictures that this has made.
"""

import io
import shutil
import subprocess
import sys
from pathlib import Path

from PIL import Image
from playwright.sync_api import Page, sync_playwright

FOLDER = Path(__file__).parent / "tutorials"
SIZE = {"width": 1100, "height": 860}


def settle(page: Page) -> None:
    page.wait_for_timeout(300)
    page.wait_for_selector("html[data-state=final]", timeout=120_000)
    page.wait_for_timeout(300)


def keep(page: Page, name: str, whole: bool = False) -> None:
    """A picture of what is in the window, or of the whole page, in 64 colours."""
    picture = Image.open(io.BytesIO(page.screenshot(full_page=whole)))
    picture.convert("RGB").quantize(64).save(FOLDER / f"live_{name}.png", optimize=True)


def place(page: Page, across: float, down: float) -> tuple[float, float]:
    """A point of the diagram, in parts of its canvas."""
    box = page.locator("#diagram").bounding_box()
    return box["x"] + across * box["width"], box["y"] + down * box["height"]


def pictures(page: Page, address: str) -> None:
    page.goto(address)
    settle(page)
    keep(page, "start")
    for key, value in (("low", "5.3"), ("high", "6.1")):
        page.fill(f"#{key}", value)
    page.press("#high", "Enter")
    settle(page)
    page.press("#diagram", "f")
    settle(page)
    page.mouse.click(*place(page, 0.35, 0.4))
    page.wait_for_selector("#facts b")
    page.click("#why")
    page.locator("#window", has_text="upper end").wait_for(timeout=120_000)
    page.wait_for_timeout(500)
    keep(page, "window", whole=True)


if __name__ == "__main__":
    command = [sys.executable, "-m", "vibro_sweep", "explore", "--no-browser"]
    program = subprocess.Popen(command, stdout=subprocess.PIPE, text=True)
    try:
        with sync_playwright() as api:
            browser = api.chromium.launch(executable_path=shutil.which("chromium"), args=["--no-sandbox"])
            pictures(browser.new_page(viewport=SIZE), program.stdout.readline().strip())
    finally:
        program.terminate()
