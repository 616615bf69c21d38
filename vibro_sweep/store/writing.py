"""Writing a file: what is computed is kept in its part, and at the end the part becomes the file."""

import contextlib
import io
import os
import time
from collections.abc import Callable
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path
from typing import Any, BinaryIO, NamedTuple

import h5py
import numpy as np

from vibro_sweep.store import checks, names, parts
from vibro_sweep.store.appending import LockedPart, said
from vibro_sweep.store.creating import complete, now, seal
from vibro_sweep.store.image import Box, Frame, Index
from vibro_sweep.store.opening import StoreError
from vibro_sweep.store.sink import Sink, changing
from vibro_sweep.tables.outcomes import NOT_COMPUTED

Arrays = dict[str, np.ndarray]


class Complete(NamedTuple):
    """A file to which nothing is to be added: how many orbits have which status, and how long its run took."""

    statuses: dict[int, int]
    seconds: float


class Writer:
    """The run of a file of any kind: what is computed is kept in its part, which at the end becomes the file.

    A block of a sweep is kept by its box, a piece of branches, curves or windows by its name. All methods raise
    StoreError where the disk, or another program, prevents them.
    """

    def __init__(self, part: LockedPart, path: Path, frame: Frame, index: Index):
        self._part, self._path, self._frame = part, path, frame
        self._began = time.perf_counter()
        self._done = np.zeros(frame.shape, bool)
        for box, _ in index:
            self._done[box] = True
        self._pieces = {}
        for record in index.pieces:
            with contextlib.suppress(ValueError):  # an empty array that is too long
                self._pieces[record.key] = record.arrays(part.file)

    def missing(self, box: Box) -> bool:
        """Whether an orbit in a box of the sweep is not computed yet."""
        return not self._done[box].all()

    def done(self) -> int:
        """Orbits computed so far."""
        return int(self._done.sum())

    def get(self, name: str, usable: Callable[[Arrays], bool]) -> Arrays | None:
        """A piece that is known already, if it is one of those that can be used."""
        found = self._pieces.get(name)
        return found if found is not None and usable(found) else None

    def write(self, where: Box | str, arrays: Arrays) -> None:
        """Keep a block, or a piece: once this returns, a kill does not lose it."""
        if isinstance(where, str):
            self._part.append(where, {name: np.asarray(values) for name, values in arrays.items()})
            self._pieces[where] = arrays
            return
        box = self._frame.whole(where)
        found = {name: np.asarray(arrays[name], dtype) for name, (dtype, _) in self._frame.datasets.items()}
        if any(list(found[name].shape) != shape for name, _, shape in self._frame.layout(box)):
            raise ValueError(f"a block of the box {box} has arrays of other shapes")
        self._part.append([[part.start, part.stop] for part in box], found)
        self._done[box] = True

    def take_over(self, file: h5py.File, found: list[tuple[str, checks.Piece]]) -> None:
        """Keep what is computed, and not damaged, of a file that has its name already."""
        for box in self._frame.units(file):
            if any(name in self._frame.datasets and _meet(box, piece) for name, piece in found):
                continue
            if not np.any(file["status"][box] == NOT_COMPUTED):
                self.write(box, {name: file[name][box] for name in self._frame.datasets})
        if found:
            self.remark(checks.summary(found))

    def remark(self, damage: str) -> None:
        """A line for the history of the file: damage that is known, and computed again."""
        self._part.append({"note": f"{now()} damage found, to be computed again: {damage}"}, {})

    def drop(self) -> None:
        """Remove the part of a run that cannot have a result."""
        with said(self._part.path):
            self._part.remove()

    def finish(self, last: Callable[[h5py.File], None], **how: Any) -> Complete:
        """Make the file of the part, give it its name and remove the part.

        last : last(file) writes what is not in the blocks, once all of them are in the file
        how : how it was computed, for the file's provenance
        """
        seconds = round(time.perf_counter() - self._began, 3)
        new = unfinished(self._path, self._part.head.run_id)
        with said(self._part.path):
            new.unlink(missing_ok=True)  # of a run that was killed here
            try:
                with open(new, "xb+") as file:
                    statuses = self._make(file, last, how | {"wall_time_s": seconds})
                    file.flush()
                    os.fsync(file.fileno())
                names.publish(new, self._path, self._part.head.replaces)
            except FileExistsError:
                raise StoreError(
                    f"{self._path} has appeared during the run and is left alone; the result is complete in "
                    f"{self._part.path}: move the other file away, then `resume` gives it its name"
                ) from None
            finally:
                new.unlink(missing_ok=True)
            self._part.remove()
        return Complete(statuses, seconds)

    def _make(self, new: BinaryIO, last: Callable[[h5py.File], None], how: dict) -> dict[int, int]:
        """Make the file in a thread of its own: Ctrl-C must not end HDF5 in the middle of a call."""
        index = Index(self._part.file, self._part.head, self._frame)
        if index.damaged:
            raise StoreError(f"{self._part.path} was damaged during the run; `resume` computes again what is lost")
        image = new if self._frame.datasets else io.BytesIO()  # sizes that were not known before
        parts.copy_skeleton(self._part.file, self._part.head, image)
        sink = Sink(image)
        with ThreadPoolExecutor(1) as thread:
            try:
                statuses = thread.submit(self._fill, sink, index, last, how).result()
            except BaseException as error:
                sink.stop(error)
                raise
        if image is not new:
            seal(image)
            new.write(image.getvalue())
        return statuses

    def _fill(self, sink: Sink, index: Index, last: Callable[[h5py.File], None], how: dict) -> dict[int, int]:
        with changing(sink) as file:
            index.fill(self._part.file, file, sink)
            last(file)
            complete(file, how, index.notes)
            return checks.statuses(file)


def unfinished(path: Path, run_id: bytes) -> Path:
    """The path at which the file of a run grows at the end of the run, before it gets its name."""
    return path.with_name(f".vibro_sweep-{run_id.hex()}.h5")


def _meet(one: checks.Piece, other: checks.Piece) -> bool:
    """Whether two boxes have a point in common; axes that only one of them has do not count."""
    return all(a.start < b.stop and b.start < a.stop for a, b in zip(one, other, strict=False))
