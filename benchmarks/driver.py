"""What the driver costs: time outside kernels on threads and on Dask, memory of 10^7 points, and so 10^12 periods.

A clock around `compute.compute`, in the worker, gives the seconds of every block. Their sum over the wall time of the
run times its workers is the share of the time in kernels; the same with CPU seconds tells what the machine withheld.
The wall time begins after a small run on the same workers, which starts and compiles everything.
"""

import contextlib
import json
import os
import subprocess
import sys
import tempfile
import time
from concurrent.futures import Executor, Future, ThreadPoolExecutor
from pathlib import Path
from unittest.mock import patch

from book import Goal, digits, main, table
from scaling import in_processes

import vibro_sweep as vs
from vibro_sweep.driver import cost, measuring, sweep
from vibro_sweep.driver.compute import compute
from vibro_sweep.scene import scene

TITLE = "The driver"
COMMAND = "python benchmarks/driver.py"
WORKERS = 2
BLOCK_SECONDS = 1.0
SHARES = {"threads": 0.95, "Dask": 0.90}  # of the time in kernels, that are asked for
MEMORY = 1e9
CORES = (16, 64, 256, 1024)
PAPER = "system: {{mu_m: 10, mu_k: 5, zeta: 0.05, f2: 0, omega: 0.63, R: 0.8, b: 6.6}}"
LINE = (
    PAPER
    + """
sweep: {{b: {{start: 6.5, stop: 6.9, num: {points}}}}}
orbit: {{transient: 3000, record: 500}}
observe: [lyapunov, impacts]
"""
)
SMALL = (
    PAPER
    + """
sweep: {{R: {{start: 0.5, stop: 0.9, num: {rows}}}, b: {{start: 5, stop: 7, num: 4000}}}}
orbit: {{transient: 0, record: 1}}
observe: [impacts]
"""
)
PLANE = (
    PAPER
    + """
sweep: {{omega: {{start: 0.5, stop: 0.8, num: 4000}}, b: {{start: 5, stop: 7, num: 4000}}}}
start: {{random: 16, seed: 1}}
orbit: {{transient: 3400, record: 506}}
observe: {observe}
"""
)


def clocked(block):
    """`compute`, and its seconds by the wall and of the CPU."""
    wall, cpu = time.perf_counter(), time.thread_time()
    result = compute(block)
    return result, (time.perf_counter() - wall, time.thread_time() - cpu)


class Clocked(Executor):
    """Another executor, with a clock around every block."""

    def __init__(self, executor: Executor):
        self.executor, self.num_workers, self.seconds = executor, WORKERS, []

    def submit(self, function, block):
        outer = Future()

        def hand_over(inner):
            try:
                result, seconds = inner.result()
            except Exception as error:
                outer.set_exception(error)
            else:
                self.seconds.append(seconds)
                outer.set_result(result)

        self.executor.submit(clocked, block).add_done_callback(hand_over)
        return outer


@contextlib.contextmanager
def dask():
    """An executor of worker processes that are started by command."""
    from vibro_sweep.driver.cluster import cluster

    with tempfile.TemporaryDirectory() as folder, contextlib.ExitStack() as stack:
        told, log = Path(folder) / "scheduler.json", stack.enter_context(open(os.devnull, "w"))
        path = os.pathsep.join([str(Path(__file__).parent), os.environ.get("PYTHONPATH", "")])

        def start(what, *options):
            command = [sys.executable, "-m", f"distributed.cli.dask_{what}", "--scheduler-file", str(told)]
            process = subprocess.Popen(
                [*command, "--no-dashboard", *options], stdout=log, stderr=log, env=os.environ | {"PYTHONPATH": path}
            )
            stack.callback(process.wait)
            stack.callback(process.terminate)

        start("scheduler", "--host", "127.0.0.1", "--port", "0", "--dashboard-address", "127.0.0.1:0")
        for _ in range(WORKERS):
            start("worker", "--nthreads", "1", "--local-directory", folder)
        while not (told.exists() and told.stat().st_size):
            time.sleep(0.05)
        with cluster(json.loads(told.read_text())["address"]) as executor:
            while executor.num_workers < WORKERS:
                time.sleep(0.05)
            yield executor


