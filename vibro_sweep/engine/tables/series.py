"""Taylor series of flight over a cell, and of the other masses while a stop holds the gap (eq. 3)."""

import math

from vibro_sweep.engine.simd.jit import jit
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
def set_grid(q, omega, rate):
    """How wide a cell is, and how far a series reaches in it. rate: the fastest."""
    q.width, q.omega = 2.0 * math.pi / omega / q.cells, omega
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
def fill_equations(A, point, inputs):
    """z' = A z for z = (x1, v1, ..., sin, cos) or (x1, v1, ..., sin, cos, 1)."""
    masses = len(point.damping)
    clear(A)
    for i in range(masses):
        A[2 * i, 2 * i + 1] = 1.0
        for j in range(masses):
            A[2 * i + 1, 2 * j], A[2 * i + 1, 2 * j + 1] = -point.stiffness[i, j], -point.damping[i, j]
        for j in range(2 * masses, inputs):
            A[2 * i + 1, j] = point.force[i, j - 2 * masses]
    A[2 * masses, 2 * masses + 1], A[2 * masses + 1, 2 * masses] = point.omega, -point.omega


@jit
def fill_flight_series(q, w):
    """Taylor series of all positions, and the acceleration of the gap."""
    inputs = len(q.force)
    for j in range(inputs):
        q.force[j] = w.A[1, j]
    for m in range(len(q.series)):
        for j in range(inputs):
            w.row[j] = 1.0 if j == 2 * m else 0.0
        derive(w.A, w.row, inputs, q.series[m])


@jit
def fill_impulse(q, point):
    """Fill the response to an impulse on the gap: of all velocities at once, and to the positions in the flight that
    follows.

    An impact leaves qj - p_j q1 as it is. Its derivative changes by -kappa_j where dampers feel a step of q1 by 1.
    """
    masses, damping, p = len(q.series), point.damping, point.push
    q.drag = 0.0
    for j in range(masses):
        q.push[j] = p[j]
        q.drag += q.force[2 * j + 1] * p[j]
    for i in range(masses):
        q.kappa[i] = 0.0
        if i > 0:
            for j in range(masses):
                q.kappa[i] -= (damping[i, j] - p[i] * damping[0, j]) * p[j]
        for n in range(ORDER):
            q.impulse[i, n] = q.series[i, 1, n]
            for j in range(1, masses):
                if p[j] != 0.0:
                    q.impulse[i, n] += p[j] * q.series[i, 2 * j + 1, n]
    q.impulse_third = 0.0
    for n in range(ORDER):
        q.impulse_third += q.third[n] * abs(q.impulse[0, n])


@jit
def fill_held(q, point, rate):
    """Accelerations of the masses while a stop holds the gap. rate: the fastest meanwhile."""
    masses = len(q.held)
    for i in range(1, masses):
        for j in range(masses):
            q.held[i, 2 * j], q.held[i, 2 * j + 1] = point.constrained[i, j], point.constrained[i, masses + j]
        for j in range(2 * masses, 2 * masses + 3):
            q.held[i, j] = point.constrained[i, j]
    q.rest_step = q.width if rate * q.width <= 1.0001 * WIDTH else q.width / math.ceil(rate * q.width / WIDTH)


@jit
def fill_taylor(G, first, slow, sin, cos, one, omega, c):
    """Taylor coefficients c (N, ORDER) of y'' = G (y1, y1', y2, .., sin, cos, 1) in the rows from `first` on; those of
    y and y' are there, and all of the rows before.

    slow : what row 0 begins with beside y1 and y1'. one : 1, or 0 where nothing but y acts
    """
    masses, states = len(c), 2 * len(c)
    for n in range(ORDER - 2):
        share = 1.0 / ((n + 1.0) * (n + 2.0))
        for i in range(first, masses):
            if n == 0 and i == 0:
                total = slow
            else:
                total = G[i, states] * sin + G[i, states + 1] * cos
                if n == 0:
                    total += G[i, states + 2] * one
                for j in range(1, masses):
                    total += G[i, 2 * j] * c[j, n] + G[i, 2 * j + 1] * ((n + 1.0) * c[j, n + 1])
            total += G[i, 0] * c[0, n] + G[i, 1] * ((n + 1.0) * c[0, n + 1])
            c[i, n + 2] = total * share
        sin, cos = omega * cos / (n + 1.0), -omega * sin / (n + 1.0)
