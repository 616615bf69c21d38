"""Files of every kind, changed in every way, before every command that reads them: what may come out of it is little.

A command ends in time, in a result or in one message that names the file, and its dataset where that is known. Damage
gives no other result than the whole file. No reader writes, and no other file is touched.
"""

import atexit
import collections
import contextlib
import functools
import shutil
import tempfile
from collections.abc import Callable, Iterable
from pathlib import Path
from typing import NamedTuple

import numpy as np

from support.changes import LONG, SAME, Case, damages, edits
from support.file_commands import (
    CHANGING,
    DAMAGED,
    HALF,
    READ,
    REFUSED,
    RESUMING,
    SLOW,
    Result,
    commands,
    write_scenes_of_commands,
)  # fmt: skip
from support.files import TEXT, write_files
from support.kinds_of_files import KINDS, PERIODIC, RAGGED, WrittenKinds
from support.searching import Report
from support.worker import Answer, Worker

ANOTHER = "another result"
EVERY = (*KINDS, PERIODIC, HALF)
CASES = 6  # of each kind of damage, for a seed


def seconds_of(name: str, key: str) -> float:
    """How long a command may take on a small file; much longer where it continues orbits."""
    return 300 if key in SLOW or (name in RAGGED and key in RESUMING) else 20


# What is tried, and in which folder


class Tried(NamedTuple):
    """A file in the current folder, the commands that it is given to, and what they read of it while it is whole."""

    name: str
    file: str
    keys: list[str]
    whole: dict[str, Answer]


def of_kind(kinds: WrittenKinds, name: str, call: Callable[..., Answer], slow: bool) -> Tried:
    """A file of a kind, beside all that its commands need. slow: with commands that compute."""
    write_scenes_of_commands()
    for other in KINDS if name != PERIODIC else ():
        shutil.copy(kinds(other), f"{other}.h5")
    file = str(shutil.copy(kinds(name), kinds(name).name))
    shutil.copy(file, "other.h5")
    Path("victim").write_bytes(bytes(range(256)) * 20)
    good, whole = Path(file).read_bytes(), {}
    keys = [key for key in commands(name) if slow or key not in SLOW]
    for key in keys:
        Path(file).write_bytes(good)  # some commands replace it
        whole[key] = call(name, key, file, seconds=300)  # kernels are compiled
    Path(file).write_bytes(good)
    return Tried(name, file, keys, whole)


def of_half(folder: Path, call: Callable[..., Answer]) -> Tried:
    """The file of a run with three of four blocks."""
    file = Path(shutil.copy(folder / "half.h5", "sweep.h5"))
    Path("sweep.yaml").write_text(TEXT)
    good, keys = file.read_bytes(), list(commands(HALF))
    whole = {key: call(HALF, key, file.name, seconds=300) for key in keys}
    file.write_bytes(good)
    return Tried(HALF, file.name, keys, whole)


def fuzz(
    tried: Tried, cases: Iterable[Case], call: Callable[..., Answer], seed: int
) -> tuple[collections.Counter, list[str]]:
    """(change, command, outcome) -> how often; and what failed. The folder is left as it was."""
    counts, failures, file = collections.Counter(), [], Path(tried.file)
    good, there = file.read_bytes(), set(stamps())
    for number, case in enumerate(cases):
        change(file, good, case, [seed, number])
        for key in tried.keys:
            before = stamps()
            said = call(tried.name, key, tried.file, seconds=seconds_of(tried.name, key))
            touched = set(dict(before.items() ^ stamps().items()))
            wrong = judged(tried, case, key, said)
            wrong += [f"{name} was changed, made or removed" for name in sorted(touched - may_touch(tried, key))]
            failures += [f"{tried.name}, case {number}: {case.kind}, {key}: {words}" for words in wrong]
            counts[case.kind, key, outcome_of(tried, key, said)] += 1
            if tried.file in touched:
                change(file, good, case, [seed, number])
            for name in touched - there:
                Path(name).unlink(missing_ok=True)
    file.write_bytes(good)
    return counts, failures


