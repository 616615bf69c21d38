"""Runs of every kind of file killed at random moments, resumed, and compared with one that was left alone.

The command line runs as a process of its own, with one worker, with two, or with the two of a Dask cluster. It gets one
of `SIGNALS`, in turn, a moment after some number of blocks or pieces has been kept, both drawn at random, once or
twice; then it is resumed to its end. By Dask the scheduler, or a worker, is killed as well. No run may print a
traceback, none may leave anything but its file, or a process, and those that can answer must end with the exit status
of an interruption. A log says what was begun and what was kept: nothing that was kept may be computed again.
"""

import contextlib
import itertools
import signal
import subprocess
import sys
import tempfile
import time
from pathlib import Path
from typing import NamedTuple

import h5py
import numpy as np
import xarray

from support.clusters import Cluster
from support.kinds_of_files import COMPLIANT, KINDS, write_scenes
from support.searching import Report, new_report

ALL = KINDS | COMPLIANT
KILLED = tuple(name for name in ALL if name != "orbit")  # which is one block

# The program, with a line in a log for each block of a sweep that is begun, here or by a worker of Dask, and for each
# block or piece that is kept: that word, and how many orbits it has.
PROGRAM = """
import math, os, signal, sys
from vibro_sweep.__main__ import program
from vibro_sweep.driver import compute, sweep
from vibro_sweep.files import sweep_file
from vibro_sweep.files.pieces import Pieces
from vibro_sweep.files.sweep_file import SweepFile
log = sys.argv[1]
def write(what, size):
    file = os.open(log, os.O_WRONLY | os.O_APPEND | os.O_CREAT)
    os.write(file, f"{what} {size}\\n".encode())
    os.close(file)
plain = compute.compute
def logged(block):
    write("begun", math.prod(part.stop - part.start for part in block.box))
    return plain(block)
sweep.compute = logged
commit, keep = SweepFile.commit, Pieces.write
def committed(self):
    count = sum(statuses.size for _, statuses in self._waiting)
    commit(self)
    if count:
        write("kept", count)
def kept(self, name, arrays):
    keep(self, name, arrays)
    write("kept", 1)
SweepFile.commit, Pieces.write, sweep_file.SECONDS = committed, kept, 0.05
sys.argv[:2] = ["vibro-sweep"]
signal.signal(signal.SIGINT, signal.default_int_handler)
program()
"""

SIGNALS = ("KILL", "TERM", "HUP", "INT", "INT twice", "STOP, CONT")
OF_DASK = ("KILL the scheduler", "KILL a worker")
INTERRUPTED = 130
MORE = 6  # runs, at most
STATUS = {"KILL": -9, "TERM": -15, "HUP": -1, "INT": INTERRUPTED, "INT twice": INTERRUPTED, "KILL the scheduler": 2}
BY = {"1 worker": SIGNALS, "2 workers": SIGNALS, "Dask": SIGNALS + OF_DASK}
LIMIT = 600  # seconds after which something hangs


class Kill(NamedTuple):
    how: str
    when: str
    kept: int  # orbits of a sweep, or pieces


class Run(NamedTuple):
    """A run that was killed and resumed: of how many orbits or pieces; how many blocks of a sweep it began again."""

    kills: list[Kill]
    total: int
    again: float

    def __str__(self):
        told = "; ".join(f"{kill.how}, {kill.when}, {kill.kept} of {self.total} kept" for kill in self.kills)
        return f"{told}; {self.again:.2f} blocks begun again"


class Threads:
    """A run by threads, or by processes of its own."""

    def __init__(self, by: str):
        self.options = ["--workers", by.split()[0]]

    def __enter__(self):
        return self

    def __exit__(self, *_):
        pass

    def mend(self) -> None:
        pass


