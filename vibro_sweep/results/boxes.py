"""Boxes of a grid of points, in the order of its arrays."""

import math
from collections.abc import Callable, Iterator

import numpy as np

Box = tuple[slice, ...]
Stretch = tuple[tuple[int, ...], int]


def boxes(shape: tuple[int, ...], size: Callable[[], int], begin: int = 0, end: int | None = None) -> Iterator[Box]:
    """An array of this shape, from entry `begin` to `end`, cut into boxes of at most `size()` entries, in order.

    A box has single values, then a part of an axis, then whole axes. The size of each is asked for when it is cut.
    """
    if not shape:
        yield ()
        return
    step = [math.prod(shape[axis + 1 :]) for axis in range(len(shape))]  # entries behind a value of an axis
    end = math.prod(shape) if end is None else end
    while begin < end:
        most, corner = max(1, min(size(), end - begin)), [int(at) for at in np.unravel_index(begin, shape)]
        cut = next(axis for axis, behind in enumerate(step) if behind <= most and begin % behind == 0)
        length = min(most // step[cut], shape[cut] - corner[cut])
        single = (slice(at, at + 1) for at in corner[:cut])
        yield (*single, slice(corner[cut], corner[cut] + length), *(slice(0, extent) for extent in shape[cut + 1 :]))
        begin += length * step[cut]


def stretches(shape: tuple[int, ...], box: Box) -> Iterator[Stretch]:
    """The parts of a box whose points lie one after the other in memory: their places in the box, and the number of the
    first point of each in the whole grid."""
    spans = [part.indices(extent)[:2] for part, extent in zip(box, shape, strict=False)]
    cut = [axis for axis, (first, end) in enumerate(spans) if end - first != shape[axis]]
    last = cut[-1] if cut else 0  # behind it all axes are whole
    steps = [math.prod(shape[axis + 1 :]) for axis in range(len(shape))]
    begin = sum(first * step for (first, _), step in zip(spans, steps, strict=False))
    for place in np.ndindex(*(end - first for first, end in spans[:last])):
        yield place, begin + sum(i * step for i, step in zip(place, steps, strict=False))
