"""What is done to a file: damage, which its checksums see, and edits, which leave all of them right."""

import json
import os
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import NamedTuple

import h5py
import numpy as np

from vibro_sweep.analysis.periodic.orbit_file import checksum_of

Change = Callable[[Path, np.random.Generator], None]
LONG = "a long text " * 500


class Case(NamedTuple):
    """What is done to a file; to one dataset, where it has the name of one."""

    kind: str
    change: Change
    dataset: str = ""


def cut_off(share: float) -> Change:
    return lambda path, rng: os.truncate(path, int(share * path.stat().st_size))


def bit_in_chunk(name: str) -> Change:
    def change(path: Path, rng: np.random.Generator) -> None:
        with h5py.File(path) as file:
            where = file[name].id.get_chunk_info(0)
        _flip(path, where.byte_offset + int(rng.integers(where.size)), rng)

    return change


def bit_anywhere(path: Path, rng: np.random.Generator) -> None:
    _flip(path, int(rng.integers(path.stat().st_size)), rng)


def bit_in_header(path: Path, rng: np.random.Generator) -> None:
    _flip(path, int(rng.integers(48)), rng)


def bytes_overwritten(path: Path, rng: np.random.Generator) -> None:
    content = bytearray(path.read_bytes())
    at, length = int(rng.integers(len(content))), int(rng.integers(2, 600))
    there = len(content[at : at + length])
    content[at : at + there] = (bytes(there), b"\xff" * there, rng.bytes(there))[int(rng.integers(3))]
    path.write_bytes(content)


def _flip(path: Path, at: int, rng: np.random.Generator) -> None:
    content = bytearray(path.read_bytes())
    content[at] ^= 1 << int(rng.integers(8))
    path.write_bytes(content)


def chunked(path: Path) -> list[str]:
    with h5py.File(path) as file:
        return [name for name, one in file.items() if one.chunks and one.id.get_num_chunks()]


def damages(path: Path, some: int) -> Iterator[Case]:
    for share in np.linspace(0, 0.999, some + 2):
        yield Case("cut off", cut_off(float(share)))
    for name in chunked(path) if path.suffix == ".h5" else ():
        yield Case("a bit of a chunk", bit_in_chunk(name), name)
    for _ in range(some):
        yield Case("a bit of the first bytes", bit_in_header)
        yield Case("a bit anywhere", bit_anywhere)
        yield Case("bytes overwritten", bytes_overwritten)


# Edits


def edited(change: Callable[[h5py.File], object]) -> Change:
    def result(path: Path, rng: np.random.Generator) -> None:
        with h5py.File(path, "a") as file:
            change(file)

    return result


VALUES = (-1, 0, 10**6, 127)


def edits(path: Path) -> Iterator[Case]:
    return (Case(*one) for one in (_of_orbit(path) if path.suffix == ".json" else _of_hdf5(path)))


def _of_orbit(path: Path) -> Iterator[tuple[str, Change]]:
    """Of a periodic orbit: keys removed and replaced, its checksum made anew."""
    record = json.loads(path.read_text())
    for key in sorted(set(record) - {"checksum"}):
        yield "a key removed", _rewritten(lambda record, key=key: record.pop(key))
        for value in (LONG, [1.5, "x"], {}, None, -1e300, [[0.0]], 10**400):
            yield "a key replaced", _rewritten(lambda record, key=key, value=value: record.update({key: value}))
    for key in sorted(record["system"]):
        for value in (LONG, [1.5], -1.0):
            change = lambda record, key=key, value=value: record["system"].update({key: value})  # noqa: E731
            yield "a number of the system", _rewritten(change)


def _rewritten(change: Callable[[dict], object]) -> Change:
    def result(path: Path, rng: np.random.Generator) -> None:
        record = json.loads(path.read_text())
        change(record)
        path.write_text(json.dumps(record | {"checksum": checksum_of(record)}))

    return result


def _of_hdf5(path: Path) -> Iterator[tuple[str, Change]]:
    with h5py.File(path) as file:
        names, attributes = sorted(file), sorted(file.attrs)
        of_datasets = [(name, own) for name in names for own in sorted(file[name].attrs)]
        numbers = {name: one.dtype.kind for name, one in file.items() if one.dtype.kind in "if" and one.size}
    for name in names:
        yield "a dataset removed", edited(lambda file, name=name: file.pop(name))
        yield "a dataset of another shape", edited(lambda file, name=name: _reshaped(file, name))
    for name in attributes:
        yield "an attribute removed", edited(lambda file, name=name: file.attrs.pop(name))
        yield "an attribute of numbers", edited(lambda file, name=name: file.attrs.create(name, [1.5, np.nan]))
        yield "an attribute of text", edited(lambda file, name=name: file.attrs.create(name, "no such thing"))
        yield "an attribute of long text", edited(lambda file, name=name: file.attrs.create(name, LONG))
    for name, own in of_datasets:
        yield "an attribute of a dataset", edited(lambda file, name=name, own=own: file[name].attrs.pop(own))
        value = "no such thing" if len(own) % 2 else [1.5, np.nan]
        change = lambda file, name=name, own=own, value=value: file[name].attrs.create(own, value)  # noqa: E731
        yield "an attribute of a dataset", edited(change)
    for name, kind in numbers.items():
        for value in VALUES if kind == "i" else (np.nan, np.inf, -1e30, 0.0):
            yield "values edited", edited(lambda file, name=name, value=value: _filled(file, name, value))


def _reshaped(file: h5py.File, name: str) -> None:
    del file[name]
    file[name] = np.zeros((3, 2))


def _filled(file: h5py.File, name: str, value: float) -> None:
    one = file[name]
    limit = np.iinfo(one.dtype) if one.dtype.kind == "i" else None
    one[...] = value if limit is None else max(limit.min, min(limit.max, value))
