"""The discontinuity mapping with its derivatives by the state and by every parameter, one half period at a time.

motion/discontinuity.py iterates the same map in sweeps, on tables of flights. Both take the impact from
engine/graze.py; here each line is followed by its derivative. Seen from the side's stop, D = X - X* is the displacement
from the grazing point, and

    a = -omega^2 x1* [+ (row of A) D],    psi = x1 - b
    C1: X -> X - (1 + R) w e^{-A late} e_v  where there is an impact,    then    D -> L D

with the term in brackets at order 2 alone (eqs. 38, 39, 41).
"""

from typing import NamedTuple

import numpy as np

from vibro_sweep.engine.graze import impact_near_graze, impact_slopes
from vibro_sweep.engine.simd.jit import entry, jit
from vibro_sweep.engine.variational.propagator import propagate
from vibro_sweep.engine.variational.sensitivity import place_of

OMEGA_COLUMN = 8  # the five parameters of flight stand in columns 4 .. 8


class Expansion(NamedTuple):
    """Where the map is expanded, and to which order."""

    order: int
    right: bool  # which stops there are
    left: bool
    graze: np.ndarray  # X* (4,)
    d_graze: np.ndarray  # (4, 4 or 12): its derivative in each column


@jit
def of_rate(e, j):
    """Derivative of omega in column j."""
    return 1.0 if j == OMEGA_COLUMN else 0.0


@jit
def acceleration_row(e, j, k):
    """Derivative, in column j, of the acceleration of M1 by X_k."""
    change = of_rate(e, j) * e.A[1, k]
    return change + (e.omega * e.A_p[j - 4, 1, k] if 4 <= j < 4 + len(e.A_p) else 0.0)


@jit
def jump(e, x, side, X, dX, w, row):
    """C1 (side 1) or C2 (side -1). row (7,) receives the impact as in `Records`. Returns whether there was one."""
    second = x.order == 2
    n = place_of(side)
    R, psi, v = e.restitution[n], side * (X[0] - e.walls[n]), side * X[1]
    a = -e.omega * e.omega * x.graze[0]
    if second:
        for k in range(4):
            a += e.omega * e.A[1, k] * (side * X[k] - x.graze[k])
    speed, late = impact_near_graze(a, psi, v, second)
    if speed == 0.0:
        return False
    row[3], row[4], row[5], row[6] = side, side * speed, X[2], X[3]
    propagate(e.A, e.A_p, e.rate, -e.omega * late, w)
    for j in range(dX.shape[1]):
        d_psi = side * (dX[0, j] - e.wall_slopes[n, j])
        dv = side * dX[1, j]
        da = -e.omega * (2.0 * of_rate(e, j) * x.graze[0] + e.omega * x.d_graze[0, j])
        if second:
            for k in range(4):
                da += e.omega * e.A[1, k] * (side * dX[k, j] - x.d_graze[k, j])
                da += acceleration_row(e, j, k) * (side * X[k] - x.graze[k])
        d_speed, d_late = impact_slopes(a, psi, v, speed, late, second, da, d_psi, dv)
        d_angle = -(e.omega * d_late + of_rate(e, j) * late)
        d_push = (1.0 + R) * d_speed + speed * e.restitution_slopes[n, j]
        for i in range(4):
            de = w.E_p[j - 4, i, 1] if 4 <= j < 4 + len(e.A_p) else 0.0
            for k in range(4):
                de += e.A[i, k] * w.E[k, 1] * d_angle
            dX[i, j] -= side * (d_push * w.E[i, 1] + (1.0 + R) * speed * de)
    for i in range(4):
        X[i] -= side * (1.0 + R) * speed * w.E[i, 1]
    return True


@jit
def fly_half(e, x, side, X, dX, w):
    """Phi_{T/2} from the side's graze to the other's: X -> -X* + L (X - X*), with X* for the right side."""
    for i in range(4):
        w.column[i] = X[i] - side * x.graze[i]
    for j in range(dX.shape[1]):
        for i in range(4):
            w.term[i, 0] = -side * x.d_graze[i, j]
            for k in range(4):
                w.term[i, 0] += w.E[i, k] * (dX[k, j] - side * x.d_graze[k, j])
                if 4 <= j < 4 + len(e.A_p):
                    w.term[i, 0] += w.E_p[j - 4, i, k] * w.column[k]
        for i in range(4):
            dX[i, j] = w.term[i, 0]
    for i in range(4):
        X[i] = -side * x.graze[i]
        for k in range(4):
            X[i] += w.E[i, k] * w.column[k]


@entry
def iterate(e, x, halves, states, ends, derivatives, impacts, counts, w):
    """So many half periods from each of `states` (n, 4), the first from the phase of the right graze.

    ends (n, 4), derivatives (n, 4, 4 or 12), impacts (n, halves, 7) and counts (n,) receive the results.
    """
    for n in range(len(states)):
        X, dX = ends[n], derivatives[n]
        counts[n] = 0
        for i in range(4):
            X[i] = states[n, i]
            for j in range(dX.shape[1]):
                dX[i, j] = 1.0 if i == j else 0.0
        for half in range(halves):
            side = 1.0 if half % 2 == 0 else -1.0
            row = impacts[n, counts[n]]
            if (x.right if side > 0.0 else x.left) and jump(e, x, side, X, dX, w, row):
                row[0], row[1], row[2] = half // 2, 0.5 * (half % 2) * e.cells, 0.0
                counts[n] += 1
            propagate(e.A, e.A_p, e.rate, np.pi, w)
            fly_half(e, x, side, X, dX, w)
