"""How cost grows with periods and points; files of millions of points, written, told about, drawn; memory; two workers.

Files and memory are those of `vibro-sweep run` in a process of its own. Two workers are the only figure by the wall
clock: beside it stands what two independent processes get done at the same time, which is what the machine has to give.
"""

import os
import statistics
import subprocess
import sys
import tempfile
from functools import cache, partial
from pathlib import Path

import numpy as np
import problem
from bench import child, digits, figures, least, main, measured, program, spent, table

import vibro_sweep as vs

SYSTEM = "system: {mu_m: 10, mu_k: 5, zeta: 0.05, f2: 0, omega: 0.63, R: 0.8, b: 6.6}\n"
FILES = {
    "a plane of 10^6 points": SYSTEM
    + "sweep: {b: {start: 1, stop: 7, num: 1000}, omega: {start: 0.55, stop: 0.7, num: 1000}}\n"
    "orbit: {transient: 0, record: 2}\nobserve: [section]\n",
    "a diagram of 10^7 samples": SYSTEM
    + "sweep: {b: {start: 1, stop: 7, num: 10000}}\norbit: {transient: 0, record: 1000}\nobserve: [section]\n",
}
PLANE = SYSTEM + (
    "sweep: {omega: {start: 0.5, stop: 0.8, num: NUM}, b: {start: 5, stop: 7, num: NUM}}\n"
    "start: {random: 16, seed: 1}\n"
    "orbit: {transient: 3400, record: 506}\nobserve: [lyapunov, impacts]\n"
)
LARGE, STARTS, PERIODS = 4000**2, 16, 3906  # of the plane that PLANE has a part of
POINTS = (1000, 10_000, 100_000)  # of sweeps whose memory is measured
TRANSIENT, LONG = 40_000, 2000  # of the sweep for two workers, whose file is small
SECONDS = """
import sys, time, vibro_sweep as vs
few, many, output, workers = sys.argv[1:]
vs.run(vs.load_scene(few), output, mode="overwrite", workers=int(workers))
began = time.perf_counter()
vs.run(vs.load_scene(many), output, mode="overwrite", workers=int(workers))
print(time.perf_counter() - began)
"""
PEAK = """
import sys, vibro_sweep as vs
vs.run(vs.load_scene(sys.argv[1]), sys.argv[2], mode="overwrite", workers=1)
print(next(line.split()[1] for line in open("/proc/self/status") if line.startswith("VmHWM")))
"""


@cache
def folder() -> tempfile.TemporaryDirectory:
    return tempfile.TemporaryDirectory(prefix="vibro_sweep_scaling_")


def written(name: str, text: str) -> Path:
    path = Path(folder().name, name.replace(" ", "_").replace("^", "") + ".yaml")
    path.write_text(text)
    return path


def everything(points: int, transient: int) -> str:
    """A sweep with everything observed."""
    return (
        f"{SYSTEM}sweep: {{b: {{start: 6.5, stop: 6.9, num: {points}}}}}\n"
        f"orbit: {{transient: {transient}, record: 50}}\nobserve: [section, lyapunov, impacts]\n"
    )


def run(scene: Path, workers: int = 1):
    return program("run", scene, "-o", scene.with_suffix(".h5"), "--overwrite", "--quiet", "--workers", workers)


def file_row(name: str, command: str):
    """A maker: CPU seconds of a command about a file, start of the program included."""

    def make():
        scene = written(name, FILES[name])
        file, picture = scene.with_suffix(".h5"), scene.with_suffix(".png")
        if command == "run" or not file.exists():
            run(scene)
        jobs = {
            "run": lambda: run(scene),
            "plot": lambda: program("plot", file, "-o", picture, "--overwrite"),
            "info": lambda: program("info", file),
        }
        return lambda: jobs[command]().seconds

    return make


def writing_row():
    """A maker: what it takes to put a sample of four numbers into a file, on all threads."""
    system, path = problem.paper(6.8), Path(folder().name, "written.h5")
    axes = {"b": {"start": 6.8, "stop": 6.81, "num": 4000}}  # swings freely: there is little to compute

    def job(observe):
        vs.sweep(system, axes, transient=0, record=500, observe=observe, workers=1, output=path, mode="overwrite")

    job(["section"])
    return lambda: 1e9 * (spent(lambda: job(["section"])) - spent(lambda: job(["impacts"]))) / 4000 / 500


def memory_row(points: int):
    """A maker: megabytes that a run has in memory at most."""

    def sample():
        scene = written(f"memory {points}", everything(points, 50))
        return float(child("-c", PEAK, scene, scene.with_suffix(".h5")).printed) / 1024

    return lambda: sample


