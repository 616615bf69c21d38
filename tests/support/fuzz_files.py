"""Files of every kind, changed in every way, before every command that reads them: what may come out of it is little.

A command ends in time, in a result or in one message that names the file, and its dataset where that is known. Damage
gives no other result than the whole file; an edit may, but no number from elsewhere. No reader writes, and no other
file is touched.
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

from support.changed_parts import edits_of_parts
from support.changes import ANY, LONG, SAME, WRITTEN, Case, damages, edited, edits
from support.edits_of_sweeps import EDITS
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
    opened,
    write_scenes_of_commands,
)  # fmt: skip
from support.files import TEXT, write_files
from support.kinds_of_files import KINDS, PERIODIC, RAGGED, WrittenKinds
from support.searching import Report
from support.worker import Answer, Worker

ANOTHER = "another result"
EVERYWHERE = np.array(True)
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
        Path(f"{file}.part").unlink(missing_ok=True)
    Path(file).write_bytes(good)
    return Tried(name, file, keys, whole)


def of_half(folder: Path) -> Tried:
    """The part of a run with three of four blocks, from a folder with it and the complete file."""
    shutil.copy(folder / "half.h5.part", "sweep.h5.part")
    shutil.copy(folder / "whole.h5", "other.h5")
    Path("sweep.yaml").write_text(TEXT)
    Path("victim").write_bytes(bytes(range(256)) * 20)
    complete = opened("other.h5")
    return Tried(HALF, "sweep.h5.part", list(commands(HALF)), {"open": complete, "run --resume": complete})


def edits_of(tried: Tried) -> list[Case]:
    """Those of any file of its kind; the kind "follow" is a sweep in b, too, and is no longer one after EDITS."""
    if tried.name == HALF:
        return list(edits_of_parts())
    of_sweeps = EDITS.items() if tried.name == "follow" else ()
    return edits(Path(tried.file)) + [Case(kind, edited(edit), ANY) for kind, edit in of_sweeps]


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
    """Files that a command may make or write: the output of a run, and the part of one that was refused late."""
    parts = {path.name for path in Path().glob("*.part")} - {tried.file}
    return parts | {tried.file, tried.file.removesuffix(".part")} if key in CHANGING else parts


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
        return [] if refused_whole else [f"{wrong}: {said.message}" for wrong in wrong_words(tried, case, said.message)]
    if said.outcome == DAMAGED or whole is None:
        return []
    may_give = case.may_give
    if tried.name == HALF:  # whatever is done to it, no wrong orbit is read; after damage the run ends as it should
        may_give = SAME if may_give == SAME and key in RESUMING else WRITTEN
    if may_give == SAME and not same(said.result, whole.result):
        return ["another result, and no word"]
    if may_give == WRITTEN and isinstance(said.result, dict):
        return [f"other numbers in {name}" for name in not_written(said.result, whole.result)]
    return []


def wrong_words(tried: Tried, case: Case, message: str) -> list[str]:
    """What is wrong with a message about a changed file."""
    wrong = [] if tried.file in message else ["the file is not named"]
    wrong += [] if case.dataset in message else [f"the dataset {case.dataset} is not named"]
    return wrong + (["a long text"] if LONG[:61] in message else [])


def same(one: Result, other: Result) -> bool:
    if isinstance(one, str) or isinstance(other, str):
        return one == other
    return one.keys() == other.keys() and all(bits(one[name]) == bits(other[name]) for name in one)


def not_written(found: dict[str, np.ndarray], whole: dict[str, np.ndarray]) -> list[str]:
    """Variables with another number than those of the whole file where orbits are computed; some may be missing."""
    done = found["status"] != -1 if "status" in found else EVERYWHERE
    names = found.keys() & whole.keys() - {"status"}
    return sorted(name for name in names if bits(found[name], done) != bits(whole[name], done))


def bits(values: np.ndarray, done: np.ndarray = EVERYWHERE) -> tuple:
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
        tried = of_half(files) if name == HALF else of_kind(kinds, name, worker, slow)
        every = edits_of(tried)
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
