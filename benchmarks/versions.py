"""Two versions of this package side by side: `python benchmarks/versions.py CHECKOUT` compares another checkout with
this one; `python benchmarks/report.py --before CHECKOUT` has that as a part.

Each version computes in processes of its own, with the benchmarks of its own checkout. The two take turns, and the
median of the ratios counts: what else the machine does meanwhile hits both. There are several processes of each, since
where the memory of one happens to lie makes it some per cent faster or slower for good. Orbits start at eight points
of their attractor, so that chaotic ones have parted; nothing else should run.
"""

import argparse
import json
import os
import statistics
import subprocess
import sys
import tempfile
import time
from pathlib import Path
from typing import NamedTuple

from book import GOAL_HEADER, HERE, Goal, digits, machine, table
from problem import CHAOTIC, CLEARANCES

PERIODIC = (6.8, *CLEARANCES)
PAIRS = 6  # of processes
ROUNDS = 36
TITLE = "Beside another version"
COMMAND = "python benchmarks/versions.py CHECKOUT"
SIZES = {"impacts": 40_000, "impacts, lyapunov": 24_000}  # periods of an orbit
SYSTEM = {"mu_m": 10, "mu_k": 5, "zeta": 0.05, "f2": 0, "omega": 0.63, "R": 0.8, "b": 6.6}
SCENE = f"""
system: {SYSTEM}
sweep: {{b: {{start: 6.5, stop: 6.9, num: 8}}}}
orbit: {{transient: 100, record: 50}}
observe: [section, lyapunov, impacts]
""".replace("'", "")
SWEEP = f"""
import pathlib, tempfile
with tempfile.TemporaryDirectory() as folder:
    scene = pathlib.Path(folder, "scene.yaml")
    scene.write_text({SCENE!r})
    vs.run(vs.load_scene(scene), scene.with_suffix(".h5"))
"""
STARTS = {
    "later starts to a sweep of 8 points, s": SWEEP,
    "later starts to a single orbit, s": f"vs.simulate(vs.System(**{SYSTEM}), (0, 0, 0, 0), periods=10)",
}
FIRST_RUNS = "a first sweep and a first orbit, s"
FIRST_POINT = "a later start to the first point, s"
TABLE_POINTS = 20_000
TABLES = "a point of a sweep in omega, of one period: us"
DRAWN = {  # files to draw
    "the quickstart": (HERE.parent / "configs" / "quickstart.yaml").read_text(),
    "a plane of 10^6 points": f"""
system: {SYSTEM}
sweep: {{b: {{start: 1, stop: 7, num: 1000}}, omega: {{start: 0.55, stop: 0.7, num: 1000}}}}
orbit: {{transient: 0, record: 2}}
observe: [section]
""".replace("'", ""),
    "a diagram of 10^7 samples": f"""
system: {SYSTEM}
sweep: {{b: {{start: 1, stop: 7, num: 10000}}}}
orbit: {{transient: 0, record: 1000}}
observe: [section]
""".replace("'", ""),
}
RATIOS = {  # asked of a row, beside a9a9cb4: issue of the speed of chaos and starts
    "impacts, b = 5.8, chaotic: ns a period": 1.3,
    "impacts, b = 4.6, chaotic: ns a period": 1.2,
    "impacts, b = 0.5, chaotic: ns a period": 1.05,
    "impacts, lyapunov, b = 5.8, chaotic: ns a period": 1.1,
    "impacts, lyapunov, b = 4.6, chaotic: ns a period": 1.1,
    "impacts, lyapunov, b = 0.5, chaotic: ns a period": 1.1,
}
MOST = {FIRST_POINT: 0.45, FIRST_RUNS: 13.0, TABLES: 5.0}  # asked of this version
WORKER = """
import sys
import time

import engine
import numpy as np

import vibro_sweep as vs

JOBS = {}
for line in sys.stdin:
    if line not in JOBS:
        b, observe, count = line.strip().split("; ")
        params = dict(mu_m=10, mu_k=5, zeta=0.05, f2=0, omega=0.63, R=0.8, b=float(b), tau=0)
        if observe == "tables":
            sweep = f"sweep: {{omega: {{start: 0.6, stop: 0.66, num: {count}}}}}"
            JOBS[line] = engine.block_of(engine.scene_text(params, (0, 0, 0, 0), "impacts", sweep, record=1))
        else:
            states = np.asarray(vs.simulate(vs.System(**params), (0, 0, 0, 0), 3000).section[-8:])
            text = engine.scene_text(params, states[0], observe, record=int(count))
            JOBS[line] = engine.block_of(text)._replace(starts=states)
    began = time.process_time()
    engine.compute.compute(JOBS[line])
    print(time.process_time() - began, flush=True)
"""


class Used(NamedTuple):
    """By a process."""

    seconds: float
    megabytes: float  # at most
    printed: str


class Row(NamedTuple):
    what: str
    before: float
    after: float
    ratio: float  # times faster, or smaller


