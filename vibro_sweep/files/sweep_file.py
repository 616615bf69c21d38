"""The file of a sweep while it is computed: blocks are put in their places, and then their statuses.

HDF5 has made the file whole, and does not touch it again. A status is written when the numbers of its point are on the
disk, once a second: so what has a status is right, after a kill and after a power failure.
"""

import math
import os
import time
from pathlib import Path
from typing import Any

import h5py
import numpy as np

from vibro_sweep.files.checksum import checksums
from vibro_sweep.files.disk import faults_said, to_disk, write_all
from vibro_sweep.files.file_errors import StoreError
from vibro_sweep.files.hdf5 import CHECKS
from vibro_sweep.files.verifying import end_record
from vibro_sweep.results.boxes import Box, Stretch, stretches
from vibro_sweep.results.statuses import Statuses
from vibro_sweep.tables.outcomes import NOT_COMPUTED

SECONDS = 1.0  # between two times at which what was computed is brought to the disk: what a kill costs at most
WHOLE: list[Stretch] = [((), 0)]  # all points, from the first one on
KEPT = "what was computed until then is kept: `resume` continues it"


class SweepFile(Statuses):
    """The file of a sweep, to be filled by one process. All methods raise StoreError where the disk fails."""

    def __init__(self, path: Path, again: np.ndarray | None = None):
        """again : points (bool) that are to be computed again"""
        self.path, self._began, self._written = path, time.perf_counter(), time.monotonic()
        with h5py.File(path, "r") as h5:
            names = [name for name in h5[CHECKS] if name != "end"]
            self._place = {
                name: (h5[name].id.get_offset(), h5[name].shape, h5[name].dtype)
                for name in (*names, *(f"{CHECKS}/{name}" for name in h5[CHECKS]))
            }
            self.names = names
            self.status = np.array(h5["status"][()])
        self._descriptor = os.open(path, os.O_RDWR | getattr(os, "O_BINARY", 0))
        self._waiting: list[tuple[Box, np.ndarray]] = []  # statuses of numbers that may not be on the disk yet
        if again is not None:
            self.status[again] = NOT_COMPUTED
            self._put("status", WHOLE, self.status)

    def write(self, box: Box, arrays: dict[str, np.ndarray]) -> None:
        """Keep a block: within a second a kill does not lose it any more."""
        lead, places = self.status[box].shape, list(stretches(self.status.shape, box))
        for name in self.names:
            _, shape, dtype = self._place[name]
            values = np.asarray(arrays[name], dtype, order="C")
            if values.shape != lead + shape[self.status.ndim :]:
                raise ValueError(f"a block of the box {box} has `{name}` of another shape")
            if name != "status":
                self._put(name, places, values)
            self._put(f"{CHECKS}/{name}", places, checksums(values, self.status.ndim))
        statuses = np.asarray(arrays["status"], self.status.dtype)
        self.status[box] = statuses
        self._waiting.append((box, statuses))
        if time.monotonic() - self._written > SECONDS:
            self.commit()

    def commit(self) -> None:
        """Bring the numbers to the disk, and then say which are there."""
        try:
            with faults_said(self.path, KEPT):
                to_disk(self._descriptor)
        except StoreError:
            self._waiting = []  # their numbers may be gone, whatever a second attempt says
            raise
        if not _stands(self.path, self._descriptor):
            raise StoreError(f"{self.path} was removed, or replaced, during the run, and what it held is lost")
        waiting, self._waiting = self._waiting, []
        for box, statuses in waiting:
            self._put("status", list(stretches(self.status.shape, box)), statuses)
        self._written = time.monotonic()

    def read(self, name: str) -> np.ndarray:
        """All numbers of a variable, read when they are used."""
        offset, shape, dtype = self._place[name]
        return np.memmap(self.path, dtype, "r", offset, shape)

    def finish(self, following: dict[str, np.ndarray], about: dict[str, Any]) -> float:
        """Write what follows from all points, and that the file is complete. Returns the seconds of the run."""
        for name, values in following.items():
            values = np.asarray(values, self._place[name][2], order="C")
            self._put(name, WHOLE, values)
            self._put(f"{CHECKS}/{name}", WHOLE, checksums(values, self.status.ndim))
        seconds = round(time.perf_counter() - self._began, 3)
        self.commit()
        with faults_said(self.path, KEPT):
            to_disk(self._descriptor)
        self._put(f"{CHECKS}/end", WHOLE, end_record(about | {"wall_time_s": seconds}))
        with faults_said(self.path, KEPT):
            os.fsync(self._descriptor)
        return seconds

    def close(self) -> None:
        """Bring to the disk what was computed."""
        try:
            self.commit()
        finally:
            os.close(self._descriptor)

    def _put(self, name: str, places: list[Stretch], values: np.ndarray) -> None:
        """Write numbers of points: those that lie one after the other in the file at once."""
        offset, shape, dtype = self._place[name]
        size = math.prod(shape[self.status.ndim :]) * dtype.itemsize  # of a point
        with faults_said(self.path, KEPT):
            for place, first in places:
                write_all(self._descriptor, memoryview(values[place].tobytes()), offset + first * size)


def _stands(path: Path, descriptor: int) -> bool:
    """Whether the open file is the one at that name."""
    try:
        return os.path.samestat(os.fstat(descriptor), os.lstat(path))
    except (FileNotFoundError, NotADirectoryError):
        return False
