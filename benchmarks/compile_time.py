"""The first run on a fresh machine, with an empty cache of compiled code, and the starts after it.

A fresh Python loads a scene and computes its first point with everything observed. What the compiler does is listened
to (numba's event `numba:compile`), function by function, each without the functions that it had compiled on its way.
"""

import json
import os
import statistics
import subprocess
import sys
import tempfile
import time
from pathlib import Path

from book import HERE, Goal, digits, main, table

TITLE = "First run and later starts"
COMMAND = "python benchmarks/compile_time.py"
SCENE = HERE.parent / "configs" / "quickstart.yaml"
ASKED_COMPILE, ASKED_START = 10, 1


def start(cache: str, scene: Path = SCENE) -> dict:
    """first_point.py in a fresh Python with this cache; seconds count from the start of that Python."""
    began = time.time()
    environment = os.environ | {"NUMBA_CACHE_DIR": cache}
    command = [sys.executable, HERE / "first_point.py", scene]
    found = json.loads(subprocess.run(command, env=environment, check=True, capture_output=True, text=True).stdout)
    return {
        "loaded": found["loaded"] - began,
        "done": found["done"] - began,
        "compile": sum(found["own"].values()),
        "own": found["own"],
    }


def measure(quick: bool) -> dict:
    fresh, later = [], []
    for _ in range(1 if quick else 3):
        with tempfile.TemporaryDirectory() as cache:
            fresh.append(start(cache))
            later += [start(cache) for _ in range(2 if quick else 5)]
    return {"fresh": min(fresh, key=lambda run: run["done"]), "later": statistics.median(run["done"] for run in later)}


def text(data: dict) -> str:
    fresh = data["fresh"]
    slowest = sorted(fresh["own"].items(), key=lambda item: -item[1])
    rows = [(f"`{name}`", digits(seconds)) for name, seconds in slowest[:12]]
    rest = sum(seconds for _, seconds in slowest[12:])
    others = (f"{max(len(slowest) - 12, 0)} others", digits(rest))
    return (
        f"With an empty cache the first point is there {fresh['done']:.2f} s after Python starts: "
        f"{fresh['loaded']:.2f} s until the scene is read, {fresh['compile']:.2f} s (CPU) of compiling. Later starts: "
        f"{data['later']:.2f} s to the first point.\n\n{table(('compiled', 'seconds'), [*rows, others])}"
    )


def goals(data: dict) -> list[Goal]:
    compiled, later = data["fresh"]["compile"], data["later"]
    return [
        Goal(f"compile time below {ASKED_COMPILE} s", f"{compiled:.1f} s", ASKED_COMPILE / compiled, COMMAND),
        Goal(f"later starts: first point below {ASKED_START} s", f"{later:.2f} s", ASKED_START / later, COMMAND),
    ]


def figure(_: dict) -> None:
    """A table says it all."""


if __name__ == "__main__":
    main(__name__)