class Dask:
    """A run by a scheduler and two workers."""

    def __enter__(self):
        self._folder = self._cluster = None
        self.mend()
        return self

    def __exit__(self, *_):
        self._cluster.end()
        self._folder.cleanup()

    def mend(self) -> None:
        """Begin again where somebody was killed."""
        if self._cluster:
            if all(process.poll() is None for process in self._cluster.processes):
                return
            self.__exit__()
        self._folder = tempfile.TemporaryDirectory()
        self._cluster = Cluster(Path(self._folder.name))
        self.options = ["--scheduler", self._cluster.address]
        for _ in range(2):
            self._cluster.worker()

    def kill(self, which: int) -> None:
        self._cluster.processes[which].kill()


def start(log: Path, name: str, output: Path, workers) -> subprocess.Popen:
    words = ALL[name].command(name)[:2]
    command = [sys.executable, "-c", PROGRAM, log, *words, "-o", output, *workers.options, "--resume", "--quiet"]
    # Python, while it begins, answers Ctrl-C by a traceback
    return subprocess.Popen(command, stderr=subprocess.PIPE, text=True, preexec_fn=ignore_interrupts)


def ignore_interrupts() -> None:
    signal.signal(signal.SIGINT, signal.SIG_IGN)


def send(process: subprocess.Popen, workers, how: str, pause: float) -> None:
    """The signals of one of SIGNALS, `pause` seconds between two; or the kills of the cluster."""
    if how in OF_DASK:
        workers.kill(OF_DASK.index(how))
        return
    for name in {"INT twice": ("INT", "INT"), "STOP, CONT": ("STOP", "CONT")}.get(how, (how,)):
        process.send_signal(getattr(signal, f"SIG{name}"))
        time.sleep(pause)


def ended(process: subprocess.Popen, how: str, output: Path) -> None:
    """Wait for it; no traceback, the exit status that the signal asks for, and no process of its own left.

    Ctrl-C in Python's own shutdown, when the file is complete, ends the process by the signal: 130 to a shell, too.
    """
    own = children(process)
    told = process.communicate(timeout=LIMIT)[1]
    allowed = {0, STATUS.get(how, 0)}
    if STATUS.get(how) == INTERRUPTED and output.exists():
        allowed.add(-signal.SIGINT)
    assert "Traceback" not in told and process.returncode in allowed, f"{how}: status {process.returncode}\n{told}"
    limit = time.monotonic() + 20
    while left := [number for number in own if alive(number)]:
        assert time.monotonic() < limit, f"{how}: processes {left} outlived their parent"
        time.sleep(0.05)


def children(process: subprocess.Popen) -> list[int]:
    """Processes that it has started, by their numbers."""
    with contextlib.suppress(FileNotFoundError, ProcessLookupError):
        return list(map(int, Path(f"/proc/{process.pid}/task/{process.pid}/children").read_text().split()))
    return []


def alive(number: int) -> bool:
    """Whether there is such a process, and it has not ended."""
    try:
        return Path(f"/proc/{number}/stat").read_text().rpartition(")")[2].split()[0] != "Z"
    except (FileNotFoundError, ProcessLookupError):
        return False


def sizes(log: Path, what: str) -> list[int]:
    """Of each block or piece that was `begun` or `kept`."""
    lines = log.read_text().splitlines() if log.exists() else []
    return [int(size) for word, size in map(str.split, lines) if word == what]


def killed(name: str, log: Path, output: Path, whole: Path, workers, how: str, after: int, pause: float) -> Kill:
    """Start a run and kill it `pause` seconds after so many blocks or pieces are kept."""
    process = start(log, name, output, workers)
    looked = time.monotonic()
    while len(sizes(log, "kept")) < after and process.poll() is None:
        time.sleep(0.002)
        if time.monotonic() - looked > 0.05:
            look(output, whole)
            looked = time.monotonic()
    try:
        process.wait(pause)
        how = "none, it had ended"
    except subprocess.TimeoutExpired:
        send(process, workers, how, pause)
    ended(process, how, output)
    workers.mend()
    if Path(f"{output}.pieces").exists() or (output.exists() and computed(output)):
        when = "in mid-run"
    elif output.exists():
        when = "went on" if how in ("STOP, CONT", "KILL a worker") else "after the end"
    else:
        when = "before its file existed"
    return Kill(how, when, sum(sizes(log, "kept")))


