"""The commands and functions that read a file of each kind, and what they said and read of it."""

import hashlib
import io
import re
from collections.abc import Callable
from pathlib import Path
from typing import NamedTuple

import numpy as np

import vibro_sweep as vs
from support.kinds_of_files import KINDS, PERIODIC, RAGGED, SYSTEM, write_scenes
from support.programs import ended

READ, REFUSED, DAMAGED = "read", "refused", "told damaged"
HALF = "half of a sweep"  # the file of a run that was interrupted, sweep.h5
Result = str | dict[str, np.ndarray]  # what is printed or drawn; the numbers that are read
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
RESUMING = ("run --resume", "windows --resume")
CHANGING = (*RESUMING, "--overwrite", "again")  # they may write, or touch, the file that they are given
BOX = "parameter: {b: [5.85, 6.2], omega: [0.6295, 0.6305]}"
OF_PLANE = "parameter: {b: [6.5, 6.7], omega: [0.62, 0.65]}"
SCENES = {
    "from_windows": f"{SYSTEM}continue: {{from: {{branches: windows.h5, special: 1}}, {BOX}}}",
    "of_plane": f"{SYSTEM}continue: {{from: {{sweep: plane.h5}}, {OF_PLANE}}}",
}


class Said(NamedTuple):
    """What a command has done: its outcome, the message of a refusal, and what it has printed, drawn or read."""

    outcome: str
    message: str
    result: Result = ""


def commands(name: str) -> dict[str, Callable[[str], Said]]:
    """What reads a file of a kind, by its words; each is called with the file's name, in its folder."""
    calls = {"info": lambda file: said(["info", file]), "plot": lambda file: drawn(["plot", file])}
    if name == PERIODIC:
        return calls | {"vs.load": loaded_orbit, "open": opened}
    calls["open"] = opened
    if name == HALF:
        return calls | {"run --resume": lambda file: resumed("sweep", file)}
    if name in RAGGED:
        calls["vs.load"] = loaded
    calls |= {"vs.plot": plotted, "vs.plot of the dataset": plotted_dataset}
    calls[RESUMING[KINDS[name].scene is None]] = lambda file: resumed(name, file)
    calls["again"] = lambda file: said(making(name, file))
    calls["--overwrite"] = lambda file: resumed(name, file, "--overwrite")
    for command, (source, words) in COMPUTING.items():
        if source == name:
            calls[command] = lambda file, words=words: made([*words, "-o", "made.h5", *QUIET], "made.h5")
    if name == "sweep":
        calls["plot --over"] = lambda file: drawn(["plot", "branches.h5", "--over", file])
        calls["plot --windows of it"] = lambda file: drawn(["plot", file, "--windows", "windows.h5"])
        calls["vs.windows"] = windows
    if name == "plane":
        calls["plot --over"] = lambda file: drawn(["plot", "curves.h5", "--over", file])
    if name == "windows":
        calls["plot --windows"] = lambda file: drawn(["plot", "sweep.h5", "--windows", file])
    return calls


def write_scenes_of_commands() -> None:
    """Into the current folder."""
    write_scenes(Path())
    for scene, text in SCENES.items():
        Path(f"{scene}.yaml").write_text(text)


def making(name: str, file: str) -> list[str]:
    """The words that make a file of a kind, under another name."""
    words = KINDS[name].command(name)
    words[words.index("-o") + 1] = file
    return words


def said(words: list[str]) -> Said:
    """A command of the command line. Raises AssertionError where it fails in any other way than by one message."""
    end = ended(*words)
    assert "Traceback" not in end.err and "internal error" not in end.err and end.status in (0, 1, 2), end.err
    if end.status == 2 and words[0] == "info" and "\ndamaged" in end.out and not end.err:
        return Said(DAMAGED, end.out)
    if end.status == 2:
        assert end.err.startswith("vibro-sweep: error: "), end.err
        return Said(REFUSED, end.err)
    if words[0] == "info" and ("checksums    none" in end.out or "unfinished" in end.out):
        return Said(DAMAGED, end.out)
    warnings = [line for line in end.err.splitlines(True) if not line.startswith("vibro-sweep: compil")]
    return Said(READ, "", re.sub(r"\d{4}-\d\d-\d\dT\S*", "", "".join([end.out, *warnings])))


def made(words: list[str], output: str) -> Said:
    """With what it has written, which is then removed."""
    answer, path = said(words), Path(output)
    if answer.outcome != READ:
        return answer
    result = numbers_in(path) if output.endswith(".h5") else hashlib.sha256(path.read_bytes()).hexdigest()
    path.unlink()
    return answer._replace(result=result)


def drawn(words: list[str]) -> Said:
    return made([*words, "-o", "x.png", "--dpi", "20"], "x.png")


def numbers_in(path: Path | str) -> dict[str, np.ndarray]:
    """All numbers and words that `open` reads."""
    with vs.open(path) as data:
        return {str(name): np.asarray(values) for name, values in data.variables.items()}


def resumed(name: str, file: str, option: str = "--resume") -> Said:
    answer = said([*making(name, file), option])
    return answer._replace(result=numbers_in(file)) if answer.outcome == READ else answer


def by_python(call: Callable[[], Result]) -> Said:
    try:
        return Said(READ, "", call())
    except (vs.StoreError, vs.PlotError, ValueError) as error:
        return Said(REFUSED, str(error))


def opened(file: str) -> Said:
    return by_python(lambda: numbers_in(file))


def pixels(what) -> str:
    figure, content = vs.plot(what), io.BytesIO()
    figure.savefig(content, format="png", dpi=20)
    return hashlib.sha256(content.getvalue()).hexdigest()


def plotted(file: str) -> Said:
    return by_python(lambda: pixels(file))


def plotted_dataset(file: str) -> Said:
    def draw() -> str:
        with vs.open(file) as data:
            return pixels(data)

    return by_python(draw)


def loaded(file: str) -> Said:
    """With the tables of what is loaded, and the points of branches and curves."""

    def read() -> str:
        results = vs.load(file)
        each = results if type(results) is list else [results]
        points = [one.points for one in each if hasattr(one, "points")]
        numbers = [repr(one.to_dataframe().to_dict()) for one in each]
        numbers += [repr((name, data[name].values.tobytes())) for data in points for name in data]
        return hashlib.sha256("".join(numbers).encode()).hexdigest()

    return by_python(read)


def loaded_orbit(file: str) -> Said:
    def read() -> str:
        orbit = vs.load(file)
        return repr((orbit.status, orbit.system, orbit.impacts.tobytes(), orbit.multipliers.tobytes()))

    return by_python(read)


def windows(file: str) -> Said:
    return by_python(lambda: repr(vs.windows(file)))
