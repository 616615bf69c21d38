"""What a person waits for: imports, the first run, later starts, commands, estimates, the live page.

Each is a process of its own, in CPU seconds; on a machine on which nothing else runs that is the time of waiting.
Estimates are what `vibro-sweep check` says of a scene, beside the seconds of its run. The live page is measured in a
browser, where chromium and playwright are installed: from a slider event to the preview and to the final picture.
"""

import os
import re
import shutil
import subprocess
import sys
import tempfile
from functools import cache
from importlib.util import find_spec
from pathlib import Path

import numpy as np
from bench import ROOT, child, digits, figures, main, measured, program, table

CONFIGS = ROOT / "configs"
QUICKSTART = CONFIGS / "quickstart.yaml"
SYSTEM = "vs.System(mu_m=10, mu_k=5, zeta=0.05, f2=0, omega=0.63, R=0.8, b=6.6)"
SWEEP = f"vs.sweep({SYSTEM}, {{'b': [6.5, 6.6, 6.7]}}, transient=100, record=50, observe=['section', 'lyapunov'])"
ORBIT = f"vs.simulate({SYSTEM}, (0, 0, 0, 0), periods=10)"
BRANCH = f"vs.continue_orbit(vs.periodic_orbit({SYSTEM}.replace(b=4), itinerary='R'), 'b', (3, 4.5))"
STARTS = {
    "import vibro_sweep": "", "a sweep of three points": SWEEP, "a single orbit": ORBIT, "a branch": BRANCH,
}  # fmt: skip
COMMANDS = {
    "`--help`": ("--help",), "`check` of the quickstart": ("check", QUICKSTART),
    "`run` of the quickstart": ("run", QUICKSTART, "-o", "FILE", "--overwrite", "--quiet", "--workers", "1"),
    "`plot` of the quickstart": ("plot", "FILE", "-o", "PICTURE", "--overwrite"),
    "`info` of the quickstart": ("info", "FILE"),
}  # fmt: skip
PAPER = "system: {mu_m: 10, mu_k: 5, zeta: 0.05, f2: 0, omega: 0.63, R: 0.8, b: 6.6}\n"
ESTIMATED = {
    **{name: CONFIGS / f"{name}.yaml" for name in ("quickstart", "hysteresis", "models/chain", "models/bouncing_ball")},
    "one long orbit": PAPER + "orbit: {transient: 0, record: 3000000}\nobserve: [impacts]\n",
    "a period each": PAPER + "sweep: {R: {start: 0.5, stop: 0.9, num: 500}, b: {start: 5, stop: 7, num: 2000}}\n"
    "orbit: {transient: 0, record: 1}\nobserve: [impacts]\n",
    "tables at each point": PAPER
    + "sweep: {omega: {start: 0.05, stop: 2, num: 300}, b: {start: 1, stop: 7, num: 300}}\n"
    "orbit: {transient: 20, record: 10}\nobserve: [section]\n",
    "chaos with many impacts": PAPER + "sweep: {b: {start: 0.3, stop: 0.7, num: 400}}\n"
    "orbit: {transient: 3000, record: 2000}\nobserve: [section, lyapunov, impacts]\n",
    "random starts": PAPER + "sweep: {b: {start: 4, stop: 6, num: 200}}\nstart: {random: 40, seed: 1}\n"
    "orbit: {transient: 1000, record: 200}\nobserve: [attractors, lyapunov]\n",
}  # fmt: skip
RUN = "import sys, vibro_sweep as vs; print(vs.run(vs.load_scene(sys.argv[1]), sys.argv[2]).seconds)"
EVENTS = """async ([name, low, high, count]) => {
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


@cache
def folder() -> tempfile.TemporaryDirectory:
    return tempfile.TemporaryDirectory(prefix="vibro_sweep_minutes_")


def start(what: str, **environment) -> float:
    """CPU seconds that a fresh Python takes until this is done, what its compiler does included."""
    return child("-c", f"import vibro_sweep as vs\n{what}", **environment).seconds


def start_row(what: str):
    def make():
        start(what)
        return lambda: start(what)

    return make


def command_row(arguments: tuple):
    def make():
        file, picture = (Path(folder().name, f"quickstart.{ending}") for ending in ("h5", "png"))
        words = [{"FILE": file, "PICTURE": picture}.get(word, word) for word in arguments]
        if file in words and not file.exists():
            program("run", QUICKSTART, "-o", file, "--quiet")
        program(*words)
        return lambda: program(*words).seconds

    return make


def first_row():
    """A maker: a first sweep and then a first orbit, with an empty cache of compiled code."""

    def sample():
        with tempfile.TemporaryDirectory() as cache_folder:
            return sum(start(what, NUMBA_CACHE_DIR=cache_folder) for what in (SWEEP, ORBIT))

    return sample


ROWS = {f"{what}: s": start_row(code) for what, code in STARTS.items()}
ROWS |= {f"{what}: s": command_row(arguments) for what, arguments in COMMANDS.items()}
FIRST = "first run, a sweep and then an orbit, nothing compiled: s"
ROWS[FIRST] = first_row


def estimates(quick: bool) -> list[dict]:
    """Seconds that `check` says, and those of the run; kernels are compiled before."""
    found = []
    for name, scene in list(ESTIMATED.items())[:: 4 if quick else 1]:
        path, file = scene, Path(folder().name, "estimated.h5")
        if isinstance(scene, str):
            path = Path(folder().name, "estimated.yaml")
            path.write_text(scene)
        program("check", path)  # compiles
        told = " ".join(program("check", path).printed.split())
        number, unit = re.search(r"time about ([\d.]+) (s|min|h)\b", told).groups()
        ran = float(child("-c", RUN, path, file).printed)
        file.unlink()
        found.append({"scene": name, "estimate": float(number) * {"s": 1, "min": 60, "h": 3600}[unit], "run": ran})
    return found


def live_page(events: int) -> dict | None:
    """Milliseconds, median and 95th percentile, from a slider event to the preview and to the final picture."""
    chromium = shutil.which("chromium") or shutil.which("chromium-browser")
    if not (chromium and find_spec("playwright") and find_spec("uvicorn")):
        return None
    from playwright.sync_api import sync_playwright

    command = [sys.executable, "-m", "vibro_sweep", "explore", str(QUICKSTART), "--no-browser"]
    process = subprocess.Popen(command, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True)
    try:
        address = next(found.group() for line in process.stdout for found in [re.search(r"http://\S+", line)] if found)
        with sync_playwright() as playwright:
            browser = playwright.chromium.launch(executable_path=chromium, args=["--no-sandbox"])
            page = browser.new_page(viewport={"width": 1280, "height": 900})
            page.goto(address)
            page.wait_for_selector("html[data-state=final]", timeout=120_000)
            page.evaluate(EVENTS, ["R", 500, 900, 5])  # the pace is measured
            preview, final = np.array(page.evaluate(EVENTS, ["R", 500, 900, events])).T
            browser.close()
    finally:
        process.terminate()
        process.wait()
    return {name: [*np.percentile(ms, [50, 95])] for name, ms in (("preview", preview), ("final", final))}


def measure(quick: bool) -> dict:
    found = measured({name: make for name, make in ROWS.items() if name != FIRST}, 1 if quick else 3)
    found |= measured({FIRST: ROWS[FIRST]}, 1)
    return {"rows": found, "estimates": estimates(quick), "page": live_page(10 if quick else 60)}


def worst(data: dict) -> float:
    """The largest factor between an estimate and its run."""
    return max(max(row["estimate"] / row["run"], row["run"] / row["estimate"]) for row in data["estimates"])


def text(data: dict) -> str:
    rows = [(row["scene"], digits(row["estimate"], 2), digits(row["run"], 2)) for row in data["estimates"]]
    found = figures(data["rows"]) + "\n" + table(("scene", "estimate, s", "run, s"), rows)
    if data["page"]:
        parts = [f"{name} {middle:.0f} ms ({most:.0f})" for name, (middle, most) in data["page"].items()]
        found += f"\nThe live page, from a slider event, median (and 95 %): {', '.join(parts)}.\n"
    return found


if __name__ == "__main__":
    os.environ.setdefault("PYTHONWARNINGS", "ignore")
    main(ROWS, measure, text)
