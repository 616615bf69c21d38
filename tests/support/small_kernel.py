"""A small kernel with all that large ones use: whether kernels compile as one with the numba that is installed.

Records and their rows, lanes and their intrinsics, tuples, loops that end early, and kernels that are called: plain,
inlined, kept as a call, and without fused multiply-adds.
"""

import numpy as np

from vibro_sweep.engine.simd.jit import exactly, inline, jit, noinline
from vibro_sweep.engine.simd.lanes import added, select
from vibro_sweep.engine.simd.memory import eight, put_eight, record, row

LANES, ROWS = 8, 3
RECORD = record([("rows", float, (ROWS, LANES)), ("scale", float), ("count", np.int64)])


@inline
def scaled(x, factor):
    return x * factor


@noinline
def bounds(one):
    return -one.scale, one.scale + 1.0


@exactly
def rest(a, b):
    """What rounding takes of a product; 0 if it is fused."""
    return a * b - a * b


@jit
def total(one, limit):
    low, high = bounds(one)
    found = 0.0
    for i in range(one.count):
        x = scaled(row(one.rows, i), one.scale)
        x = select(x < low, x - x, x)
        found += added(x)
        if found > limit:
            break
    return found, high


def kernel(records, space):
    """Sums of scaled rows, up to a limit; the lanes of `space` doubled."""
    result = 0.0
    for n in range(len(records)):
        found, high = total(records[n], 50.0)
        result += found * high + rest(found, high)
    x = eight(space, 0)
    put_eight(space, LANES, x + x)
    return result


def works(compiled) -> bool:
    """Whether `compiled`, made of `kernel`, gives what Python gives."""
    records = np.zeros(2, RECORD)
    records["rows"] = np.arange(2 * ROWS * LANES, dtype=float).reshape(2, ROWS, LANES) - 10.0
    records["scale"], records["count"] = (1.5, 0.25), ROWS
    space = np.arange(16, dtype=float)
    expected = 0.0
    for one in records:
        found = 0.0
        for x in one["rows"] * one["scale"]:
            found += np.where(x < -one["scale"], 0.0, x).sum()
            if found > 50.0:
                break
        expected += found * (one["scale"] + 1.0)
    return bool(compiled(records, space) == expected) and space[LANES:].tolist() == (2 * space[:LANES]).tolist()
