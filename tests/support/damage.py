"""Files of every kind, damaged in every way, before every command that reads them: what may come out of it is little.

Damage that checksums see (a file cut off, bits turned over, bytes overwritten) must be told, or do no harm: then the
command says and draws what it does with the whole file. An edit leaves all checksums right, as who edits makes them
anew; then there may be another picture, but no traceback, no hang, and a message that names the file.
"""

import collections
import contextlib
import hashlib
import io
import re
import shutil
from collections.abc import Callable
from pathlib import Path
from typing import NamedTuple

import h5py
import numpy as np

import vibro_sweep as vs
from support.changed_files import damages, edits
from support.kinds_of_files import KINDS, write_scenes
from vibro_sweep.cli import main

HARMLESS, REFUSED, TOLD, DRAWN = "as the whole file", "refused", "told damaged", "another result"
OUTCOMES = (HARMLESS, REFUSED, TOLD, DRAWN)


class Said(NamedTuple):
    """What a command has done: its outcome, the message of a refusal, and what it has printed, drawn or read."""

    outcome: str
    message: str
    result: str


# Commands


def commands(name: str) -> dict[str, Callable[[str], Said]]:
    """What reads a file of a kind, by its words; each is called with the file's name."""
    found = {"info": lambda file: said(["info", file]), "plot": lambda file: _drawn(["plot", file])}
    found |= {"open": _opened, "vs.plot": _plotted, "vs.plot of the dataset": _plotted_dataset}
    found["run --resume" if KINDS[name].scene else "windows --resume"] = lambda file: _resumed(name, file)
    found["again"] = lambda file: said(_of(name, file))
    if name == "sweep":
        found["windows"] = lambda file: _made(["windows", file, "-o", "w.h5", "--quiet", "--workers", "1"], "w.h5")
        found["plot --over"] = lambda file: _drawn(["plot", "branches.h5", "--over", file])
        found["plot --windows of it"] = lambda file: _drawn(["plot", file, "--windows", "windows.h5"])
        found["vs.windows"] = _windows
    if name == "plane":
        found["plot --over"] = lambda file: _drawn(["plot", "curves.h5", "--over", file])
    if name == "windows":
        found["plot --windows"] = lambda file: _drawn(["plot", "sweep.h5", "--windows", file])
    if name == "branches":
        found["run of curves"] = lambda file: _made(["run", "curves.yaml", "-o", "c.h5", "--workers", "1"], "c.h5")
    return found


SLOW = ("windows", "vs.windows", "run of curves")  # they compute


def _of(name: str, file: str) -> list[str]:
    words = KINDS[name].command(name)
    words[words.index("-o") + 1] = file
    return words


def said(words: list[str]) -> Said:
    """A command of the command line. Raises AssertionError where it fails in any other way than by one message."""
    out, err = io.StringIO(), io.StringIO()
    with contextlib.redirect_stdout(out), contextlib.redirect_stderr(err):
        status = main(words)
    told, printed = err.getvalue(), out.getvalue()
    assert "Traceback" not in told and "internal error" not in told and status in (0, 1, 2), told
    if status == 2 and words[0] == "info" and "\ndamaged" in printed and not told:
        return Said(TOLD, printed, "")
    if status == 2:
        assert told.startswith("vibro-sweep: error: "), told
        return Said(REFUSED, told, "")
    return Said(HARMLESS, "", re.sub(r"\d{4}-\d\d-\d\dT\S*", "", printed))


def _drawn(words: list[str]) -> Said:
    return _made([*words, "-o", "x.png", "--dpi", "20"], "x.png")


def _made(words: list[str], output: str) -> Said:
    """With what it has written, which is then removed."""
    found, made = said(words), Path(output)
    if found.outcome != HARMLESS:
        return found
    result = contents(made) if output.endswith(".h5") else hashlib.sha256(made.read_bytes()).hexdigest()
    made.unlink()
    return found._replace(result=result)


def contents(path: Path) -> str:
    """All numbers of a file."""
    with h5py.File(path) as file:
        numbers = [name.encode() + file[name][()].tobytes() for name in sorted(file) if file[name].dtype.kind != "O"]
    return hashlib.sha256(b"".join(numbers)).hexdigest()