class Version:
    """A checkout, and a process that computes with it."""

    def __init__(self, root: Path, cache: str):
        self.root = root
        path = os.pathsep.join((str(root), str(root / "benchmarks")))
        self.environment = os.environ | {"PYTHONPATH": path, "PYTHONSAFEPATH": "1", "NUMBA_CACHE_DIR": cache}
        # modules are compiled once, as where the package is installed: else each start would do it again
        self.environment.pop("PYTHONDONTWRITEBYTECODE", None)
        command, pipe = [sys.executable, "-c", WORKER], subprocess.PIPE
        self.worker = subprocess.Popen(command, env=self.environment, cwd=root, stdin=pipe, stdout=pipe, text=True)

    def seconds(self, b: float, observe: str, count: int) -> float:
        """CPU time of a block of eight orbits over `count` periods; of "tables", of that many values of omega."""
        self.worker.stdin.write(f"{b}; {observe}; {count}\n")
        self.worker.stdin.flush()
        return float(self.worker.stdout.readline())

    def run(self, *arguments) -> Used:
        """A fresh Python with these arguments."""
        began, pipe = time.perf_counter(), subprocess.PIPE
        process = subprocess.Popen(
            [sys.executable, *arguments], env=self.environment, cwd=self.root, stdout=pipe, text=True
        )
        printed = process.stdout.read()
        _, status, usage = os.wait4(process.pid, 0)
        if status:
            raise RuntimeError(f"{arguments} ended with status {status}")
        return Used(time.perf_counter() - began, usage.ru_maxrss / 1024, printed)

    def start(self, what: str) -> float:
        """Seconds that a fresh Python takes until `what` is done."""
        return self.run("-c", f"import vibro_sweep as vs\n{what}").seconds

    def first_point(self) -> float:
        """Seconds that a fresh Python takes to the first point of the quickstart."""
        began = time.time()
        found = self.run(self.root / "benchmarks" / "first_point.py", self.root / "configs" / "quickstart.yaml")
        return json.loads(found.printed)["done"] - began

    def compute(self, scene: Path, file: Path) -> Used:
        """`vibro-sweep run` with one worker."""
        file.unlink(missing_ok=True)
        return self.run("-m", "vibro_sweep", "run", scene, "-o", file, "--workers", "1", "--quiet")

    def draw(self, file: Path) -> float:
        """Seconds of `vibro-sweep plot`."""
        picture = file.with_suffix(".png")
        picture.unlink(missing_ok=True)
        return self.run("-m", "vibro_sweep", "plot", file, "-o", picture).seconds


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


def measure(checkout: Path, rounds: int = ROUNDS) -> list[Row]:
    """Orbits, tables, starts, files, pictures and memory, of the other version and of this one."""
    other, rows, few = checkout.resolve(), [], max(3, rounds // 3)
    with tempfile.TemporaryDirectory() as one, tempfile.TemporaryDirectory() as another:
        pairs = [(Version(other, one), Version(HERE.parent, another)) for _ in range(PAIRS)]

        def add(what: str, one_of, unit: float = 1.0, among=pairs[:1], rounds: int = few) -> None:
            before, after, ratio = compared(among, one_of, rounds)
            rows.append(Row(what, before * unit, after * unit, ratio))

        for observe, periods in SIZES.items():
            for b in (*PERIODIC, *CHAOTIC):
                what = f"{observe}, b = {b:g}{', chaotic' if b in CHAOTIC else ''}: ns a period"
                add(what, lambda v, b=b, o=observe, n=periods: v.seconds(b, o, n), 1e9 / 8 / periods, pairs, rounds)
        add(TABLES, lambda v: v.seconds(6.6, "tables", TABLE_POINTS), 1e6 / TABLE_POINTS, pairs)
        add(FIRST_POINT, Version.first_point)
        for name, what in STARTS.items():
            add(name, lambda v, what=what: v.start(what))
        for name, text in DRAWN.items():
            scene = Path(one, "scene.yaml")
            scene.write_text(text)
            files = {v: Path(v.environment["NUMBA_CACHE_DIR"], "drawn.h5") for v in pairs[0]}
            add(f"`run` of {name}, s", lambda v, scene=scene, files=files: v.compute(scene, files[v]).seconds, rounds=3)
            if name == "the quickstart":
                memory = {v: v.compute(scene, files[v]).megabytes for v in pairs[0]}
                rows.append(Row(f"`run` of {name}, MB", *memory.values(), memory[pairs[0][0]] / memory[pairs[0][1]]))
            add(f"`plot` of {name}, s", lambda v, files=files: v.draw(files[v]), rounds=3)
    before, after = first_runs(other), first_runs(HERE.parent)
    return [*rows, Row(FIRST_RUNS, before, after, before / after)]


def text(rows: list[Row], checkout: Path) -> str:
    header = ("", commit_of(checkout), "here", "ratio: times faster")
    about = " ".join(__doc__.split("\n\n", 1)[1].split())
    lines = [(row.what, digits(row.before), digits(row.after), f"{row.ratio:.3f}") for row in rows]
    return f"{about}\n\n{table(header, lines)}"


def goals(rows: list[Row]) -> list[Goal]:
    found = {row.what: row for row in rows}
    faster = [
        Goal(f"{what}: {asked} times faster", f"{found[what].ratio:.3f} times", found[what].ratio / asked, COMMAND)
        for what, asked in RATIOS.items()
    ]
    return faster + [
        Goal(f"{what}: at most {asked:g}", digits(found[what].after), asked / found[what].after, COMMAND)
        for what, asked in MOST.items()
    ]


def commit_of(checkout: Path) -> str:
    command = ["git", "-C", checkout, "rev-parse", "--short", "HEAD"]
    return subprocess.run(command, capture_output=True, text=True, check=True).stdout.strip()


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__.split("\n\n")[0])
    parser.add_argument("checkout", type=Path)
    parser.add_argument("--rounds", type=int, default=ROUNDS)
    chosen = parser.parse_args()
    rows = measure(chosen.checkout, chosen.rounds)
    goal_rows = [goal.row() for goal in goals(rows)]
    print(f"{machine()}\n{text(rows, chosen.checkout)}\n{table(GOAL_HEADER, goal_rows)}")


if __name__ == "__main__":
    main()
