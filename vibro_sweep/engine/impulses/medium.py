"""The oscillator along one parameter: the free flight and the stops at any value of it, with exact derivatives.

All numbers are polynomials of the parameter on an interval (analysis/branches/track.py fits them), so that kernels
may go to any value of it. Where the flight changes with the parameter, its tables are built anew at each value.
"""

import math
from functools import cache

import numpy as np

from vibro_sweep.engine.impulses.extremes import MIDDLE
from vibro_sweep.engine.impulses.tables import ORDER
from vibro_sweep.engine.simd.jit import jit
from vibro_sweep.engine.simd.memory import put, record, row

LOW, HIGH, GAIN_LOW, GAIN_HIGH, OMEGA, TAU, PERIOD = range(7)  # of `numbers`; gain: 1 + R, PERIOD: P
NUMBERS = 7


DEGREE = 20  # of the polynomials, at most
BITS = 18


@cache
def medium_of(masses: int) -> np.dtype:
    """zeta' = B zeta for zeta = (q, u, cos(omega t + tau), sin(omega t + tau), 1), n = 2N, m = n + 3 (flow.py)."""
    n, m = 2 * masses, 2 * masses + 3
    return record([
        ("centre", float),  # of the interval of the parameter
        ("reach", float),
        ("degree", np.int64),
        ("moves", np.int64),  # 1 where B depends on the parameter
        ("width", float),  # of a cell
        ("bits", np.int64),  # of the number of cells of the longest flight
        ("fit", float, (DEGREE + 1, m * m + NUMBERS)),  # coefficients of the powers of (p - centre)/reach
        ("values", float, m * m + NUMBERS),  # B and `numbers` one after the other
        ("slopes", float, m * m + NUMBERS),  # their derivatives
        ("B", float, (m, m)),
        ("B_slope", float, (m, m)),
        ("numbers", float, NUMBERS),
        ("number_slopes", float, NUMBERS),
        ("series", float, (ORDER + 1, n, m)),  # first rows of B^k/k!
        ("series_slopes", float, (ORDER + 1, n, m)),
        ("powers", float, (BITS, m, m)),  # exp(B width 2^j)
        ("power_slopes", float, (BITS, m, m)),
        ("gap_rows", float, (m, ORDER + 1)),  # the gap's Taylor coefficients, by columns
        ("step", float, (m, m)),  # exp(B width) by columns
        ("middle_weights", float, (ORDER + 1, MIDDLE)),
        ("rest_weights", float, ORDER + 1),
        ("middle", float, (m, MIDDLE)),  # gap_rows . middle_weights
        ("rest", float, m),  # |gap_rows| . rest_weights
    ])  # fmt: skip


@jit
def combined(x, rows, first):
    """sum_j x_j rows_{first + j}."""
    total = x[0] * row(rows, first)
    for j in range(1, len(x)):
        total = total + x[j] * row(rows, first + j)
    return total


@jit
def move_to(f, p):
    """Numbers and tables at the value p of the parameter."""
    s = (p - f.centre) / f.reach
    last = f.degree
    for i in range(len(f.values)):
        f.values[i], f.slopes[i] = f.fit[last, i], 0.0
    for k in range(last - 1, -1, -1):
        for i in range(len(f.values)):
            f.slopes[i] = f.slopes[i] * s + f.values[i]
            f.values[i] = f.values[i] * s + f.fit[k, i]
    m = len(f.B)
    for i in range(NUMBERS):
        f.numbers[i], f.number_slopes[i] = f.values[m * m + i], f.slopes[m * m + i] / f.reach
    for i in range(m):
        for j in range(m):
            f.B[i, j], f.B_slope[i, j] = f.values[m * i + j], f.slopes[m * i + j] / f.reach
    if f.moves > 0:
        build_series(f)
        build_powers(f)
        build_middle(f)


@jit
def build_series(f):
    n, m = f.series.shape[1], f.series.shape[2]
    for i in range(n):
        for j in range(m):
            f.series[0, i, j], f.series_slopes[0, i, j] = 1.0 if i == j else 0.0, 0.0
    for k in range(1, ORDER + 1):
        for i in range(n):
            value, slope = f.series[k - 1, i], f.series_slopes[k - 1, i]
            put(f.series, k * n + i, combined(value, f.B, 0) / k)
            put(f.series_slopes, k * n + i, (combined(slope, f.B, 0) + combined(value, f.B_slope, 0)) / k)
        for j in range(m):
            f.gap_rows[j, k] = f.series[k, 0, j]
    for j in range(m):
        f.gap_rows[j, 0] = f.series[0, 0, j]


