"""The part of a run while the run holds it: blocks are appended, nothing else in it is touched.

One program at a time holds a part, by a lock of the operating system. On a file system without locks a second program
may append to it; the first finds out at its next block, by the length, and stops.
"""

import contextlib
import errno
import os
import shutil
import time
from collections.abc import Iterator, Mapping
from pathlib import Path
from typing import Any, BinaryIO

import numpy as np
import portalocker

from vibro_sweep.store import parts
from vibro_sweep.store.opening import StoreError
from vibro_sweep.store.parts import Head, PartError

SYNC_SECONDS = 1.0  # a power failure costs about so much, a kill of the program nothing


class LockedPart:
    """A part that this program has made or goes on with. Raises StoreError where the disk does not take a record."""

    def __init__(self, path: Path, file: BinaryIO):
        self.path, self.file = path, file
        self.head: Head | None = None
        self._synced = -SYNC_SECONDS

    def begin(self, head: Head, skeleton: bytes) -> None:
        """The head and the skeleton, in place of everything."""
        with said(self.path):
            self.file.truncate(0)
            self._end = 0
            self._write([head.packed(), skeleton])
            os.fsync(self.file.fileno())
        self.head = head

    def go_on(self, head: Head, end: int) -> None:
        """Behind the last whole record; what a kill has left of another is cut off."""
        self.head, self._end = head, end
        self.file.truncate(end)

    def append(self, key: Any, arrays: Mapping[str, np.ndarray]) -> None:
        """A record: once this returns, a kill does not lose it."""
        text = {"key": key, "arrays": [[name, one.dtype.str, list(one.shape)] for name, one in arrays.items()]}
        data = [memoryview(np.ascontiguousarray(one).reshape(-1).view(np.uint8)) for one in arrays.values()]
        with said(self.path):
            self._check_unchanged()
            self._write(parts.record(self.head.run_id, text, data))
            if time.monotonic() - self._synced > SYNC_SECONDS:
                os.fsync(self.file.fileno())
                self._synced = time.monotonic()

    def _check_unchanged(self) -> None:
        if not _stands(self.path, self.file):
            try:
                self._put_back()
            except OSError as error:
                raise StoreError(f"{self.path} was removed during the run, and cannot be put back: {error}") from None
            raise StoreError(
                f"{self.path} was removed during the run; it is there again, with all that was computed: `resume` "
                "continues it"
            )
        if parts.size(self.file) != self._end:
            raise StoreError(
                f"{self.path} was changed by another program during the run; this one stops, and `resume` continues "
                "with what is left"
            )

    def _write(self, pieces: list[bytes | memoryview]) -> None:
        self.file.seek(self._end)
        try:
            for piece in pieces:
                view = memoryview(piece).cast("B")
                while view:
                    view = view[self.file.write(view) :]
        except BaseException:
            self.file.truncate(self._end)
            raise
        self._end += sum(memoryview(piece).nbytes for piece in pieces)

    def _put_back(self) -> None:
        """Write it where it was, with all its blocks. Raises OSError."""
        self.path.parent.mkdir(parents=True, exist_ok=True)
        with open(self.path, "xb") as copy:
            self.file.seek(0)
            shutil.copyfileobj(self.file, copy, parts.PIECE)
            os.fsync(copy.fileno())

    def remove(self) -> None:
        """Remove the part, whose contents have become a file."""
        if _stands(self.path, self.file):
            os.unlink(self.path)

    def close(self) -> None:
        with contextlib.suppress(OSError):
            os.fsync(self.file.fileno())
        self.file.close()


def make(path: Path) -> LockedPart:
    """A new and empty part. Raises FileExistsError, and BlockingIOError where another run was quicker."""
    return _locked(path, os.O_RDWR | os.O_CREAT | os.O_EXCL)


def lock(path: Path) -> LockedPart:
    """The part that is there. Raises FileNotFoundError, PartError for what is not a file of its own,
    BlockingIOError."""
    return _locked(path, os.O_RDWR)


def is_locked(path: Path) -> bool:
    """Whether a run is writing this part now."""
    try:
        lock(path).close()
    except BlockingIOError:
        return True
    except (OSError, PartError):
        return False
    return False


def _locked(path: Path, flags: int) -> LockedPart:
    while True:
        file = parts.open_regular(path, flags | getattr(os, "O_NOFOLLOW", 0))
        try:
            if os.fstat(file.fileno()).st_nlink > 1:
                raise PartError("has a second name, so that another file would be written too; remove one of them")
            _lock(file)
            if _stands(path, file):
                return LockedPart(path, file)
        except BaseException:
            file.close()
            raise
        file.close()  # its last owner removed it between the two calls


def _lock(file: BinaryIO) -> None:
    try:
        portalocker.lock(file, portalocker.LockFlags.EXCLUSIVE | portalocker.LockFlags.NON_BLOCKING)
    except portalocker.AlreadyLocked:
        raise BlockingIOError(errno.EAGAIN, os.strerror(errno.EAGAIN)) from None
    except portalocker.LockException:
        pass  # a file system without locks


def _stands(path: Path, file: BinaryIO) -> bool:
    """Whether the open file is the one at that name."""
    try:
        return os.path.samestat(os.fstat(file.fileno()), os.lstat(path))
    except (FileNotFoundError, NotADirectoryError):
        return False


@contextlib.contextmanager
def said(path: Path) -> Iterator[None]:
    """Faults of the disk under the part of a run, in words, and that nothing is lost."""
    try:
        yield
    except PartError as error:
        raise StoreError(f"{path} {error}") from None
    except OSError as error:
        kept = "what was computed until then is kept: `resume` continues it"
        reason = os.strerror(error.errno) if error.errno else str(error)
        full = error.errno in (errno.ENOSPC, errno.EDQUOT, errno.EFBIG)
        raise StoreError(f"{path}: {reason}; {'make room; ' if full else ''}{kept}") from None
