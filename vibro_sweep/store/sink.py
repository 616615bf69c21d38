"""What HDF5 writes into: faults of the disk wait until HDF5 has let go.

HDF5 does not survive a write that fails: it goes on, says that all is well, and ends in a segmentation fault. So no
write fails here; the first fault is kept, nothing is written after it, and `check` raises it.
"""

import contextlib
import os
from collections.abc import Iterator
from typing import BinaryIO

import h5py

LIBVER = "v110"  # of HDF5, whose structure has checksums


class Sink:
    """A binary file as h5py wants it. To be used in a thread that gets no signals; others may call `stop`."""

    def __init__(self, file: BinaryIO):
        self._file = file
        self._fault: BaseException | None = None

    def stop(self, why: BaseException) -> None:
        """Stop writing; `check` raises this error."""
        self._fault = self._fault or why

    def check(self) -> None:
        """Raise the first fault, if there was one."""
        if self._fault:
            raise self._fault

    def seek(self, offset: int, whence: int = os.SEEK_SET) -> int:
        if self._file.closed:  # after a second Ctrl-C HDF5 lets go of it late: nothing is written then
            return offset
        return self._file.seek(offset, whence)

    def tell(self) -> int:
        return self._file.tell()

    def read(self, count: int = -1) -> bytes:
        return self._file.read(count)

    def write(self, data) -> int:
        data = memoryview(data).cast("B")
        self._try(lambda: self._file.write(data))
        return data.nbytes

    def truncate(self, size: int | None = None) -> int:
        self._try(lambda: self._file.truncate(size))
        return size

    def flush(self) -> None:
        self._try(self._file.flush)

    def _try(self, action) -> None:
        if self._fault is None and not self._file.closed:
            try:
                action()
            except OSError as error:
                self._fault = error


@contextlib.contextmanager
def changing(sink: Sink) -> Iterator[h5py.File]:
    """The HDF5 file in a sink, to be changed. Raises what the sink has kept."""
    try:
        with h5py.File(sink, "r+", libver=LIBVER) as file:
            yield file
    except (OSError, RuntimeError):
        sink.check()
        raise
    sink.check()
