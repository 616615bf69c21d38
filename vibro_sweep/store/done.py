"""Which orbits of a sweep are computed: intervals in the order in which blocks are cut."""

import bisect
from collections.abc import Iterator

import numpy as np

Box = tuple[slice, ...]


class Done:
    """Boxes of a grid of orbits, joined. `order` are its axes as blocks go through them, the fastest one last.

    A block is then one interval, or a few; where a run went on, the intervals grow together again.
    """

    def __init__(self, shape: tuple[int, ...], order: tuple[int, ...]):
        self._shape, self._order = shape, order
        self._starts, self._ends = [], []

    def add(self, box: Box) -> None:
        for start, end in self.intervals(box):
            first = bisect.bisect_left(self._ends, start)  # those that touch the new one
            last = bisect.bisect_right(self._starts, end)
            if first < last:
                start, end = min(start, self._starts[first]), max(end, self._ends[last - 1])
            self._starts[first:last], self._ends[first:last] = [start], [end]

    def count(self) -> int:
        """Orbits."""
        return sum(self._ends) - sum(self._starts)

    def holds(self, box: Box) -> bool:
        """Whether all of a box is there."""
        for start, end in self.intervals(box):
            at = bisect.bisect_right(self._starts, start) - 1
            if at < 0 or self._ends[at] < end:
                return False
        return True

    def intervals(self, box: Box) -> Iterator[tuple[int, int]]:
        """A box as intervals [start, end) of the orbits in their order; axes that it does not name are whole."""
        spans = [part.indices(extent)[:2] for part, extent in zip(box, self._shape, strict=False)]
        spans += [(0, extent) for extent in self._shape[len(box) :]]
        spans, shape = [spans[axis] for axis in self._order], [self._shape[axis] for axis in self._order]
        length = 1  # of the trailing axes that are whole
        while spans and spans[-1] == (0, shape[-1]):
            spans.pop()
            length *= shape.pop()
        low, high = spans.pop() if spans else (0, 1)
        extent = shape.pop() if shape else 1
        for corner in np.ndindex(*(end - start for start, end in spans)):
            at = 0
            for (start, _), place, count in zip(spans, corner, shape, strict=True):
                at = at * count + start + place
            at = at * extent
            yield (at + low) * length, (at + high) * length


def in_order_of_blocks(axes: int, swept: int, follow: bool) -> tuple[int, ...]:
    """Axes of the orbits as blocks go through them: those of a `follow` have the whole first axis and one start."""
    natural = tuple(range(axes))
    return (*natural[swept:], *natural[1:swept], 0) if follow and swept else natural
