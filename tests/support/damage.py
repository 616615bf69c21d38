"""Files of every kind, damaged in every way, before every command that reads them: what may come out of it is little.

Damage that checksums see (a file cut off, bits turned over, bytes overwritten) must be told, or do no harm: then the
command says and draws what it does with the whole file. An edit leaves all checksums right, as who edits makes them
anew; then there may be another picture, but no traceback, no hang, and a message that names the file.
"""

import atexit
import collections
import contextlib
import functools
import hashlib
import io
import re
import shutil
import tempfile
from collections.abc import Callable
from pathlib import Path
from typing import NamedTuple

import h5py
import numpy as np

import vibro_sweep as vs
from support.changed_files import LONG, Case, damages, edits
from support.kinds_of_files import KINDS, PERIODIC, RAGGED, SYSTEM, WrittenKinds, write_scenes
from support.programs import main
from support.searching import Report

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
    if name == PERIODIC:
        return found | {"vs.load": _loaded_orbit, "open": _opened}
    if name in RAGGED:
        found["vs.load"] = _loaded
    found |= {"open": _opened, "vs.plot": _plotted, "vs.plot of the dataset": _plotted_dataset}
    found["run --resume" if KINDS[name].scene else "windows --resume"] = lambda file: _resumed(name, file)
    found["again"] = lambda file: said(_of(name, file))
    found["--overwrite"] = lambda file: _resumed(name, file, "--overwrite")
    for command, (source, words) in COMPUTING.items():
        if source == name:
            found[command] = lambda file, words=words: _made([*words, "-o", "made.h5", *QUIET], "made.h5")
    if name == "sweep":
        found["plot --over"] = lambda file: _drawn(["plot", "branches.h5", "--over", file])
        found["plot --windows of it"] = lambda file: _drawn(["plot", file, "--windows", "windows.h5"])
        found["vs.windows"] = _windows
    if name == "plane":
        found["plot --over"] = lambda file: _drawn(["plot", "curves.h5", "--over", file])
    if name == "windows":
        found["plot --windows"] = lambda file: _drawn(["plot", "sweep.h5", "--windows", file])
    return found


QUIET = ("--workers", "1", "--quiet")
# What is computed from files: the kind of the file, and the words of the command.
COMPUTING = {
    "windows": ("sweep", ["windows", "sweep.h5"]),
    "windows of a plane": ("plane", ["windows", "plane.h5"]),
    "windows of several starts": ("follow", ["windows", "follow.h5"]),
    "run of branches": ("sweep", ["run", "branches.yaml"]),
    "run of curves": ("branches", ["run", "curves.yaml"]),
    "run of curves from windows": ("windows", ["run", "from_windows.yaml"]),
    "run of curves of a plane": ("plane", ["run", "of_plane.yaml"]),
}
SLOW = (*COMPUTING, "vs.windows", "--overwrite")  # they compute
BOX = "parameter: {b: [5.85, 6.2], omega: [0.6295, 0.6305]}"
OF_PLANE = "parameter: {b: [6.5, 6.7], omega: [0.62, 0.65]}"
SCENES = {
    "from_windows": f"{SYSTEM}continue: {{from: {{branches: windows.h5, special: 1}}, {BOX}}}",
    "of_plane": f"{SYSTEM}continue: {{from: {{sweep: plane.h5}}, {OF_PLANE}}}",
}


def write_scenes_of_commands() -> None:
    """Into the current folder."""
    write_scenes(Path())
    for scene, text in SCENES.items():
        Path(f"{scene}.yaml").write_text(text)


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


def _resumed(name: str, file: str, option: str = "--resume") -> Said:
    found = said([*_of(name, file), option])
    return found._replace(result=contents(Path(file))) if found.outcome == HARMLESS else found


def _python(call: Callable[[], str]) -> Said:
    try:
        return Said(HARMLESS, "", call())
    except (vs.StoreError, vs.PlotError, ValueError) as error:
        return Said(REFUSED, str(error), "")


