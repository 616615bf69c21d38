"""The oscillator over two parameters, one, or none: its flight, forced motion and stops, with exact derivatives.

In contact coordinates z = (q, u) (flow.py) the motion is z = y + Re(Z e^{i phi}), phi = omega t + tau, where the flight
y' = A (y, 1) knows the constant force alone.

All numbers are polynomials of the parameters (analysis/continuation/oscillators.py fits them), so that kernels may go
to any of their values. Where A changes there, the tables of the flight are built anew at each point.
"""

import math
from functools import cache

import numpy as np

from vibro_sweep.engine.continuation.factors import factorise, square, substitute
from vibro_sweep.engine.continuation.flight_tables import build_powers, build_series, columns_of
from vibro_sweep.engine.impulses.extremes import MIDDLE
from vibro_sweep.engine.impulses.taylor_orders import ORDER
from vibro_sweep.engine.simd.jit import jit
from vibro_sweep.engine.simd.memory import record

LOW, HIGH, ONE_PLUS_R_LOW, ONE_PLUS_R_HIGH, OMEGA = range(5)  # of `numbers`
NUMBERS = 5
LAWS = 6  # k_stop, c_stop and preload over m_e, of the left stop and of the right one, where a stop is compliant
DEGREE = 12  # of the polynomials in each parameter, at most
BITS = 18


def count_of(masses: int, compliant: bool) -> int:
    """Numbers that are polynomials: A, both forces, laws of contact where a stop is compliant, `numbers`."""
    n = 2 * masses
    return n * (n + 1) + n + LAWS * compliant + NUMBERS


@cache
def plane_of(masses: int, compliant: bool = False) -> np.dtype:
    """N masses, n = 2N. Slopes: derivatives by the first and the second parameter."""
    n, count = 2 * masses, count_of(masses, compliant)
    return record([
        ("parameters", np.int64),  # that are free
        ("centre", float, 2),
        ("reach", float, 2),
        ("degree", np.int64, 2),
        ("moves", np.int64, 2),  # 1 where A depends on that parameter
        ("is_still", np.int64),  # 1 where the forced motion does not depend on the parameters
        ("is_known", np.int64),  # 1 after it was computed
        ("width", float),  # of a cell
        ("bits", np.int64),  # of the number of cells of the longest flight
        ("half_turns", float),  # of the force in a period
        ("by_force", np.int64),  # 1 where contacts with damped stops end when the force is 0
        ("has_unseen", np.int64),  # 1 where there are free modes that the contact does not see
        ("closing", float, (n, n + 1)),  # of an orbit alone without rests, see guesses.py
        ("unseen", float, (n, n)),  # of these the momenta times the places, which the closure keeps by this
        ("fit", float, (DEGREE + 1, DEGREE + 1, count)),  # coefficients of the powers of (p - centre)/reach
        ("exact", float, (count,)),  # what `values` are at a point, of the oscillator itself
        ("shift", float, (count,)),  # of the polynomials, so that they pass through `exact`
        ("values", float, (count,)),
        ("slopes", float, (2, count)),
        ("A", float, (n, n + 1)),
        ("A_slopes", float, (2, n, n + 1)),
        ("numbers", float, (NUMBERS,)),
        ("number_slopes", float, (2, NUMBERS)),
        ("Z", complex, (n,)),
        ("Z_slopes", complex, (2, n)),
        ("series", float, (ORDER + 1, n, columns_of(n))),  # first rows of B^k/k!, B = (A; 0)
        ("series_slopes", float, (2, ORDER + 1, n, columns_of(n))),
        ("powers", float, (BITS, n, columns_of(n))),  # exp(B width 2^j)
        ("power_slopes", float, (2, BITS, n, columns_of(n))),
        ("middle_weights", float, (ORDER + 1, MIDDLE)),  # see extremes.py
        ("rest_weights", float, (ORDER + 1,)),
        ("middle", float, (n + 1, MIDDLE)),  # of the gap over a cell, by each coordinate of the state, and the shift
        ("rest", float, (n + 1,)),
        ("swing", complex, (MIDDLE,)),  # the same of Re(Z e), times Z
        ("swing_rest", float),
        ("stiffness", complex, (masses, masses)),  # factors of what Z is solved from
        ("order", np.int64, (masses,)),
    ])  # fmt: skip


@jit
def moves(f):
    """Whether A depends on a parameter."""
    return f.moves[0] > 0 or f.moves[1] > 0


