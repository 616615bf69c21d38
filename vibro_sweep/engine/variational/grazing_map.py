"""The discontinuity mapping with its derivatives by the state and by every parameter, one half period at a time.

motion/discontinuity.py iterates the same map in sweeps, on tables of flights. Both take the impact from
engine/graze.py; here each line is followed by its derivative. For any oscillator that is symmetric but for its stops,
with the gap n.x and p = M^-1 n/(n.M^-1 n): seen from the side's stop, D = X - X* is the displacement from the grazing
point, and

    a = -omega^2 n.x* [+ n.(rows of A) D],    psi = n.x - b
    C1: X -> X - (1 + R) w e^{-A late} (0, p)  where there is an impact,    then    D -> L D

with the term in brackets at order 2 alone (eqs. 38, 39, 41).
"""

from typing import NamedTuple

import numpy as np

from vibro_sweep.engine.graze import impact_near_graze, impact_slopes
from vibro_sweep.engine.simd.jit import exported, jit
from vibro_sweep.engine.variational.parameter_sensitivity import gap_of, place_of
from vibro_sweep.engine.variational.propagator import propagate


class Expansion(NamedTuple):
    """The orbit about which the map is expanded, and the order."""

    order: int
    right: bool  # which stops there are
    left: bool
    graze: np.ndarray  # X* (2 N,)
    d_graze: np.ndarray  # (2 N, columns): its derivative in each column
    pull: np.ndarray  # (2 N,): acceleration of the gap as a function of the state
    d_pull: np.ndarray  # (2 N, columns)
    parameter: np.ndarray  # (columns,): which of A_p belongs to a column; -1: none


@jit
def jump(e, x, side, X, dX, w, row):
    """C1 (side 1) or C2 (side -1). row (5 + 2 N,) receives the impact: place, side, speed, X. Returns whether there is
    one.
    """
    second, states, n = x.order == 2, len(x.graze), place_of(side)
    R, psi, v = e.restitution[n], side * (gap_of(e, X, 0) - e.walls[n]), side * gap_of(e, X, 1)
    top = gap_of(e, x.graze, 0)
    a = -e.omega * e.omega * top
    if second:
        for k in range(states):
            a += x.pull[k] * (side * X[k] - x.graze[k])
    speed, late = impact_near_graze(a, psi, v, second)
    if speed == 0.0:
        return False
    row[3], row[4] = side, side * speed
    for k in range(states):
        row[5 + k] = X[k]
    propagate(e.A, e.A_p, e.rate, -e.omega * late, w)
    for i in range(states):  # e^{-A late} (0, p), and what A makes of it
        w.column[i] = 0.0
        for m in range(states // 2):
            w.column[i] += w.E[i, 2 * m + 1] * e.push[m]
    for j in range(dX.shape[1]):
        d_psi = side * (gap_of(e, dX[:, j], 0) - e.wall_slopes[n, j])
        dv = side * gap_of(e, dX[:, j], 1)
        da = -e.omega * (2.0 * e.omega_slopes[j] * top + e.omega * gap_of(e, x.d_graze[:, j], 0))
        if second:
            for k in range(states):
                da += x.pull[k] * (side * dX[k, j] - x.d_graze[k, j])
                da += x.d_pull[k, j] * (side * X[k] - x.graze[k])
        d_speed, d_late = impact_slopes(a, psi, v, speed, late, second, da, d_psi, dv)
        d_angle = -(e.omega * d_late + e.omega_slopes[j] * late)
        d_push = (1.0 + R) * d_speed + speed * e.restitution_slopes[n, j]
        for i in range(states):
            de = 0.0
            for k in range(states):
                de += e.A[i, k] * w.column[k] * d_angle
            for m in range(states // 2):
                de += w.E[i, 2 * m + 1] * e.push_slopes[m, j]
                if x.parameter[j] >= 0:
                    de += w.E_p[x.parameter[j], i, 2 * m + 1] * e.push[m]
            dX[i, j] -= side * (d_push * w.column[i] + (1.0 + R) * speed * de)
    for i in range(states):
        X[i] -= side * (1.0 + R) * speed * w.column[i]
    return True


@jit
def fly_half(e, x, side, X, dX, w):
    """Phi_{T/2} from the side's graze to the other's: X -> -X* + L (X - X*), with X* for the right side."""
    states = len(x.graze)
    for i in range(states):
        w.column[i] = X[i] - side * x.graze[i]
    for j in range(dX.shape[1]):
        for i in range(states):
            w.term[i, 0] = -side * x.d_graze[i, j]
            for k in range(states):
                w.term[i, 0] += w.E[i, k] * (dX[k, j] - side * x.d_graze[k, j])
                if x.parameter[j] >= 0:
                    w.term[i, 0] += w.E_p[x.parameter[j], i, k] * w.column[k]
        for i in range(states):
            dX[i, j] = w.term[i, 0]
    for i in range(states):
        X[i] = -side * x.graze[i]
        for k in range(states):
            X[i] += w.E[i, k] * w.column[k]


@exported
def iterate(e, x, half_periods, states, ends, derivatives, impacts, counts, w):
    """Iterate the map over so many half periods from each of `states` (n, 2 N), the first from the phase of the right
    graze.

    ends (n, 2 N), derivatives (n, 2 N, columns), impacts (n, half_periods + 1, 5 + 2 N), counts (n,) get results.
    """
    for n in range(len(states)):
        X, dX = ends[n], derivatives[n]
        counts[n] = 0
        for i in range(states.shape[1]):
            X[i] = states[n, i]
            for j in range(dX.shape[1]):
                dX[i, j] = 1.0 if i == j else 0.0
        for half in range(half_periods):
            side = 1.0 if half % 2 == 0 else -1.0
            row = impacts[n, counts[n]]
            if (x.right if side > 0.0 else x.left) and jump(e, x, side, X, dX, w, row):
                row[0], row[1], row[2] = half // 2, 0.5 * (half % 2) * e.cells, 0.0
                counts[n] += 1
            propagate(e.A, e.A_p, e.rate, np.pi, w)
            fly_half(e, x, side, X, dX, w)
