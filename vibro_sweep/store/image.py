"""From a part to an HDF5 file: its skeleton is copied, and the blocks are put into their places."""

import math
from array import array
from collections.abc import Collection, Iterator
from typing import BinaryIO, NamedTuple

import h5py
import numpy as np

from vibro_sweep.store.attributes import is_flat, quantities_of
from vibro_sweep.store.parts import Head, Record, Scan
from vibro_sweep.store.sink import Sink

Box = tuple[slice, ...]
GROUP_BYTES = 2**24  # of blocks that are put into the file together


class Frame(NamedTuple):
    """The datasets that blocks fill: dtype and shape of each dataset, in the order in which a block holds them."""

    datasets: dict[str, tuple[np.dtype, tuple[int, ...]]]
    shape: tuple[int, ...]  # of the orbits, which is that of `status` and the first axes of all others

    def layout(self, box: Box) -> list:
        """Name, dtype and shape of each dataset in a box of orbits, as a record has them."""
        lead = [part.stop - part.start for part in box]
        return [(name, dtype, lead + list(shape[len(box) :])) for name, (dtype, shape) in self.datasets.items()]

    def size(self, box: Box) -> int:
        """Bytes of a box of orbits."""
        return sum(math.prod(shape) * dtype.itemsize for _, dtype, shape in self.layout(box))

    def whole(self, box: Box) -> Box:
        """A box of the first axes as one of all axes, with its ends as numbers."""
        spans = [slice(*part.indices(extent)[:2]) for part, extent in zip(box, self.shape, strict=False)]
        return (*spans, *(slice(0, extent) for extent in self.shape[len(box) :]))

    def units(self, file: h5py.File) -> Iterator[Box]:
        """Boxes that together have all orbits, each within one chunk of the dataset with the most numbers."""
        largest = max(self.datasets, key=lambda name: math.prod(self.datasets[name][1][len(self.shape) :]))
        edges = (file[largest].chunks or ())[: len(self.shape)]
        counts = [-(-extent // edge) for extent, edge in zip(self.shape, edges, strict=True)]
        for corner in np.ndindex(*counts):
            yield self.whole(tuple(slice(at * edge, (at + 1) * edge) for at, edge in zip(corner, edges, strict=True)))


def frame_of(file: h5py.File) -> Frame:
    """The frame of a sweep; of branches, curves and windows, which have no blocks, one without orbits."""
    if is_flat(file):
        return Frame({}, (0,))
    return Frame({name: (file[name].dtype, file[name].shape) for name in quantities_of(file)}, file["status"].shape)


class Index:
    """The index of the records of a part: blocks of a sweep, `pieces` of branches, curves and windows, `notes`.

    `damaged` counts what is not whole; a note means that all before it is known and computed again. `end` is the end
    of the last whole record.
    """

    def __init__(self, file: BinaryIO, head: Head, frame: Frame):
        self._frame = frame
        scan, rows, known = Scan(file, head), array("Q"), 0
        self.notes, self.pieces = [], []
        for record in scan:
            box = _box(record, frame)
            if box is not None:
                rows.extend([record.at, *(end for part in box for end in (part.start, part.stop))])
            elif isinstance(record.key, dict) and isinstance(record.key.get("note"), str):
                self.notes.append(record.key["note"])
                known = scan.damaged
            elif isinstance(record.key, str) and not frame.datasets:
                self.pieces.append(record)
            else:
                scan.damaged += 1
        self.damaged, self.end = scan.damaged - known, scan.end
        self._rows = np.array(rows).reshape(-1, 1 + 2 * len(frame.shape))

    def __iter__(self) -> Iterator[tuple[Box, int]]:
        """Each block's box and where its data begin, in the order of the sweep."""
        order = np.lexsort((self._rows[:, 0], *self._rows.T[:0:-1]))
        for row in self._rows[order].tolist():
            yield tuple(slice(*ends) for ends in zip(row[1::2], row[2::2], strict=True)), row[0]

    def fill(self, source: BinaryIO, target: h5py.File, sink: Sink, names: Collection[str] | None = None) -> None:
        """Put the blocks into a copy of the skeleton, in a sink; of the datasets in `names` only, if it is given."""
        for axis, group in self._groups():
            sink.check()
            first, last = group[0][0], group[-1][0]
            whole = tuple(slice(one.start, other.stop) for one, other in zip(first, last, strict=True))
            ats = [at for _, at in group]
            for name, (dtype, shape) in self._frame.datasets.items():
                found = []
                for k, (box, _) in enumerate(group):
                    lead = tuple(part.stop - part.start for part in box)
                    count = math.prod(lead) * math.prod(shape[len(box) :])
                    if names is None or name in names:
                        source.seek(ats[k])
                        found.append(np.fromfile(source, dtype, count).reshape(lead + shape[len(box) :]))
                    ats[k] += count * dtype.itemsize
                if found:
                    target[name][whole] = np.concatenate(found, axis) if len(found) > 1 else found[0]

    def _groups(self) -> Iterator[tuple[int | None, list[tuple[Box, int]]]]:
        """Blocks that continue each other along an axis, as many as are quickly written as one."""
        group, along, size = [], None, 0
        for box, at in self:
            axis, more = _continues(group[-1][0], box) if group else None, self._frame.size(box)
            if axis is None or along not in (None, axis) or size + more > GROUP_BYTES:
                if group:
                    yield along, group
                group, along, size = [], None, 0
            else:
                along = axis
            group.append((box, at))
            size += more
        if group:
            yield along, group


def _continues(one: Box, other: Box) -> int | None:
    """The axis along which a box begins where another ends, if they are alike along all others."""
    differing = [axis for axis, (a, b) in enumerate(zip(one, other, strict=True)) if a != b]
    if len(differing) == 1 and other[differing[0]].start == one[differing[0]].stop:
        return differing[0]
    return None


def _box(record: Record, frame: Frame) -> Box | None:
    """The box of a record, if it is one of such a file."""
    spans = record.key
    if not isinstance(spans, list) or len(spans) != len(frame.shape):
        return None
    for span, extent in zip(spans, frame.shape, strict=True):
        if not isinstance(span, list) or [type(end) for end in span] != [int, int]:
            return None
        if not 0 <= span[0] < span[1] <= extent:
            return None
    box = tuple(slice(*span) for span in spans)
    return box if record.layout == frame.layout(box) else None
