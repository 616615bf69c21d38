"""Control points of the gap over the cells, by which a scan excludes cells without contact.

The cubic through x1 and v1 at both ends of a cell of width h has the Bernstein coefficients x_k, x_k + h v_k/3,
x_{k+1} - h v_{k+1}/3, x_{k+1}. Its error is at most bound t^2 (1 - t)^2 h^4/24, with a bound on the fourth derivative:
a quartic with the one coefficient bound h^4/144, the middle one. So x1 stays below b where both inner control points do
by that much, and both ends do. An end is the mean of the inner points beside it.
"""

from vibro_sweep.engine.simd.jit import inline, jit
from vibro_sweep.engine.simd.lanes import LANES, SINGLES, added, number, select
from vibro_sweep.engine.simd.memory import eight, sixteen
from vibro_sweep.engine.tables.flight import CHUNK, ORDER

UNIT = 2.0**-24  # rounding of single precision, in which control points are kept and held against the stops
SMALLEST = 2.0**-100  # of x1: what is lost below the range of single precision lies far below it


@jit
def rounding(q, i, size):
    """The largest change of a control point by rounding, for unit X - r in state i, or for r; size: of the largest one
    there.

    Each of its `states` + 1 terms is rounded when it is tabulated, its factor is, and so are the product and each sum;
    the last one is for what the point is held against, which matters only where that is no larger than these terms.
    """
    states = 2 * len(q.series)
    return (states + 5) * UNIT * size + (SMALLEST if i == states else 0.0)


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
    sizes = abs(sixteen(points, 0))
    for p in range(SINGLES, last + 1, SINGLES):
        others = abs(sixteen(points, p))
        sizes = select(others > sizes, others, sizes)
    largest = 0.0
    for i in range(SINGLES):
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
        q.remainder[i] = fourth * q.width**4 / 144.0 + rounding(q, i, largest_point(q, scan[i]))
        if i < states:
            q.slow[i] = 0.0
