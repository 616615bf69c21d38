"""An event that lasts: a rest where R = 0, or a contact with a compliant stop, in which the stop presses the gap back.

The second unknown of the event is its length s in phase. As of lasting_map.py Z(phi + s) = E Z, and y+ = z(phi + s) -
S(phi + s), so that no steady motion of the pressed masses is needed. Z begins with d = 0, which is row 1, and a rest
also with the gap's velocity 0. Row 2 of the event is

    q Z(phi + s) = 0        a rest, until its free acceleration vanishes; a contact that its force ends, where the
                            gap goes on from d
    d(phi + s)/s = m Z = 0  a contact that ends with the gap at its stop, d = 0 exactly

which are both v = 0 at a graze without preload, s = 0: nothing is singular there. With Z_phi the free rate of Z before
the event, of what the stop does not hold, the changes at fixed phases are

    xi+ = E (xi + Z_phi dphi) - y'+ (dphi + ds) + ..        y'+ the free rate after it: B Z + e_v q Z/omega

The stop that is left by force relaxes alone: relaxation.py.
"""

import cmath

import numpy as np

from vibro_sweep.engine.continuation.lasting import ends_by_force, force_scale, moves_on
from vibro_sweep.engine.continuation.lasting_map import halvings_of, put_force_course, put_gap_course, put_map, put_step
from vibro_sweep.engine.continuation.moving_flow import HIGH, LOW, OMEGA
from vibro_sweep.engine.impulses.extremes import OVERLAP, extremes_of_cell
from vibro_sweep.engine.simd.jit import jit


@jit
def dot(row, vector, count):
    total = row[0] * vector[0]
    for k in range(1, count):
        total += row[k] * vector[k]
    return total


