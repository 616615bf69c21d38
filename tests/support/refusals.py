"""What the program answers to a row of tests/cases/messages.yaml, and what is wrong with the answer.

A row has an input:
    scene: a text, perhaps with `change` (old text: new text), `add` (lines at the end), the `commands` that read it; or
    command: a command line, in which {x5000} stands for 5000 times x; with a `scene` its result is there, sweep.h5; or
    call: a Python expression, with names of `given` (name: expression), and the `files` that it writes itself.
And it has the answer:
    status: the exit status; or of a call `raises`, the public types of the exception; and
    message: the whole message; only where that is not the same everywhere `has`, parts of it.
"""

import functools
import json
import math
import shlex
import tempfile
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np
import xarray as xr
from matplotlib.figure import Figure

import vibro_sweep as vs

from .programs import ended

PREFIX = "vibro-sweep: error: "
SCENE = "scene.yaml"
COMMANDS = ("run", "check", "grazing")  # that read it
FILES = {  # in the folder of every command line
    "good.yaml": b"""
system: {mu_m: 10, mu_k: 5, zeta: 0.05, f2: 0, omega: 0.63, R: 0.8, b: 6.6}
orbit: {transient: 2, record: 3}
sweep: {b: {values: [6.5, 6.6, 6.7]}}
""",
    "binary.yaml": b"system: \xff\xfe",
    "data.h5": b"\x89HDF\r\n\x1a\n",
    "old.h5": b"years of work",
    "half.h5.pieces": b"hours of work",
}
LONG = {"x5000": "x" * 5000, "x252": "x" * 252, "nines": "9" * 5000}
NAMES = {"vs": vs, "np": np, "xr": xr, "math": math, "json": json, "Path": Path, "Figure": Figure}
PUBLIC = [getattr(vs, name) for name in vs.__all__ if name.endswith("Error")]
PUBLIC += [ValueError, TypeError, RuntimeError, ImportError, LookupError, AttributeError]
PUBLIC += [OSError, FileExistsError, FileNotFoundError]


class Answer(NamedTuple):
    """The exit status, or the public types of an exception; the message, None where nothing is refused; and what no
    refusal does: print anything else, or write a file.
    """

    kind: int | str
    message: str | None
    defects: tuple[str, ...] = ()


def answer(row: dict[str, Any]) -> Answer:
    """To a row, in the current folder, which is empty."""
    if "call" in row:
        return _of_call(row)
    if "command" in row:
        return _of_command(row)
    return _of_scene(row)


def faults(row: dict[str, Any]) -> list[str]:
    """What is wrong with the answer, in words; nothing: []."""
    kind, message, defects = answer(row)
    if message is None:
        return [f"accepted: {kind}"]
    result = list(defects)
    if kind != row.get("status", row.get("raises")):
        result.append(f"ended with {kind!r}")
    if "has" in row:
        result += [f"{part!r} is not in {message!r}" for part in row["has"] if part not in message]
    elif message != row["message"]:
        result.append(f"said {message!r}")
    return result


def text_of(row: dict[str, Any]) -> str:
    """The scene of a row."""
    text = row["scene"]
    for old, new in row.get("change", {}).items():
        if text.count(old) != 1:
            raise ValueError(f"{old!r} does not stand in the scene once")
        text = text.replace(old, new)
    return text + row.get("add", "")


def _of_scene(row) -> Answer:
    """Of a command that reads a scene; each of them has its turn."""
    text, commands = text_of(row), row.get("commands", COMMANDS)
    Path(SCENE).write_text(text)
    return _of_program(commands[len(text) % len(commands)], SCENE)


def _of_command(row) -> Answer:
    for name, content in FILES.items():
        Path(name).write_bytes(content)
    if "scene" in row:
        Path("sweep.h5").write_bytes(_computed(row["scene"]))
    return _of_program(*(word.format(**LONG) for word in shlex.split(row["command"])))


@functools.cache
def _computed(scene: str) -> bytes:
    """The file of a scene."""
    with tempfile.TemporaryDirectory() as folder:
        Path(folder, SCENE).write_text(scene)
        vs.run(vs.load_scene(Path(folder, SCENE)), Path(folder, "sweep.h5"))
        return Path(folder, "sweep.h5").read_bytes()


def _of_program(*arguments: str) -> Answer:
    before = _contents()
    status, out, err = ended(*arguments)
    if status == 0:
        return Answer(0, None)
    message = err.removeprefix(PREFIX).removesuffix("\n")
    defects = [] if out == "" and err == f"{PREFIX}{message}\n" else [f"printed {out!r} and {err!r}"]
    if _contents() != before:
        defects.append("changed files")
    if "Traceback" in message or "error:" in message.lower():
        defects.append(f"no single message: {message!r}")
    return Answer(status, message, tuple(defects))


def _of_call(row) -> Answer:
    names = _names(tuple(row.get("given", {}).items()))
    try:
        result = eval(row["call"], dict(names))
    except Exception as error:
        files = sorted(path.name for path in Path().iterdir())
        defects = [] if files == row.get("files", []) else [f"left the files {files}"]
        if isinstance(error, vs.ParameterError) and not _says(error):
            defects.append(f"has the key {error.key!r} and says that it must be {error.allowed!r}")
        return Answer(", ".join(_public(type(error))), str(error), tuple(defects))
    return Answer(repr(result), None)


def _says(error: vs.ParameterError) -> bool:
    """Whether the message has what the error has."""
    return str(error).startswith(f"{error.key}: ") and error.allowed in str(error)


@functools.cache
def _names(given: tuple[tuple[str, str], ...]) -> dict[str, Any]:
    """What a call may use. An expression may have the names before it; it is evaluated once for all rows."""
    if not given:
        return NAMES
    *before, (name, text) = given
    names = dict(_names(tuple(before)))
    return names | {name: eval(text, names)}


def _public(kind: type) -> list[str]:
    """Types that a user may catch: those of which the exception has no closer one."""
    bases = [one for one in PUBLIC if issubclass(kind, one)]
    closest = [one for one in bases if not any(other is not one and issubclass(other, one) for other in bases)]
    return [one.__name__ for one in closest]


def _contents() -> dict[str, bytes]:
    return {path.name: path.read_bytes() for path in Path().iterdir() if path.is_file()}
