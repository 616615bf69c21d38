"""A contact with a compliant stop as one event: between its touch and its release the stop presses the gap back.

The second unknown of the event is the length s of the contact in phase. With z = y + S the whole motion, d = g - stop,
and k, c, p the stop's stiffness, damping and preload over m_e, the force acts on the gap alone:

    dz/dphi = (A (z, 1) + Re(F e^{i phi}) - e_v (k d + c v + side p))/omega        y+ = z(phi + s) - S(phi + s)

so that no steady motion of the contact is needed. Row 2 of the event is

    d(phi + s)/s = 0                          released at the stop, d = 0 exactly
    (k d + c v + side p)(phi + s) = 0         released by force, where that comes first: the gap goes on from d

which both are v = 0 at a graze without preload, s = 0: nothing is singular there. E_c is the derivative of z(phi + s)
by z. At fixed phases, with J = (k d + c v + side p)/omega of the touch, where d = 0, and J+ of the release,

    xi+ = E_c (xi - e_g v/omega dphi + e_v J dphi) - e_v J+ (dphi + ds) + ..       gap left out of xi

The stop that is left by force relaxes alone: relaxation.py.

The contact is computed in equal parts, by one linear map (contact_map.py).
"""

import cmath

import numpy as np

from vibro_sweep.engine.continuation.contact_map import (
    MEAN,
    SUM,
    apply,
    copy_motion,
    ends_by_force,
    force_scale,
    of_motion,
    parts_of,
    put_course,
    put_tables,
)
from vibro_sweep.engine.continuation.moving_flow import HIGH, LOW, OMEGA, law_at
from vibro_sweep.engine.impulses.extremes import OVERLAP, extremes_of_cell
from vibro_sweep.engine.impulses.taylor_orders import ORDER
from vibro_sweep.engine.simd.jit import jit
from vibro_sweep.engine.simd.lanes import LANES
from vibro_sweep.engine.simd.memory import eight, put_eight


@jit
def contact(f, side, x, e, work):
    """`after`, `carry`, `pull`, `release` and `depth` of a contact, after `approach`."""
    n, N, omega, s = f.A.shape[0], f.A.shape[0] // 2, f.numbers[OMEGA], x[f.A.shape[0] + 1]
    stop, law, v = HIGH if side > 0 else LOW, law_at(f, side), e.motion[0]
    by_length = press_gap(f, side, x, s, e, work)
    state, turn, by_force = work.resting[0], e.turn * cmath.exp(1j * s), ends_by_force(f, side, work.resting[0, N, n])
    k, c, p = f.values[law], f.values[law + 1], side * f.values[law + 2]
    touched = (c * v + p) / omega
    if by_force:
        put_force(f, side, touched, turn, e, work)
    else:
        put_place(f, touched, by_length, e, work)
    released = (k * state[0, n] + c * state[N, n] + p) / omega
    e.depth = side * state[0, n]
    for r in range(n):
        e.after[r] = state[r, n] - (f.Z[r] * turn).real
        for i in range(n):
            e.carry[r, i] = state[r, i]
        e.carry[r, 0] = 0.0
        e.carry[r, n + 1] = -released if r == N else 0.0
        e.carry[r, n] = state[r, N] * touched - state[r, 0] * v / omega + e.carry[r, n + 1]
        for j in range(f.parameters):
            e.carry[r, n + 2 + j] = state[r, n + 1 + j] - (f.Z_slopes[j, r] * turn).real
    e.after[0] += f.numbers[stop]
    e.after[n] = 1.0
    for j in range(f.parameters):
        e.carry[0, n + 2 + j] += f.number_slopes[j, stop]
    if not by_force:
        e.carry[0, n] = e.carry[0, n + 1] = -state[N, n] / omega


@jit
def put_place(f, touched, by_length, e, work):
    """`pull` and `release` where the gap is back at its stop, exactly: row 2 is its mean rate."""
    n, N, omega, state, mean = f.A.shape[0], f.A.shape[0] // 2, f.numbers[OMEGA], work.resting[0], work.resting[3]
    for i in range(n):
        e.release[i] = mean[0, i]
    e.pull = mean[0, n]
    e.release[0], e.release[n + 1] = 0.0, by_length
    e.release[n] = (mean[N, n] - mean[0, 0] * e.motion[0]) / omega + mean[0, N] * touched
    for j in range(f.parameters):
        e.release[n + 2 + j] = mean[0, n + 1 + j]
    for i in range(n + 1 + f.parameters):
        state[0, i] = 0.0


