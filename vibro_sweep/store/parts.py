"""FILE.h5.part: an empty HDF5 file and, after it, the blocks of a run as they come. Nothing in it is ever rewritten.

    head       magic, format, run id, what the run may replace, length and checksum of the skeleton; its checksum
    skeleton   the HDF5 file of the run with nothing computed in it
    record     run id, length of the text and of the data, their checksum; checksum of all that
               text (JSON: {"key": KEY, "arrays": [[name, dtype, shape], ...]}), the arrays one after the other
    record ...

KEY is [[first, end], ...] of a block of a sweep, a text of a piece of branches, curves or windows, and {"note": TEXT}
of a line for the history of the file.

A record that a kill has cut off is the last one and is as if it had never been begun. `run_id` is 16 random bytes:
they make the file known as this run's own, and find the next record behind one whose length is damaged.
"""

import contextlib
import errno
import io
import json
import math
import os
import secrets
import stat
import struct
import zlib
from collections.abc import Iterator
from pathlib import Path
from typing import Any, BinaryIO, NamedTuple

import numpy as np

from vibro_sweep.store.names import Stamp

FORMAT = 2  # of files and their parts
MAGIC = b"\x89vibro_sweep\r\n\x1a\n"
MOST_TEXT, MOST_DATA = 10**6, 2 * 10**9  # bytes of a record
PIECE = 2**20  # bytes read at a time

_HEAD = struct.Struct(">16sI16s3QQI")
_RECORD = struct.Struct(">16sIQI")
_CHECKSUM = struct.Struct(">I")


class PartError(ValueError):
    """A file that is not a part, or whose head or skeleton is damaged; the message goes on "FILE ..."."""


class Head(NamedTuple):
    run_id: bytes
    replaces: Stamp | None  # the file that stood at FILE.h5 when `overwrite` was asked for
    length: int  # of the skeleton
    checksum: int  # of the skeleton

    @property
    def start(self) -> int:
        """The offset at which the skeleton begins."""
        return _HEAD.size + _CHECKSUM.size

    def packed(self) -> bytes:
        stamp = self.replaces or (0, 0, 0)
        return _sealed(_HEAD.pack(MAGIC, FORMAT, self.run_id, *stamp, self.length, self.checksum))


class Record(NamedTuple):
    key: Any
    layout: list  # name, dtype and shape of each array
    at: int  # where the arrays begin

    def arrays(self, file: BinaryIO) -> dict[str, np.ndarray]:
        """The arrays by name."""
        file.seek(self.at)
        return {name: np.fromfile(file, dtype, math.prod(shape)).reshape(shape) for name, dtype, shape in self.layout}


def new_head(skeleton: bytes, replaces: Stamp | None, run_id: bytes) -> Head:
    return Head(run_id, replaces, len(skeleton), zlib.crc32(skeleton))


def new_run_id() -> bytes:
    return secrets.token_bytes(16)


def record(run_id: bytes, text: dict, data: list[memoryview]) -> list[bytes | memoryview]:
    """A record as the pieces that are written one after the other."""
    encoded = json.dumps(text).encode()
    checksum = zlib.crc32(encoded)
    for piece in data:
        checksum = zlib.crc32(piece, checksum)
    return [_sealed(_RECORD.pack(run_id, len(encoded), sum(map(len, data)), checksum)), encoded, *data]


def open_regular(path: Path, flags: int = os.O_RDONLY) -> BinaryIO:
    """A file, unbuffered; a pipe is not waited for. Raises PartError for what is not a file."""
    extra = sum(getattr(os, name, 0) for name in ("O_NONBLOCK", "O_BINARY", "O_CLOEXEC"))
    descriptor = os.open(path, flags | extra, 0o666)
    try:
        if not stat.S_ISREG(os.fstat(descriptor).st_mode):
            raise PartError("is a folder, a device or a pipe; it must be a file")
        return io.FileIO(descriptor, "r" if flags == os.O_RDONLY else "r+")
    except BaseException:
        os.close(descriptor)
        raise


def is_part(file: BinaryIO) -> bool:
    file.seek(0)
    return file.read(len(MAGIC)) == MAGIC


def is_begun(file: BinaryIO) -> bool:
    """Whether its head and skeleton are there as a whole: a run may be killed before they are.

    Raises PartError where the head is there and damaged.
    """
    if size(file) < _HEAD.size + _CHECKSUM.size:
        return False
    head = read_head(file)
    return size(file) >= head.start + head.length


