"""Points of oscillators whose dampers couple modes, for pages (page_kernel.py).

From K and C in the metric of the masses; there is no frame of tangent vectors, so that exponents are NaN, no motion is
confined, and rates are bounds: where no motion is stiffer than k, nor damped more than c, no root of s^2 + c s + k is
beyond max(sqrt k, c).
"""

import math

import numpy as np

from vibro_sweep.engine.points.plain_coordinates import set_constrained, set_coordinates, set_equations
from vibro_sweep.engine.points.plain_points import APART
from vibro_sweep.engine.simd.jit import jit


@jit
def set_coupled_point(q, p, w):
    """Fill a point, with bounds in place of modes in w. Returns whether its equations while a stop holds the gap were
    found."""
    n, stiffest, strongest = len(q.M), largest_sum(w.K), largest_sum(w.C)
    for j in range(n):
        w.square[j], w.damping[j] = stiffest, strongest
    p.omega, p.tau, p.rate = q.omega, q.tau, max(math.sqrt(stiffest), strongest)
    p.constrained_rate, p.rounding, p.apart = p.rate, 0.0, p.rate > APART * p.omega
    set_coordinates(q, p, w)
    set_equations(q, p, w)
    p.middle, p.swing = 0.0, math.inf
    for m in range(n):
        p.frame_eta[m], p.frame_square[m], p.frame_scale[m] = 0.0, 0.0, 1.0
    for i in range(2 * n):
        p.steady[i] = 0.0
        for j in range(2 * n):
            p.confining[i, j], p.to_frame[i, j], p.from_frame[i, j] = 0.0, np.nan, np.nan
    return set_constrained(q, p, w)


@jit
def largest_sum(matrix):
    """The largest sum of moduli in a row, which no eigenvalue exceeds."""
    largest = 0.0
    for i in range(len(matrix)):
        total = 0.0
        for j in range(len(matrix)):
            total += abs(matrix[i, j])
        largest = max(largest, total)
    return largest
