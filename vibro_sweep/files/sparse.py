"""A binary file in memory, of which only the pages that are written take room.

HDF5 makes a file in it, which may be larger than the memory, and meets no disk that fails: it does not survive that.
"""

import os

PAGE = 2**16


class SparseFile:
    """What h5py asks of a file."""

    def __init__(self):
        self.pages: dict[int, bytearray] = {}  # by the place where they begin
        self.size = self._at = 0

    def seek(self, offset: int, whence: int = os.SEEK_SET) -> int:
        self._at = offset + {os.SEEK_SET: 0, os.SEEK_CUR: self._at, os.SEEK_END: self.size}[whence]
        return self._at

    def tell(self) -> int:
        return self._at

    def write(self, data) -> int:
        view = memoryview(data).cast("B")
        for begin, end, page in self._parts(view.nbytes):
            self.pages.setdefault(page, bytearray(PAGE))[begin:end] = view[: end - begin]
            view = view[end - begin :]
        self.size = max(self.size, self._at)
        return memoryview(data).nbytes

    def read(self, count: int = -1) -> bytes:
        rest = max(0, self.size - self._at)
        parts = self._parts(rest if count < 0 else min(count, rest))
        return b"".join(bytes(self.pages.get(page, bytes(PAGE))[begin:end]) for begin, end, page in parts)

    def truncate(self, size: int | None = None) -> int:
        self.size = self._at if size is None else size
        return self.size

    def flush(self) -> None:
        """Nothing is kept back."""

    def _parts(self, count: int):
        """The parts of pages that so many bytes from here on take; moves on behind them."""
        end = self._at + count
        while self._at < end:
            begin = self._at % PAGE
            step = min(PAGE - begin, end - self._at)
            yield begin, begin + step, self._at - begin
            self._at += step
