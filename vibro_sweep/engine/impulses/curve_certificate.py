"""The certificate of an orbit on a bifurcation curve: how far its turning points stay from their stops."""

import cmath
import math

import numpy as np

from vibro_sweep.engine.impulses.chatter import NEXT
from vibro_sweep.engine.impulses.extremes import OVERLAP, extremes_of_cell
from vibro_sweep.engine.impulses.factors import square
from vibro_sweep.engine.impulses.locus import GRAZE, STICK
from vibro_sweep.engine.impulses.plane import HIGH, LOW, OMEGA, polynomial
from vibro_sweep.engine.impulses.tables import ORDER
from vibro_sweep.engine.simd.jit import jit

FARTHER = 0.05  # relative: where the nearest turning point is looked for first, beyond that of the last point
ASIDE = 1e-3  # of 1/omega beside a graze in which its own turning point lies


@jit
def certify(f, c, place, b):
    """The least distance of a turning point of the gap from its stop; that of the graze itself is left out.

    b.nearest: the distance, its time and the side. Where all is farther away than at the last point, cells are passed
    over; if nothing nearer is found, they are looked at again.
    """
    weigh(f, b.weights)
    far = b.nearest[0] + FARTHER * abs(b.nearest[0])
    if not far < np.inf:
        far = np.inf
    b.nearest[0] = far
    look(f, c, place, b)
    if b.nearest[0] == far and far < np.inf:
        b.nearest[0] = np.inf
        look(f, c, place, b)
    return b.nearest[0]


@jit
def weigh(f, weights):
    """Bounds, over a cell, of how far the gap moves by each coordinate of the state, which is 1, and by the shift."""
    n, power = f.n, f.width * OVERLAP
    for r in range(n + 1):
        weights[r] = 0.0
    for q in range(1, ORDER + 1):
        for r in range(n + 1):
            weights[r] += power * abs(f.series[q, 0, r])
        power *= f.width * OVERLAP


@jit
def is_far(f, h, e, swing, weights, distance):
    """Whether the gap stays farther than `distance` from both stops over a cell; swing: a bound of the steady part."""
    n = f.n
    gap, moved = h[0] + (f.Z[0] * e).real, swing + weights[n]
    for r in range(n):
        moved += weights[r] * abs(h[r])
    return f.numbers[HIGH] - gap - moved > distance and gap - moved - f.numbers[LOW] > distance


@jit
def look(f, c, place, b):
    """Lower `b.nearest` to the nearest turning point."""
    K, n = len(place.t), f.n
    N, omega = n // 2, f.numbers[OMEGA]
    cell, nearest, h, after = b.cell, b.nearest, b.after[0], b.after[1]
    aside, most = ASIDE / omega, math.sqrt(square(f.Z[0])) * omega * f.width * OVERLAP
    for i in range(K):
        end = place.t[i + 1] if i + 1 < K else place.t[0] + f.P
        begin = place.t[i]
        for r in range(n):
            h[r] = b.room.h[i, r]
        h[N] += place.D[i]
        if c.kind >= GRAZE:
            if i == c.index:
                polynomial(n, f.series, aside, b.room.other[0])
                for r in range(n):
                    after[r] = b.room.other[0, r, n]
                    for k in range(n):
                        after[r] += b.room.other[0, r, k] * h[k]
                for r in range(n):
                    h[r] = after[r]
                begin += aside
            if (i + 1) % K == c.index:
                end -= b.tail.numbers[NEXT] if c.kind == STICK else aside
        length = end - begin
        e, turn = cmath.exp(1j * (omega * begin + f.tau)), cmath.exp(1j * omega * f.width)
        cells = int(length / f.width)
        for k in range(cells + 1):
            width = min(f.width * OVERLAP, length - k * f.width)
            if width > 0.0 and not is_far(f, h, e, most, b.weights, nearest[0]):
                expand(f, h, e, cell)
                if extremes_of_cell(cell, width, f.numbers[LOW], f.numbers[HIGH], nearest, b.waiting):
                    nearest[1] += begin + k * f.width
            if k < cells:
                for r in range(n):
                    after[r] = f.powers[0, r, n]
                    for q in range(n):
                        after[r] += f.powers[0, r, q] * h[q]
                for r in range(n):
                    h[r] = after[r]
                e *= turn


@jit
def expand(f, h, e, cell):
    """The gap's Taylor coefficients from the state h, where the steady motion is Re(Z e)."""
    n, omega, swing = f.n, f.numbers[OMEGA], f.Z[0] * e
    for q in range(ORDER + 1):
        total = f.series[q, 0, n]
        for r in range(n):
            total += f.series[q, 0, r] * h[r]
        cell[q] = total + swing.real
        swing *= 1j * omega / (q + 1)
