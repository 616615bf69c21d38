"""The certificate of an orbit: how far its turning points stay from their stops."""

import cmath

import numpy as np

from vibro_sweep.engine.continuation.chatter_sum import NEXT
from vibro_sweep.engine.continuation.flight_tables import polynomial
from vibro_sweep.engine.continuation.lasting import leaves_slowly, speed_after, take_releases
from vibro_sweep.engine.continuation.lasting_event import hold_of
from vibro_sweep.engine.continuation.moving_flow import HIGH, LOW, OMEGA, expand_gap, shift
from vibro_sweep.engine.continuation.problem import GRAZE, STICK
from vibro_sweep.engine.impulses.extremes import OVERLAP, extremes_of_cell, turns_near
from vibro_sweep.engine.impulses.taylor_orders import ORDER
from vibro_sweep.engine.simd.jit import jit

FARTHER = 0.05  # relative: where the nearest turning point is looked for first, beyond that of the last point
ASIDE = 1e-3  # of the phase beside a graze in which its own turning point lies


@jit
def certify(f, c, place, b):
    """The least distance of a turning point of the gap from its stop; that of the graze itself is left out.

    work.nearest: the distance, its phase and the side. Where all is farther away than at the last point, cells are
    passed over; if nothing nearer is found, they are looked at again.
    """
    work = b.work[0]
    far = work.nearest[0] + FARTHER * abs(work.nearest[0])
    if not far < np.inf:
        far = np.inf
    work.nearest[0] = far
    look(f, c, place, b)
    take_releases(f, c, place, b)
    if work.nearest[0] == far and far < np.inf:
        work.nearest[0] = np.inf
        look(f, c, place, b)
    return work.nearest[0]


@jit
def may_turn(f, y, e, low, high, nearest):
    """`turns_near` of the cell that begins in the state y, where the steady motion is Re(Z e)."""
    n, swing = f.A.shape[0], f.Z[0] * e
    p0, p1, p2, p3, rest = f.middle[n, 0], f.middle[n, 1], f.middle[n, 2], f.middle[n, 3], f.rest[n] + f.swing_rest
    for r in range(n):
        p0 += y[r] * f.middle[r, 0]
        p1 += y[r] * f.middle[r, 1]
        p2 += y[r] * f.middle[r, 2]
        p3 += y[r] * f.middle[r, 3]
        rest += abs(y[r]) * f.rest[r]
    p0, p1 = p0 + (swing * f.swing[0]).real, p1 + (swing * f.swing[1]).real
    p2, p3 = p2 + (swing * f.swing[2]).real, p3 + (swing * f.swing[3]).real
    return turns_near(p0, p1, p2, p3, rest, low, high, nearest)


@jit
def is_touch(c, i):
    """Whether event i is a turning point of the gap: it grazes, or takes part in nothing."""
    return c.sides[i] == 0.0 or (c.kind >= GRAZE and i == c.index)


@jit
def look(f, c, place, b):
    """Lower `work.nearest` to the nearest turning point."""
    K, n, omega, work = len(place.x), f.A.shape[0], f.numbers[OMEGA], b.work[0]
    nearest, y, other = work.nearest, work.flying[0], work.flying[1]
    aside = ASIDE / omega
    for i in range(K):
        begin, length = place.x[i, n], b.events[i].length
        for r in range(n):
            y[r] = b.events[i].after[r]
        if is_touch(c, i):
            polynomial(n, f.series, aside, work.other[0])
            shift(f, work.other[0], y, other)
            begin, length = begin + omega * aside, length - aside
        if is_touch(c, (i + 1) % K):
            length -= b.tail[0].numbers[NEXT] if c.kind == STICK else aside
        if c.rests[i]:
            b.events[i].hold = hold_of(f, c.compliant, c.sides[i], place.x[i], b.events[i], work)
            begin += place.x[i, n + 1]
        if leaves_slowly(c, i):
            away = apart(f, y, cmath.exp(1j * begin), length, work.cell)
            polynomial(n, f.series, away, work.other[0])
            shift(f, work.other[0], y, other)
            begin, length = begin + omega * away, length - away
        e, turn = cmath.exp(1j * begin), cmath.exp(1j * omega * f.width)
        cells = int(length / f.width)
        for k in range(cells + 1):
            width = min(f.width * OVERLAP, length - k * f.width)
            if width > 0.0 and may_turn(f, y, e, f.numbers[LOW], f.numbers[HIGH], nearest[0]):
                e = cmath.exp(1j * (begin + omega * k * f.width))  # products have rounded from cell to cell
                expand_gap(f, y, e, work.cell)
                if k == 0:
                    work.cell[1] = speed_after(f, c, i, b.events[i], work.cell[1])
                if extremes_of_cell(work.cell, width, f.numbers[LOW], f.numbers[HIGH], nearest, work.waiting):
                    nearest[1] = begin + omega * (nearest[1] + k * f.width)
            if k < cells:
                shift(f, f.powers[0], y, other)
                e *= turn


@jit
def apart(f, y, e, length, cell):
    """Time from the end of a rest, as long as the gap leaves the stop like its third power: it does not turn."""
    expand_gap(f, y, e, cell)
    u = min(f.width, length)
    while u > 1e-9 * f.width:
        most = 0.0
        for k in range(4, ORDER + 1):
            most += k * abs(cell[k]) * u ** (k - 3)
        if most < 3.0 * abs(cell[3]):
            break
        u *= 0.5
    return u
