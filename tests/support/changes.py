"""What is done to a good file: damage, which its checksums see, and edits of JSON files, whose checksum is made anew.

Each change says what a command may then read that does not refuse the file: the same as of the whole one, or anything.
"""

import json
import os
import zlib
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import NamedTuple

import h5py
import numpy as np

Change = Callable[[Path, np.random.Generator], None]
Edit = Callable[[h5py.File], object]
SAME, ANY = "the same result", "any result"
LONG = "a long text " * 500


class Case(NamedTuple):
    """A change of a file."""

    kind: str
    change: Change
    may_give: str = SAME


# Damage


def overwrite(path: Path, at: int, new: Callable[[bytes], bytes], length: int = 1) -> None:
    content = bytearray(path.read_bytes())
    content[at : at + length] = new(bytes(content[at : at + length]))
    path.write_bytes(content)


def cut_off(share: float) -> Change:
    return lambda path, rng: os.truncate(path, int(share * path.stat().st_size))


def flip(path: Path, at: int, bit: int) -> None:
    overwrite(path, at, lambda old: bytes([old[0] ^ 1 << bit]))


def bit_anywhere(path: Path, rng: np.random.Generator) -> None:
    flip(path, int(rng.integers(path.stat().st_size)), int(rng.integers(8)))


def byte_of_the_header(path: Path, rng: np.random.Generator) -> None:
    overwrite(path, int(rng.integers(60)), lambda old: bytes([(old[0] + int(rng.integers(1, 256))) % 256]))


def bytes_overwritten(path: Path, rng: np.random.Generator) -> None:
    """By zeros, by ones, or by anything."""
    length, at = int(rng.integers(2, 600)), int(rng.integers(path.stat().st_size))
    fill = (lambda n: bytes(n), lambda n: b"\xff" * n, rng.bytes)[int(rng.integers(3))]
    overwrite(path, at, lambda old: fill(len(old)), length)


def place_of(path: Path, name: str) -> tuple[int, int]:
    """Where the numbers of a dataset begin in the file, and how many bytes they have."""
    with h5py.File(path) as file:
        return file[name].id.get_offset() or 0, file[name].id.get_storage_size()


def bit_in(name: str) -> Change:
    def change(path: Path, rng: np.random.Generator) -> None:
        begin, size = place_of(path, name)
        flip(path, begin + int(rng.integers(size)), int(rng.integers(8)))

    return change


def with_numbers(path: Path) -> list[str]:
    """The datasets of a file whose numbers have a place in it."""
    with h5py.File(path) as file:
        return [name for name, one in file.items() if isinstance(one, h5py.Dataset) and one.id.get_offset()]


def damages(path: Path, sample: int) -> Iterator[Case]:
    for share in np.linspace(0, 0.999, sample + 2):
        yield Case("cut off", cut_off(float(share)))
    for name in with_numbers(path) if path.suffix == ".h5" else ():
        yield Case("a bit of a dataset", bit_in(name))
    for _ in range(sample):
        yield Case("a byte of the header", byte_of_the_header)
        yield Case("a bit anywhere", bit_anywhere)
        yield Case("bytes overwritten", bytes_overwritten)


def set_text(name: str, value: str | list[str]) -> Edit:
    """An attribute that is a text, or a list of them, of fixed length, as the program writes it."""
    raw = np.char.encode(value, "utf-8")
    kind = h5py.string_dtype("utf-8", max(2, raw.dtype.itemsize))
    return lambda file: file.attrs.create(name, raw if raw.ndim else raw[()], dtype=kind)


# Edits of the file of a periodic orbit


def edits_of_orbit(path: Path) -> Iterator[tuple[str, Change, str]]:
    """Keys removed and replaced, the checksum made anew."""
    record = json.loads(path.read_text())
    for key in sorted(set(record) - {"checksum"}):
        yield "a key removed", rewritten(lambda record, key=key: record.pop(key)), ANY
        for value in (LONG, [1.5, "x"], {}, None, -1e300, [[0.0]], 10**400):
            yield "a key replaced", rewritten(lambda record, key=key, value=value: record.update({key: value})), ANY
    for key in sorted(record["system"]):
        for value in (LONG, [1.5], -1.0):
            change = lambda record, key=key, value=value: record["system"].update({key: value})  # noqa: E731
            yield "a number of the system", rewritten(change), ANY


def rewritten(change: Callable[[dict], object]) -> Change:
    def result(path: Path, rng: np.random.Generator) -> None:
        record = json.loads(path.read_text())
        change(record)
        del record["checksum"]
        record["checksum"] = f"{zlib.crc32(json.dumps(record, sort_keys=True).encode()):08x}"
        path.write_text(json.dumps(record))

    return result


def edits(path: Path) -> list[Case]:
    """Of the file of a periodic orbit; other files that somebody has edited are known by their missing seal."""
    return [Case(*row) for row in edits_of_orbit(path)] if path.suffix == ".json" else []
