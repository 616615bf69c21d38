"""Files and parts damaged or made up in every way: each command ends in a result or in one message, and in time.

Every command looks at a changed file in a process that is killed where it does not answer. What may come out of it is
little: `OUTCOMES`. Everything else is a failure, and so is a changed bystander, a reader that writes, and a number that
is read without complaint and is not the one that was written.
"""

import atexit
import collections
import contextlib
import functools
import io
import multiprocessing
import os
import shutil
import tempfile
import traceback
from pathlib import Path

import numpy as np

import vibro_sweep as vs
from support.files import TEXT, write_files
from support.fuzz_files import changes
from support.programs import main
from support.searching import Report

NAMES = ("whole.h5", "half.h5.part")
OUTCOMES = ("same numbers", "refused", "told damaged", "fewer points")
COMMANDS = ("info", "plot", "open", "resume")
SECONDS = 20  # for a command on a small file


def command(name: str, path: Path, whole: dict[str, np.ndarray]) -> str:
    """One of `OUTCOMES`, or what went wrong."""
    if name == "open":
        try:
            with vs.open(path) as data:
                return _compared(data, whole)
        except vs.StoreError:
            return "refused"
    target = path.with_suffix("") if path.suffix == ".part" else path
    arguments = {"resume": ["run", "scene.yaml", "-o", str(target), "--resume", "--quiet", "--workers", "1"]}
    out, err = io.StringIO(), io.StringIO()
    with contextlib.redirect_stdout(out), contextlib.redirect_stderr(err):
        status = main(arguments.get(name, [name, str(path)]))
    told = err.getvalue()
    if status == 2 and name == "info" and "\ndamaged" in out.getvalue() and not told:
        return "told damaged"
    if status == 2:
        return "refused" if told.startswith("vibro-sweep: error: ") and "Traceback" not in told else f"said {told!r}"
    if status or told:
        return f"ended with {status}, said {told!r}"
    if name == "resume":
        with vs.open(target) as data:
            return _compared(data, whole)
    return "same numbers" if "12 of 12" in out.getvalue() or name == "plot" else "fewer points"


def _compared(data, whole: dict[str, np.ndarray]) -> str:
    done = data["status"].values != -1
    for name, array in whole.items():
        if name in data.data_vars and name != "status":
            if np.asarray(data[name])[done].tobytes() != array[done].tobytes():
                return f"other numbers in {name}"
        elif name in data.coords and np.asarray(data[name]).tobytes() != array.tobytes():
            return f"other numbers in {name}"
    return "same numbers" if done.all() else "fewer points"


def _work(pipe, whole: dict[str, np.ndarray]) -> None:
    while True:
        try:
            folder, name, path = pipe.recv()
        except EOFError:
            return
        os.chdir(folder)
        try:
            pipe.send(command(name, path, whole))
        except BaseException:
            pipe.send(f"traceback: {traceback.format_exc()}")


class Worker:
    """A process that runs commands, and is replaced where it hangs or dies."""

    def __init__(self, whole: dict[str, np.ndarray]):
        self._whole = whole
        self._begin()

    def _begin(self):
        context = multiprocessing.get_context("spawn")
        self._pipe, other = context.Pipe()
        self._process = context.Process(target=_work, args=(other, self._whole), daemon=True)
        self._process.start()
        other.close()
        self("none", Path())  # it is loaded then

    def __call__(self, name: str, path: Path) -> str:
        outcome = f"hung for {SECONDS} s"
        with contextlib.suppress(OSError):
            self._pipe.send((os.getcwd(), name, path))
        try:
            if self._pipe.poll(SECONDS if name in COMMANDS else 120):
                return self._pipe.recv()
        except (EOFError, OSError):
            outcome = "killed the process"
        self.close()
        self._begin()
        return outcome

    def close(self):
        self._process.kill()
        self._process.join()


def _stamp(path: Path) -> tuple[int, ...]:
    status = path.lstat()
    return status.st_ino, status.st_size, status.st_mtime_ns


class Workshop:
    """Good files, what is in them, and a process that reads changed ones."""

    def __init__(self):
        self.folder = write_files(Path(tempfile.mkdtemp()))
        with vs.open(self.folder / "whole.h5") as data:
            whole = {name: np.asarray(data[name]) for name in data.variables}
        self.worker = Worker(whole)
        self.changes = {name: changes((self.folder / name).stat().st_size, name.endswith("part")) for name in NAMES}


@functools.cache
def workshop() -> Workshop:
    found = Workshop()
    atexit.register(found.worker.close)
    atexit.register(shutil.rmtree, found.folder)
    return found


def seeds_of(name: str, few: int) -> list[int]:
    """Seeds of so many changes of each kind, of a file of this name."""
    kinds, found = [kind for kind, _ in workshop().changes[name]], []
    for kind in dict.fromkeys(kinds):
        first, count = kinds.index(kind), kinds.count(kind)
        found += [first + k * count // few for k in range(min(few, count))]
    return [len(NAMES) * number + NAMES.index(name) for number in found]


def study(seed: int) -> Report:
    """A file and a part in turn, each changed in all ways one after the other: what each command says to it."""
    shop, name = workshop(), NAMES[seed % len(NAMES)]
    ways = shop.changes[name]
    kind, change = ways[seed // len(NAMES) % len(ways)]
    report = Report(collections.Counter(), [])
    where = f"seed {seed}, {name}, {kind}"
    with tempfile.TemporaryDirectory() as place, contextlib.chdir(place):
        path = Path(f"x{''.join(Path(name).suffixes)}")
        Path("scene.yaml").write_text(TEXT)
        Path("victim").write_bytes(bytes(range(256)) * 20)
        shutil.copy(shop.folder / "whole.h5", "other.h5")
        shutil.copy(shop.folder / name, path)
        change(path, np.random.default_rng([1, seed]))
        bystanders = {other: Path(other).read_bytes() for other in ("scene.yaml", "victim", "other.h5")}
        before = _stamp(path)
        for command in COMMANDS:
            outcome = shop.worker(command, path)
            report.counted[f"{kind}, {command}: {outcome if outcome in OUTCOMES else 'failed'}"] += 1
            if outcome not in OUTCOMES:
                report.wrong.append(f"{where}, {command}: {outcome}")
            if command != "resume" and _stamp(path) != before:
                report.wrong.append(f"{where}, {command}: the file was changed")
        if any(Path(other).read_bytes() != content for other, content in bystanders.items()):
            report.wrong.append(f"{where}: another file was changed")
    return report