@jit
def build_powers(f):
    n, m = f.series.shape[1], f.series.shape[2]
    one, one_slope = f.powers[0], f.power_slopes[0]
    for i in range(n):
        value, slope = row(f.series, ORDER * n + i), row(f.series_slopes, ORDER * n + i)
        for k in range(ORDER - 1, -1, -1):
            value = value * f.width + row(f.series, k * n + i)
            slope = slope * f.width + row(f.series_slopes, k * n + i)
        put(f.powers, i, value)
        put(f.power_slopes, i, slope)
    angle, turn = f.numbers[OMEGA] * f.width, f.number_slopes[OMEGA] * f.width
    c, s = math.cos(angle), math.sin(angle)
    one[n, n], one[n, n + 1], one[n + 1, n], one[n + 1, n + 1], one[n + 2, n + 2] = c, -s, s, c, 1.0
    one_slope[n, n], one_slope[n, n + 1] = -s * turn, -c * turn
    one_slope[n + 1, n], one_slope[n + 1, n + 1] = c * turn, -s * turn
    for k in range(1, f.bits):
        first = (k - 1) * m
        for i in range(m):
            value, slope = f.powers[k - 1, i], f.power_slopes[k - 1, i]
            put(f.powers, k * m + i, combined(value, f.powers, first))
            change = combined(slope, f.powers, first) + combined(value, f.power_slopes, first)
            put(f.power_slopes, k * m + i, change)
    for i in range(m):
        for j in range(m):
            f.step[j, i] = one[i, j]


@jit
def build_middle(f):
    for j in range(len(f.rest)):
        c = f.gap_rows[j]
        put(f.middle, j, combined(c, f.middle_weights, 0))
        total = 0.0
        for k in range(MIDDLE, ORDER + 1):
            total += abs(c[k]) * f.rest_weights[k]
        f.rest[j] = total


@jit
def set_phase(f, zeta, t):
    """The forcing at the time t."""
    m = len(zeta)
    angle = f.numbers[OMEGA] * t + f.numbers[TAU]
    zeta[m - 3], zeta[m - 2], zeta[m - 1] = math.cos(angle), math.sin(angle), 1.0


@jit
def flight_matrix(f, length, E):
    """E (n, m): the state after a time `length` from zeta."""
    n, m = E.shape
    cells = int(length / f.width)
    u = length - cells * f.width
    for i in range(n):
        total = row(f.series, ORDER * n + i)
        for k in range(ORDER - 1, -1, -1):
            total = total * u + row(f.series, k * n + i)
        put(E, i, total)
    bit = 0
    while cells > 0:
        if cells & 1:
            for i in range(n):
                put(E, i, combined(E[i], f.powers, bit * m))
        cells >>= 1
        bit += 1


@jit
def flight_slope(f, length, zeta, slope, out, work):
    """out (n,): derivative by the parameter of the state after `length`, where zeta (m,) at the start has `slope`.

    zeta and slope are destroyed. work: (2, m).
    """
    n, m = f.series.shape[1], f.series.shape[2]
    cells = int(length / f.width)
    u = length - cells * f.width
    bit = 0
    while cells > 0:
        if cells & 1:
            for i in range(m):
                work[0, i] = work[1, i] = 0.0
                for j in range(m):
                    work[0, i] += f.powers[bit, i, j] * zeta[j]
                    work[1, i] += f.powers[bit, i, j] * slope[j] + f.power_slopes[bit, i, j] * zeta[j]
            for i in range(m):
                zeta[i], slope[i] = work[0, i], work[1, i]
        cells >>= 1
        bit += 1
    for i in range(n):
        total = 0.0
        for j in range(m):
            value, change = f.series[ORDER, i, j], f.series_slopes[ORDER, i, j]
            for k in range(ORDER - 1, -1, -1):
                value = value * u + f.series[k, i, j]
                change = change * u + f.series_slopes[k, i, j]
            total += value * slope[j] + change * zeta[j]
        out[i] = total
