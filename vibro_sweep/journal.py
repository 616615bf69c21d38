"""A file that changes by whole steps, whatever kills the program: a write-ahead journal beside it.

What is written since the last `commit` waits in memory. `commit` appends it to FILE.journal with its checksum and hands
it to the operating system: from then on a kill cannot lose it. The file itself is touched by `checkpoint` alone, about
once a second: the journal goes to the disk, its changes into the file, the file to the disk, and only then is the
journal emptied. Killed in the middle of that, the file is put right from the journal by whoever opens it next. A power
failure costs what came after the last checkpoint, no more. A full disk stops a commit before it has changed anything.

The journal is also the lock: one program at a time holds it. On a file system without locks its first bytes name the
owner, so that a second program takes over, and the first finds out at its next commit and stops.
"""

import contextlib
import errno
import fcntl
import math
import os
import shutil
import struct
import time
import uuid
import zlib

from vibro_sweep import changes

CHECKPOINT_SECONDS = 1.0
CHECKPOINT_BYTES = 16_000_000

_START = struct.Struct(">16sQ")  # of the journal: a name that nobody else gives, bytes of the file when it was emptied


class DamagedError(OSError):
    """Another program has cut the file off: what was in it cannot be told from zeros."""


class Journal:
    """The file at `path`, for reading and writing as h5py does it; changes are kept by `commit`.

    Raises BlockingIOError where another program holds the file, and OSError where the disk does not take what is
    written: then nothing of that step is kept, and everything before it is. With `sure`, OSError too where the file
    system has no locks.
    """

    def __init__(self, path, sure: bool = False):
        self.path = os.fspath(path)
        self._log_path = log_path(path)
        self._log = _locked(self._log_path, sure)
        self._file = None
        self._logged: changes.Changes = {}
        self._pending: changes.Changes = {}

    def discard(self) -> None:
        """Forget what a killed program left in the journal: the file is made anew."""
        os.ftruncate(self._log, 0)

    def open(self) -> None:
        """Put the file right, if its last writer was killed, and begin."""
        file = os.open(self.path, os.O_RDWR)
        try:
            _recover(self._log, file)
        except OSError:
            os.close(file)
            raise
        self._file = file
        self._at = 0
        self._size = self._kept = os.fstat(self._file).st_size  # with what is pending; with what is committed
        self._empty()
        self._checkpointed = -math.inf

    def _empty(self) -> None:
        self._base, self._end = os.fstat(self._file).st_size, _START.size
        self._start = _START.pack(uuid.uuid4().bytes, self._base)
        self._checksum = zlib.crc32(self._start)
        changes.put(self._log, self._start, 0)
        os.ftruncate(self._log, _START.size)

    # What h5py calls

    def seek(self, offset: int, whence: int = os.SEEK_SET) -> int:
        self._at = offset + (0, self._at, self._size)[whence]
        return self._at

    def tell(self) -> int:
        return self._at

    def read(self, count: int = -1) -> bytes:
        at, left = self._at, max(0, self._size - self._at)
        count = left if count < 0 else min(count, left)
        found = bytearray(os.pread(self._file, count, at).ljust(count, b"\0"))
        for layer in (self._logged, self._pending):
            for (where, length), data in layer.items():
                first, last = max(at, where), min(at + count, where + length)
                if first < last:
                    found[first - at : last - at] = data[first - where : last - where]
        self._at += count
        return bytes(found)

    def write(self, data) -> int:
        data = bytes(data)
        changes.add(self._pending, self._at, data)
        self._at += len(data)
        self._size = max(self._size, self._at)
        return len(data)

    def truncate(self, size: int) -> int:
        self._size = size
        return size

    def flush(self) -> None:
        """Nothing is kept before `commit`."""

    # Steps

    def commit(self) -> None:
        """Keep what was written. Raises FileNotFoundError where the file or its folder was removed meanwhile."""
        self._check_owner()
        try:
            self._append()
        except OSError:
            if not self._logged:
                raise
            self.checkpoint()  # makes room, where there is little
            self._append()
        if self._end > CHECKPOINT_BYTES or time.monotonic() - self._checkpointed > CHECKPOINT_SECONDS:
            self.checkpoint()

    def _check_owner(self) -> None:
        for descriptor, path in ((self._log, self._log_path), (self._file, self.path)):
            if not os.path.samestat(os.fstat(descriptor), os.stat(path)):
                raise FileNotFoundError(errno.ENOENT, os.strerror(errno.ENOENT), path)
        if os.pread(self._log, _START.size, 0) != self._start:
            raise BlockingIOError(errno.EAGAIN, "another program took it over", self.path)
        if os.fstat(self._file).st_size < self._base:
            raise DamagedError(errno.EIO, "another program cut it off", self.path)

    def _append(self) -> None:
        record, checksum = changes.record(self._pending, self._size, self._checksum)
        try:
            changes.put(self._log, record, self._end)
        except OSError:
            os.ftruncate(self._log, self._end)
            raise
        self._end, self._checksum = self._end + len(record), checksum
        for (where, _), data in self._pending.items():
            changes.add(self._logged, where, data)
        self._pending, self._kept = {}, self._size

    def checkpoint(self) -> None:
        """Bring the file up to the last commit, and both to the disk."""
        os.fsync(self._log)
        changes.apply(self._file, self._logged, self._kept)
        self._empty()
        self._logged = {}
        self._checkpointed = time.monotonic()

    def rename(self, path) -> None:
        """Bring the file up to date and give it its last name."""
        self.checkpoint()
        os.replace(self.path, path)
        self.path = os.fspath(path)

    def put_back(self) -> None:
        """Write what is committed where the file was, which was removed, or its folder, or the journal."""
        if self._file is None:
            raise FileNotFoundError(errno.ENOENT, os.strerror(errno.ENOENT), self.path)
        if os.path.exists(self.path) and os.path.samestat(os.stat(self.path), os.fstat(self._file)):
            self.checkpoint()
            return
        os.makedirs(os.path.dirname(os.path.abspath(self.path)), exist_ok=True)
        with open(self.path, "xb") as copy, open(self._file, "rb", closefd=False) as old:
            old.seek(0)
            shutil.copyfileobj(old, copy)
            copy.flush()
            changes.apply(copy.fileno(), self._logged, self._kept)

    def close(self) -> None:
        """Drop what is not committed, bring the file up to date and let go of it; the journal stays if that fails."""
        try:
            if self._file is not None:
                self._check_owner()
                if self._logged:
                    self.checkpoint()
            if os.fstat(self._log).st_size <= _START.size:
                os.unlink(self._log_path)
        except OSError:
            pass  # the journal still holds it, for the next program; or the file is no more ours
        finally:
            for descriptor in (self._log, self._file):
                if descriptor is not None:
                    os.close(descriptor)


