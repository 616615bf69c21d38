"""The scan: the next cell in which an orbit in free flight may touch a stop, and its state there."""

import numpy as np

from vibro_sweep.engine.simd.jit import inline, jit
from vibro_sweep.engine.simd.lanes import LANES, bits, count_leading, eight, first_number, lanes_of, row, select
from vibro_sweep.engine.tables.flight import CHUNK


@inline
def control_points(scan, p, since, y0, y1, y2, y3):
    """Control points p, ..., p + 7 of a flight that starts at (y0, ..., y3); since: as counted from there."""
    return (
        eight(scan[4], p)
        + eight(scan[0], since) * y0
        + eight(scan[1], since) * y1
        + eight(scan[2], since) * y2
        + eight(scan[3], since) * y3
    )


@inline
def first_suspect(f, o):
    """The first cell from `o.cell` on in which contact cannot be excluded; `cells` if there is none.

    The orbit is in free flight from node `origin`. The control points of all cells
    (tables/control_points.py) are looked at, `CHUNK` at a time; an end of a cell may lie outside though all control
    points before it are inside (`suspect_state`).
    """
    scan, cells, bound = f.scan, f.oscillator[0].cells, f.oscillator[0].remainder
    origin, y0, y1, y2, y3 = o.origin, o.y[0], o.y[1], o.y[2], o.y[3]
    margin = (bound[0] * abs(y0) + bound[1] * abs(y1)) + (bound[2] * abs(y2) + bound[3] * abs(y3)) + bound[4]
    low, high = o.stops[0] + margin, o.stops[1] - margin
    o.low, o.high = low, high
    k = cells
    for p in range(2 * o.cell, 2 * cells, CHUNK):
        since = p - 2 * origin
        a = control_points(scan, p, since, y0, y1, y2, y3)
        b = control_points(scan, p + LANES, since + LANES, y0, y1, y2, y3)
        a_inside, b_inside = (a >= low) & (a <= high), (b >= low) & (b <= high)
        if bits(~(a_inside & b_inside)) != 0:
            n = count_leading(a_inside)
            k = min((p + n + (count_leading(b_inside) if n == LANES else 0)) // 2, cells)
            break
    return k


@inline
def state_at(o, nodes, k):
    """X, sin and cos after the free flight to node k; at node `origin` it is known already, and better."""
    if k == o.origin:
        return row(o.X, 0)
    E, y = nodes[np.uint64(k - o.origin)].E, o.y
    moved = (row(E, 0) * y[0] + row(E, 1) * y[1]) + (row(E, 2) * y[2] + row(E, 3) * y[3])
    return moved + row(nodes[np.uint64(k)].z, 0)


@inline
def suspect_state(o, nodes):
    """The suspect cell, and X at its beginning; or the cell before, if that end of it lies outside."""
    k = o.suspect
    X = state_at(o, nodes, k)
    if k > o.cell and not o.low <= first_number(X) <= o.high:
        k -= 1
        X = state_at(o, nodes, k)
    return k, X


@jit
def open_cell(f, o, k):
    """The first cell up to k in which contact cannot be excluded, where all inner points are inside: of a stiff system.

    The cubic is one of the slow modes, and x1 itself may be inside by the swing of a fast one: so its ends are found
    from it. It begins at node `origin`; its end in the cell before node k is the mean of the points beside it; the ends
    of other cells lie between points that are inside.
    """
    q, scan, y = f.oscillator[0], f.scan, o.y
    x = f.nodes[o.origin].z[0] + (q.slow[0] * y[0] + q.slow[1] * y[1]) + (q.slow[2] * y[2] + q.slow[3] * y[3])
    if not o.low <= x <= o.high:
        return o.origin
    x, since = 0.0, 2 * k - 1 - 2 * o.origin
    for p in range(since, since + 2):
        x += 0.5 * (scan[4, p + 2 * o.origin] + (scan[0, p] * y[0] + scan[1, p] * y[1]))
        x += 0.5 * (scan[2, p] * y[2] + scan[3, p] * y[3])
    return k if o.low <= x <= o.high else k - 1


@inline
def careful_state(o, nodes, k):
    """X, sin and cos at node k from X at node `base`, and not from X - r.

    Between near stops r, the motion from rest at node 0, is far larger than the motion itself, and a flight of some
    cells would lose the digits that the two have in common.
    """
    if k == o.base:
        return row(o.start, 0)
    E, x = nodes[np.uint64(k - o.base)].E, o.start
    moved = (row(E, 0) * x[0] + row(E, 1) * x[1]) + (row(E, 2) * x[2] + row(E, 3) * x[3])
    moved += row(E, 4) * x[4] + row(E, 5) * x[5]
    return select(lanes_of(15), moved, row(nodes[np.uint64(k)].z, 0))
