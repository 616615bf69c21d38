"""The exclusion test of a stiff oscillator: fast roots are bounded, the scan follows the others.

Where a rate is so fast that series would need more than `cells.MOST_CELLS` cells to a period, the system is called
stiff: its cells are those of a coarser grid, and a series takes a small step within its cell. The gap is a sum of
exponentials (points/exponentials.py). One whose root the cells do not resolve stays below its size at the
beginning, since no root grows; the slow ones are followed by cubics, whose error their fourth derivatives bound. The
motion r begins so that the force excites no fast root. Where eigenvectors all but coincide (a free mode, critical
damping) the sum has lost digits: it is compared at all nodes with the flights themselves, and the bounds are raised by
ten times what they differ.
"""

import math

import numpy as np

from vibro_sweep.engine.simd.jit import jit
from vibro_sweep.engine.tables.exclusion import put_points, rounding
from vibro_sweep.engine.tables.flight import CHUNK, WIDTH

DOUBT = 10.0


@jit
def is_fast(q, point, m):
    """Whether the cells do not resolve root m."""
    return math.hypot(point.root[m, 0], point.root[m, 1]) * q.width > WIDTH


@jit
def turn_roots(point, t, turned):
    """e^{l t} of all roots."""
    for m in range(len(point.root)):
        decay, angle = math.exp(point.root[m, 0] * t), point.root[m, 1] * t
        turned[0, m], turned[1, m] = decay * math.cos(angle), decay * math.sin(angle)


@jit
def gap_at(q, point, i, turned):
    """x and v of the slow roots, and x of all of them, of the motion i."""
    x, v, total = 0.0, 0.0, 0.0
    for m in range(len(point.root)):
        a, b = point.part[i, m, 0], point.part[i, m, 1]
        now = a * turned[0, m] - b * turned[1, m]
        total += now
        if not is_fast(q, point, m):
            x += now
            v += point.root[m, 0] * now - point.root[m, 1] * (a * turned[1, m] + b * turned[0, m])
    return x, v, total


@jit
def bound_roots(q, point, i):
    """Bounds on the fast part of the motion i, and on the fourth derivative of the slow one, over a period."""
    fast, fourth = 0.0, 0.0
    for m in range(len(point.root)):
        size = math.hypot(point.part[i, m, 0], point.part[i, m, 1])
        size *= math.exp(max(point.root[m, 0], 0.0) * q.width * q.cells)  # rounding of an undamped one
        if is_fast(q, point, m):
            fast += size
        else:
            fourth += size * math.hypot(point.root[m, 0], point.root[m, 1]) ** 4
    return fast, fourth


@jit
def fill_stiff_exclusion(q, nodes, scan, point, turned):
    """`scan`, `remainder` and `slow` of a stiff oscillator; turned (2, 2 N + 3): scratch."""
    states = 2 * len(q.series)
    for i in range(states + 1):
        for p in range(2 * q.cells + 1, 2 * q.cells + CHUNK):
            scan[i, p] = 0.0
        q.remainder[i] = 0.0  # for now the largest difference from the flights
    for k in range(q.cells + 1):
        turn_roots(point, k * q.width, turned)
        for i in range(states + 1):
            x, v, total = gap_at(q, point, i, turned)
            exact = nodes[k].z[0] if i == states else nodes[k].E[i, 0]
            q.remainder[i] = max(q.remainder[i], abs(total - exact))
            if i == states:
                x, v = nodes[k].z[0], nodes[k].z[1]
            elif k == 0:
                q.slow[i] = x
            put_points(scan[i], q.width / 3.0, k, x, v)
    for i in range(states + 1):
        fast, fourth = bound_roots(q, point, i)
        largest = 0.0
        for p in range(2 * q.cells + 1):
            largest = max(largest, abs(scan[i, p]))
        stop_distance = rounding(q, i, largest + fast)
        q.remainder[i] = (fast + fourth * q.width**4 / 144.0) + (DOUBT * q.remainder[i] + stop_distance)
        if not (point.valid and q.remainder[i] < np.inf):
            q.remainder[i] = np.inf  # no cell can be excluded
