"""Files and parts damaged or made up in every way: each command ends in a result or in one message, and in time.

A case is a way to change a good file. Every command looks at the changed one in a process that is killed where it does
not answer. What may come out of it is little: `OUTCOMES`. Everything else is a failure, and so is a changed bystander,
a reader that writes, and a number that is read without complaint and is not the one that was written.
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
from collections.abc import Callable
from pathlib import Path

import h5py
import numpy as np

import vibro_sweep as vs
from support.files import EDITS, LINKS, TEXT, elsewhere, write_files
from support.programs import main
from support.searching import Report
from vibro_sweep.store import parts

OUTCOMES = ("same numbers", "refused", "told damaged", "fewer points")
NAMES = ("whole.h5", "half.h5.part")
COMMANDS = ("info", "plot", "open", "resume")
SECONDS = 20  # for a command on a small file

Change = Callable[[Path, np.random.Generator], None]


def truncated(at: int) -> Change:
    return lambda path, rng: os.truncate(path, at)


def flipped(path: Path, rng: np.random.Generator) -> None:
    overwrite(path, int(rng.integers(path.stat().st_size)), lambda old: bytes([old[0] ^ 1 << int(rng.integers(8))]))


def range_overwritten(path: Path, rng: np.random.Generator) -> None:
    """By zeros, by ones, or by anything."""
    length, size = int(rng.integers(2, 600)), path.stat().st_size
    with_what = (lambda n: bytes(n), lambda n: b"\xff" * n, lambda n: rng.bytes(n))[int(rng.integers(3))]
    overwrite(path, int(rng.integers(size)), lambda old: with_what(len(old)), length)


def header_byte(at: int) -> Change:
    return lambda path, rng: overwrite(path, at, lambda old: bytes([(old[0] + int(rng.integers(1, 256))) % 256]))


def overwrite(path: Path, at: int, new: Callable[[bytes], bytes], length: int = 1) -> None:
    with open(path, "r+b") as file:
        file.seek(at)
        old = file.read(length)
        file.seek(at)
        file.write(new(old))


def edited(change: Callable[[h5py.File], object]) -> Change:
    """Also the skeleton of a part, with all its checksums right."""

    def result(path: Path, rng: np.random.Generator) -> None:
        if path.suffix != ".part":
            with h5py.File(path, "a") as file:
                change(file)
            return
        with parts.open_regular(path) as file, open("skeleton.h5", "w+b") as copy:
            head = parts.read_head(file)
            parts.copy_skeleton(file, head, copy)
            file.seek(head.start + head.length)
            rest = file.read()
        with h5py.File("skeleton.h5", "a") as file:
            change(file)
        skeleton = Path("skeleton.h5").read_bytes()
        os.unlink("skeleton.h5")
        path.write_bytes(parts.new_head(skeleton, None, head.run_id).packed() + skeleton + rest)

    return result


def records(*made: tuple[dict, int]) -> Change:
    """More records at the end of a part, with their checksums right: (text, bytes of data)."""

    def result(path: Path, rng: np.random.Generator) -> None:
        with parts.open_regular(path) as file:
            run_id = parts.read_head(file).run_id
        with open(path, "ab") as file:
            for text, length in made:
                file.writelines(parts.record(run_id, text, [memoryview(rng.bytes(length))]))

    return result


def block(key, length: int) -> tuple[dict, int]:
    """A record with a key and an array of bytes."""
    return {"key": key, "arrays": [["x1", "|u1", [length]]]}, length


def grown(path: Path, rng: np.random.Generator) -> None:
    os.truncate(path, 2**40)


def random_edit(seed: int) -> Change:
    """Remove, rename or replace something, as h5py lets anybody do."""

    def change(file: h5py.File) -> None:
        rng = np.random.default_rng(seed)
        for _ in range(int(rng.integers(1, 4))):
            name = str(rng.choice(sorted(file)))
            attribute = str(rng.choice(sorted(file.attrs)))
            what = int(rng.integers(7))
            if what == 0:
                del file[name]
            elif what == 1:
                del file.attrs[attribute]
            elif what == 2:
                file.attrs.create(attribute, rng.standard_normal(int(rng.integers(1, 5))))
            elif what == 3:
                file.move(name, f"moved_{name}")
            elif what == 4:
                del file[name]
                file[name] = rng.integers(0, 9, tuple(rng.integers(0, 4, int(rng.integers(0, 3))).tolist()))
            elif what == 5 and "DIMENSION_LIST" in file[name].attrs:
                del file[name].attrs["DIMENSION_LIST"]
            else:
                file[name].attrs["units"] = rng.integers(0, 9, 3)

    return edited(change)


HOSTILE = {
    **{f"edit: {name}": edited(change) for name, change in EDITS.items()},
    **{
        f"{how}: {name}": edited(lambda file, a=name, b=how: elsewhere(file, a, b))
        for how in LINKS
        for name in ("x1", "b")
    },
    **{f"random edit {seed}": random_edit(seed) for seed in range(22)},
}
HOSTILE_PARTS = {
    "a terabyte long": grown,
    "a box that is none": records(block(3, 0), block([[0, 1], [0, 1]], 0), block([["a", None]], 0)),
    "a box outside": records(block([[11, 13]], 100), block([[-1, 1]], 100), block([[10**30, 10**31]], 0)),
    "a box too small": records(block([[3, 3]], 0), block([[5, 4]], 10)),
    "data of another length": records(block([[0, 1]], 7), block([[0, 12]], 10**6)),
    "arrays of nonsense": records(
        ({"key": [[0, 1]]}, 0),
        ({"key": [[0, 1]], "arrays": [["x1", "O", [1]]]}, 8),
        ({"key": [[0, 1]], "arrays": [["x1", "<f8", [1e999]]]}, 8),
        ({"key": [[0, 1]], "arrays": [["x1", "<f8", [-1, -1]]]}, 8),
        ({"key": [[0, 1]], "arrays": {"x1": 3}}, 8),
    ),
    "texts of anything": records(
        block({"note": 3}, 0), ({}, 9), block({"note": "a" * 10**5}, 0), ({"x": [[[[1]]]]}, 0)
    ),
    **{f"edit: {name}": edited(EDITS[name]) for name in list(EDITS)[:9]},
    **{f"{how}: x1": edited(lambda file, b=how: elsewhere(file, "x1", b)) for how in LINKS},
}


def changes(size: int, part: bool) -> list[tuple[str, Change]]:
    """(kind, change)"""
    kinds = {
        "cut off": [truncated(at) for at in range(0, size, 1000)],
        "a bit flipped": [flipped] * 300,
        "a range overwritten": [range_overwritten] * 100,
        "a byte of the header": [header_byte(at) for at in range(60)],
        "made up": list((HOSTILE_PARTS if part else HOSTILE).values()),
    }
    return [(kind, change) for kind, some in kinds.items() for change in some]


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