def change(file: Path, good: bytes, case: Case, seed: list[int]) -> None:
    """Made anew, not copied: a file may be a terabyte long."""
    file.write_bytes(good)
    case.change(file, np.random.default_rng(seed))


def stamps() -> dict[str, tuple[int, ...]]:
    """All files of the current folder, as they are."""
    status = {path.name: path.lstat() for path in Path().iterdir()}
    return {name: (one.st_ino, one.st_size, one.st_mtime_ns) for name, one in status.items()}


def may_touch(tried: Tried, key: str) -> set[str]:
    """Files that a command may make or write: the output of a run, and the pieces of one that was refused late."""
    pieces = {path.name for path in Path().glob("*.pieces")}
    return pieces | {tried.file} if key in CHANGING else pieces


# What comes out of it


def outcome_of(tried: Tried, key: str, said: Answer) -> str:
    if isinstance(said, str):
        return "FAILED"
    known = tried.whole.get(key)
    return ANOTHER if said.outcome == READ and known and not same(said.result, known.result) else said.outcome


def judged(tried: Tried, case: Case, key: str, said: Answer) -> list[str]:
    """What is wrong with an answer."""
    if isinstance(said, str):
        return [said]
    whole = tried.whole.get(key)
    if said.outcome == REFUSED:
        refused_whole = whole and whole.outcome == REFUSED
        return [] if refused_whole else [f"{wrong}: {said.message}" for wrong in wrong_words(tried, said.message)]
    if said.outcome == DAMAGED or whole is None:
        return []
    return ["another result, and no word"] if case.may_give == SAME and not same(said.result, whole.result) else []


def wrong_words(tried: Tried, message: str) -> list[str]:
    """What is wrong with a message about a changed file."""
    wrong = [] if tried.file in message else ["the file is not named"]
    return wrong + (["a long text"] if LONG[:61] in message else [])


def same(one: Result, other: Result) -> bool:
    """Of numbers: bit for bit; where an orbit is not computed a file may hold anything."""
    if isinstance(one, str) or isinstance(other, str):
        return one == other
    done = other["status"] != -1 if "status" in other else np.array(True)
    return one.keys() == other.keys() and all(bits(one[name], done) == bits(other[name], done) for name in one)


def bits(values: np.ndarray, done: np.ndarray) -> tuple:
    """The numbers or words of a variable; of one along the sweep where orbits are computed."""
    if values.shape[: done.ndim] == done.shape:
        values = values[done]
    return values.dtype.kind, values.tolist() if values.dtype == object else values.tobytes()


# A search


def fuzz_kind(
    kinds: WrittenKinds, files: Path, name: str, cases: int, slow: bool, seed: int
) -> tuple[collections.Counter, list[str]]:
    """So many cases of each kind of damage to a file of a kind, and ten times as many of all edits."""
    rng, worker = np.random.default_rng(seed), Worker()
    with tempfile.TemporaryDirectory() as folder, contextlib.chdir(folder), contextlib.closing(worker):
        tried = of_half(files, worker) if name == HALF else of_kind(kinds, name, worker, slow)
        every = edits(Path(tried.file))
        chosen = sorted(rng.choice(len(every), min(10 * cases, len(every)), replace=False))
        return fuzz(tried, [*damages(Path(tried.file), cases), *(every[k] for k in chosen)], worker, seed)


@functools.cache
def good_files() -> tuple[WrittenKinds, Path]:
    """Files of all kinds, and the folder with half of a run, made once in this process."""
    folders = [Path(tempfile.mkdtemp()) for _ in range(2)]
    for folder in folders:
        atexit.register(shutil.rmtree, folder)
    return WrittenKinds(folders[0]), write_files(folders[1])


def study(seed: int) -> Report:
    """One kind of file after the other, before every command, also those that compute."""
    name = EVERY[seed % len(EVERY)]
    counts, failures = fuzz_kind(*good_files(), name, CASES, slow=True, seed=1 + seed // len(EVERY))
    report = Report(collections.Counter(), [f"seed {seed}: {words}" for words in failures])
    for (kind, _, outcome), count in counts.items():
        report.counted[f"{kind}: {outcome}"] += count
    return report
