"""Tangent vectors along an orbit, and from them the Lyapunov spectrum.

Four vectors are kept as the columns of Z, in the frame z = (g_1 xi_1, xi_1' + eta_1 xi_1, g_2 xi_2, xi_2' + eta_2
xi_2) with g_j = |omega_dj|, in which the flight of mode j is e^{-eta_j u} times a rotation: in this metric the
exponents of a non-impacting orbit are exact after any time, where those of (x, v) would only converge like 1/t.
(Overdamped: times a symmetric matrix, and exact as soon as its eigenvectors are found.)

Flight is not applied step by step but collected as four numbers (c_1, s_1, c_2, s_2), and applied at the next impact.
"""

import math

import numpy as np

from vibro_sweep.kernels.flight import ORDER, decaying
from vibro_sweep.kernels.jit import jit

CONDITION = 1e3  # bound on the condition number of Z past which it is orthonormalised


# Tangent vectors of one orbit.
TANGENT = np.dtype(
    [
        ("wanted", np.bool_),  # else nothing is computed
        ("lost", np.int64),  # dimensions: two by sticking, one by an impact without restitution
        ("cell", np.int64),  # the cell, and
        ("offset", float),  # the offset in it, up to which `flight` reaches
        ("flight", float, 4),  # c_1, s_1, c_2, s_2 of the flight since Z was last touched
        ("stretch", np.int64),  # whole cells of that flight
        ("Z", float, (4, 4)),  # columns are vectors
        ("volume", float),  # |det Z|, from the identity det S = R^2
        ("growth", float, 4),  # products of the diagonals of R in Z = Q R
        ("logs", float, 4),  # their logarithms, taken before they leave the range of the floats
    ]
)


@jit
def begin(t):
    """Four orthonormal vectors at the section."""
    t.wanted, t.lost = True, 0
    for i in range(4):
        for j in range(4):
            t.Z[i, j] = 1.0 if i == j else 0.0
        t.flight[i] = 1.0 - i % 2
    t.cell, t.offset, t.stretch, t.volume = 0, 0.0, 0, 1.0
    start_record(t)


@jit
def join(t, q, c1, s1, c2, s2):
    """Lengthen the collected flight by a flight with these factors."""
    a, b = t.flight[0], t.flight[1]
    t.flight[0] = a * c1 - q.frame_square[0] * (b * s1)
    t.flight[1] = a * s1 + b * c1
    a, b = t.flight[2], t.flight[3]
    t.flight[2] = a * c2 - q.frame_square[1] * (b * s2)
    t.flight[3] = a * s2 + b * c2


@jit
def fly(t, q, nodes, k, s):
    """Lengthen the collected flight to the offset s in cell k of this period."""
    cells, u = k - t.cell, s - t.offset
    if u < 0.0:
        cells -= 1
        u += q.width
    t.cell, t.offset = k, s
    while t.stretch + cells > q.stretch:  # or all vectors would become the one that decays least
        part = q.stretch - t.stretch
        frame = nodes[part].frame
        join(t, q, frame[0], frame[1], frame[2], frame[3])
        catch_up(t, q)
        cells -= part
    t.stretch += cells
    if cells > 0:
        frame = nodes[cells].frame
        join(t, q, frame[0], frame[1], frame[2], frame[3])
    if u > 0.0 and q.stiff:
        eta1, eta2 = -q.frame_series[1, 0], -q.frame_series[1, 2]
        c1, s1, _, _ = decaying(eta1, q.frame_square[0] + eta1 * eta1, u)
        c2, s2, _, _ = decaying(eta2, q.frame_square[1] + eta2 * eta2, u)
        join(t, q, c1, s1, c2, s2)
    elif u > 0.0:
        series = q.frame_series
        c1, s1, c2, s2 = 0.0, 0.0, 0.0, 0.0
        for n in range(ORDER - 1, -1, -1):
            c1 = c1 * u + series[n, 0]
            s1 = s1 * u + series[n, 1]
            c2 = c2 * u + series[n, 2]
            s2 = s2 * u + series[n, 3]
        join(t, q, c1, s1, c2, s2)


@jit
def apply_flight(t, q):
    """Z after the collected flight."""
    for j in range(2):
        c, s = t.flight[2 * j], t.flight[2 * j + 1]
        above, below = q.frame_scale[j] * s, -q.frame_square[j] / q.frame_scale[j] * s
        for i in range(4):
            first, second = t.Z[2 * j, i], t.Z[2 * j + 1, i]
            t.Z[2 * j, i] = c * first + above * second
            t.Z[2 * j + 1, i] = below * first + c * second
        t.volume *= c * c - above * below
        t.flight[2 * j], t.flight[2 * j + 1] = 1.0, 0.0
    t.stretch = 0


@jit
def end_period(t, q, nodes):
    """Carry the collected flight over the section."""
    fly(t, q, nodes, q.cells, 0.0)
    t.cell = 0


