"""The scan: the next cell in which an orbit in free flight may touch a stop, and its state there."""

import numpy as np

from vibro_sweep.kernels.flight import CHUNK
from vibro_sweep.kernels.jit import inline
from vibro_sweep.kernels.lanes import LANES, bits, eight, leading, leading_lanes, row


@inline
def control_points(scan, p, q, y0, y1, y2, y3):
    """Control points p, ..., p + 7 of a flight that starts at (y0, ..., y3); q: as counted from there."""
    return (
        eight(scan[4], p)
        + eight(scan[0], q) * y0
        + eight(scan[1], q) * y1
        + eight(scan[2], q) * y2
        + eight(scan[3], q) * y3
    )


@inline
def at_node(nodes, k, base, y0, y1, y2, y3):
    """X - r at node k of a free flight that has X - r = (y0, ..., y3) at node `base`."""
    E = nodes[np.uint64(k - base)].E
    return (row(E, 0) * y0 + row(E, 1) * y1) + (row(E, 2) * y2 + row(E, 3) * y3)


@inline
def first_suspect(f, o):
    """The first cell from `o.cell` on in which contact cannot be excluded; `cells` if there is none.

    The orbit is in free flight from node `base`. The control points of all cells (tables.py) are looked at, `CHUNK` at
    a time; an end of a cell may lie outside though all control points before it are inside (`suspect_state`).
    """
    scan, cells, bound = f.scan, f.oscillator[0].cells, f.oscillator[0].remainder
    base, y0, y1, y2, y3 = o.base, o.y[0], o.y[1], o.y[2], o.y[3]
    margin = (bound[0] * abs(y0) + bound[1] * abs(y1)) + (bound[2] * abs(y2) + bound[3] * abs(y3)) + bound[4]
    low, high = o.stops[0] + margin, o.stops[1] - margin
    o.low, o.high = low, high
    k = cells
    for p in range(2 * o.cell, 2 * cells, CHUNK):
        q = p - 2 * base
        a = control_points(scan, p, q, y0, y1, y2, y3)
        b = control_points(scan, p + LANES, q + LANES, y0, y1, y2, y3)
        a_inside, b_inside = (a >= low) & (a <= high), (b >= low) & (b <= high)
        if bits(~(a_inside & b_inside)) != 0:
            n = leading_lanes(a_inside)
            k = min((p + n + (leading_lanes(b_inside) if n == LANES else 0)) // 2, cells)
            break
    return k


@inline
def state_at(o, nodes, k):
    """X after the free flight from `base` to node k; there it is known already, and better."""
    if k == o.base:
        return row(o.X, 0)
    return at_node(nodes, k, o.base, o.y[0], o.y[1], o.y[2], o.y[3]) + row(nodes[np.uint64(k)].z, 0)


@inline
def suspect_state(o, nodes):
    """The suspect cell, and X at its beginning; or the cell before, if that end of it lies outside."""
    k = o.suspect
    X = state_at(o, nodes, k)
    if k > o.cell and not o.low <= leading(X) <= o.high:
        k -= 1
        X = state_at(o, nodes, k)
    return k, X
