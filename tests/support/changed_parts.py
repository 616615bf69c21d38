"""What is done to the part of a run, with all its checksums right: another skeleton, and more records at its end."""

import os
from collections.abc import Callable, Iterator
from pathlib import Path

import h5py
import numpy as np

from support.changes import ANY, LINKS, WRITTEN, Case, Change, elsewhere
from support.edits_of_sweeps import EDITS
from vibro_sweep.store import parts


def with_skeleton(edit: Callable[[h5py.File], object]) -> Change:
    def change(path: Path, rng: np.random.Generator) -> None:
        with parts.open_regular(path) as file, open("skeleton.h5", "w+b") as copy:
            head = parts.read_head(file)
            parts.copy_skeleton(file, head, copy)
            file.seek(head.start + head.length)
            rest = file.read()
        with h5py.File("skeleton.h5", "a") as file:
            edit(file)
        skeleton = Path("skeleton.h5").read_bytes()
        os.unlink("skeleton.h5")
        path.write_bytes(parts.new_head(skeleton, None, head.run_id).packed() + skeleton + rest)

    return change


def records(*made: tuple[dict, int | bytes]) -> Change:
    """More records at the end, each of a text and of data, or of so many random bytes of it."""

    def change(path: Path, rng: np.random.Generator) -> None:
        with parts.open_regular(path) as file:
            run_id = parts.read_head(file).run_id
        with open(path, "ab") as file:
            for text, data in made:
                content = rng.bytes(data) if isinstance(data, int) else data
                file.writelines(parts.record(run_id, text, [memoryview(content)]))

    return change


def block(key, length: int) -> tuple[dict, int]:
    """A record with a key and an array of bytes."""
    return {"key": key, "arrays": [["x1", "|u1", [length]]]}, length


RECORDS = {
    "a terabyte long": lambda path, rng: os.truncate(path, 2**40),
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
}


def edits_of_parts() -> Iterator[Case]:
    for kind, change in RECORDS.items():
        yield Case(kind, change, WRITTEN)
    for name, edit in EDITS.items():
        yield Case(f"skeleton with {name}", with_skeleton(edit), ANY)
    for how in LINKS:
        yield Case(how, with_skeleton(lambda file, how=how: elsewhere(file, "x1", how)), WRITTEN)
