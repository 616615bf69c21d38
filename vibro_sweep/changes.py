"""Changes of a file: collected, made into a record of a journal and read back from it, and done."""

import os
import struct
import zlib
from collections.abc import Iterator

_HEAD = struct.Struct(">QQI")  # of a record: bytes of its changes, the file's size after it, its checksum
_CHANGE = struct.Struct(">QQ")  # of a change: where, how many bytes

Changes = dict[tuple[int, int], bytes]  # (where, how many) -> the bytes, oldest first: later ones win


def add(changes: Changes, where: int, data: bytes) -> None:
    """One more change."""
    key = (where, len(data))
    changes.pop(key, None)  # to the end: it wins over all that overlap it
    changes[key] = data


def record(changes: Changes, size: int, before: int) -> tuple[bytes, int]:
    """The changes as bytes of a journal, and their checksum, which goes on from that of what stands before them.

    `size` is the file's after them.
    """
    parts = [part for key, data in changes.items() for part in (_CHANGE.pack(*key), data)]
    checksum = _checksum(parts, size, before)
    return b"".join([_HEAD.pack(sum(map(len, parts)), size, checksum), *parts]), checksum


def records(log: int, start: bytes) -> Iterator[tuple[Changes, int]]:
    """The changes of each whole record after the start of a journal, and the file's size after it."""
    at, before = len(start), zlib.crc32(start)
    while len(head := os.pread(log, _HEAD.size, at)) == _HEAD.size:
        length, size, checksum = _HEAD.unpack(head)
        at += _HEAD.size
        body = os.pread(log, length, at) if at + length <= os.fstat(log).st_size else b""
        if len(body) != length or _checksum([body], size, before) != checksum:
            return  # the writer was killed here; or these are left from before the journal was last emptied
        at, before = at + length, checksum
        changes: Changes = {}
        place = 0
        while place < length:
            where, count = _CHANGE.unpack_from(body, place)
            place += _CHANGE.size + count
            add(changes, where, body[place - count : place])
        yield changes, size


def _checksum(parts: list[bytes], size: int, before: int) -> int:
    result = zlib.crc32(size.to_bytes(8), before)
    for part in parts:
        result = zlib.crc32(part, result)
    return result


def apply(file: int, changes: Changes, size: int) -> None:
    """Make the changes, and bring them to the disk."""
    for (where, _), data in changes.items():
        put(file, data, where)
    if os.fstat(file).st_size < size:
        os.ftruncate(file, size)
    os.fsync(file)


def put(file: int, data: bytes, where: int) -> None:
    """Write all of it, or raise OSError."""
    view = memoryview(data)
    while view:
        written = os.pwrite(file, view, where)
        view, where = view[written:], where + written