def share(executor: Executor, seconds: float) -> dict[str, float]:
    """Run a sweep that takes about so long; where the time of its workers went."""
    one = cost.orbit_cost(scene.parse_scene(LINE.format(points=1000)), WORKERS).seconds
    text = LINE.format(points=int(WORKERS * seconds / one))
    with tempfile.TemporaryDirectory() as folder, patch.object(sweep, "SECONDS", BLOCK_SECONDS):
        vs.run(scene.parse_scene(LINE.format(points=200)), Path(folder) / "warm.h5", executor=executor)
        clock = Clocked(executor)
        began = time.perf_counter()
        vs.run(scene.parse_scene(text), Path(folder) / "run.h5", executor=clock)
        wall = time.perf_counter() - began
    inside, cpu = (sum(column) for column in zip(*clock.seconds, strict=True))
    blocks = len(clock.seconds)
    return {"wall": wall, "blocks": blocks, "block": inside / blocks, "share": inside / wall / WORKERS,
            "cpu": cpu / wall / WORKERS}  # fmt: skip


def measure(quick: bool) -> dict:
    seconds = 6 if quick else 60
    with ThreadPoolExecutor(WORKERS) as threads:
        shares = {"threads": share(threads, seconds)}
    with dask() as executor:
        shares["Dask"] = share(executor, seconds)
    rows = 100 if quick else 2500
    ((wall, peak, size),) = in_processes(1, SMALL.format(rows=rows), WORKERS)
    planes = {}
    for observe in ("[impacts]", "[lyapunov, impacts]"):
        plane = scene.parse_scene(PLANE.format(observe=observe))
        periods = plane.transient + plane.record
        with patch.multiple(measuring, PLACES=100, MEASURED=0.5):  # more of them, from beginning to end
            planes[observe] = (plane.n_points * periods, cost.orbit_cost(plane, 1).seconds / periods)
    return {"shares": shares, "store": (rows * 4000, wall, peak, size), "planes": planes}


def figure(data: dict):
    """None: there is nothing to draw."""


def hours(data: dict, observe: str, cores: int) -> float:
    """Of the plane, with the share of time in kernels that Dask left here."""
    periods, seconds = data["planes"][observe]
    return periods * seconds / data["shares"]["Dask"]["share"] / cores / 3600


def text(data: dict) -> str:
    shares = [
        (name, row["blocks"], f"{row['block']:.2f}", digits(row["wall"]), f"{row['share']:.1%}", f"{row['cpu']:.1%}")
        for name, row in data["shares"].items()
    ]
    points, wall, peak, size = data["store"]
    planes = [
        (observe, f"{periods:.2e}", f"{1e9 * seconds:.0f}", *(digits(hours(data, observe, n)) for n in CORES))
        for observe, (periods, seconds) in data["planes"].items()
    ]
    header = ("two workers", "blocks", "seconds each", "wall time, s", "in kernels", "of the CPU in kernels")
    return "\n".join(
        [
            table(header, shares),
            f"A plane of {points:,} points, a period each, two threads: {wall:.0f} s, peak memory {peak / 1e6:.0f} MB, "
            f"file {size / 1e6:.0f} MB.\n",
            "4000 x 4000 points, 16 random starts each, 3906 periods: the rate of one core measured here on some of "
            "the plane's own orbits, with the share above that Dask leaves to kernels, gives hours on so many cores "
            "(were those as fast):\n",
            table(("observed", "periods", "ns a period", *(f"{n} cores" for n in CORES)), planes),
        ]
    )


def goals(data: dict) -> list[Goal]:
    rows = []
    for name, asked in SHARES.items():
        row = data["shares"][name]
        reached = f"{row['share']:.1%} in blocks of {row['block']:.2f} s"
        rows.append(
            Goal(f"{name}, two workers: {asked:.0%} of the time in kernels", reached, row["share"] / asked, COMMAND)
        )
    points, _, peak, _ = data["store"]
    asked = "10^7 points planned and stored in less than 1 GB of memory"
    rows.append(Goal(asked, f"{points:,} points: {peak / 1e6:.0f} MB", MEMORY / peak, COMMAND))
    return rows


if __name__ == "__main__":
    main(__name__)
