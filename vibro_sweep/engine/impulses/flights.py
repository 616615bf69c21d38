"""The motion between the impacts of a periodic orbit: states, and the certified extremes of the gap.

Kernels on the tables of flow.py; zeta is the state in contact coordinates, with the force.
"""

import math
from typing import NamedTuple

import numpy as np

from vibro_sweep.engine.impulses.extremes import OVERLAP, PIECES, extremes_of_cell, turns_near
from vibro_sweep.engine.impulses.taylor_orders import ORDER
from vibro_sweep.engine.simd.jit import exported, jit


class Workspace(NamedTuple):
    """Arrays in which flights are computed."""

    E: np.ndarray  # (m^2,)
    state: np.ndarray  # (m,)
    column: np.ndarray  # (m,)
    c: np.ndarray  # (ORDER + 1,)
    waiting: np.ndarray  # (PIECES, 2)


def new_workspace(m: int) -> Workspace:
    return Workspace(*(np.empty(shape) for shape in (m * m, m, m, ORDER + 1, (PIECES, 2))))


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
def may_turn(f, z, low, high, nearest):
    """`turns_near` of the cell that begins with z."""
    value = slope = curve = jerk = rest = 0.0
    for j in range(len(z)):
        value += z[j] * f.middle[j, 0]
        slope += z[j] * f.middle[j, 1]
        curve += z[j] * f.middle[j, 2]
        jerk += z[j] * f.middle[j, 3]
        rest += abs(z[j]) * f.rest[j]
    return turns_near(value, slope, curve, jerk, rest, low, high, nearest)


@jit
def set_phase(f, z, t):
    """The forcing at the time t."""
    m = len(z)
    z[m - 3], z[m - 2], z[m - 1] = math.cos(f.omega * t + f.tau), math.sin(f.omega * t + f.tau), 1.0


@jit
def extremes(f, z, length, low, high, nearest, workspace):
    """Fly `length` from zeta in place; lower `nearest` (distance, time from the start, side) to its turning points'."""
    m, c = len(z), workspace.c
    cells = int(length / f.width)
    for k in range(cells + 1):
        start = k * f.width
        width = min(f.width * OVERLAP, length - start)  # or a turning point between two cells could be lost to both
        if not width > 0.0:
            break
        if may_turn(f, z, low, high, nearest[0]):
            for n in range(ORDER + 1):
                c[n] = 0.0
                for i in range(m):
                    c[n] += f.rows[n, i] * z[i]
            if extremes_of_cell(c, width, low, high, nearest, workspace.waiting):
                nearest[1] += start
        if k < cells:
            multiply(f.powers[0], z, workspace.column)
        else:
            advance(f, z, width, workspace)


@jit
def start_of_orbit(f, close, u, K, P, gap, z, workspace):
    """zeta before the first impact (at t = 0 without impacts) of the orbit with these times and impulses."""
    m = len(z)
    n, N = m - 3, (m - 3) // 2
    for i in range(n):
        z[i] = 0.0
    first = u[0] if K > 0 else 0.0
    set_phase(f, z, first)
    for k in range(K):
        z[N] += u[K + k]
        advance(f, z, (u[k + 1] if k + 1 < K else first + P) - u[k], workspace)
    if K == 0:
        advance(f, z, P, workspace)
    for i in range(n):
        workspace.column[i] = z[i]
    for i in range(n):
        total = close[i, n] * gap
        for j in range(n):
            total += close[i, j] * workspace.column[j]
        z[i] = total
    set_phase(f, z, first)


@exported
def fly_orbit(f, close, contacts, u, P, low, high, states, nearest, workspace):
    """States before each impact, (max(K, 1), m), and the turning point nearest to its stop: (distance, t, side).

    Without impacts: the state at t = 0.
    """
    K = len(contacts)
    z = states[0]
    m = len(z)
    start_of_orbit(f, close, u, K, P, contacts[0, 0] if K > 0 else 0.0, z, workspace)
    nearest[0], nearest[1], nearest[2] = np.inf, 0.0, 0.0
    N = (m - 3) // 2
    flying = states[max(K, 1)]
    first = u[0] if K > 0 else 0.0
    for i in range(m):
        flying[i] = z[i]
    for k in range(max(K, 1)):
        begin = u[k] if K > 0 else 0.0
        end = u[k + 1] if k + 1 < K else first + P
        for i in range(m):
            states[k, i] = flying[i]
        set_phase(f, flying, begin)
        set_phase(f, states[k], begin)
        if K > 0:
            flying[N] = flying[N] + u[K + k] if contacts[k, 1] > 1.0 else 0.0
        distance = nearest[0]
        if K == 0:  # a turning point at t = 0 must not be lost between the ends
            end += 0.5 * f.width
        extremes(f, flying, end - begin, low, high, nearest, workspace)
        if nearest[0] < distance:
            nearest[1] += begin


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


@exported
def fly_once(f, z, begin, length, low, high, nearest, workspace):
    """Fly `length` from z in place; lower `nearest` (distance, t, side) to the turning points of the gap."""
    distance = nearest[0]
    set_phase(f, z, begin)
    extremes(f, z, length, low, high, nearest, workspace)
    if nearest[0] < distance:
        nearest[1] += begin


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
