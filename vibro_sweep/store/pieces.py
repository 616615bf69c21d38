"""Runs whose results have sizes that are not known before: windows and branches. Pieces are kept in FILE.h5.part.

A piece is what one worker returns: arrays by name, kept under a key. The file is made of all pieces at the end.
"""

import contextlib
import time
from collections.abc import Callable, Collection, Iterator
from functools import partial
from pathlib import Path

import h5py
import numpy as np

from vibro_sweep.model.column import Column
from vibro_sweep.store import parts
from vibro_sweep.store.appending import LockedPart
from vibro_sweep.store.attributes import text
from vibro_sweep.store.beginning import Run, begun
from vibro_sweep.store.opening import StoreError, made_by
from vibro_sweep.store.parts import Scan
from vibro_sweep.store.ragged_checks import damage_of
from vibro_sweep.store.ragged_files import Subject, ragged_image
from vibro_sweep.store.writing import Complete, publish, said

Arrays = dict[str, np.ndarray]


class Pieces:
    """A run of branches or windows. Methods raise StoreError where the disk does not let them."""

    def __init__(self, part: LockedPart, path: Path, subject: Subject, known: dict[str, Arrays]):
        self._part, self._path, self._subject, self._known = part, path, subject, known
        self._began = time.perf_counter()

    def get(self, key: str, usable: Callable[[Arrays], bool]) -> Arrays | None:
        """A piece that is known already, if it is one of those that can be used."""
        found = self._known.get(key)
        return found if found is not None and usable(found) else None

    def write(self, key: str, arrays: Arrays) -> None:
        """Keep a piece: once this returns, a kill does not lose it."""
        with said(self._part):
            self._part.append(key, {name: np.asarray(values) for name, values in arrays.items()})
        self._known[key] = arrays

    def drop(self) -> None:
        """Remove the part of a run that cannot have a result."""
        with said(self._part):
            self._part.remove()

    def finish(self, provenance: dict, columns: list[Column], arrays: Arrays) -> None:
        """Give the file its name, and remove the part."""
        run_id, seconds = self._part.head.run_id, round(time.perf_counter() - self._began, 3)
        made = made_by() | provenance | {"wall_time_s": seconds}
        image = ragged_image(self._subject, run_id, made, columns, arrays)
        publish(self._part, self._path, lambda new: new.write(image))


@contextlib.contextmanager
def pieces(subject: Subject, path: Path, mode: str, inputs: Collection[Path]) -> Iterator[Pieces | Complete]:
    """A run of a subject into `path`; `mode` is "new", "resume" or "overwrite". Raises StoreError.

    inputs : files that the run reads, which it must not write
    """
    run = Run(
        partial(_check_subject, subject),
        _lacking,
        lambda run_id: ragged_image(subject, run_id, made_by(), [], {}),
        0,
        inputs,
    )
    with begun(run, path, mode) as part:
        if isinstance(part, Complete):
            yield part
            return
        head = parts.read_head(part.file)
        scan, known = Scan(part.file, head), {}
        for record in scan:
            with contextlib.suppress(ValueError):  # an empty array that is too long
                known |= {record.key: record.arrays(part.file)} if isinstance(record.key, str) else {}
        part.go_on(head, scan.end)
        yield Pieces(part, path, subject, known)


def _lacking(file: h5py.File, _path: Path) -> str:
    found = damage_of(file)
    return f"is damaged: {found}" if found else ""


def _check_subject(subject: Subject, file: h5py.File, path: Path) -> None:
    """Raise StoreError where a file or part is about something else."""
    same = "kind" in file.attrs and text(file, "kind") == subject.kind and text(file, "scene") == subject.scene
    for name, value in subject.attributes.items():
        if isinstance(value, str):
            same = same and name in file.attrs and text(file, name) == value
    if not same:
        raise StoreError(f"{path} was made from something else; name another file, or overwrite it")
