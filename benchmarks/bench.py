"""What the scripts share: times in turns, tables, the machine, and the command line.

A script has ROWS, the figures that versions.py compares: name -> maker. A maker sets a row up, compiles, and returns
a function that measures it once; a name ends with the unit, and less is better. Each script also has
measure(quick) -> data for --json, and text(data) -> Markdown.

Times are CPU seconds, of this process and its threads or of a child, so that a busy machine disturbs them little. Rows
that are compared are measured in turns (A B A B), and the median over the rounds counts.
"""

import argparse
import json
import os
import platform
import resource
import statistics
import subprocess
import sys
import tempfile
import time
import warnings
from collections.abc import Callable
from datetime import UTC, datetime
from functools import partial
from importlib.metadata import version
from importlib.util import find_spec
from pathlib import Path
from typing import NamedTuple

ROOT = Path(__file__).resolve().parents[1]
Sample = Callable[[], float]


def spent(job: Callable[[], object]) -> float:
    """CPU seconds of a call."""
    began = time.process_time()
    job()
    return time.process_time() - began


def least(job: Callable[[], object], rounds: int = 5) -> float:
    """CPU seconds of the fastest of some calls, after one that compiles."""
    job()
    return min(spent(job) for _ in range(rounds))


def per_unit(job: Callable[[int], object], unit_count: int, fixed: int = 1, scale: float = 1e9) -> Sample:
    """What a unit takes of job(units): the time of many less that of a few, so that what every call takes drops out."""
    job(fixed), job(unit_count)
    return lambda: scale * (spent(lambda: job(unit_count)) - spent(lambda: job(fixed))) / (unit_count - fixed)


def enough(job: Callable[[int], object], seconds: float, cycle: int = 1) -> int:
    """A number of units, a multiple of `cycle`, that takes about so many seconds."""
    job(cycle)
    count = cycle
    while (taken := spent(partial(job, count))) < 0.2 * seconds:
        count *= 4
    return cycle * max(1, round(count * seconds / taken / cycle))


def in_turns(samples: dict[str, Sample], rounds: int) -> dict[str, float]:
    """Medians over the rounds of samples that take turns."""
    taken = {name: [] for name in samples}
    for _ in range(rounds):
        for name, sample in samples.items():
            taken[name].append(sample())
    return {name: statistics.median(values) for name, values in taken.items()}


def measured(rows: dict[str, Callable[[], Sample]], rounds: int) -> dict[str, float]:
    """Medians of rows by name, each made and measured by itself."""
    return {name: statistics.median(sample() for _ in range(rounds)) for name in rows for sample in (rows[name](),)}


class Used(NamedTuple):
    """By a child process."""

    seconds: float  # CPU
    printed: str


def child(*arguments, **environment: str) -> Used:
    """A fresh Python with these arguments; not in a checkout, which it would import in place of that of PYTHONPATH."""
    command, before = [sys.executable, *map(str, arguments)], resource.getrusage(resource.RUSAGE_CHILDREN)
    place = tempfile.gettempdir()
    done = subprocess.run(command, cwd=place, env=os.environ | environment, capture_output=True, text=True)
    if done.returncode:
        raise RuntimeError(f"{arguments} ended with status {done.returncode}: {done.stderr[-500:]}")
    after = resource.getrusage(resource.RUSAGE_CHILDREN)
    return Used(after.ru_utime + after.ru_stime - before.ru_utime - before.ru_stime, done.stdout)


def program(*arguments, **environment: str) -> Used:
    """A command of vibro-sweep."""
    return child("-m", "vibro_sweep", *arguments, **environment)


def table(header, rows) -> str:
    """A Markdown table; columns after the first are aligned right."""
    rule = ["---"] + ["---:"] * (len(header) - 1)
    return "\n".join("| " + " | ".join(map(str, row)) + " |" for row in (header, rule, *rows)) + "\n"


def figures(values: dict[str, float]) -> str:
    """A table of rows whose names end with their unit."""
    return table(("", "CPU time, or memory"), [(name, digits(value)) for name, value in values.items()])


def digits(value: float, count: int = 3) -> str:
    """A number with so many significant digits."""
    return f"{float(f'{value:.{count}g}'):.10g}" if 1e-3 <= abs(value) < 1e5 or value == 0 else f"{value:.1e}"


def machine() -> str:
    """Date, machine, and versions, as Markdown."""
    try:
        lines = Path("/proc/cpuinfo").read_text().splitlines()
    except OSError:
        lines = []
    processor = next((line.split(":")[1].strip() for line in lines if "model name" in line), platform.processor())
    packages = ("numpy", "numba", "heyoka", "scipy")
    versions = ", ".join(f"{name} {version(name)}" for name in packages if find_spec(name))
    own = child("-c", "import vibro_sweep; print(vibro_sweep.__version__)").printed.strip()
    return (
        f"{datetime.now(UTC):%Y-%m-%d}; {processor}, {os.cpu_count()} cores, load {os.getloadavg()[0]:.1f}; "
        f"{platform.system()}, Python {platform.python_version()}, vibro_sweep {own}, {versions}"
    )


def main(rows: dict, measure: Callable[[bool], dict], text: Callable[[dict], str]) -> None:
    """The command line of a script."""
    parser = argparse.ArgumentParser(description=sys.modules["__main__"].__doc__.split("\n\n")[0])
    parser.add_argument("--quick", action="store_true", help="in reduced form: shows that it works")
    parser.add_argument("--json", action="store_true", help="print the figures as JSON")
    parser.add_argument("--turns", action="store_true", help="measure each row that is named on a line of the input")
    chosen = parser.parse_args()
    if chosen.turns:
        answer_turns(rows)
    else:
        data = measure(chosen.quick)
        print(json.dumps(data) if chosen.json else text(data))


def answer_turns(rows: dict) -> None:
    """For versions.py: a figure for each line; of a row that this version cannot measure, the reason."""
    import vibro_sweep

    warnings.simplefilter("ignore")
    out, sys.stdout = sys.stdout, sys.stderr
    print(json.dumps(vibro_sweep.__file__), file=out, flush=True)
    made = {}
    for line in sys.stdin:
        name = line.rstrip("\n")
        try:
            if name not in made:
                made[name] = rows[name]()
            answer = made[name]()
        except Exception as error:
            answer = f"{type(error).__name__}: {error}"
        print(json.dumps(answer), file=out, flush=True)
