"""Taylor series of flight over a cell (eq. 3)."""

import math
from typing import NamedTuple

import numpy as np

from vibro_sweep.engine.simd.jit import inline, jit
from vibro_sweep.engine.simd.lanes import LANES, alike, lanes_of, number, select
from vibro_sweep.engine.simd.memory import new_lines, put, row
from vibro_sweep.engine.tables.flight import ORDER, WIDTH


@jit
def derive(A, row, size, series):
    """series[i, n]: Taylor coefficient n of (row . z) as a function of z_i, for z' = A z."""
    for i in range(size):
        series[i, 0] = row[i]
    for n in range(1, series.shape[1]):
        for i in range(size):
            total = 0.0
            for j in range(size):
                total += series[j, n - 1] * A[j, i]
            series[i, n] = total / n


@jit
def clear(a):
    for i in range(a.shape[0]):
        for j in range(a.shape[1]):
            a[i, j] = 0.0


@jit
def set_grid(q, cells, omega, rate):
    """The cells of the forcing period, and how far a series reaches in them. rate: the fastest."""
    q.cells, q.width, q.omega = cells, 2.0 * math.pi / omega / cells, omega
    q.stiff = rate * q.width > 1.0001 * WIDTH
    q.step = q.width / math.ceil(rate * q.width / WIDTH) if q.stiff else q.width
    power = 1.0
    for n in range(ORDER):
        q.reach[n] = power if n > 0 else 0.0
        if n < ORDER - 3:
            q.third[n + 3] = (n + 3.0) * (n + 2.0) * (n + 1.0) * power
        if n < ORDER - 4:
            q.fourth[n + 4] = (n + 4.0) * (n + 3.0) * (n + 2.0) * (n + 1.0) * power
        power *= q.step


class Workspace(NamedTuple):
    """The matrices A of z' = A z for z = (x1, v1, x2, v2, sin(omega t + tau), cos(omega t + tau)), eq. (3), padded."""

    free: np.ndarray  # (6, LANES)
    constrained: np.ndarray  # (6, LANES), while M1 rests: v1 = 0


def new_workspace() -> Workspace:
    return Workspace(new_lines((6, LANES), float), new_lines((6, LANES), float))


@jit
def fill_equations(q, w, mu_m, mu_k, f2):
    """Fill both matrices, and the acceleration of M1 as a function of z. What is zero in every A stays as it was
    made."""
    A, constrained, zeta, omega = w.free, w.constrained, q.zeta, q.omega
    A[0, 1] = A[2, 3] = 1.0
    A[1, 0], A[1, 1], A[1, 2], A[1, 3], A[1, 4] = -1.0, -2.0 * zeta, 1.0, 2.0 * zeta, 1.0 - f2
    A[3, 0], A[3, 1] = 1.0 / mu_m, 2.0 * zeta / mu_m
    A[3, 2], A[3, 3], A[3, 4] = -(1.0 + mu_k) / mu_m, -2.0 * zeta * (1.0 + mu_k) / mu_m, f2 / mu_m
    A[4, 5], A[5, 4] = omega, -omega
    for i in range(6):
        q.force[i] = A[1, i]
    for i in range(2, 6):
        put(constrained, i, row(A, i))
    constrained[3, 1] = 0.0


@inline
def times(c, A):
    """The row vector c times A, both of six numbers, padded."""
    total = alike(0.0)
    for i in range(6):
        total = total + row(A, i) * number(c, i)
    return total


@jit
def fill_series(q, w):
    """Taylor series of x1 and x2 in free flight; and while M1 rests of its free acceleration and of x2.

    Each term is the one before it times A/n. All four go side by side: none waits for the last step of another.
    """
    x1, x2 = select(lanes_of(0b000001), 1.0, 0.0), select(lanes_of(0b000100), 1.0, 0.0)
    pull, constrained_x2 = select(lanes_of(0b000010), 0.0, row(w.free, 1)), x2
    for n in range(ORDER):
        if n > 0:
            x1, x2 = times(x1, w.free) / n, times(x2, w.free) / n
            pull, constrained_x2 = times(pull, w.constrained) / n, times(constrained_x2, w.constrained) / n
        for i in range(6):
            q.series[0, i, n], q.series[1, i, n] = number(x1, i), number(x2, i)
        for i in range(5):  # without v1
            j = i + 1 if i > 0 else 0
            q.resting[0, i, n], q.resting[1, i, n] = number(pull, j), number(constrained_x2, j)


@jit
def fill_impulse(q):
    """Fill the response to an impulse on M1, which moves no other mass at once."""
    q.push[0], q.push[1], q.drag = 1.0, 0.0, q.force[1]
    q.impulse_third = 0.0
    for n in range(ORDER):
        q.impulse[0, n], q.impulse[1, n] = q.series[0, 1, n], q.series[1, 1, n]
        q.impulse_third += q.third[n] * abs(q.impulse[0, n])
