"""Runs killed at random moments, resumed, and compared bit for bit with one that was left alone.

Each time the command line runs a scene of some seconds and gets one of `SIGNALS`, in turn, at a moment drawn uniformly
from the time that the whole run takes; then it is resumed to its end. By Dask there are two workers of one thread, and
the scheduler, or a worker, is killed as well. No run may print a traceback, none may leave anything but its file, and
those that can answer must end with the exit status of an interruption. Every block leaves a line in a log when it is
begun, so that points computed again are known: about one block of each worker at most.
"""

import contextlib
import os
import signal
import subprocess
import sys
import tempfile
import time
from pathlib import Path
from typing import NamedTuple

import h5py
import numpy as np

from support.clusters import Cluster

POINTS = 2000
SCENE = f"""
system: {{mu_m: 10, mu_k: 5, zeta: 0.05, f2: 0, omega: 0.63, R: 0.8}}
sweep: {{b: {{start: 6.5, stop: 6.9, num: {POINTS}}}}}
orbit: {{transient: 12000, record: 100}}
observe: [section, lyapunov, impacts]
"""

# The program, with a line in a log for each block that is begun, here or by a worker of Dask: its first point, its end.
PROGRAM = """
import os, signal, sys
from vibro_sweep.__main__ import program
from vibro_sweep.driver import compute
from vibro_sweep.driver import pool
log = sys.argv[1]
plain = compute.compute
def logged(block):
    file = os.open(log, os.O_WRONLY | os.O_APPEND | os.O_CREAT)
    os.write(file, f"{block.box[0].start} {block.box[0].stop}\\n".encode())
    os.close(file)
    return plain(block)
pool.compute = logged
sys.argv[:2] = ["vibro-sweep", "run"]
signal.signal(signal.SIGINT, signal.default_int_handler)
program()
"""

SIGNALS = ("KILL", "TERM", "HUP", "INT", "INT twice", "STOP, CONT")
OF_DASK = ("KILL the scheduler", "KILL a worker")
INTERRUPTED = 130
STATUS = {"KILL": -9, "TERM": -15, "HUP": -1, "INT": INTERRUPTED, "INT twice": INTERRUPTED, "KILL the scheduler": 2}
BY = {"1 worker": SIGNALS, "2 workers": SIGNALS, "Dask": SIGNALS + OF_DASK}
LIMIT = 600  # seconds after which something hangs


class Kill(NamedTuple):
    how: str
    when: str
    points: int  # computed again
    blocks: float  # the same, in the largest of the blocks


class Threads:
    """A run by threads."""

    def __init__(self, by):
        self.options = ["--workers", by.split()[0]]

    def __enter__(self):
        return self

    def __exit__(self, *_):
        pass

    def mend(self):
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

    def mend(self):
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

    def kill(self, which):
        self._cluster.processes[which].kill()


def start(log, scene, output, workers):
    command = [sys.executable, "-c", PROGRAM, log, scene, "-o", output, *workers.options, "--resume", "--quiet"]
    # Python, while it begins, answers Ctrl-C by a traceback
    return subprocess.Popen(command, stderr=subprocess.PIPE, text=True, preexec_fn=ignore_interrupts)


def ignore_interrupts():
    signal.signal(signal.SIGINT, signal.SIG_IGN)


def send(process, workers, how, pause):
    """The signals of one of SIGNALS, `pause` seconds between two; or the kills of the cluster."""
    if how in OF_DASK:
        workers.kill(OF_DASK.index(how))
        return
    for name in {"INT twice": ("INT", "INT"), "STOP, CONT": ("STOP", "CONT")}.get(how, (how,)):
        process.send_signal(getattr(signal, f"SIG{name}"))
        time.sleep(pause)


def ended(process, how, output):
    """Wait for it; no traceback, and the exit status that the signal asks for.

    Ctrl-C in Python's own shutdown, when the file is complete, ends the process by the signal: 130 to a shell, too.
    """
    told = process.communicate(timeout=LIMIT)[1]
    allowed = {0, STATUS.get(how, 0)}
    if STATUS.get(how) == INTERRUPTED and output.exists():
        allowed.add(-signal.SIGINT)
    if "Traceback" in told or process.returncode not in allowed:
        raise SystemExit(f"a run with {how} ended with the exit status {process.returncode}:\n{told}")


def killed(scene, place, workers, moment, how, pause):
    """One run killed after `moment` seconds and resumed: what was lost, and the file."""
    folder = place / "files"
    folder.mkdir(parents=True)
    output, logs = folder / "out.h5", [place / "first", place / "second"]
    process = start(logs[0], scene, output, workers)
    try:
        process.wait(moment)
        how = "none, it had ended"
    except subprocess.TimeoutExpired:
        send(process, workers, how, pause)
    ended(process, how, output)
    part = Path(f"{output}.part")
    if output.exists():
        when = "went on" if how in ("STOP, CONT", "KILL a worker") else "after the end"
    elif not part.exists():
        when = "before the part existed"
    else:
        when = "while the file was made" if any(folder.glob(".*")) else "in mid-run"
    workers.mend()
    ended(start(logs[1], scene, output, workers), "resumed", output)
    if left := [path.name for path in folder.iterdir() if path != output]:
        raise SystemExit(f"a run with {how} after {moment} s left {left}")
    sizes = [size for log in logs for size in blocks(log)]
    again = sum(sizes) - POINTS
    return Kill(how, when, again, again / max(sizes)), output


def blocks(log):
    """Points of each block that was begun."""
    lines = log.read_text().splitlines() if log.exists() else []
    return [int(end) - int(first) for first, end in map(str.split, lines)]


def arrays(path):
    with h5py.File(path) as file:
        return {name: dataset[()].tobytes() for name, dataset in file.items()}


def measure(kills, by, seed):
    """What each kill cost; seconds of the whole run; whether all arrays are the same."""
    rng, found, same = np.random.default_rng(seed), [], True
    with contextlib.ExitStack() as stack:
        folder = Path(stack.enter_context(tempfile.TemporaryDirectory()))
        workers = stack.enter_context(Dask() if by == "Dask" else Threads(by))
        scene, whole = folder / "scene.yaml", folder / "whole.h5"
        scene.write_text(SCENE)
        for _ in range(2):  # the first one compiles
            whole.unlink(missing_ok=True)
            began = time.monotonic()
            ended(start(os.devnull, scene, whole, workers), "whole", whole)
            seconds = time.monotonic() - began
        expected = arrays(whole)
        for k in range(kills):
            moment, pause = rng.uniform(0, seconds), rng.uniform(0, 0.1)
            how = BY[by][k % len(BY[by])]
            kill, output = killed(scene, folder / str(k), workers, moment, how, pause)
            same &= arrays(output) == expected
            found.append(kill)
            told = f"{kill.how}, {kill.when}, {kill.points} points again, {kill.blocks:.2f} blocks, same bits: {same}"
            print(f"{by} {k + 1} of {kills}: {told}", file=sys.stderr, flush=True)
    return found, seconds, same