@jit
def put_force(f, side, touched, turn, e, work):
    """`pull` and `release` where the force is 0: row 2 is the force, of the size of a speed."""
    n, N, omega, state, law = f.A.shape[0], f.A.shape[0] // 2, f.numbers[OMEGA], work.resting[0], law_at(f, side)
    scale = force_scale(f, side)
    k, c, depth, speed = f.values[law] / scale, f.values[law + 1] / scale, state[0, n], state[N, n]
    for i in range(n):
        e.release[i] = k * state[0, i] + c * state[N, i]
    e.pull = k * depth + c * speed + side * f.values[law + 2] / scale
    e.release[n + 1] = (k * speed + c * of_motion(f, work.rates[0, N], state, turn)) / omega
    e.release[n] = e.release[N] * touched - e.release[0] * e.motion[0] / omega + e.release[n + 1]
    e.release[0] = 0.0
    for j in range(f.parameters):
        by_law = f.slopes[j, law] * depth + f.slopes[j, law + 1] * speed + side * f.slopes[j, law + 2]
        e.release[n + 2 + j] = k * state[0, n + 1 + j] + c * state[N, n + 1 + j] + by_law / scale


@jit
def begin_contact(f, x, e, state):
    """Derivatives of z by xi (n), z, with d in place of the gap, and derivatives by the parameters."""
    n = f.A.shape[0]
    for r in range(n):
        for k in range(n):
            state[r, k] = 1.0 if r == k else 0.0
        state[r, n] = x[r] + (f.Z[r] * e.turn).real if r != 0 else 0.0
        for j in range(f.parameters):
            state[r, n + 1 + j] = (f.Z_slopes[j, r] * e.turn).real if r != 0 else 0.0
        for c in range(n + 1 + f.parameters, state.shape[1]):
            state[r, c] = 0.0


@jit
def press_gap(f, side, x, length, e, work):
    """work.resting[0]: as of `begin_contact`, but this length in phase, which may be negative, after the touch."""
    begin_contact(f, x, e, work.resting[0])
    return press_on(f, side, length, e.turn, work)


@jit
def put_nan(motion):
    for r in range(len(motion)):
        for k in range(motion.shape[1]):
            motion[r, k] = np.nan


@jit
def press_on(f, side, length, turn, work):
    """Take work.resting[0] so far ahead, from e^{i phi} = turn on; work.resting[3]: its mean rate of change.

    Returned is the derivative of the mean rate of d by the length. NaN everywhere where it takes too many parts.
    """
    n, N, parts = f.A.shape[0], f.A.shape[0] // 2, parts_of(f, side, length)
    state, start, other, mean = work.resting[0], work.resting[1], work.resting[2], work.resting[3]
    if parts == 0:
        put_nan(state)
        put_nan(mean)
        return np.nan
    step, by_length, power = length / parts, 0.0, 1.0
    put_tables(f, side, step, work)
    copy_motion(state, start)
    if parts == 1:
        put_course(f, state, turn, work)
        for order in range(2, ORDER + 1):
            by_length += (order - 1) * work.cell[order] * power
            power *= step
        apply(f, work.pressing[MEAN], turn, start, mean)
    swing, ahead = turn, cmath.exp(1j * step)
    for _ in range(parts):
        apply(f, work.pressing[SUM], swing, state, other)
        copy_motion(other, state)
        swing *= ahead
    if parts > 1:
        for place in range(0, n * state.shape[1], LANES):
            put_eight(mean, place, (eight(state, place) - eight(start, place)) * (1.0 / length))
        by_length = (state[N, n] / f.numbers[OMEGA] - mean[0, n]) / length
    return by_length


@jit
def least_depth(f, side, x, e, work):
    """The least depth at which the gap turns back into the stop during a contact, inf where it does not; with a release
    by force also the least force, as of row 2, where that rises again."""
    parts, nearest, state, other = parts_of(f, side, x[-1]), work.turning, work.resting[0], work.resting[1]
    if parts == 0:
        return np.nan
    step, cell = x[-1] / parts, work.cell
    begin_contact(f, x, e, state)
    put_tables(f, side, step, work)
    nearest[0] = np.inf
    for k in range(parts):
        swing = e.turn * cmath.exp(1j * step * k)
        put_course(f, state, swing, work)
        for order in range(ORDER + 1):
            cell[order] *= side
        if step > 0.0:
            length = step * OVERLAP if k + 1 < parts else step
            extremes_of_cell(cell, length, 0.0, np.inf, nearest, work.waiting)
            if f.by_force > 0:
                put_force_course(f, side, cell)
                extremes_of_cell(cell, length, 0.0, np.inf, nearest, work.waiting)
        apply(f, work.pressing[SUM], swing, state, other)
        copy_motion(other, state)
    return nearest[0]


@jit
def put_force_course(f, side, cell):
    """The Taylor coefficients of the force, as of row 2, from those of the depth."""
    law, scale = law_at(f, side), force_scale(f, side)
    k, c = f.values[law] / scale, f.values[law + 1] * f.numbers[OMEGA] / scale
    for order in range(ORDER):
        cell[order] = k * cell[order] + c * (order + 1) * cell[order + 1]
    cell[ORDER] *= k
    cell[0] += f.values[law + 2] / scale
