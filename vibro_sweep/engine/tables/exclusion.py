"""Control points of the gap over the cells, for any number of masses; what they are for stands in control_points.py."""

from vibro_sweep.engine.simd.jit import jit
from vibro_sweep.engine.simd.lanes import LANES, number
from vibro_sweep.engine.simd.memory import eight
from vibro_sweep.engine.tables.flight import CHUNK, ORDER

ROUNDING = 1e-15  # of a control point of two masses, a few units in the last place of each of its terms


@jit
def bound_fourth(q, X, count):
    """Bound on the fourth derivative of x1 over a cell that begins with the first `count` inputs X."""
    s = q.series[0]
    first, second = eight(s, 0) * X[0], eight(s, LANES) * X[0]
    for j in range(1, count):
        first = first + eight(s, ORDER * j) * X[j]
        second = second + eight(s, ORDER * j + LANES) * X[j]
    terms = abs(first) * eight(q.fourth, 0) + abs(second) * eight(q.fourth, LANES)
    low = (number(terms, 0) + number(terms, 1)) + (number(terms, 2) + number(terms, 3))
    return low + ((number(terms, 4) + number(terms, 5)) + (number(terms, 6) + number(terms, 7)))


@jit
def put_points(q, row, k, x, v):
    """The control points beside node k, where x1 and v1 are these. Returns the larger of their sizes."""
    third, before = q.width / 3.0, 0.0
    row[2 * k] = x + third * v
    if k > 0:
        before = x - third * v
        row[2 * k - 1] = before
    return max(abs(row[2 * k]), abs(before))


@jit
def fill_exclusion(q, nodes, scan):
    """`scan` and `remainder` where the cells resolve every rate (else fast_roots.py)."""
    states, inputs = 2 * len(q.series), len(q.force)
    for i in range(states + 1):
        for p in range(2 * q.cells + 1, 2 * q.cells + CHUNK):
            scan[i, p] = 0.0
        largest, fourth = 0.0, 0.0
        for k in range(q.cells + 1):
            if i < states:
                E = nodes[k].E[i]
                largest = max(largest, put_points(q, scan[i], k, E[0], E[1]))
                fourth = max(fourth, bound_fourth(q, E, states))
            else:
                z = nodes[k].z[:]  # a row, as E is: one kernel serves both
                largest = max(largest, put_points(q, scan[i], k, z[0], z[1]))
                fourth = max(fourth, bound_fourth(q, z, inputs))
        # a point is a sum of states + 1 terms, and so is its rounding
        margin = ROUNDING * max(1.0, 0.5 * len(q.series)) * largest
        q.remainder[i] = fourth * q.width**4 / 144.0 + margin
        if i < states:
            q.slow[i] = 0.0