def _resumed(name: str, file: str) -> Said:
    found = said([*_of(name, file), "--resume"])
    return found._replace(result=contents(Path(file))) if found.outcome == HARMLESS else found


def _python(call: Callable[[], str]) -> Said:
    try:
        return Said(HARMLESS, "", call())
    except (vs.StoreError, vs.PlotError, ValueError) as error:
        return Said(REFUSED, str(error), "")


def _opened(file: str) -> Said:
    def read() -> str:
        with vs.open(file) as data:
            numbers = [name.encode() + np.asarray(data[name]).tobytes() for name in sorted(map(str, data.variables))]
        return hashlib.sha256(b"".join(numbers)).hexdigest()

    return _python(read)


def _pixels(given) -> str:
    figure, content = vs.plot(given), io.BytesIO()
    figure.savefig(content, format="png", dpi=20)
    return hashlib.sha256(content.getvalue()).hexdigest()


def _plotted(file: str) -> Said:
    return _python(lambda: _pixels(file))


def _plotted_dataset(file: str) -> Said:
    def draw() -> str:
        with vs.open(file) as data:
            return _pixels(data)

    return _python(draw)


def _windows(file: str) -> Said:
    return _python(lambda: repr(vs.windows(file)))


# The table


def table(
    folder: Path, name: str, some: int, slow: bool = False, seed: int = 1
) -> tuple[collections.Counter, list[str]]:
    """(damage, command, outcome) -> how often, of a file of this kind in the current folder; and what failed.

    some : cases of each kind of damage; of edits a sample of ten times as many. slow: with commands that compute
    """
    rng = np.random.default_rng(seed)
    counts, failures = collections.Counter(), []
    good, file = (folder / f"{name}.h5").read_bytes(), f"{name}.h5"
    write_scenes(Path())
    for other in KINDS:
        shutil.copy(folder / f"{other}.h5", f"{other}.h5")
    chosen = {key: call for key, call in commands(name).items() if slow or key not in SLOW}
    whole = {key: call(file) for key, call in chosen.items()}
    every = list(edits(Path(file)))
    picked = rng.choice(len(every), min(10 * some, len(every)), replace=False)
    cases = [(kind, change, False) for kind, change in damages(Path(file), some)]
    cases += [(*every[i], True) for i in sorted(picked)]
    for number, (kind, change, may_differ) in enumerate(cases):
        Path(file).write_bytes(good)
        change(Path(file), rng)
        changed = Path(file).read_bytes()
        for key, call in chosen.items():
            Path(file).write_bytes(changed)
            where = f"{name}, case {number}: {kind}, {key}"
            try:
                found = call(file)
            except Exception as error:
                failures.append(f"{where}: {type(error).__name__}: {error}")
                continue
            finally:
                shutil.rmtree("x.png", ignore_errors=True)
            outcome = found.outcome
            if outcome == HARMLESS and found.result != whole[key].result:
                outcome = DRAWN
                if not may_differ and changed != good:
                    failures.append(f"{where}: other numbers, and no word")
            if outcome == REFUSED and name not in found.message:
                failures.append(f"{where}: the message does not name the file: {found.message}")
            if "--resume" not in key and Path(file).read_bytes() != changed:
                failures.append(f"{where}: the file was changed")
            counts[kind, key, outcome] += 1
            for left in (f"{file}.part", "w.h5.part", "c.h5.part"):
                Path(left).unlink(missing_ok=True)
    Path(file).write_bytes(good)
    return counts, failures


def in_words(name: str, counts: collections.Counter) -> str:
    rows = [f"| {name} | command | " + " | ".join(OUTCOMES) + " |", "| --- | --- |" + " ---: |" * len(OUTCOMES)]
    for kind, key in dict.fromkeys((kind, key) for kind, key, _ in counts):
        numbers = [counts[kind, key, outcome] for outcome in OUTCOMES]
        rows.append(f"| {kind} | {key} | {' | '.join(map(str, numbers))} |")
    return "\n".join(rows)
