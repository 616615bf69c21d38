"""How cost grows: with periods, points and impacts; memory with the size of a sweep; speed with workers.

Cost is CPU time of `compute.compute` on one block, the least of a few. Of impacts, it is what they add to the same
flight without stops. Memory is the peak of a fresh process that runs a whole sweep into its file.
"""

import multiprocessing
import resource
import statistics
import tempfile
import time
from pathlib import Path
from typing import NamedTuple

import numpy as np
import problem
from book import Goal, digits, main, styled, table
from engine import block_of, scene_text
from timing import spent

import vibro_sweep as vs
from vibro_sweep.driver.blocks import Block
from vibro_sweep.driver.compute import compute
from vibro_sweep.driver.memory_needed import BLOCK_BYTES
from vibro_sweep.plotting.page import page
from vibro_sweep.plotting.style import DASHES, FAINT
from vibro_sweep.scene import scene

TITLE = "Scaling"
COMMAND = "python benchmarks/scaling.py"
FREE = 6.8  # a clearance at which the orbit from rest swings freely in the end
FAR = 1e6  # a clearance that nothing reaches
WORKERS = 1.8
BLOCKS = 5  # one computed, one written; at the end as many as are put into the file together, and what HDF5 keeps
SLOPE = 1.1  # of a line in the double logarithmic plot that still counts as straight
COLOURS = {FREE: "#6e6e78", 6.69: "#b2182b", 3.0: "#2166ac", 1.0: "#4d9221"}


class Curve(NamedTuple):
    label: str
    b: float
    sizes: list[int]
    seconds: list[float]

    def slope(self) -> float:
        """Exponent of the growth over all sizes."""
        return float(np.polyfit(np.log(self.sizes), np.log(self.seconds), 1)[0])

    def steepest(self) -> float:
        """Over all sizes or at the end, where what is not linear shows first: the larger exponent."""
        last = np.log(self.seconds[-1] / self.seconds[-2]) / np.log(self.sizes[-1] / self.sizes[-2])
        return max(self.slope(), float(last))


def least(block: Block, rounds: int = 3) -> tuple[float, dict]:
    """CPU seconds of a block, and its arrays."""
    compute(block)
    taken = [spent(lambda: compute(block)) for _ in range(rounds)]
    return min(seconds for seconds, _ in taken), taken[0][1][1]


def orbit_block(b: float, periods: int, clearance: float | None = None) -> Block:
    """An orbit that starts on the attractor at b; as a transient it needs no memory."""
    params, states = problem.on_attractor(b)
    return block_of(scene_text(params | {"b": clearance or b}, states[0], transient=periods - 1, record=1))


def periods_curve(b: float, sizes) -> Curve:
    return Curve("periods", b, list(sizes), [least(orbit_block(b, n))[0] for n in sizes])


def recorded_curve(b: float, sizes) -> Curve:
    """Periods recorded from rest: the way to the attractor is among the section points, whose period is looked for."""
    params, _ = problem.on_attractor(b)
    blocks = [block_of(scene_text(params, (0.0,) * 4, record=n)) for n in sizes]
    return Curve("recorded periods, from rest", b, list(sizes), [least(block)[0] for block in blocks])


def points_curve(b: float, sizes) -> Curve:
    """Points of a sweep over clearances near b, 100 periods each."""
    params, states = problem.on_attractor(b)
    seconds = []
    for n in sizes:
        key = f"sweep: {{b: {{start: {b!r}, stop: {b + 0.01!r}, num: {n}}}}}"
        seconds.append(least(block_of(scene_text(params, states[0], sweep_key=key, record=100)))[0])
    return Curve("points", b, list(sizes), seconds)


def impacts_curve(b: float, sizes) -> Curve:
    """Impacts of one orbit, and what they cost beyond the flight."""
    params, states = problem.on_attractor(b)
    cycle = problem.CYCLE[b]
    arrays = least(block_of(scene_text(params, states[0], record=cycle)))[1]
    per_cycle = int(arrays["impacts_right"].sum() + arrays["impacts_left"].sum())
    found, seconds = [], []
    for n in sizes:
        cycles = round(n / per_cycle)
        flight = least(orbit_block(b, cycles * cycle, FAR))[0]
        found.append(cycles * per_cycle)
        seconds.append(least(orbit_block(b, cycles * cycle))[0] - flight)
    return Curve("impacts", b, found, seconds)


