"""Two versions of this package side by side: `python benchmarks/versions.py CHECKOUT` compares another checkout with
this one and writes versions.md.

Each version computes in processes of its own, with the benchmarks of its own checkout. The two take turns, and the
median of the ratios counts: what else the machine does meanwhile hits both. There are several processes of each, since
where the memory of one happens to lie makes it some per cent faster or slower for good. Orbits start at eight points
of their attractor, so that chaotic ones have parted; nothing else should run.
"""

import argparse
import os
import statistics
import subprocess
import sys
import tempfile
import time
from pathlib import Path

from book import HERE, digits, machine, table
from problem import CHAOTIC, CLEARANCES

PERIODIC = (6.8, *CLEARANCES)
PAIRS = 6  # of processes
SIZES = {"impacts": 40_000, "impacts, lyapunov": 24_000}  # periods of an orbit
SYSTEM = {"mu_m": 10, "mu_k": 5, "zeta": 0.05, "f2": 0, "omega": 0.63, "R": 0.8, "b": 6.6}
SCENE = f"""
system: {SYSTEM}
sweep: {{b: {{start: 6.5, stop: 6.9, num: 8}}}}
orbit: {{transient: 100, record: 50}}
observe: [section, lyapunov, impacts]
""".replace("'", "")
STARTS = {
    "later starts to a sweep of 8 points, s": f"""
import pathlib, tempfile
with tempfile.TemporaryDirectory() as folder:
    scene = pathlib.Path(folder, "scene.yaml")
    scene.write_text({SCENE!r})
    vs.run(vs.load_scene(scene), scene.with_suffix(".h5"))
""",
    "later starts to a single orbit, s": f"vs.simulate(vs.System(**{SYSTEM}), (0, 0, 0, 0), periods=10)",
}
WORKER = """
import sys
import time

import engine
import numpy as np

import vibro_sweep as vs

JOBS = {}
for line in sys.stdin:
    if line not in JOBS:
        b, observe, periods = line.strip().split("; ")
        params = dict(mu_m=10, mu_k=5, zeta=0.05, f2=0, omega=0.63, R=0.8, b=float(b), tau=0)
        states = np.asarray(vs.simulate(vs.System(**params), (0, 0, 0, 0), 3000).section[-8:])
        text = engine.scene_text(params, states[0], observe, record=int(periods))
        JOBS[line] = engine.block_of(text)._replace(starts=states)
    began = time.process_time()
    engine.compute.compute(JOBS[line])
    print(time.process_time() - began, flush=True)
"""


class Version:
    """A checkout, and a process that computes with it."""

    def __init__(self, root: Path, cache: str):
        self.root = root
        path = os.pathsep.join((str(root), str(root / "benchmarks")))
        self.environment = os.environ | {"PYTHONPATH": path, "NUMBA_CACHE_DIR": cache}
        command, pipe = [sys.executable, "-c", WORKER], subprocess.PIPE
        self.worker = subprocess.Popen(command, env=self.environment, cwd=root, stdin=pipe, stdout=pipe, text=True)

    def seconds(self, b: float, observe: str) -> float:
        """CPU time of a block of eight orbits."""
        self.worker.stdin.write(f"{b}; {observe}; {SIZES[observe]}\n")
        self.worker.stdin.flush()
        return float(self.worker.stdout.readline())

    def start(self, what: str) -> float:
        """Seconds that a fresh Python takes until `what` is done."""
        program = f"import vibro_sweep as vs\n{what}"
        began = time.perf_counter()
        subprocess.run([sys.executable, "-c", program], env=self.environment, check=True, cwd=self.root)
        return time.perf_counter() - began


def compared(versions: list[tuple[Version, Version]], measure, rounds: int) -> tuple[float, float, float]:
    """Medians of both, and of their ratio; in turns of these pairs, too."""
    for old, new in versions:
        measure(old), measure(new)
    pairs = []
    for i in range(rounds):
        old, new = versions[i // 2 % len(versions)]
        first, second = (old, new) if i % 2 else (new, old)
        one, other = measure(first), measure(second)
        pairs.append((one, other) if first is old else (other, one))
    before, after = zip(*pairs, strict=True)
    ratios = [a / b for a, b in pairs]
    return statistics.median(before), statistics.median(after), statistics.median(ratios)


def first_runs(root: Path) -> float:
    """Seconds of a first sweep and then of a first single orbit, each in a fresh Python, with an empty cache."""
    with tempfile.TemporaryDirectory() as cache:
        version = Version(root, cache)
        version.worker.stdin.close()
        return sum(version.start(what) for what in STARTS.values())


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__.split("\n\n")[0])
    parser.add_argument("checkout", type=Path)
    parser.add_argument("--rounds", type=int, default=36)
    chosen = parser.parse_args()
    about, rows = machine(), []
    with tempfile.TemporaryDirectory() as one, tempfile.TemporaryDirectory() as other:
        pairs = [(Version(chosen.checkout.resolve(), one), Version(HERE.parent, other)) for _ in range(PAIRS)]
        for observe, periods in SIZES.items():
            for b in (*PERIODIC, *CHAOTIC):
                before, after, ratio = compared(pairs, lambda v, b=b, o=observe: v.seconds(b, o), chosen.rounds)
                unit = 1e9 / 8 / periods
                what = f"{observe}, b = {b:g}{', chaotic' if b in CHAOTIC else ''}: ns a period"
                rows.append((what, digits(before * unit), digits(after * unit), f"{ratio:.3f}"))
        for name, what in STARTS.items():
            before, after, ratio = compared(pairs[:1], lambda v, what=what: v.start(what), max(3, chosen.rounds // 3))
            rows.append((name, digits(before), digits(after), f"{ratio:.3f}"))
    before, after = first_runs(chosen.checkout.resolve()), first_runs(HERE.parent)
    rows.append(("a first sweep and a first orbit, s", digits(before), digits(after), f"{before / after:.3f}"))
    commit = subprocess.run(
        ["git", "-C", chosen.checkout, "rev-parse", "--short", "HEAD"], capture_output=True, text=True, check=True
    ).stdout.strip()
    text = " ".join(__doc__.split("\n\n", 1)[1].split())
    header = ("", commit, "here", "ratio: times faster")
    count = f"- {chosen.rounds} rounds, {PAIRS} processes of each version\n\n"
    (HERE / "versions.md").write_text(f"# Beside version {commit}\n\n{about}{count}{text}\n\n{table(header, rows)}")


if __name__ == "__main__":
    main()
