"""Ways to damage files and parts, or to make them up: a case changes a good file."""

import os
from collections.abc import Callable
from pathlib import Path

import h5py
import numpy as np

from support.files import EDITS, LINKS, elsewhere
from vibro_sweep.store import parts

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
