"""The tables of any linear oscillator with one contact, in contact coordinates (coordinates/contact.py)."""

import math
from typing import NamedTuple

import numpy as np

from vibro_sweep.engine.simd.jit import exported, jit
from vibro_sweep.engine.tables.exclusion import fill_exclusion
from vibro_sweep.engine.tables.fast_roots import fill_stiff_exclusion
from vibro_sweep.engine.tables.flight import ORDER, WIDTH, decaying, inputs_of
from vibro_sweep.engine.tables.frame_tables import LOST, MOST_CELLS, SEPARATION, VANISHED
from vibro_sweep.engine.tables.products import fill_forced_motion, fill_products
from vibro_sweep.engine.tables.series import clear, derive, set_grid


class Workspace(NamedTuple):
    """The arrays in which the tables are computed."""

    A: np.ndarray  # (inputs, inputs)
    row: np.ndarray  # (inputs,)
    turned: np.ndarray  # (2, 2 N + 3)
    twofold: np.ndarray  # (4, 2, inputs, inputs)


def new_workspace(masses: int, constant: bool) -> Workspace:
    inputs = inputs_of(masses, constant)
    return Workspace(
        np.empty((inputs, inputs)),
        np.empty(inputs),
        np.empty((2, 2 * masses + 3)),
        np.empty((4, 2, inputs, inputs)),
    )


@exported
def build_any(f, w, point):
    """Fill the tables of a point (`point_of`)."""
    q = f.oscillator[0]
    set_grid(q, point.cells, point.omega, max(point.omega, point.rate))
    q.zeta, q.rest_square = 0.0, 0.0
    fill_equations(w.A, point, len(q.force))
    fill_flight_series(q, w)
    fill_impulse(q, point)
    fill_rest_series(q, w, point, max(point.omega, point.constrained_rate))
    fill_products(q, f.nodes, point, w.twofold)
    fill_forced_motion(q, f.nodes, point.tau, point.begin)
    q.exact = q.stiff and point.apart
    if q.stiff:
        fill_stiff_exclusion(q, f.nodes, f.scan, point, w.turned)
    else:
        fill_exclusion(q, f.nodes, f.scan)
    fill_any_frame(q, f.nodes, point)
    q.middle, q.swing = point.middle, point.swing
    for i in range(len(q.steady)):
        q.steady[i] = point.steady[i]
        for j in range(len(q.steady)):
            q.confining[i, j] = point.confining[i, j]


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
def fill_constrained(A, point, inputs):
    """z' = A z while a stop holds the gap."""
    masses = len(point.damping)
    for i in range(1, masses):
        for j in range(masses):
            A[2 * i + 1, 2 * j], A[2 * i + 1, 2 * j + 1] = point.constrained[i, j], point.constrained[i, masses + j]
        for j in range(2 * masses, inputs):
            A[2 * i + 1, j] = point.constrained[i, j]


@jit
def fill_rest_series(q, w, point, rate):
    """The same while a stop holds the gap: without v1 among the inputs. Takes A apart. rate: the fastest meanwhile."""
    A, row, count = w.A, w.row, len(q.force) - 1
    fill_constrained(A, point, len(q.force))
    for j in range(count):
        row[j] = A[1, j + 1 if j > 0 else 0]
    for i in range(count):
        for j in range(count):
            A[i, j] = A[i + 1, j + 1 if j > 0 else 0] if i > 0 else 0.0
    derive(A, row, count, q.resting[0])
    for m in range(1, len(q.series)):
        for j in range(count):
            row[j] = 1.0 if j == 2 * m - 1 else 0.0
        derive(A, row, count, q.resting[m])
    q.rest_step = q.width if rate * q.width <= 1.0001 * WIDTH else q.width / math.ceil(rate * q.width / WIDTH)


@jit
def fill_any_frame(q, nodes, point):
    """The frame of tangent vectors, from the pairs of roots of the point, and how far they may be flown in it."""
    masses, states = len(q.series), 2 * len(q.series)
    fastest, slowest, turning, q.vanishing = 0.0, np.inf, True, 0
    for j in range(masses):
        eta, square = point.frame_eta[j], point.frame_square[j]
        swift = eta + math.sqrt(max(-square, 0.0))
        product = square + eta * eta  # of both roots
        if swift * q.width > VANISHED:
            q.vanishing += 2 if square > 0.0 else 1
        fastest = max(fastest, swift)
        slowest = min(slowest, eta if square >= 0.0 else product / swift)
        turning = turning and square > 1e-6 * product
        q.frame_square[j], q.frame_scale[j] = square, point.frame_scale[j]
        series = q.frame_series
        series[0, 2 * j], series[1, 2 * j] = 1.0, -eta
        series[0, 2 * j + 1], series[1, 2 * j + 1] = 0.0, 1.0
        for n in range(ORDER - 2):
            for i in range(2 * j, 2 * j + 2):
                rate = 2.0 * eta * (n + 1.0) * series[n + 1, i] + product * series[n, i]
                series[n + 2, i] = -rate / ((n + 1.0) * (n + 2.0))
        for k in range(q.cells + 1):
            c, s, _, _ = decaying(eta, product, k * q.width)
            nodes[k].frame[2 * j], nodes[k].frame[2 * j + 1] = c, s
    for i in range(states):
        for j in range(states):
            q.to_frame[i, j], q.from_frame[i, j] = point.to_frame[i, j], point.from_frame[i, j]
    apart = (fastest - slowest) * q.width
    # with one rate of decay all vectors shrink alike: they must not leave the range of the floats
    most = max(1, int(min(LOST / (fastest * q.width), MOST_CELLS))) if fastest > 0.0 else MOST_CELLS
    q.most_cells_mixed = min(most, max(1, int(SEPARATION / apart))) if apart > 1e-9 * SEPARATION else most
    q.most_cells_in_planes = max(q.most_cells_mixed, most) if turning else q.most_cells_mixed