def sweep_text(count: int, record: int, transient: int = 50) -> str:
    """A sweep of so many clearances with everything observed."""
    params, _ = problem.on_attractor(6.69)
    key = f"sweep: {{b: {{start: 6.5, stop: 6.9, num: {count}}}}}"
    return scene_text(params, (0.0,) * 4, "section, lyapunov, impacts", key, transient=transient, record=record)


def peak_bytes() -> float:
    """Highest resident memory of this process; `ru_maxrss` alone would also count the process that started it."""
    try:
        for line in Path("/proc/self/status").read_text().splitlines():
            if line.startswith("VmHWM"):
                return 1024.0 * int(line.split()[1])
    except OSError:
        pass
    return 1024.0 * resource.getrusage(resource.RUSAGE_SELF).ru_maxrss


def one_run(text: str, workers: int, barrier, answers) -> None:
    """In a process of its own: warm up, wait for the others, run; wall time, peak memory and size of the file."""
    with tempfile.TemporaryDirectory() as folder:
        vs.run(scene.parse_scene(sweep_text(4, 20)), Path(folder) / "warm.h5", workers=workers)
        barrier.wait()
        began = time.perf_counter()
        vs.run(scene.parse_scene(text), Path(folder) / "run.h5", workers=workers)
        seconds = time.perf_counter() - began
        answers.put((seconds, peak_bytes(), (Path(folder) / "run.h5").stat().st_size))


def in_processes(count: int, text: str, workers: int = 1) -> list[tuple[float, float, int]]:
    """`one_run` in so many fresh processes at the same time."""
    context = multiprocessing.get_context("spawn")
    barrier, answers = context.Barrier(count), context.Queue()
    processes = [context.Process(target=one_run, args=(text, workers, barrier, answers)) for _ in range(count)]
    for process in processes:
        process.start()
    results = [answers.get() for _ in processes]
    for process in processes:
        process.join()
    return results


def parallel(points: int, rounds: int) -> dict[str, float]:
    """Throughput with two workers, and of two processes, over that of one; interleaved, medians."""
    text = sweep_text(points, 100, 40_000)  # a long time to settle, and a file of a few megabytes
    one, two, both = [], [], []
    for _ in range(rounds):
        one.append(in_processes(1, text, 1)[0][0])
        two.append(in_processes(1, text, 2)[0][0])
        both.append(max(seconds for seconds, *_ in in_processes(2, text, 1)))
    one, two, both = (statistics.median(times) for times in (one, two, both))
    return {"seconds": one, "workers": one / two, "processes": 2 * one / both}


def measure(quick: bool) -> dict:
    top = 0 if quick else 1
    memory = []
    for points in [100, 1000, 10_000, 100_000][: 3 + top]:
        ((_, peak, size),) = in_processes(1, sweep_text(points, 50))
        memory.append((points, peak, size))
    return {
        "curves": [
            *(periods_curve(b, [10**n for n in range(3, 7 + top)]) for b in problem.CLEARANCES),
            *(recorded_curve(b, [10**n for n in range(2, 5 + top)]) for b in (FREE, *problem.CLEARANCES)),
            *(points_curve(b, [10**n for n in range(1, 5 + top)]) for b in problem.CLEARANCES),
            *(impacts_curve(b, [10**n for n in range(3, 6 + 2 * top)]) for b in problem.CLEARANCES),
        ],
        "memory": memory,
        "parallel": parallel(1000 if quick else 4000, 1 if quick else 5),
    }


