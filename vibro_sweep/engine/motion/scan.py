"""The scan: the next cell in which an orbit in free flight may touch a stop, and its state there."""

import numpy as np

from vibro_sweep.engine.simd.jit import inline, jit, noinline
from vibro_sweep.engine.simd.lanes import bits, lowest, number, state_and_rest
from vibro_sweep.engine.simd.memory import head, row, sixteen, widened
from vibro_sweep.engine.tables.flight import CHUNK


@inline
def control_points(scan, p, since, y, states):
    """Control points from p on of a flight that starts at y, `states` numbers; since: p as counted from there."""
    length = scan.shape[1]
    points = sixteen(scan, states * length + p)
    for j in range(states):
        points = points + sixteen(scan, j * length + since) * y[j]
    return points


@inline
def first_candidate(f, o):
    """The first cell from `o.cell` on in which contact cannot be excluded; `cells` if there is none.

    The orbit is in free flight from node `origin`. The control points of all cells
    (tables/exclusion.py) are looked at, `CHUNK` at a time; an end of a cell may lie outside though all control
    points before it are inside (`candidate_state`). What leaves the range of single precision is not inside.
    """
    cells, bound, y, states = o.cells, o.remainder, o.y, len(o.remainder) - 1
    stop_distance = bound[0] * abs(y[0]) + bound[1] * abs(y[1])
    for j in range(2, states, 2):
        stop_distance = stop_distance + (bound[j] * abs(y[j]) + bound[j + 1] * abs(y[j + 1]))
    stop_distance = stop_distance + bound[states]
    low, high = o.limits[0] + stop_distance, o.limits[1] - stop_distance
    o.low, o.high = low, high
    p = 2 * o.cell
    while p < 2 * cells:
        points = control_points(f.scan, p, p - 2 * o.origin, y, states)
        outside = bits(~((points >= low) & (points <= high)))
        if outside != 0:
            return min((p + lowest(outside)) // 2, cells)
        p += CHUNK
    return cells


@noinline
def next_watched(f, o, times):
    """The next candidate cell, or one before it in which there is a sample to take."""
    i = o.samples_taken
    sampled = int(times[i, 0]) if i < len(times) else o.cells
    return o.cell if sampled <= o.cell else min(sampled, first_candidate(f, o))


@inline
def combine(E, y, count, c):
    """The sum of the first `count` rows of E times y, by pairs: the states, and zeros. c: as of an orbit."""
    moved = head(E, 0, c) * y[0] + head(E, 1, c) * y[1]
    for j in range(2, count, 2):
        moved = moved + (head(E, j, c) * y[j] + head(E, j + 1, c) * y[j + 1])
    return widened(moved, E)


@inline
def state_at(o, nodes, k):
    """X, sin and cos after the free flight to node k; at node `origin` it is known already, and better."""
    if k == o.origin:
        return row(o.X, 0)
    E = nodes[np.uint64(k - o.origin)].E
    return combine(E, o.y, 2 * len(o.c), o.c) + row(nodes[np.uint64(k)].z, 0)


@inline
def is_inside(o, x):
    """Whether x1 at an end of a cell lies inside. One comparison, not two: the processor has to guess each outcome."""
    return min(x - o.low, o.high - x) >= 0.0


@inline
def candidate_state(o, nodes):
    """The candidate cell, and X at its beginning; or the cell before, if that end of it lies outside."""
    k = o.candidate
    X = state_at(o, nodes, k)
    if k > o.cell and not is_inside(o, number(X, 0)):
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
    x, states = f.nodes[o.origin].z[0], len(q.slow)
    for j in range(states):
        x += q.slow[j] * y[j]
    if not o.low <= x <= o.high:
        return o.origin
    x, since = 0.0, 2 * k - 1 - 2 * o.origin
    for p in range(since, since + 2):
        x += 0.5 * scan[states, p + 2 * o.origin]
        for j in range(states):
            x += 0.5 * scan[j, p] * y[j]
    return k if o.low <= x <= o.high else k - 1


@inline
def state_from_base(o, nodes, k):
    """X, sin and cos at node k from X at node `base`, and not from X - r.

    Between near stops r, the motion from rest at node 0, is far larger than the motion itself, and a flight of some
    cells would lose the digits that the two have in common.
    """
    if k == o.base:
        return row(o.start, 0)
    E = nodes[np.uint64(k - o.base)].E
    return state_and_rest(combine(E, o.start, len(E), o.c), row(nodes[np.uint64(k)].z, 0), o.c)
