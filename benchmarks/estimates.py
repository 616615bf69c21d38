"""What `check` says that a scene will take, beside what its run takes: twenty scenes, as the machine is and beside two
busy processes.

Both are asked in Pythons of their own, with kernels that are compiled already: the estimate, then the run, whose own
seconds count, as `run` says them at its end.
"""

import contextlib
import json
import os
import subprocess
import sys
import tempfile
from pathlib import Path

from book import HERE, Goal, digits, main, table

TITLE = "Estimates"
COMMAND = "python benchmarks/estimates.py"
CONFIGS = HERE.parent / "configs"
BUSY = 2  # processes that do nothing but compute
FACTOR = 2.0  # between an estimate and what is measured
PAPER = "system: {mu_m: 10, mu_k: 5, zeta: 0.05, f2: 0, omega: 0.63, R: 0.8, b: 6.6}\n"
CHAIN = (
    "system: {type: chain, m: [1, 1, 1], k: [1, 1, 1, 1], c: [0.02, 0.02, 0.02, 0.02], force: [1, 0, 0], stop_at: 2, "
    "omega: 1, R: 0.8, b: 1}\n"
)
FROM_FILES = (
    "quickstart", "basins", "coexistence", "hysteresis", "plane_clearance_frequency",
    "models/bouncing_ball", "models/ball_in_cavity", "models/chain", "paper/figure_06",
)  # fmt: skip
WRITTEN = {
    "one long orbit": PAPER + "orbit: {transient: 0, record: 3000000}\nobserve: [impacts]\n",
    "few long orbits": PAPER + "sweep: {b: {start: 1, stop: 7, num: 12}}\norbit: {transient: 100000, record: 50000}\n"
    "observe: [impacts, lyapunov]\n",
    "a period each": PAPER + "sweep: {R: {start: 0.5, stop: 0.9, num: 500}, b: {start: 5, stop: 7, num: 2000}}\n"
    "orbit: {transient: 0, record: 1}\nobserve: [impacts]\n",
    "tables at each point": PAPER
    + "sweep: {omega: {start: 0.05, stop: 2, num: 300}, b: {start: 1, stop: 7, num: 300}}\n"
    "orbit: {transient: 20, record: 10}\nobserve: [section]\n",
    "slow forcing": PAPER + "sweep: {omega: {start: 0.0005, stop: 0.005, num: 60}}\n"
    "orbit: {transient: 50, record: 50}\nobserve: [impacts]\n",
    "large steps, chaos": PAPER + "sweep: {b: {start: 0.3, stop: 0.7, num: 400}}\n"
    "orbit: {transient: 3000, record: 2000}\nobserve: [section, lyapunov, impacts]\n",
    "random starts, attractors": PAPER + "sweep: {b: {start: 4, stop: 6, num: 200}}\nstart: {random: 40, seed: 1}\n"
    "orbit: {transient: 1000, record: 200}\nobserve: [attractors, lyapunov]\n",
    "up and down": PAPER + "sweep: {omega: {start: 0.5, stop: 0.8, num: 800}}\nstart: {follow: both}\n"
    "orbit: {transient: 2000, record: 200}\nobserve: [section]\n",
    "the map": PAPER + "dynamics: map\nsweep: {b: {start: 6.6, stop: 6.7, num: 500}}\n"
    "orbit: {transient: 2000, record: 500}\nobserve: [section, lyapunov]\n",
    "three masses": CHAIN + "sweep: {R: {start: 0.3, stop: 0.95, num: 100}, omega: {start: 0.6, stop: 2, num: 40}}\n"
    "orbit: {transient: 500, record: 200}\nobserve: [section, lyapunov]\n",
}

ESTIMATE = """
import json, sys
from vibro_sweep.driver.cost import estimate
from vibro_sweep.scene import load_scene
found = estimate(load_scene(sys.argv[1]))
print(json.dumps([found.seconds, found.alone]))
"""
RUN = """
import sys
import vibro_sweep as vs
print(vs.run(vs.load_scene(sys.argv[1]), sys.argv[2]).seconds)
"""


def told(script: str, *arguments) -> object:
    """What a script prints, in a Python of its own."""
    command = [sys.executable, "-c", script, *map(str, arguments)]
    return json.loads(subprocess.run(command, check=True, capture_output=True, text=True).stdout)


@contextlib.contextmanager
def busy(count: int):
    """So many processes that compute meanwhile."""
    loops = [subprocess.Popen([sys.executable, "-c", "while True: pass"]) for _ in range(count)]
    try:
        yield
    finally:
        for loop in loops:
            loop.kill()
            loop.wait()


def measure(quick: bool) -> dict:
    """Rows (estimate, measured) of each scene: as the machine is, and beside the busy processes."""
    rows = {}
    with tempfile.TemporaryDirectory() as folder:
        scenes = {name: CONFIGS / f"{name}.yaml" for name in FROM_FILES}
        for name, text in WRITTEN.items():
            scenes[name] = Path(folder) / f"{name}.yaml"
            scenes[name].write_text(text)
        for name, path in list(scenes.items())[:: 7 if quick else 1]:
            output = Path(folder) / "run.h5"
            told(ESTIMATE, path)  # compiles
            rows[name] = []
            for count in (0, BUSY):
                with busy(count):
                    seconds, _ = told(ESTIMATE, path)
                    rows[name].append((seconds, told(RUN, path, output)))
                output.unlink()
    return {"rows": rows, "load": os.getloadavg()[0]}


def text(data: dict) -> str:
    rows = [
        (name, *(digits(value, 2) for pair in pairs for value in (*pair, pair[0] / pair[1])))
        for name, pairs in data["rows"].items()
    ]
    header = ("scene", "estimate, s", "run, s", "ratio", f"beside {BUSY}: estimate, s", "run, s", "ratio")
    return (
        f"What `check` says of a scene, and the seconds of its run, with two workers: on the machine as it is (load "
        f"{data['load']:.1f} at the end), and beside {BUSY} processes that do nothing but compute. Kernels are "
        f"compiled before.\n\n{table(header, rows)}"
    )


def goals(data: dict) -> list[Goal]:
    ratios = [pair[0] / pair[1] for pairs in data["rows"].values() for pair in pairs]
    worst = max(max(ratio, 1 / ratio) for ratio in ratios)
    asked = f"estimates within a factor of {FACTOR:.0f} of the run"
    return [Goal(asked, f"at most {worst:.2f}, of {len(ratios)}", FACTOR / worst, COMMAND)]


def figure(_: dict) -> None:
    """A table says it all."""


if __name__ == "__main__":
    main(__name__)
