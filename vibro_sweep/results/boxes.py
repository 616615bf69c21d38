"""Boxes of a grid of points, in the order of its arrays."""

import math
from collections.abc import Iterator

import numpy as np

Box = tuple[slice, ...]


def boxes(shape: tuple[int, ...], size: int) -> Iterator[Box]:
    """An array of this shape cut into boxes of at most `size` entries, in order.

    A box has whole trailing axes, then a part of one, then single values.
    """
    lengths = list(shape)
    for axis in reversed(range(len(shape))):
        lengths[axis] = max(1, min(shape[axis], size))
        size //= shape[axis]
    counts = [-(-extent // length) for extent, length in zip(shape, lengths, strict=True)]
    for n in range(math.prod(counts)):  # itertools.product would hold all of them along an axis
        corner = [int(at) * length for at, length in zip(np.unravel_index(n, counts), lengths, strict=True)]
        yield tuple(
            slice(at, min(at + length, extent)) for at, length, extent in zip(corner, lengths, shape, strict=True)
        )


def stretches(shape: tuple[int, ...], box: Box) -> Iterator[tuple[tuple[int, ...], int]]:
    """The parts of a box of the first axes that lie one after the other in memory: their places in the box, and the
    number of the first entry of each in the whole array."""
    spans = [part.indices(extent)[:2] for part, extent in zip(box, shape, strict=False)]
    cut = [axis for axis, (first, end) in enumerate(spans) if end - first != shape[axis]]
    last = cut[-1] if cut else 0  # behind it all axes are whole
    steps = [math.prod(shape[axis + 1 :]) for axis in range(len(shape))]
    begin = sum(first * step for (first, _), step in zip(spans, steps, strict=False))
    for place in np.ndindex(*(end - first for first, end in spans[:last])):
        yield place, begin + sum(i * step for i, step in zip(place, steps, strict=False))