def log_path(path) -> str:
    return f"{os.fspath(path)}.journal"


def recover(path) -> None:
    """Put a file right whose writer was killed; nothing is done where none was, or where it is still at work."""
    if not os.path.exists(log_path(path)):
        return
    with contextlib.suppress(OSError):  # held by its writer, or not ours to change: it is read as it is
        journal = Journal(path, sure=True)  # a reader must not take the file from its writer
        try:
            journal.open()
        finally:
            journal.close()


def _locked(path: str, sure: bool) -> int:
    """The journal, open and held by this program."""
    while True:
        log = os.open(path, os.O_RDWR | os.O_CREAT, 0o666)
        try:
            fcntl.flock(log, fcntl.LOCK_EX | fcntl.LOCK_NB)
        except OSError as error:
            if sure or isinstance(error, BlockingIOError):  # else a file system without locks
                os.close(log)
                raise
        with contextlib.suppress(FileNotFoundError):
            if os.path.samestat(os.fstat(log), os.stat(path)):
                return log
        os.close(log)  # its last owner removed it between the two calls


def _recover(log: int, file: int) -> None:
    start = os.pread(log, _START.size, 0)
    if len(start) == _START.size:
        if os.fstat(file).st_size < _START.unpack(start)[1]:
            raise DamagedError(errno.EIO, "another program cut it off")
        for step, size in changes.records(log, start):
            changes.apply(file, step, size)
    os.ftruncate(log, 0)
