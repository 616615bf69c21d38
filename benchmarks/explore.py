"""The speed of the live page in a real browser: python benchmarks/explore.py [--events N]

Slider event to repaint of the preview and of the final picture, a long drag, two pages at once, the start; and how far
dots of previews lie from those of the final picture. Needs chromium (`apt-get install chromium`) and playwright.
"""

import argparse
import shutil
import time

import numpy as np
import shared  # noqa: F401  puts tests/ on the path
from playwright.sync_api import sync_playwright
from support import ROOT
from support.explorers import explorer

import vibro_sweep as vs
from vibro_sweep.live.frames import frames
from vibro_sweep.live.views import scene_of_view, view_of

ROWS = 450  # pixels of the picture
CASES = [  # example, swept number, slider
    ("quickstart", "b", "R"),
    ("quickstart", "b", "omega"),
    ("quickstart", "b", "zeta"),
    ("quickstart", "omega", "R"),
    ("one_mass", "F", "R"),
    ("chain", "k2", "R"),
]
MEASURE = """async ([name, low, high, count]) => {
  const root = document.documentElement, slider = document.getElementById(`slider-${name}`);
  const reached = (states) => new Promise((done) => {
    const look = () => states.includes(root.dataset.state) && (watch.disconnect(), done(performance.now()));
    const watch = new MutationObserver(look);
    watch.observe(root, { attributes: true });
  });
  const result = [];
  for (let i = 0; i < count; i++) {
    await new Promise((done) => setTimeout(done, 13 + 30 * Math.random()));
    slider.value = Math.round(low + (high - low) * Math.random());
    const began = performance.now(), preview = reached(["preview", "final"]), final = reached(["final"]);
    slider.dispatchEvent(new Event("input", { bubbles: true }));
    result.push([await preview - began, await final - began]);
  }
  return result;
}"""
DRAG = """async ([name, low, high, count, seconds]) => {
  const root = document.documentElement, slider = document.getElementById(`slider-${name}`);
  const first = Number(root.dataset.frame), began = performance.now();
  const drawn = [], watch = new MutationObserver(() => drawn.push([performance.now() - began, root.dataset.state]));
  watch.observe(root, { attributes: true, attributeFilter: ["data-frame"] });
  for (let i = 0; i < count; i++) {
    const wait = began + (1000 * seconds * i) / count - performance.now();
    if (wait > 0) await new Promise((done) => setTimeout(done, wait));
    slider.value = Math.round(low + ((high - low) * i) / (count - 1));
    slider.dispatchEvent(new Event("input", { bubbles: true }));
  }
  const last = performance.now() - began, frames = Number(root.dataset.frame) - first;
  while (root.dataset.state !== "final") await new Promise((done) => setTimeout(done, 2));
  watch.disconnect();
  const preview = drawn.find(([at, state]) => at > last && state !== "computing")[0] - last;
  return { pictures: frames / (last / 1000), preview, final: performance.now() - began - last };
}"""


def quantiles(values):
    return f"{np.median(values):6.0f} / {np.percentile(values, 95):4.0f}"


def settle(page):
    page.wait_for_selector("html[data-state=final]", timeout=120_000)


def choose(page, example, axis):
    page.select_option("#presets", example)
    page.wait_for_timeout(300)
    settle(page)
    if page.input_value("#axis") != axis:
        page.select_option("#axis", axis)
        page.wait_for_timeout(100)
        settle(page)


def measure(browser, address, events):
    page = browser.new_page(viewport={"width": 1280, "height": 900})
    began = time.perf_counter()
    page.goto(address)
    settle(page)
    print(f"page opened to first final picture: {time.perf_counter() - began:.2f} s")
    print("\nms, median / 95 %                 preview      final")
    for example, axis, slider in CASES:
        choose(page, example, axis)
        page.evaluate(MEASURE, [slider, 500, 900, 5])  # the pace is measured
        found = np.array(page.evaluate(MEASURE, [slider, 500, 900, events]))
        print(f"{example:12} {axis:6} {slider:8} {quantiles(found[:, 0])} {quantiles(found[:, 1])}")
    choose(page, "quickstart", "b")
    for _ in range(3):
        drag = page.evaluate(DRAG, ["R", 400, 900, 200, 2.0])
        print(
            f"200 events in 2 s: {drag['pictures']:.0f} pictures a second; from the last event to the preview "
            f"{drag['preview']:.0f} ms, to the final {drag['final']:.0f} ms"
        )
    other = browser.new_page()
    other.goto(address)
    settle(other)
    # an endless drag in the other page, while the first one asks for single pictures
    other.evaluate(f"window.dragging = ({DRAG})(['R', 400, 900, 1200, 12.0]), null")
    found = np.array(page.evaluate(MEASURE, ["R", 500, 900, 15]))
    print(f"while a second page drags: preview {quantiles(found[:, 0])}, final {quantiles(found[:, 1])}")
    for one in (page, other):
        one.close()


def distances():
    """The share of preview dots within one pixel of the final ones, where the final is periodic."""
    print("\npreview dots within one pixel of the final picture's, where that is periodic")
    for example, axis, _ in CASES:
        scene = vs.load_scene(next(ROOT.glob(f"configs/**/{example}.yaml")))
        view = view_of(scene)
        if axis != view.axis:
            value = scene.system.numbers[axis]
            view = view.model_copy(update={"axis": axis, "low": 0.7 * value, "high": 1.4 * value})
        first, *pieces = frames(scene_of_view(view.model_copy(update={"start": {}})), variables=["x1", "period"])
        columns = np.arange(view.columns)
        final = {}
        for piece in pieces:
            for i, column in enumerate(columns[piece.box[0]]):
                final[column] = piece.arrays["x1"][i], piece.arrays["period"][i]
        heights = np.concatenate([x1 for x1, _ in final.values()])
        pixel = np.ptp(heights) * 1.06 / ROWS
        near = []
        for i, column in enumerate(columns[first.box[0]]):
            x1, period = final[column]
            if period:
                near.append((np.abs(first.arrays["x1"][i][:, None] - x1[-period:]).min(axis=1) <= pixel).mean())
        print(f"{example:12} {axis:6} {100 * np.mean(near):5.1f} %  ({len(first.arrays['x1'])} columns)")


def main():
    options = argparse.ArgumentParser(description=__doc__.partition("\n")[0])
    options.add_argument("--events", type=int, default=100, help="slider events of each case")
    events = options.parse_args().events
    began = time.perf_counter()
    with explorer() as program, sync_playwright() as playwright:
        print(f"program started to its address: {time.perf_counter() - began:.2f} s")
        browser = playwright.chromium.launch(executable_path=shutil.which("chromium"), args=["--no-sandbox"])
        measure(browser, program.address, events)
        browser.close()
    distances()


if __name__ == "__main__":
    main()
