"""The seal of a file: a checksum of its structure behind its end, which is compared before HDF5 sees the file.

HDF5 can hang on a damaged structure, and takes some damage for other contents. It ignores what is behind the end of a
file, and drops it where it changes the file: so a file without a seal was made, or edited, by another program. Layout:

    offset, size (uint64)                        of each stretch of numbers, which have checksums of their own
    how many there are, CRC-32 of all the rest (uint32), mark (8 bytes)
"""

import os
import struct
import zlib
from typing import BinaryIO, NamedTuple

from vibro_sweep.files.sparse import SparseFile

MARK = b"vsweep03"
PIECE = 2**20  # bytes read at a time

_STRETCH = struct.Struct("<QQ")
_END = struct.Struct("<II8s")


class SealError(ValueError):
    """A structure that is not the one that was written; the message goes on "FILE ..."."""


class Stretch(NamedTuple):
    """Bytes of a file that the seal leaves out."""

    offset: int
    size: int


def seal(file: BinaryIO | SparseFile, stretches: list[Stretch]) -> None:
    """Write the seal behind the end of a file that is complete but for the numbers in these stretches."""
    joined: list[Stretch] = []
    for stretch in sorted(stretches):
        if joined and stretch.offset == joined[-1].offset + joined[-1].size:
            joined[-1] = Stretch(joined[-1].offset, joined[-1].size + stretch.size)
        elif stretch.size:
            joined.append(stretch)
    table = b"".join(_STRETCH.pack(*stretch) for stretch in joined)
    end = file.seek(0, os.SEEK_END)
    file.write(table)
    checksum = _checksum(file, joined, end + len(table))
    file.seek(0, os.SEEK_END)
    file.write(_END.pack(len(joined), checksum, MARK))


def is_sealed(file: BinaryIO) -> bool:
    """Whether a file has a seal. Raises SealError where that does not fit the file."""
    size = file.seek(0, os.SEEK_END)
    if size < _END.size:
        return False
    file.seek(size - _END.size)
    count, checksum, mark = _END.unpack(file.read(_END.size))
    if mark != MARK:
        return False
    end = size - _END.size
    first = end - count * _STRETCH.size
    if first < 0:
        raise SealError("is damaged: its seal does not fit it")
    file.seek(first)
    stretches = [Stretch(*_STRETCH.unpack(file.read(_STRETCH.size))) for _ in range(count)]
    ends = [0, *(stretch.offset + stretch.size for stretch in stretches)]
    if any(stretch.offset < before for stretch, before in zip(stretches, ends, strict=False)) or ends[-1] > first:
        raise SealError("is damaged: its seal does not fit it")
    if _checksum(file, stretches, end) != checksum:
        raise SealError("is damaged: its structure is not the one that was written")
    return True


def _checksum(file: BinaryIO | SparseFile, stretches: list[Stretch], end: int) -> int:
    """CRC-32 of a file up to `end`, but for these stretches."""
    checksum, at = 0, 0
    for offset, size in (*stretches, Stretch(end, 0)):
        file.seek(at)
        while at < offset and (piece := file.read(min(PIECE, offset - at))):
            checksum, at = zlib.crc32(piece, checksum), at + len(piece)
        at = offset + size
    return checksum
