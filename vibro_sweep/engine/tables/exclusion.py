"""Control points of the gap over the cells, for any number of masses; what they are for stands in control_points.py."""

from vibro_sweep.engine.simd.jit import inline, jit
from vibro_sweep.engine.simd.lanes import LANES, added, number, select
from vibro_sweep.engine.simd.memory import eight
from vibro_sweep.engine.tables.flight import CHUNK, ORDER

ROUNDING = 1e-15  # of a control point of two masses, a few units in the last place of each of its terms


@inline
def bound_fourth(q, X, count):
    """Bound on the fourth derivative of x1 over a cell that begins with the first `count` inputs X."""
    s = q.series[0]
    first, second = eight(s, 0) * X[0], eight(s, LANES) * X[0]
    for j in range(1, count):
        first = first + eight(s, ORDER * j) * X[j]
        second = second + eight(s, ORDER * j + LANES) * X[j]
    return added(abs(first) * eight(q.fourth, 0) + abs(second) * eight(q.fourth, LANES))


@inline
def put_points(points, third, k, x, v):
    """The control points beside node k, where x1 and v1 are these. third: of the width of a cell."""
    points[2 * k] = x + third * v
    if k > 0:
        points[2 * k - 1] = x - third * v


@jit
def largest_point(q, points):
    """The largest |point|; what is left of the row, to which chunks reach, becomes zero."""
    last = 2 * q.cells
    for p in range(last + 1, last + CHUNK):
        points[p] = 0.0
    sizes = abs(eight(points, 0))
    for p in range(LANES, last + 1, LANES):
        others = abs(eight(points, p))
        sizes = select(others > sizes, others, sizes)
    largest = 0.0
    for i in range(LANES):
        largest = max(largest, number(sizes, i))
    return largest


@jit
def fill_exclusion(q, nodes, scan):
    """`scan` and `remainder` where the cells resolve every rate (else fast_roots.py)."""
    states, inputs, third = 2 * len(q.series), len(q.force), q.width / 3.0
    for i in range(states + 1):
        fourth = 0.0
        if i < states:
            for k in range(q.cells + 1):
                E = nodes[k].E
                put_points(scan[i], third, k, E[i, 0], E[i, 1])
            for k in range(q.cells + 1):
                fourth = max(fourth, bound_fourth(q, nodes[k].E[i], states))
        else:
            for k in range(q.cells + 1):
                z = nodes[k].z
                put_points(scan[i], third, k, z[0], z[1])
            for k in range(q.cells + 1):
                fourth = max(fourth, bound_fourth(q, nodes[k].z, inputs))
        # a point is a sum of states + 1 terms, and so is its rounding
        margin = ROUNDING * max(1.0, 0.5 * len(q.series)) * largest_point(q, scan[i])
        q.remainder[i] = fourth * q.width**4 / 144.0 + margin
        if i < states:
            q.slow[i] = 0.0
