"""Taylor series of flight over a cell (eq. 3)."""

import math

from vibro_sweep.engine.simd.jit import jit
from vibro_sweep.engine.tables.flight import ORDER, WIDTH


@jit
def derive(A, row, size, series):
    """series[i, n]: Taylor coefficient n of (row . z) as a function of z_i, for z' = A z."""
    for i in range(size):
        series[i, 0] = row[i]
    for n in range(1, ORDER):
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


@jit
def fill_series(q, A, row, mu_m, mu_k, f2):
    """Taylor series of x1 and x2, and the acceleration of M1 (eq. 3). A (6, 6) and row (6,) are scratch."""
    zeta, omega = q.zeta, q.omega
    clear(A)
    # (3) as z' = A z for z = (x1, v1, x2, v2, sin(omega t + tau), cos(omega t + tau))
    A[0, 1] = A[2, 3] = 1.0
    A[1, 0], A[1, 1], A[1, 2], A[1, 3], A[1, 4] = -1.0, -2.0 * zeta, 1.0, 2.0 * zeta, 1.0 - f2
    A[3, 0], A[3, 1] = 1.0 / mu_m, 2.0 * zeta / mu_m
    A[3, 2], A[3, 3], A[3, 4] = -(1.0 + mu_k) / mu_m, -2.0 * zeta * (1.0 + mu_k) / mu_m, f2 / mu_m
    A[4, 5], A[5, 4] = omega, -omega
    for i in range(6):
        q.force[i] = A[1, i]
        row[i] = 0.0
    row[0] = 1.0
    derive(A, row, 6, q.series[0])
    row[0], row[2] = 0.0, 1.0
    derive(A, row, 6, q.series[1])
