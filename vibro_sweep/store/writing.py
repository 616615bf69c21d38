"""Writing a file: blocks are kept in its part, and at the end the part becomes the file."""

import contextlib
import errno
import json
import os
from collections.abc import Callable, Iterator
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path
from typing import BinaryIO

import h5py
import numpy as np

from vibro_sweep.model.status import NOT_COMPUTED
from vibro_sweep.store import checks, names, parts
from vibro_sweep.store.appending import ChangedError, LockedPart, RemovedError
from vibro_sweep.store.attributes import set_text, text
from vibro_sweep.store.creating import now, units
from vibro_sweep.store.done import Done
from vibro_sweep.store.image import Frame, Index
from vibro_sweep.store.opening import StoreError, made_by
from vibro_sweep.store.parts import PartError
from vibro_sweep.store.sink import Sink, changing


class Writer:
    """The file of a run. All methods raise StoreError where the disk, or another program, prevents them."""

    def __init__(self, part: LockedPart, frame: Frame, done: Done, path: Path):
        self._part, self._frame, self._done, self._path = part, frame, done, path

    def missing(self, box: tuple[slice, ...]) -> bool:
        """Whether an orbit in a box of the sweep is not computed yet."""
        return not self._done.holds(box)

    def done(self) -> int:
        """Orbits computed so far."""
        return self._done.count()

    def write(self, box: tuple[slice, ...], arrays: dict[str, np.ndarray]) -> None:
        """Keep a block: once this returns, a kill does not lose it."""
        box = self._frame.whole(box)
        data = [_bytes(np.asarray(arrays[name], dtype)) for name, (dtype, _) in self._frame.datasets.items()]
        if [len(raw) for raw in data] != list(self._frame.sizes(box).values()):
            raise ValueError(f"a block of the box {box} has arrays of other shapes")
        with said(self._part):
            self._part.append({"box": [[part.start, part.stop] for part in box]}, data)
        self._done.add(box)

    def finish(self, provenance: dict, last: Callable[[h5py.File], None]) -> dict[int, int]:
        """Make the file of the part. Returns how many orbits have which status.

        last : writes what follows from the blocks, once all of them are in the file
        """
        new = unfinished(self._path, self._part.head.run_id)
        with said(self._part):
            new.unlink(missing_ok=True)  # of a run that was killed here
            try:
                with open(new, "xb+") as file:
                    statuses = self._make(file, provenance, last)
                names.publish(new, self._path, self._part.head.replaces)
            except FileExistsError:
                raise StoreError(
                    f"{self._path} has appeared during the run and is left alone; the result is complete in "
                    f"{self._part.path}: move the other file away, then `resume` gives it its name"
                ) from None
            finally:
                new.unlink(missing_ok=True)
            self._part.remove()
        return statuses

    def _make(self, new: BinaryIO, provenance: dict, last: Callable[[h5py.File], None]) -> dict[int, int]:
        """Make the file in a thread of its own: Ctrl-C must not end HDF5 in the middle of a call."""
        index = Index(self._part.file, self._part.head, self._frame)
        if index.damaged:
            raise StoreError(f"{self._part.path} was damaged during the run; `resume` computes again what is lost")
        parts.copy_skeleton(self._part.file, self._part.head, new)
        sink = Sink(new)
        with ThreadPoolExecutor(1) as thread:
            try:
                statuses = thread.submit(self._fill, sink, index, provenance, last).result()
            except BaseException as error:
                sink.stop(error)
                raise
        new.flush()
        os.fsync(new.fileno())
        return statuses

    def _fill(self, sink: Sink, index: Index, provenance: dict, last: Callable[[h5py.File], None]) -> dict[int, int]:
        with changing(sink) as file:
            index.fill(self._part.file, file, sink)
            last(file)
            for what in (*index.notes, f"{now()} complete"):
                set_text(file, "history", f"{text(file, 'history')}\n{what}")
            set_text(file, "provenance", json.dumps(made_by() | provenance))
            return checks.statuses(file)

    def take_over(self, file: h5py.File, found: list[tuple[str, checks.Piece]]) -> None:
        """Keep what is computed, and not damaged, of a file that has its name already."""
        for box in units(file, self._frame):
            if any(name in self._frame.datasets and _meet(box, piece) for name, piece in found):
                continue
            if not np.any(file["status"][box] == NOT_COMPUTED):
                self.write(box, {name: file[name][box] for name in self._frame.datasets})
        if found:
            self.remark(f"damage found, to be computed again: {checks.summary(found)}")

    def remark(self, what: str) -> None:
        """A line for the history of the file; damage that was found before it is known."""
        with said(self._part):
            self._part.append({"note": f"{now()} {what}"}, [])


class Complete:
    """A `Writer` of a file to which nothing is to be added; `seconds` is the wall time of the run that made it."""

    def __init__(self, statuses: dict[int, int], seconds: float):
        self._statuses, self.seconds = statuses, seconds

    def missing(self, box: tuple[slice, ...]) -> bool:
        return NOT_COMPUTED in self._statuses

    def done(self) -> int:
        return sum(self._statuses.values())

    def finish(self, provenance: dict, last: Callable[[h5py.File], None]) -> dict[int, int]:
        return self._statuses


def _bytes(values: np.ndarray) -> memoryview:
    return memoryview(np.ascontiguousarray(values).reshape(-1).view(np.uint8))


def unfinished(path: Path, run_id: bytes) -> Path:
    """The path at which the file of a run grows at the end of the run, before it gets its name."""
    return path.with_name(f".vibro_sweep-{run_id.hex()}.h5")


def _meet(one: checks.Piece, other: checks.Piece) -> bool:
    """Whether two boxes have a point in common; axes that only one of them has do not count."""
    return all(a.start < b.stop and b.start < a.stop for a, b in zip(one, other, strict=False))


@contextlib.contextmanager
def said(part: LockedPart) -> Iterator[None]:
    """Faults of the disk, in words, and that nothing is lost."""
    try:
        yield
    except RemovedError:
        try:
            part.put_back()
        except OSError as error:
            raise StoreError(f"{part.path} was removed during the run, and cannot be put back: {error}") from None
        raise StoreError(
            f"{part.path} was removed during the run; it is there again, with all that was computed: `resume` "
            "continues it"
        ) from None
    except ChangedError:
        raise StoreError(
            f"{part.path} was changed by another program during the run; this one stops, and `resume` continues with "
            "what is left"
        ) from None
    except PartError as error:
        raise StoreError(f"{part.path} {error}") from None
    except OSError as error:
        kept = "what was computed until then is kept: `resume` continues it"
        reason = os.strerror(error.errno) if error.errno else str(error)
        full = error.errno in (errno.ENOSPC, errno.EDQUOT, errno.EFBIG)
        raise StoreError(f"{part.path}: {reason}; {'make room; ' if full else ''}{kept}") from None
