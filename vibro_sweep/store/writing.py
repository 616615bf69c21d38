"""Writing a file: blocks are kept in its part, and at the end the part becomes the file."""

import contextlib
import errno
import json
import os
from collections.abc import Callable, Iterator
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path
from typing import BinaryIO, NamedTuple, TypeVar

import h5py
import numpy as np

from vibro_sweep.model.status import NOT_COMPUTED
from vibro_sweep.store import checks, names, parts
from vibro_sweep.store.appending import ChangedError, LockedPart, RemovedError
from vibro_sweep.store.attributes import set_text, text
from vibro_sweep.store.creating import now, units
from vibro_sweep.store.image import Frame, Index
from vibro_sweep.store.opening import StoreError, made_by
from vibro_sweep.store.parts import PartError
from vibro_sweep.store.sink import Sink, changing

T = TypeVar("T")


class Writer:
    """The file of a run. All methods raise StoreError where the disk, or another program, prevents them."""

    def __init__(self, part: LockedPart, frame: Frame, index: Index, path: Path):
        self._part, self._frame, self._path = part, frame, path
        self._done = np.zeros(frame.shape, bool)
        for box, _ in index:
            self._done[box] = True

    def missing(self, box: tuple[slice, ...]) -> bool:
        """Whether an orbit in a box of the sweep is not computed yet."""
        return not self._done[box].all()

    def done(self) -> int:
        """Orbits computed so far."""
        return int(self._done.sum())

    def write(self, box: tuple[slice, ...], arrays: dict[str, np.ndarray]) -> None:
        """Keep a block: once this returns, a kill does not lose it."""
        box = self._frame.whole(box)
        found = {name: np.asarray(arrays[name], dtype) for name, (dtype, _) in self._frame.datasets.items()}
        if any(list(found[name].shape) != shape for name, _, shape in self._frame.layout(box)):
            raise ValueError(f"a block of the box {box} has arrays of other shapes")
        with said(self._part):
            self._part.append([[part.start, part.stop] for part in box], found)
        self._done[box] = True

    def finish(self, provenance: dict, last: Callable[[h5py.File], None]) -> dict[int, int]:
        """Make the file of the part. Returns how many orbits have which status.

        last : writes what follows from the blocks, once all of them are in the file
        """
        return publish(self._part, self._path, lambda new: self._make(new, provenance, last))

    def _make(self, new: BinaryIO, provenance: dict, last: Callable[[h5py.File], None]) -> dict[int, int]:
        """Make the file in a thread of its own: Ctrl-C must not end HDF5 in the middle of a call."""
        index = Index(self._part.file, self._part.head, self._frame)
        if index.damaged:
            raise StoreError(f"{self._part.path} was damaged during the run; `resume` computes again what is lost")
        parts.copy_skeleton(self._part.file, self._part.head, new)
        sink = Sink(new)
        with ThreadPoolExecutor(1) as thread:
            try:
                return thread.submit(self._fill, sink, index, provenance, last).result()
            except BaseException as error:
                sink.stop(error)
                raise

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
            self._part.append({"note": f"{now()} {what}"}, {})


class Complete(NamedTuple):
    """A file to which nothing is to be added: how many orbits have which status, and how long its run took."""

    statuses: dict[int, int]
    seconds: float


def publish(part: LockedPart, path: Path, make: Callable[[BinaryIO], T]) -> T:
    """Make the file of a part, give it its name and remove the part. Raises StoreError. Returns what `make` returns."""
    new = unfinished(path, part.head.run_id)
    with said(part):
        new.unlink(missing_ok=True)  # of a run that was killed here
        try:
            with open(new, "xb+") as file:
                result = make(file)
                file.flush()
                os.fsync(file.fileno())
            names.publish(new, path, part.head.replaces)
        except FileExistsError:
            raise StoreError(
                f"{path} has appeared during the run and is left alone; the result is complete in {part.path}: move "
                "the other file away, then `resume` gives it its name"
            ) from None
        finally:
            new.unlink(missing_ok=True)
        part.remove()
    return result


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