def _opened(file: str) -> Said:
    def read() -> str:
        with vs.open(file) as data:
            known = {name: np.asarray(data[name]) for name in sorted(map(str, data.variables))}
        words = {name: values.astype(str) for name, values in known.items() if values.dtype == object}  # not addresses
        parts = [name.encode() + values.tobytes() for name, values in (known | words).items()]
        return hashlib.sha256(b"".join(parts)).hexdigest()

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


def _loaded(file: str) -> Said:
    """With the tables of what is loaded, and the points of branches and curves."""

    def read() -> str:
        found = vs.load(file)
        each = found if type(found) is list else [found]
        points = [one.points for one in each if hasattr(one, "points")]
        numbers = [repr(one.to_dataframe().to_dict()) for one in each]
        numbers += [repr((name, data[name].values.tobytes())) for data in points for name in data]
        return hashlib.sha256("".join(numbers).encode()).hexdigest()

    return _python(read)


def _loaded_orbit(file: str) -> Said:
    def read() -> str:
        orbit = vs.load(file)
        return repr((orbit.status, orbit.system, orbit.impacts.tobytes(), orbit.multipliers.tobytes()))

    return _python(read)


def _windows(file: str) -> Said:
    return _python(lambda: repr(vs.windows(file)))


# The table


def table(
    kinds: WrittenKinds, name: str, some: int, slow: bool = False, seed: int = 1
) -> tuple[collections.Counter, list[str]]:
    """(damage, command, outcome) -> how often, of a file of this kind in the current folder; and what failed.

    some : cases of each kind of damage; of edits a sample of ten times as many. slow: with commands that compute
    """
    rng, counts, failures = np.random.default_rng(seed), collections.Counter(), []
    write_scenes_of_commands()
    for other in KINDS if name != PERIODIC else ():
        shutil.copy(kinds(other), f"{other}.h5")
    file = str(shutil.copy(kinds(name), kinds(name).name))
    good = Path(file).read_bytes()
    chosen = {key: call for key, call in commands(name).items() if slow or key not in SLOW}
    whole = {}
    for key, call in chosen.items():
        Path(file).write_bytes(good)  # some commands replace it
        whole[key] = call(file)
    every = list(edits(Path(file)))
    picked = rng.choice(len(every), min(10 * some, len(every)), replace=False)
    cases = [(case, False) for case in damages(Path(file), some)] + [(every[i], True) for i in sorted(picked)]
    for number, (case, may_differ) in enumerate(cases):
        Path(file).write_bytes(good)
        case.change(Path(file), rng)
        changed = Path(file).read_bytes()
        for key, call in chosen.items():
            Path(file).write_bytes(changed)
            where = f"{name}, case {number}: {case.kind}, {key}"
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
            if outcome == REFUSED and whole[key].outcome != REFUSED:
                failures += [f"{where}: {wrong}: {found.message}" for wrong in _missing(found.message, file, case)]
            if key not in CHANGING and Path(file).read_bytes() != changed:
                failures.append(f"{where}: the file was changed")
            counts[case.kind, key, outcome] += 1
            for left in Path().glob("*.part"):
                left.unlink()
    Path(file).write_bytes(good)
    return counts, failures


CHANGING = ("run --resume", "windows --resume", "--overwrite")


def _missing(message: str, file: str, case: Case) -> list[str]:
    """What is wrong with a message about a damaged file."""
    wrong = [] if file in message else ["the file is not named"]
    wrong += [] if case.dataset in message else [f"the dataset {case.dataset} is not named"]
    return wrong + (["a long text"] if LONG[:61] in message else [])


EVERY = (*KINDS, PERIODIC)
CASES = 6  # of each kind of damage


@functools.cache
def good_files() -> WrittenKinds:
    folder = tempfile.mkdtemp()
    atexit.register(shutil.rmtree, folder)
    return WrittenKinds(Path(folder))


def study(seed: int) -> Report:
    """Files of one kind after the other, damaged and edited, before every command: how many had which outcome."""
    name = EVERY[seed % len(EVERY)]
    with tempfile.TemporaryDirectory() as folder, contextlib.chdir(folder):
        counts, failures = table(good_files(), name, CASES, slow=True, seed=1 + seed // len(EVERY))
    report = Report(collections.Counter(), failures)
    for (kind, _, outcome), count in counts.items():
        report.counted[f"{kind}: {outcome}"] += count
    return report