def read_head(file: BinaryIO) -> Head:
    """Raises PartError for a part that is not of this format, or is damaged."""
    file.seek(0)
    raw = file.read(_HEAD.size + _CHECKSUM.size)
    if not raw.startswith(MAGIC):
        raise PartError("is not a file of vibro-sweep")
    if not _holds(raw, _HEAD):
        raise PartError("is damaged (its head); overwrite it")
    _, version, run_id, inode, length, changed, skeleton, checksum = _HEAD.unpack_from(raw)
    if version != FORMAT:
        raise PartError(f"has the format {version} of another version of vibro_sweep; this one reads {FORMAT}")
    stamp = Stamp(inode, length, changed) if inode or length or changed else None
    return Head(run_id, stamp, skeleton, checksum)


def copy_skeleton(file: BinaryIO, head: Head, target: BinaryIO) -> None:
    """Raises PartError where the checksum does not hold; then `target` holds nothing to be used."""
    checksum, left = 0, head.length
    file.seek(head.start)
    while left and (piece := file.read(min(left, PIECE))):
        checksum, left = zlib.crc32(piece, checksum), left - len(piece)
        target.write(piece)
    if left or checksum != head.checksum:
        raise PartError("is damaged (its skeleton); overwrite it")


class Scan:
    """Goes through the records of a part.

    `damaged` counts what is not whole, but for a last one that is cut off; `end` is the end of the last whole one.
    """

    def __init__(self, file: BinaryIO, head: Head):
        self._file, self._head = file, head
        self.damaged, self.end = 0, head.start + head.length

    def __iter__(self) -> Iterator[Record]:
        at, size_now = self.end, size(self._file)
        lost = False  # what stands before `at` is not a record, and is counted if one follows
        while at + _RECORD.size + _CHECKSUM.size <= size_now:
            self._file.seek(at)
            raw = self._file.read(_RECORD.size + _CHECKSUM.size)
            mark, texts, length, checksum = _RECORD.unpack_from(raw)
            if mark != self._head.run_id or not _holds(raw, _RECORD) or texts > MOST_TEXT or length > MOST_DATA:
                lost, at = True, find(self._file, self._head.run_id, at + 1)
                continue
            self.damaged, lost = self.damaged + lost, False
            begin, end = at + len(raw), at + len(raw) + texts + length
            if end > size_now:  # it is being written, or its writer was killed
                return
            found = self._record(begin, texts, length, checksum)
            self.damaged += found is None
            at = self.end = end
            if found is not None:
                yield found
        self.damaged += lost

    def _record(self, begin: int, texts: int, length: int, checksum: int) -> Record | None:
        """A record whose checksum holds, and whose arrays are numbers and fill its data."""
        self._file.seek(begin)
        encoded, left = self._file.read(texts), length
        found = zlib.crc32(encoded)
        while left and (piece := self._file.read(min(left, PIECE))):
            found, left = zlib.crc32(piece, found), left - len(piece)
        if left or found != checksum:
            return None
        with contextlib.suppress(ValueError, RecursionError, KeyError, TypeError, OverflowError):
            text = json.loads(encoded)
            layout = [(str(name), np.dtype(dtype), [int(n) for n in shape]) for name, dtype, shape in text["arrays"]]
            sound = all(kind.kind in "biuf" and min(shape, default=0) >= 0 for _, kind, shape in layout)
            if sound and sum(kind.itemsize * math.prod(shape) for _, kind, shape in layout) == length:
                return Record(text["key"], layout, begin + texts)
        return None


def find(file: BinaryIO, mark: bytes, at: int) -> int:
    """The next place of the mark, or the end of the file; holes in it are skipped."""
    end = size(file)
    while at < end:
        try:
            at = os.lseek(file.fileno(), at, getattr(os, "SEEK_DATA", os.SEEK_SET))
        except OSError as error:
            if error.errno == errno.ENXIO:  # a hole until the end
                break
            file.seek(at)  # a system that cannot tell
        piece = file.read(PIECE)
        if mark in piece:
            return at + piece.index(mark)
        if len(piece) <= len(mark):
            break
        at += len(piece) - len(mark) + 1
    return end


def size(file: BinaryIO) -> int:
    return file.seek(0, os.SEEK_END)


def _sealed(raw: bytes) -> bytes:
    return raw + _CHECKSUM.pack(zlib.crc32(raw))


def _holds(raw: bytes, form: struct.Struct) -> bool:
    return len(raw) == form.size + _CHECKSUM.size and raw == _sealed(raw[: form.size])
