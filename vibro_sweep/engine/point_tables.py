"""From a point to its tables, and between the coordinates of its masses and those of its contact.

paper : scratch of tables/series.py, by modes; None unless it is the paper's oscillator
other : scratch of tables/general.py; None of the paper's oscillator, whose coordinates are those of its contact

numba leaves out what stands under `if x is not None` where x is None: each kind of point has kernels of its own.
"""

import numpy as np

from vibro_sweep.engine.simd.jit import jit
from vibro_sweep.engine.tables.build import build
from vibro_sweep.engine.tables.general_tables import build_any

ON_STOP = 2.0**-50  # of the terms of the gap: a distance from a stop, and a speed, that are rounding


@jit
def same_tables(a, b, paper, other):
    """Whether two points share their tables: they may differ in the stops."""
    same = a.cells == b.cells and a.omega == b.omega and a.tau == b.tau
    if paper is not None:
        same = same and a.mu_m == b.mu_m and a.mu_k == b.mu_k and a.zeta == b.zeta and a.f2 == b.f2
    if other is not None:
        for i in range(len(a.force)):
            for j in range(len(a.force)):
                same = same and a.stiffness[i, j] == b.stiffness[i, j] and a.damping[i, j] == b.damping[i, j]
            for j in range(3):
                same = same and a.force[i, j] == b.force[i, j]
            same = same and a.push[i] == b.push[i]
    return same


@jit
def fill_tables(f, point, paper, other):
    if paper is not None:
        build(
            f, paper, point.cells, point.psi, point.omega_squared,
            point.mu_m, point.mu_k, point.zeta, point.f2, point.omega, point.tau,
        )  # fmt: skip
    if other is not None:
        build_any(f, other, point)


@jit
def set_graze(q, point):
    """The point at which the discontinuity mapping is expanded."""
    for j in range(len(q.graze)):
        q.graze[j] = point.graze[j]


@jit
def divergence_of(point, paper, other):
    """-tr(M^-1 C)."""
    result = np.nan
    if paper is not None:
        result = -2.0 * point.zeta * (1.0 + (1.0 + point.mu_k) / point.mu_m)
    if other is not None:
        result = point.divergence
    return result


@jit
def turn(matrix, x, scratch):
    """The coordinates and velocities x1, v1, x2, ... become those of the matrix times x."""
    masses = len(matrix)
    for k in range(2):
        for i in range(masses):
            total = 0.0
            for j in range(masses):
                total += matrix[i, j] * x[2 * j + k]
            scratch[2 * i + k] = total
    for j in range(2 * masses):
        x[j] = scratch[j]


@jit
def to_contact(point, x, stops, other):
    """The state x in contact coordinates; on a stop, and at rest there, if it is so but for rounding."""
    if other is not None:
        if not point.turned:
            return
        size, speed = 0.0, 0.0
        for j in range(len(point.P)):
            size += abs(point.P[0, j] * x[2 * j])
            speed += abs(point.P[0, j] * x[2 * j + 1])
            x[2 * j] -= point.origin[j]
        turn(point.P, x, other.row)
        if abs(x[1]) <= ON_STOP * speed:
            x[1] = 0.0
        if abs(x[0] - stops.left) <= ON_STOP * size:
            x[0] = stops.left
        if abs(x[0] - stops.right) <= ON_STOP * size:
            x[0] = stops.right


@jit
def to_masses(point, x, other):
    """The state x, in contact coordinates, of the masses themselves."""
    if other is not None:
        if point.turned:
            turn(point.back, x, other.row)
            for j in range(len(point.P)):
                x[2 * j] += point.origin[j]