@jit
def law_at(f, side):
    """The index in `values` of the stiffness of a compliant stop, which its damping and preload follow."""
    n = f.A.shape[0]
    return n * (n + 2) + (LAWS // 2 if side > 0 else 0)


@jit
def fit_at(f, p, q):
    """Values and slopes of the polynomials at the parameters (p, q)."""
    s, u = (p - f.centre[0]) / f.reach[0], (q - f.centre[1]) / f.reach[1]
    n = f.A.shape[0]
    first = n * (n + 2) if f.is_still > 0 and f.is_known > 0 and not moves(f) else 0
    for i in range(first, len(f.values)):
        value, by_s, by_u = 0.0, 0.0, 0.0
        for k in range(f.degree[0], -1, -1):
            row, slope = 0.0, 0.0
            for l in range(f.degree[1], -1, -1):  # noqa: E741
                slope = slope * u + row
                row = row * u + f.fit[k, l, i]
            by_s = by_s * s + value
            value = value * s + row
            by_u = by_u * s + slope
        f.values[i] = value + f.shift[i]
        f.slopes[0, i], f.slopes[1, i] = by_s / f.reach[0], by_u / f.reach[1]


@jit
def take_shift(f, p, q, exact):
    """Let the polynomials pass through the values `exact` at (p, q), or as they are."""
    for i in range(len(f.shift)):
        f.shift[i] = 0.0
    if exact:
        fit_at(f, p, q)
        for i in range(len(f.shift)):
            if math.isfinite(f.exact[i]):
                f.shift[i] = f.exact[i] - f.values[i]


@jit
def move_exactly(f, p, q):
    """Move the oscillator to the parameters (p, q) with the values `exact`, and slopes of the polynomials. False as of
    `spread`."""
    fit_at(f, p, q)
    for i in range(len(f.values)):
        f.values[i] = f.exact[i]
    return spread(f)


@jit
def spread(f):
    """Matrices, forced motion and tables from `values` and `slopes`. False in the resonance of an undamped mode."""
    n = f.A.shape[0]
    N = n // 2
    size, last = n * (n + 1), len(f.values) - NUMBERS
    for i in range(NUMBERS):
        f.numbers[i] = f.values[last + i]
        for j in range(f.parameters):
            f.number_slopes[j, i] = f.slopes[j, last + i]
    if moves(f) or f.is_known == 0:
        for r in range(n):
            for c in range(n + 1):
                f.A[r, c] = f.values[r * (n + 1) + c]
                for j in range(f.parameters):
                    f.A_slopes[j, r, c] = f.slopes[j, r * (n + 1) + c]
        if moves(f):
            build_series(f)
            build_powers(f)
        build_middle(f)
    if f.is_still > 0 and f.is_known > 0:
        return True
    f.is_known = 1
    # Z_q = W Y, Z_u = i omega Y,    (-omega^2 - i omega A_uu - A_uq W) Y = cosine - i sine
    omega, S = f.numbers[OMEGA], f.stiffness
    for r in range(N):
        for c in range(N):
            S[r, c] = -f.A[N + r, c] - 1j * omega * f.A[N + r, N + c]
        S[r, 0] -= by_push(f, f.A, f.A, r)
        S[r, r] -= omega * omega
        f.Z[r] = f.values[size + r] - 1j * f.values[size + N + r]
    if not square(factorise(S, N, f.order)) > 0.0:
        return False
    substitute(S, N, f.order, f.Z)
    for r in range(N):
        f.Z[N + r] = 1j * omega * f.Z[r]
    for j in range(f.parameters):
        turn = f.number_slopes[j, OMEGA]
        for r in range(N):
            change = f.slopes[j, size + r] - 1j * f.slopes[j, size + N + r] + 2.0 * omega * turn * f.Z[r]
            for k in range(N):
                change += f.A_slopes[j, N + r, k] * f.Z[k]
                change += 1j * (turn * f.A[N + r, N + k] + omega * f.A_slopes[j, N + r, N + k]) * f.Z[k]
            change += (by_push(f, f.A_slopes[j], f.A, r) + by_push(f, f.A, f.A_slopes[j], r)) * f.Z[0]
            f.Z_slopes[j, r] = change
        substitute(S, N, f.order, f.Z_slopes[j])
        for r in range(N):
            f.Z_slopes[j, N + r] = 1j * (turn * f.Z[r] + omega * f.Z_slopes[j, r])
        for r in range(1, N):
            f.Z_slopes[j, r] += f.A[r, N] * f.Z_slopes[j, 0] + f.A_slopes[j, r, N] * f.Z[0]
    for r in range(1, N):
        f.Z[r] += f.A[r, N] * f.Z[0]
    build_swing(f)
    return True


@jit
def build_middle(f):
    """Build the motion of the gap over a cell from its Taylor coefficients."""
    for r in range(f.A.shape[0] + 1):
        f.rest[r] = 0.0
        for k in range(MIDDLE):
            f.middle[r, k] = 0.0
        for q in range(ORDER + 1):
            f.rest[r] += abs(f.series[q, 0, r]) * f.rest_weights[q]
            for k in range(MIDDLE):
                f.middle[r, k] += f.series[q, 0, r] * f.middle_weights[q, k]


@jit
def build_swing(f):
    """The same of the steady motion."""
    power, size = 1.0 + 0j, 1.0
    f.swing_rest = 0.0
    for k in range(MIDDLE):
        f.swing[k] = 0.0
    for q in range(ORDER + 1):
        f.swing_rest += size * f.rest_weights[q]
        for k in range(MIDDLE):
            f.swing[k] += power * f.middle_weights[q, k]
        power *= 1j * f.numbers[OMEGA] / (q + 1)
        size *= f.numbers[OMEGA] / (q + 1)
    f.swing_rest *= math.sqrt(square(f.Z[0]))


@jit
def by_push(f, A, W, r):
    """Row r of the first column of A_uq (W - 1): of both matrices, or of the slope of one of them."""
    N, total = f.A.shape[0] // 2, 0.0
    for k in range(1, N):
        total += A[N + r, k] * W[k, N]
    return total


@jit
def move_to(f, p, q):
    """Numbers and tables at the parameters (p, q)."""
    fit_at(f, p, q)
    return spread(f)


@jit
def shift(f, table, y, other):
    """y <- table (y, 1)."""
    n = f.A.shape[0]
    for r in range(n):
        other[r] = table[r, n]
        for k in range(n):
            other[r] += table[r, k] * y[k]
    for r in range(n):
        y[r] = other[r]


@jit
def expand_gap(f, y, e, cell):
    """The gap's Taylor coefficients from the state y, where the steady motion is Re(Z e)."""
    n, omega, swing = f.A.shape[0], f.numbers[OMEGA], f.Z[0] * e
    for q in range(ORDER + 1):
        total = f.series[q, 0, n]
        for r in range(n):
            total += f.series[q, 0, r] * y[r]
        cell[q] = total + swing.real
        swing *= 1j * omega / (q + 1)