@styled
def figure(data: dict):
    """Cost against periods, points and impacts, memory against points, and speed with two workers."""
    fig = page(6.2, None)
    axes = fig.subplots(3, 2).ravel()
    names = {
        "periods": "forcing periods of one orbit",
        "recorded periods, from rest": "forcing periods recorded from rest",
        "points": "points, 100 periods each",
        "impacts": "impacts, without their flight",
    }
    for ax, (label, name) in zip(axes, names.items(), strict=False):
        for curve in (c for c in data["curves"] if c.label == label):
            marks = {"ms": 6.5, "mfc": "none"} if curve.b == 3.0 else {"ms": 3.2}  # b = 1 costs the same and covers it
            ax.loglog(curve.sizes, curve.seconds, "o-", color=COLOURS[curve.b], label=f"$b={curve.b:g}$", **marks)
        sizes = np.array([min(curve.sizes), max(curve.sizes)])
        ax.loglog(sizes, 0.15 * curve.seconds[-1] * sizes / sizes[-1], color=FAINT, ls=":")
        mark = {"textcoords": "offset points", "ha": "right", "va": "top", "fontsize": 7.5, "color": FAINT}
        ax.annotate("linear", (sizes[-1], 0.15 * curve.seconds[-1] / 2), (0, 0), **mark)
        ax.set(xlabel=name, ylabel="CPU time (s)")
    points, peaks, sizes = (np.array(column, float) for column in zip(*data["memory"], strict=True))
    axes[4].loglog(points, peaks / 1e6, "o-", ms=3.2, color="#542788", label="peak memory")
    axes[4].loglog(points, sizes / 1e6, "s--", ms=3.2, color=FAINT, label="file")
    axes[4].set(xlabel="points of a sweep, 50 periods recorded", ylabel="megabytes")
    axes[4].legend()
    axes[1].legend()
    speed = data["parallel"]
    axes[5].barh(
        ["two workers", "two processes"], [speed["workers"], speed["processes"]], 0.5, color=["#542788", FAINT]
    )
    axes[5].axvline(WORKERS, color=FAINT, lw=0.8, ls=DASHES)
    axes[5].invert_yaxis()
    axes[5].set(xlabel="work done, as a multiple of one alone", xlim=(0, 2.1), ylim=(1.6, -0.6))
    for ax in axes:
        ax.grid(color="#e6e6ea", lw=0.4)
        ax.minorticks_off()
        ax.set_axisbelow(True)
    return fig


def text(data: dict) -> str:
    curves = [
        (
            curve.label, f"{curve.b:g}", f"{curve.sizes[0]} .. {curve.sizes[-1]}",
            f"{curve.slope():.3f}", f"{curve.steepest():.3f}", digits(1e9 * curve.seconds[-1] / curve.sizes[-1]),
        )
        for curve in data["curves"]
    ]  # fmt: skip
    memory = [(points, f"{peak / 1e6:.0f}", digits(size / 1e6)) for points, peak, size in data["memory"]]
    speed = data["parallel"]
    return "\n".join(
        [
            table(("over", "b", "range", "exponent", "or at the end", "ns each, at the end"), curves),
            table(("points", "peak memory, MB", "file, MB"), memory),
            f"A sweep that takes {speed['seconds']:.1f} s with one worker: {speed['workers']:.2f} times as fast with "
            f"two. Two independent processes at the same time get {speed['processes']:.2f} times as much done as one: "
            "what this machine has to give.\n",
        ]
    )


def goals(data: dict) -> list[Goal]:
    rows = []
    for label in dict.fromkeys(curve.label for curve in data["curves"]):
        curves = [curve for curve in data["curves"] if curve.label == label]
        steepest = max(curve.steepest() for curve in curves)
        decades = min(np.log10(curve.sizes[-1] / curve.sizes[0]) for curve in curves)
        reached = f"exponent at most {steepest:.3f} over {decades:.1f} decades"
        rows.append(Goal(f"cost linear in {label}", reached, SLOPE / steepest, COMMAND))
    points, peaks, sizes = zip(*data["memory"], strict=True)
    grown, file = peaks[-1] - peaks[1], sizes[-1] - sizes[1]
    reached = f"{points[1]} to {points[-1]} points: {grown / 1e6:+.0f} MB of memory, {file / 1e6:+.0f} MB of file"
    asked = f"memory bounded by a few blocks, {BLOCKS * BLOCK_BYTES / 1e6:.0f} MB"
    rows.append(Goal(asked, reached, BLOCKS * BLOCK_BYTES / max(grown, 1e6), COMMAND))
    speed = data["parallel"]
    reached = f"{speed['workers']:.2f} times; two processes: {speed['processes']:.2f} times"
    asked = f"two workers: {WORKERS} times one, where the machine has two cores to give"
    rows.append(Goal(asked, reached, speed["workers"] / WORKERS, COMMAND))
    return rows


if __name__ == "__main__":
    main(__name__)
