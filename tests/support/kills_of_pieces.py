"""Runs of windows, branches and curves killed at random moments, resumed, and compared with one that was left alone.

The command line runs as a process of its own, with one worker, two, or the two of a Dask cluster. It gets SIGKILL a
moment after some number of pieces has been kept, both drawn at random, once or twice, and is then resumed to its end. A
log says which pieces were kept: none of them may be computed again.
"""

import signal
import subprocess
import sys
import time
from pathlib import Path
from typing import NamedTuple

import h5py
import numpy as np

import vibro_sweep as vs
from support.kills import LIMIT, Dask, Threads, ended, ignore_interrupts
from support.windows import SYSTEM

SWEEP = {"b": np.linspace(5.4, 6.2, 41)}
BRANCHES = """
system: {{mu_m: 10, mu_k: 5, zeta: 0.05, f2: 0, omega: 0.63, R: 0.8, b: 6}}
continue:
  from: {{sweep: {sweep}}}
  along: {{b: {{start: 5.4, stop: 6.2}}}}
  depth: 1
"""
CURVES = """
system: {{mu_m: 10, mu_k: 5, zeta: 0.05, f2: 0, omega: 0.63, R: 0.8, b: 6}}
continue:
  from: {{sweep: {sweep}, largest: 4}}
  along:
    b: {{start: 5.4, stop: 6.2}}
    omega: {{start: 0.629, stop: 0.631}}
  depth: 1
"""
SCENES = {"branches": BRANCHES, "curves": CURVES}
WHAT = ("windows", *SCENES)

# The program, with a line in a log for each piece that is kept.
PROGRAM = """
import os, sys
from vibro_sweep.__main__ import program
from vibro_sweep.store.pieces import Pieces
log = os.open(sys.argv[1], os.O_WRONLY | os.O_APPEND | os.O_CREAT)
plain = Pieces.write
def logged(self, key, arrays):
    plain(self, key, arrays)
    os.write(log, f"{key}\\n".encode())
Pieces.write = logged
sys.argv[:2] = ["vibro-sweep"]
program()
"""


class Killed(NamedTuple):
    """Of one run: how often it was killed, and how many pieces it had kept by then, of how many."""

    kills: int
    kept: int
    pieces: int


def sweep_of(folder: Path) -> Path:
    """A sweep with some twenty windows."""
    vs.sweep(SYSTEM, SWEEP, transient=1000, record=100, observe=["section"], output=folder / "s.h5", workers=1).close()
    return folder / "s.h5"


def command_of(what: str, folder: Path, sweep: Path) -> list[str]:
    if what == "windows":
        return ["windows", str(sweep)]
    scene = folder / "scene.yaml"
    scene.write_text(SCENES[what].format(sweep=sweep))
    return ["run", str(scene)]


def start(log: Path, command: list[str], output: Path, workers) -> subprocess.Popen:
    words = [sys.executable, "-c", PROGRAM, str(log), *command, "-o", str(output), *workers.options]
    words += ["--resume", "--quiet"]
    return subprocess.Popen(words, stderr=subprocess.PIPE, text=True, preexec_fn=ignore_interrupts)


def children(process: subprocess.Popen) -> list[int]:
    """Processes that it has started, by their numbers."""
    told = Path(f"/proc/{process.pid}/task/{process.pid}/children")
    return list(map(int, told.read_text().split())) if told.exists() else []


def alive(number: int) -> bool:
    """Whether there is such a process, and it has not ended."""
    try:
        return Path(f"/proc/{number}/stat").read_text().rpartition(")")[2].split()[0] != "Z"
    except FileNotFoundError:
        return False


def kill(process: subprocess.Popen) -> None:
    """By SIGKILL; the processes that it has started end as well."""
    own = children(process)
    process.send_signal(signal.SIGKILL)
    process.communicate(timeout=LIMIT)
    limit = time.monotonic() + 20
    while left := [number for number in own if alive(number)]:
        if time.monotonic() > limit:
            raise SystemExit(f"processes {left} outlived their killed parent")
        time.sleep(0.05)


def killed(folder: Path, command: list[str], workers, moments: list[tuple[int, float]]) -> tuple[Killed, Path]:
    """One run killed at each of the moments (pieces, seconds after the last of them), and resumed to its end."""
    folder.mkdir()
    output, log, kills = folder / "out.h5", folder.parent / f"{folder.name}.log", 0
    for pieces, seconds in moments:
        process = start(log, command, output, workers)
        while len(lines(log)) < pieces and process.poll() is None:
            time.sleep(0.002)
        time.sleep(seconds)
        if process.poll() is None:
            kill(process)
            kills += 1
        else:
            ended(process, "none", output)
    kept = lines(log)
    workers.mend()
    ended(start(log, command, output, workers), "resumed", output)
    if left := [path.name for path in folder.iterdir() if path != output]:
        raise SystemExit(f"a run killed after {moments} left {left}")
    done = lines(log)
    if again := sorted({piece for piece in done if done.count(piece) > 1}):
        raise SystemExit(f"after {moments} kept pieces were computed again: {again}")
    return Killed(kills, len(kept), len(done)), output


def lines(log: Path) -> list[str]:
    return log.read_text().splitlines() if log.exists() else []


def contents(path: Path) -> dict:
    """All numbers and attributes, bit for bit; not when, and by how many workers, they were made."""
    with h5py.File(path) as file:
        found = {name: dataset[()].tobytes() for name, dataset in file.items()}
        attributes = {name: np.asarray(value).tolist() for name, value in file.attrs.items()}
    for name in ("identity", "history", "provenance", "heap"):
        del attributes[name]
    return found | {"attributes": attributes}


def measure(folder: Path, what: str, by: str, count: int, seed: int) -> tuple[list[Killed], bool]:
    """`count` runs, killed once or twice by turns: what became of them, and whether all contents are the same."""
    rng, found, same = np.random.default_rng(seed), [], True
    sweep = sweep_of(folder)
    command = command_of(what, folder, sweep)
    with Dask() if by == "Dask" else Threads(by) as workers:
        (folder / "whole").mkdir()
        log, whole = folder / "whole.log", folder / "whole" / "out.h5"
        ended(start(log, command, whole, workers), "whole", whole)
        expected, pieces = contents(whole), len(lines(log))
        for k in range(count):
            after = np.sort(rng.integers(0, pieces, size=1 + k % 2)).tolist()
            one, output = killed(folder / str(k), command, workers, [(n, rng.uniform(0, 0.1)) for n in after])
            same &= contents(output) == expected
            found.append(one)
    return found, same