ROWS = {f"`{command}` of {name}: s": file_row(name, command) for name in FILES for command in ("run", "plot", "info")}
ROWS |= {"writing a section point: ns": writing_row}
ROWS |= {f"memory of a run of {points} points: MB": memory_row(points) for points in POINTS}


def growth(job, sizes) -> dict:
    """CPU seconds by size, less those of almost nothing; and the exponent of the growth at the end."""
    fixed = least(partial(job, 1), 2)
    seconds = [max(least(partial(job, n), 2) - fixed, 1e-6) for n in sizes]
    last = float(np.log(seconds[-1] / seconds[-2]) / np.log(sizes[-1] / sizes[-2]))
    return {"sizes": list(sizes), "seconds": seconds, "exponent": last}


def over_periods(b: float):
    """Periods of the transient of eight orbits."""
    axes = {"x1": np.linspace(-0.4, 0.4, 8)}
    return lambda n: vs.sweep(problem.paper(b), axes, transient=n, record=1, observe=["impacts"], workers=1)


def over_points(b: float):
    """Points of a sweep near b, 100 periods each."""

    def job(n):
        axes = {"b": {"start": b, "stop": b + 0.01, "num": n}} if n > 1 else {"b": [b]}
        vs.sweep(problem.paper(b), axes, transient=0, record=100, observe=["impacts"], workers=1)

    return job


def together(*workers: int) -> float:
    """Seconds of a run with so many workers, in as many processes at the same time; the longest."""
    scenes = [str(written(name, everything(points, TRANSIENT))) for name, points in (("few", 16), ("many", LONG))]
    jobs = [[*scenes, str(Path(folder().name, f"{n}.h5")), str(count)] for n, count in enumerate(workers)]
    processes = [subprocess.Popen([sys.executable, "-c", SECONDS, *job], stdout=subprocess.PIPE) for job in jobs]
    return max(float(process.communicate()[0]) for process in processes)


def workers(rounds: int) -> dict[str, float]:
    """Work done, as a multiple of one worker in one process."""
    jobs = {
        "one": lambda: together(1),
        "two workers": lambda: together(2),
        "two processes": lambda: together(1, 1) / 2,
    }
    taken = {name: [] for name in jobs}
    for _ in range(rounds):
        for name, job in jobs.items():
            taken[name].append(job())
    medians = {name: statistics.median(times) for name, times in taken.items()}
    return {"seconds": medians["one"]} | {name: medians["one"] / medians[name] for name in medians if name != "one"}


def plane() -> float:
    """Core hours of a plane of 4000 x 4000 points with 16 starts each, from the CPU time that 40 x 40 of its points
    take more than 20 x 20."""
    few, many = (written(f"plane of {num}", PLANE.replace("NUM", str(num))) for num in (20, 40))
    run(few)  # compiles
    return (run(many).seconds - run(few).seconds) * LARGE / (40**2 - 20**2) / 3600


def measure(quick: bool) -> dict:
    few = 1 if quick else 2
    clearances, curves = problem.PERIODIC[1:2] if quick else problem.PERIODIC, {}
    for what, job, decades in (
        ("periods", over_periods, range(4, 5 + few)),
        ("points, 100 periods each", over_points, range(2, 4 + few)),
    ):
        curves[what] = {f"{b:g}": growth(job(b), [10**n for n in decades]) for b in clearances}
    return {
        "curves": curves,
        "rows": measured(dict(list(ROWS.items())[:: 4 if quick else 1]), 1 if quick else 2),
        "workers": workers(1 if quick else 2),
        "core hours of the plane": plane(),
    }


def text(data: dict) -> str:
    clearances = list(data["curves"]["periods"])
    curves = [
        (what, *(f"{curve[b]['sizes'][-2]:.0e} .. {curve[b]['sizes'][-1]:.0e}" for b in clearances[:1]),
         *(f"{curve[b]['exponent']:.2f}" for b in clearances))
        for what, curve in data["curves"].items()
    ]  # fmt: skip
    found = data["workers"]
    done = ", ".join(f"{name} {value:.2f} times" for name, value in found.items() if name != "seconds")
    return (
        table(("exponent of the cost over", "between", *(f"b = {b}" for b in clearances)), curves)
        + "\n"
        + figures(data["rows"])
        + f"\nWork done beside one worker, of a sweep of {found['seconds']:.1f} s: {done}.\n\n"
        f"A plane of 4000 x 4000 points with {STARTS} starts each, {LARGE * STARTS * PERIODS:.0e} forcing periods with "
        f"exponents: {digits(data['core hours of the plane'], 2)} core hours, from 1600 of its points.\n"
    )


if __name__ == "__main__":
    os.environ.setdefault("PYTHONWARNINGS", "ignore")
    main(ROWS, measure, text)
