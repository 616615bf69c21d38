"""What is done to a good file, one table: damage, which its checksums see, and edits, which leave all of them right.

Each change says what a command may then read that does not refuse the file: what it reads of the whole one, no number
but those that were written, or anything.
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
SAME, WRITTEN, ANY = "the same result", "no number that was not written", "any result"
LONG = "a long text " * 500


class Case(NamedTuple):
    """A change of a file; of a part of one dataset, which a message then has to name."""

    kind: str
    change: Change
    may_give: str = SAME
    dataset: str = ""


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


def chunk_of(path: Path, name: str, index: int = 0) -> tuple[int, int]:
    """Where a chunk of a dataset begins in the file, and how long it is there."""
    with h5py.File(path) as file:
        place = file[name].id.get_chunk_info(index)
    return place.byte_offset, place.size


def bit_in_chunk(name: str) -> Change:
    def change(path: Path, rng: np.random.Generator) -> None:
        begin, size = chunk_of(path, name)
        flip(path, begin + int(rng.integers(size)), int(rng.integers(8)))

    return change


def zeros_in(path: Path, name: str) -> int:
    """Where in the file four bytes of a dataset's first chunk are zeros; -1 if there are none."""
    begin, size = chunk_of(path, name)
    return path.read_bytes().find(bytes(4), begin, begin + size)


def zeros_to_ones(name: str) -> Change:
    """In a chunk, two bytes at a time, as a worn-out disk may give them: Fletcher-32 alone does not see it."""

    def change(path: Path, rng: np.random.Generator) -> None:
        overwrite(path, zeros_in(path, name), lambda _: b"\xff" * 4, 4)

    return change


def chunked(path: Path) -> list[str]:
    with h5py.File(path) as file:
        return [name for name, dataset in file.items() if dataset.chunks and dataset.id.get_num_chunks()]


def damages(path: Path, sample: int) -> Iterator[Case]:
    for share in np.linspace(0, 0.999, sample + 2):
        yield Case("cut off", cut_off(float(share)))
    for name in chunked(path) if path.suffix == ".h5" else ():
        yield Case("a bit of a chunk", bit_in_chunk(name), dataset=name)
        if zeros_in(path, name) >= 0:
            yield Case("zeros of a chunk that become ones", zeros_to_ones(name))
    for _ in range(sample):
        yield Case("a byte of the header", byte_of_the_header)
        yield Case("a bit anywhere", bit_anywhere)
        yield Case("bytes overwritten", bytes_overwritten)


# Edits of files of HDF5


def edited(edit: Edit) -> Change:
    def change(path: Path, rng: np.random.Generator) -> None:
        with h5py.File(path, "a") as file:
            edit(file)

    return change


def set_text(name: str, value: str | list[str]) -> Edit:
    """An attribute that is a text, or a list of them, of fixed length, as the program writes it."""
    raw = np.char.encode(value, "utf-8")
    kind = h5py.string_dtype("utf-8", max(2, raw.dtype.itemsize))
    return lambda file: file.attrs.create(name, raw if raw.ndim else raw[()], dtype=kind)


LINKS = ["external storage", "external link", "soft link", "looping link", "virtual dataset"]


def elsewhere(file: h5py.File, name: str, how: str) -> None:
    """Replace a dataset by one whose numbers are in another place: one of LINKS."""
    shape, dtype = file[name].shape, file[name].dtype
    scales = [] if file[name].is_scale else [dimension[0] for dimension in file[name].dims]
    other = next(key for key in sorted(file, reverse=True) if key != name)
    del file[name]
    if "link" in how:
        links = {"external link": h5py.ExternalLink("other.h5", name), "soft link": h5py.SoftLink(f"/{other}")}
        file[name] = links.get(how) or h5py.SoftLink(f"/{name}")
        return
    if how == "external storage":
        file.create_dataset(name, shape, dtype, external=[("victim", 0, h5py.h5f.UNLIMITED)])
    else:
        layout = h5py.VirtualLayout(shape, dtype)
        layout[...] = h5py.VirtualSource("other.h5", name, shape)
        file.create_virtual_dataset(name, layout)
    for dimension, scale in zip(file[name].dims, scales, strict=False):
        dimension.attach_scale(scale)


def reshaped(file: h5py.File, name: str) -> None:
    del file[name]
    file[name] = np.zeros((3, 2))


def filled(file: h5py.File, name: str, value: float) -> None:
    dataset = file[name]
    limit = np.iinfo(dataset.dtype) if dataset.dtype.kind == "i" else None
    dataset[...] = value if limit is None else max(limit.min, min(limit.max, value))


def random_edits(seed: int) -> Edit:
    """Remove, rename or replace something, as h5py lets anybody do."""

    def edit(file: h5py.File) -> None:
        rng = np.random.default_rng(seed)
        for _ in range(int(rng.integers(1, 4))):
            name, attribute = str(rng.choice(sorted(file))), str(rng.choice(sorted(file.attrs)))
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

    return edit


def edits_of_hdf5(path: Path) -> Iterator[tuple[str, Edit, str]]:
    """(kind, edit, what may be read)."""
    with h5py.File(path) as file:
        names, attributes = sorted(file), sorted(file.attrs)
        of_datasets = [(name, key) for name in names for key in sorted(file[name].attrs)]
        numbers = {name: data.dtype.kind for name, data in file.items() if data.dtype.kind in "if" and data.size}
    for name in names:
        yield "a dataset removed", lambda file, name=name: file.pop(name), ANY
        yield "a dataset of another shape", lambda file, name=name: reshaped(file, name), ANY
        for how in LINKS:
            yield how, lambda file, name=name, how=how: elsewhere(file, name, how), WRITTEN
    for name in attributes:
        yield "an attribute removed", lambda file, name=name: file.attrs.pop(name), ANY
        for kind, value in {"numbers": [1.5, np.nan], "text": "no such thing", "long text": LONG}.items():
            change = lambda file, name=name, value=value: file.attrs.create(name, value)  # noqa: E731
            yield f"an attribute of {kind}", change, ANY
    for name, key in of_datasets:
        yield "an attribute of a dataset", lambda file, name=name, key=key: file[name].attrs.pop(key), ANY
        value = "no such thing" if len(key) % 2 else [1.5, np.nan]
        change = lambda file, name=name, key=key, value=value: file[name].attrs.create(key, value)  # noqa: E731
        yield "an attribute of a dataset", change, ANY
    for name, kind in numbers.items():
        for value in (-1, 0, 10**6, 127) if kind == "i" else (np.nan, np.inf, -1e30, 0.0):
            yield "values edited", lambda file, name=name, value=value: filled(file, name, value), ANY
    for seed in range(22):
        yield "random edits", random_edits(seed), ANY


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
    if path.suffix == ".json":
        return [Case(*row) for row in edits_of_orbit(path)]
    return [Case(kind, edited(edit), may_give) for kind, edit, may_give in edits_of_hdf5(path)]
