"""The motion between the impacts of a periodic orbit.

Kernels on the tables of flow.py; zeta is the state in contact coordinates, with the force.
"""

import math
from typing import NamedTuple

import numpy as np

from vibro_sweep.engine.impulses.taylor_orders import ORDER
from vibro_sweep.engine.simd.jit import exported, jit


class Workspace(NamedTuple):
    """Arrays in which flights are computed."""

    E: np.ndarray  # (m^2,)
    state: np.ndarray  # (m,)
    column: np.ndarray  # (m,)


def new_workspace(m: int) -> Workspace:
    return Workspace(*(np.empty(shape) for shape in (m * m, m, m)))


@jit
def multiply(matrix, z, column):
    """z <- matrix z."""
    m = len(z)
    for i in range(m):
        column[i] = 0.0
        for k in range(m):
            column[i] += matrix[i, k] * z[k]
    for i in range(m):
        z[i] = column[i]


@jit
def within_cell(f, u, E):
    """E = exp(B u), one row after the other; u: at most the width of a cell."""
    for i in range(len(E)):
        E[i] = f.series[ORDER, i]
    for k in range(ORDER - 1, -1, -1):
        for i in range(len(E)):
            E[i] = E[i] * u + f.series[k, i]


@jit
def over_cells(f, z, cells, workspace):
    """z over so many cells, in place."""
    j = 0
    while cells > 0:
        last = j == len(f.powers) - 1
        for _ in range(cells if last else cells & 1):
            multiply(f.powers[j], z, workspace.column)
        cells = 0 if last else cells >> 1
        j += 1


@jit
def advance(f, z, length, workspace):
    """zeta over a time `length` >= 0, in place."""
    cells = int(length / f.width)
    over_cells(f, z, cells, workspace)
    within_cell(f, length - cells * f.width, workspace.E)
    multiply(workspace.E.reshape(f.B.shape), z, workspace.column)


@jit
def set_phase(f, z, t):
    """The forcing at the time t."""
    m = len(z)
    z[m - 3], z[m - 2], z[m - 1] = math.cos(f.omega * t + f.tau), math.sin(f.omega * t + f.tau), 1.0


@exported
def free_part(f, h, t, D, P, moment, workspace):
    """room.state becomes the free part of zeta, without the harmonic force, at `moment` in [t_1, t_1 + P], before an
    impact there. h (n,): before the first impact; t, D: times and impulses (K,)."""
    K, n, z = len(t), len(h), workspace.state
    for i in range(n):
        z[i] = h[i]
    z[n], z[n + 1], z[n + 2] = 0.0, 0.0, 1.0
    k = 0
    while k < K and t[k] < moment:
        z[n // 2] += D[k]
        advance(f, z, min(t[k + 1] if k + 1 < K else t[0] + P, moment) - t[k], workspace)
        k += 1


@jit
def flight_matrix(f, length, E, workspace):
    """E (n, n) = exp(A length) of the free motion, without the force."""
    n, z = len(E), workspace.state
    cells = int(length / f.width)
    within_cell(f, length - cells * f.width, workspace.E)
    for j in range(n):
        for i in range(len(z)):
            z[i] = 1.0 if i == j else 0.0
        over_cells(f, z, cells, workspace)
        multiply(workspace.E.reshape(f.B.shape), z, workspace.column)
        for i in range(n):
            E[i, j] = z[i]


@exported
def flight_matrices(f, lengths, out, workspace):
    """`flight_matrix` of each flight: out (flights, n, n)."""
    for k in range(len(lengths)):
        flight_matrix(f, lengths[k], out[k], workspace)


@exported
def sample_flights(f, starts, begins, which, times, out, workspace):
    """zeta at `times` of the flights that start with starts[which] at begins[which]: out (samples, m)."""
    for i in range(len(times)):
        k = which[i]
        for j in range(out.shape[1]):
            out[i, j] = starts[k, j]
        set_phase(f, out[i], begins[k])
        advance(f, out[i], times[i] - begins[k], workspace)
