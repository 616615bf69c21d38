"""HDF5's global heap, the one structure of a file that HDF5 keeps no checksum of: here is one.

It holds the references from datasets to their dimension scales, and texts of variable length. HDF5 loops forever on
some damaged heaps, so this is looked at before HDF5 reads one. What others add to a heap later on does not matter.
The format: HDF5 File Format Specification 3.0, III.E "Global Heap".
"""

import struct
import zlib
from typing import BinaryIO

from vibro_sweep.store import parts

START = b"GCOL\x01\0\0\0"  # signature, version, reserved
_OBJECT = struct.Struct("<HH4xQ")  # index, references, bytes
MOST = 2**24  # bytes of a collection; HDF5 makes them of 4096, or as large as the largest object


class HeapError(ValueError):
    """A heap that is damaged."""


def collections(file: BinaryIO) -> list[int]:
    """The places where the collections of a file begin."""
    found, at = [], 0
    while (at := parts.find(file, START, at)) < parts.size(file):
        found.append(at)
        at += len(START)
    return found


def measured(file: BinaryIO, at: int) -> tuple[int, int]:
    """The largest index of an object in a collection, and the checksum of all."""
    objects = _objects(file, at)
    last = max(objects, default=0)
    return last, _checksum(objects, last)


def verify(file: BinaryIO, at: int, last: int, checksum: int) -> None:
    """Raise HeapError where the collection's objects up to that index are not those that were `measured`."""
    if last >= MOST or _checksum(_objects(file, at), last) != checksum:
        raise HeapError("its references and texts are not what was written")


def _checksum(objects: dict[int, bytes], last: int) -> int:
    checksum = 0
    for index in range(1, last + 1):
        checksum = zlib.crc32(objects.get(index, b""), zlib.crc32(index.to_bytes(4), checksum))
    return checksum


def _objects(file: BinaryIO, at: int) -> dict[int, bytes]:
    """The objects of a collection by their index; raises HeapError where HDF5 could not walk through them."""
    file.seek(at)
    head = file.read(16)
    if len(head) < 16 or not head.startswith(START):
        raise HeapError("a collection of its heap is not where it was")
    length = int.from_bytes(head[8:], "little")
    if not 16 <= length <= MOST:
        raise HeapError(f"a collection of its heap has {length} bytes")
    body = file.read(length - 16)
    if len(body) != length - 16:
        raise HeapError("a collection of its heap is cut off")
    objects, place = {}, 0
    while place + _OBJECT.size <= len(body):
        index, _, count = _OBJECT.unpack_from(body, place)
        step = _OBJECT.size + count + -count % 8 if index else count
        if not _OBJECT.size <= step <= len(body) - place or index in objects:
            raise HeapError("a collection of its heap cannot be walked through")
        if index:
            objects[index] = body[place + _OBJECT.size : place + _OBJECT.size + count]
        place += step
    return objects