@jit
def catch_up(t, q):
    """Bring Z to where the collected flight ends, orthonormal."""
    apply_flight(t, q)
    orthonormalise(t)


@jit
def saltate(t, q, R, steepness):
    """Z across an impact, by the saltation matrix S = DG + (F+ - DG F-) n^T/(n . F-).

    In (x1, v1, x2, v2), with steepness = (a1+ + R a1-)/v1- and kappa = 2 zeta/mu_m: dx1 -> -R dx1, dv1 -> steepness
    dx1 - R dv1, dv2 -> dv2 - kappa (1 + R) dx1. det S = R^2.
    """
    apply_flight(t, q)
    for j in range(4):
        dx = q.from_frame[0, 0] * t.Z[0, j] + q.from_frame[0, 2] * t.Z[2, j]
        dv = q.from_frame[1, 0] * t.Z[0, j] + q.from_frame[1, 1] * t.Z[1, j]
        dv += q.from_frame[1, 2] * t.Z[2, j] + q.from_frame[1, 3] * t.Z[3, j]
        to_x1 = -(1.0 + R) * dx
        to_v1 = steepness * dx - (1.0 + R) * dv
        to_v2 = -q.kappa * (1.0 + R) * dx
        for i in range(4):
            t.Z[i, j] += q.to_frame[i, 0] * to_x1 + q.to_frame[i, 1] * to_v1 + q.to_frame[i, 3] * to_v2
    watch(t, R * R)


@jit
def watch(t, determinant):
    """Orthonormalise, after a step with this |determinant|, if the vectors come to lie too close together."""
    t.volume *= determinant
    if determinant == 0.0:
        t.lost = max(t.lost, 1)
    if t.lost > 0:
        orthonormalise(t)
        return
    size = 0.0
    for i in range(4):
        for j in range(4):
            size += t.Z[i, j] * t.Z[i, j]
    if size * size > 8.0 * CONDITION * t.volume:  # the condition number is below 2/det (|Z|^2/4)^2
        orthonormalise(t)


@jit
def orthonormalise(t):
    """Gram-Schmidt: Z = Q R, Z becomes Q and the diagonal of R is added to the growth."""
    Z = t.Z
    for i in range(4):
        square = 0.0
        for row in range(4):
            square += Z[row, i] * Z[row, i]
        length = math.sqrt(square)
        if i >= 4 - t.lost:
            length = 0.0
        inverse = 1.0 / length if length > 0.0 else 0.0
        for row in range(4):
            Z[row, i] *= inverse
        for j in range(i + 1, 4):
            along = 0.0
            for row in range(4):
                along += Z[row, i] * Z[row, j]
            for row in range(4):
                Z[row, j] -= along * Z[row, i]
        t.growth[i] *= length
        if not 1e-100 < t.growth[i] < 1e100:
            t.logs[i] += np.log(t.growth[i])
            t.growth[i] = 1.0
    t.volume = 1.0


@jit
def rest(t, q):
    """Z when M1 comes to rest on a stop: dx1 = dv1 = 0, and two of the four dimensions are lost for good."""
    apply_flight(t, q)
    t.lost = 2
    release(t, q, 1.0, 0.0, 0.0, 1.0)


@jit
def release(t, q, xx, xv, vx, vv):
    """Z after a rest on the stop during which (dx2, dv2) is multiplied by ((xx, xv), (vx, vv))."""
    for j in range(4):
        dx = q.from_frame[2, 0] * t.Z[0, j] + q.from_frame[2, 2] * t.Z[2, j]
        dv = q.from_frame[3, 0] * t.Z[0, j] + q.from_frame[3, 1] * t.Z[1, j]
        dv += q.from_frame[3, 2] * t.Z[2, j] + q.from_frame[3, 3] * t.Z[3, j]
        dx, dv = xx * dx + xv * dv, vx * dx + vv * dv
        for i in range(4):
            t.Z[i, j] = q.to_frame[i, 2] * dx + q.to_frame[i, 3] * dv
    orthonormalise(t)


@jit
def start_record(t):
    """Count growth from here on."""
    for i in range(4):
        t.growth[i] = 1.0
        t.logs[i] = 0.0


@jit
def read_growth(t, q, out):
    """Logarithms of the growth of the four vectors up to this section, -inf for dimensions lost by sticking."""
    catch_up(t, q)
    for i in range(4):
        out[i] = t.logs[i] + np.log(t.growth[i])


@jit
def sort(spectrum, error):
    """Descending; the vectors find their order only as far as the exponents differ."""
    for i in range(1, 4):
        value, doubt, j = spectrum[i], error[i], i
        while j > 0 and spectrum[j - 1] < value:
            spectrum[j], error[j] = spectrum[j - 1], error[j - 1]
            j -= 1
        spectrum[j], error[j] = value, doubt