@jit
def begin(f, compliant, side, x, e, work):
    """work.start: Z and its derivatives by the parameters; work.start_rate: Z_phi; work.moving: 0.0 of what is held."""
    n, stop, start, rate = f.A.shape[0], HIGH if side > 0 else LOW, work.start, work.start_rate
    off = (f.numbers[stop] - e.gap) / f.numbers[OMEGA]  # Z begins at the stop, where the gap is in the end
    for r in range(n):
        work.moving[r] = moving = 1.0 if moves_on(compliant, side, r, n // 2) else 0.0
        start[0, r] = moving * (x[r] + (f.Z[r] * e.turn).real)
        rate[r] = moving * (e.rate[r] + f.A[r, 0] * off + (1j * f.Z[r] * e.turn).real)
        for j in range(f.parameters):
            start[1 + j, r] = moving * (f.Z_slopes[j, r] * e.turn).real
    start[0, n], start[0, n + 1], start[0, n + 2], start[0, n + 3] = e.turn.real, e.turn.imag, 1.0, f.numbers[stop]
    rate[n], rate[n + 1] = -e.turn.imag, e.turn.real
    for j in range(f.parameters):
        start[1 + j, n + 3] = f.number_slopes[j, stop]


@jit
def put_state(f, E, Z, end):
    """end: E Z, but for what stays."""
    n = f.A.shape[0]
    for r in range(n):
        end[r] = dot(E[r], Z, n + 4)
    for r in range(n, n + 2):
        end[r] = E[r, n] * Z[n] + E[r, n + 1] * Z[n + 1]


@jit
def put_end(f, work):
    """work.end: E Z and its derivatives by the parameters."""
    n, E, start, end = f.A.shape[0], work.lasting, work.start, work.end
    put_state(f, E[0], start[0], end[0])
    for r in range(n):
        for j in range(1, f.parameters + 1):
            end[j, r] = dot(E[0, r], start[j], n + 4) + dot(E[j, r], start[0], n + 4)
    for j in range(f.parameters + 1):
        end[j, n + 2], end[j, n + 3] = start[j, n + 2], start[j, n + 3]


@jit
def last(f, compliant, side, x, e, work):
    """`after`, `carry`, `pull`, `release` and `depth` of an event that lasts, after `approach`."""
    if compliant is None:
        return
    n, omega, stop = f.A.shape[0], f.numbers[OMEGA], HIGH if side > 0 else LOW
    N, s, E, B, end = n // 2, x[n + 1], work.lasting, work.generator, work.end
    turn = e.turn * cmath.exp(1j * s)
    begin(f, compliant, side, x, e, work)
    doublings = put_map(f, compliant, side, s, work)
    put_end(f, work)
    for r in range(n):  # E (Z_phi - B Z)
        e.carry[r, n] = dot(E[0, r], work.start_rate, n + 2) - dot(B[0, r], end[0], n + 4)
        e.carry[r, n + 1] = 0.0
    by_force = ends_by_force(f, compliant, side, s, end[0, N])
    if by_force:
        put_force_row(f, force_scale(f, compliant, side), e, work)
    else:
        put_place_row(f, s, doublings, e, work)
        e.carry[0, n] = e.carry[0, n + 1] = -dot(B[0, 0], end[0], n)
        for k in range(n + 4):  # d = 0, by the row that this was
            E[0, 0, k] = 0.0
        for j in range(f.parameters + 1):
            end[j, 0] = 0.0
    released = dot(work.force[0], end[0], n + 4) / omega
    e.carry[N, n], e.carry[N, n + 1] = e.carry[N, n] - released, -released
    e.depth = side * end[0, 0]
    for r in range(n):
        e.after[r] = end[0, r] - (f.Z[r] * turn).real
        for k in range(n):
            e.carry[r, k] = E[0, r, k] * work.moving[k]
        for j in range(f.parameters):
            e.carry[r, n + 2 + j] = end[1 + j, r] - (f.Z_slopes[j, r] * turn).real
    e.after[0] += f.numbers[stop]
    e.after[n] = 1.0
    for j in range(f.parameters):
        e.carry[0, n + 2 + j] += f.number_slopes[j, stop]


@jit
def put_force_row(f, scale, e, work):
    """`pull` and `release` where the force is 0: row 2 is the force over `scale`."""
    n, force, end, row = f.A.shape[0], work.force, work.end, work.row
    e.pull, by_length = dot(force[0], end[0], n + 4) / scale, 0.0
    for k in range(n + 4):
        row[k] = 0.0
        for r in range(n + 4):
            row[k] += force[0, r] * work.lasting[0, r, k] / scale
    for r in range(n + 2):
        by_length += force[0, r] * dot(work.generator[0, r], end[0], n + 4) / scale
    put_release(f, by_length, e, work)
    for j in range(1, f.parameters + 1):
        e.release[n + 1 + j] = (dot(force[0], end[j], n + 4) + dot(force[j], end[0], n + 4)) / scale


@jit
def put_place_row(f, s, doublings, e, work):
    """The same where the gap is back at its stop: row 2 is its mean rate."""
    n, start, mean = f.A.shape[0], work.start, work.mean
    e.pull, by_length = dot(mean[0], start[0], n + 4), dot(work.mean_slope, start[0], n + 4)
    if doublings > 0:
        by_length = (dot(work.generator[0, 0], work.end[0], n) - e.pull) / s
    for k in range(n + 4):
        work.row[k] = mean[0, k]
    put_release(f, by_length, e, work)
    for j in range(1, f.parameters + 1):
        e.release[n + 1 + j] = dot(mean[0], start[j], n + 4) + dot(mean[j], start[0], n + 4)


@jit
def put_release(f, by_length, e, work):
    """`release` by xi, phi and s of row 2, of which work.row is the derivative by Z."""
    n = f.A.shape[0]
    for k in range(n):
        e.release[k] = work.row[k] * work.moving[k]
    e.release[n], e.release[n + 1] = dot(work.row, work.start_rate, n + 2), by_length


@jit
def hold_of(f, compliant, side, x, e, work):
    """What keeps the event up: the least force into the stop where it turns, of a rest also where it begins; the least
    depth of a contact where it turns back into the stop, and its force only with a release by force."""
    if compliant is None:
        return np.inf
    n, Z = f.A.shape[0], work.start[0]
    halvings = halvings_of(f, compliant, side, x[n + 1])
    if halvings < 0:
        return np.nan
    begin(f, compliant, side, x, e, work)
    step, in_contact = x[n + 1] / (1 << halvings), work.moving[n // 2] > 0
    put_step(f, compliant, side, step, work)
    scale = side * force_scale(f, compliant, side)
    work.turning[0] = np.inf if in_contact else dot(work.force[0], Z, n + 4) / scale
    for k in range(1 << halvings):
        if k > 0:
            put_state(f, work.lasting[0], Z, work.end[0])
            for r in range(n + 2):
                Z[r] = work.end[0, r]
        length = step * OVERLAP if k + 1 < 1 << halvings else step
        if in_contact and step > 0.0:
            put_gap_course(f, side, Z, work)
            lower(side, length, work)
        if (f.by_force > 0 or not in_contact) and step > 0.0:
            put_force_course(f, side, Z, work)
            lower(1.0 / scale, length, work)
    return work.turning[0]


@jit
def lower(factor, length, work):
    """Lower work.turning to the least turning point of work.cell times this."""
    for order in range(len(work.cell)):
        work.cell[order] *= factor
    extremes_of_cell(work.cell, length, 0.0, np.inf, work.turning, work.waiting)


@jit
def state_within(f, compliant, side, x, delay, e, work, state):
    """The whole motion (n,) so long after the event has begun."""
    if compliant is None:
        return
    begin(f, compliant, side, x, e, work)
    put_map(f, compliant, side, delay, work)
    for r in range(f.A.shape[0]):
        state[r] = dot(work.lasting[0, r], work.start[0], f.A.shape[0] + 4)
    state[0] += f.numbers[HIGH if side > 0 else LOW]


@jit
def put_lasting(f, e, panel):
    """Row 2 of the event, and the rows of the flight after it: state and parameters."""
    n = f.A.shape[0]
    p, F, second = 3 * n + 2, 3 * n + 2 + f.parameters, n + 1
    panel[second, F] = e.pull
    for c in range(n + 2 + f.parameters):
        to = c if c < n + 2 else p + c - n - 2
        panel[second, to] = e.release[c]
        for r in range(n):
            for k in range(n):
                panel[n + 2 + r, to] -= e.E[0, r, k] * e.carry[k, c]