def computed(output: Path) -> bool:
    """Whether orbits of a sweep are missing; what is not is right already now, for any program that reads."""
    with xarray.open_dataset(output) as data:
        return bool((data["status"].values == -1).any()) if data.attrs["kind"] == "sweep" else False


def look(output: Path, whole: Path) -> None:
    """What another process reads of a file that is being written: where there is a status, the right numbers."""
    if not output.exists():
        return
    with xarray.open_dataset(output) as found, xarray.open_dataset(whole) as right:
        found.load()
        done = found["status"].values >= 0 if found.attrs["kind"] == "sweep" else np.array(True)
        for name in found.data_vars:
            if name not in FOLLOWING and found[name].shape[: done.ndim] == done.shape:
                assert found[name].values[done].tobytes() == right[name].values[done].tobytes(), f"{output}: {name}"


FOLLOWING = ("attractor_id", "attractor", "share")  # known when all points are


def contents(path: Path) -> dict:
    """All numbers and attributes, bit for bit; not when, and by how many workers, they were made."""
    with h5py.File(path) as file:
        values = {name: dataset[()] for name, dataset in file.items() if isinstance(dataset, h5py.Dataset)}
        attributes = {name: np.asarray(value).tolist() for name, value in file.attrs.items()}
    for name in ("identity", "history", "provenance"):
        attributes.pop(name)
    found = {name: one.tolist() if one.dtype.kind == "O" else one.tobytes() for name, one in values.items()}
    return found | {"attributes": attributes}


def measure(place: Path, name: str, by: str, count: int, seed: int) -> list[Run]:
    """So many runs of a kind of file, killed once or twice by turns, in the folder `place`, which is the current one.

    A busy machine sends signals late: where each came after the end of its run, a few more runs are killed.

    Raises AssertionError where one of them did not end as it should, or has made another file.
    """
    rng, found = np.random.default_rng([seed, KILLED.index(name)]), []
    hows = itertools.cycle(rng.permutation(BY[by]).tolist())
    write_scenes(place, longer=True)
    with Dask() if by == "Dask" else Threads(by) as workers:
        if ALL[name].scene is None or "sweep.h5" in (place / f"{name}.yaml").read_text():
            ended(start(place / "sweep.log", "sweep", place / "sweep.h5", workers), "sweep", place)
        log, whole = place / "whole.log", place / "whole.h5"
        ended(start(log, name, whole, workers), "whole", whole)
        kept, largest = sizes(log, "kept"), max(sizes(log, "begun"), default=1)
        for k in range(count + MORE):
            if k >= count and any(0 < kill.kept < sum(kept) for run in found for kill in run.kills):
                break
            log, output, kills = place / f"{k}.log", place / str(k) / "out.h5", []
            output.parent.mkdir()
            last = len(kept) if k else max(1, len(kept) // 2)  # one of them early: on a busy machine signals come late
            for after in np.sort(rng.integers(0, last, size=1 + k % 2)).tolist():
                kills.append(killed(name, log, output, whole, workers, next(hows), after, rng.uniform(0, 0.02)))
            ended(start(log, name, output, workers), "resumed", output)
            again = max(0, sum(sizes(log, "begun")) - sum(kept)) / largest
            found.append(Run(kills, sum(kept), again))
            where = f"{name} by {by}: {found[-1]}"
            assert [path.name for path in output.parent.iterdir()] == [output.name], f"{where}: files are left"
            assert sum(sizes(log, "kept")) <= sum(kept), f"{where}: what was kept has been computed again"
            assert contents(output) == contents(whole), f"{where}: another file"
    return found


def study(seed: int) -> Report:
    """Two runs of a kind of file by threads, processes or Dask, all in turn; AssertionError as of `measure`."""
    cases = list(itertools.product(KILLED, BY))
    name, by = cases[seed % len(cases)]
    with tempfile.TemporaryDirectory() as folder, contextlib.chdir(folder):
        runs = measure(Path(folder), name, by, 2, 5 + seed // len(cases))
    report = new_report(runs=len(runs))
    report.counted.update(f"{kill.how}, {kill.when}" for run in runs for kill in run.kills)
    return report
