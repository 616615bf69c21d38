"""A contact with a compliant stop as one event: between its touch and its release the stop presses the gap back.

The second unknown of the event is the length s of the contact in phase. With z = y + S the whole motion, d = g - stop,
and k, c, p the stop's stiffness, damping and preload over m_e, the force acts on the gap alone:

    dz/dphi = (A (z, 1) + Re(F e^{i phi}) - e_v (k d + c v + side p))/omega        y+ = z(phi + s) - S(phi + s)

so that no steady motion of the contact is needed. Row 2 of the event is d(phi + s)/s = 0, which is v = 0 at a graze,
s = 0: nothing is singular there. d is 0 at both ends, exactly. E_c is the derivative of z(phi + s) by z. At fixed
phases, with J = (c v + side p)/omega of the touch, and J+ of the release,

    xi+ = E_c (xi - e_g v/omega dphi + e_v J dphi) - e_v J+ (dphi + ds) + ..       gap left out of xi, and of xi+

(z, e^{i phi}, 1) moves by a linear map: that of a part which resolves the rates of the contact, and its derivatives by
parameters, are summed as Taylor series, and the same map leads through all parts.
"""

import cmath
import math

import numpy as np

from vibro_sweep.engine.continuation.moving_flow import HIGH, LOW, OMEGA, law_at
from vibro_sweep.engine.impulses.extremes import OVERLAP, extremes_of_cell
from vibro_sweep.engine.impulses.taylor_orders import ORDER
from vibro_sweep.engine.simd.jit import jit
from vibro_sweep.engine.simd.lanes import LANES
from vibro_sweep.engine.simd.memory import eight, put_eight

BEFORE, TERM, SUM, MEAN = range(4)  # of `work.pressing`


@jit
def contact(f, side, x, e, work):
    """`after`, `carry`, `pull` and `release` of a contact, after `approach`."""
    n, N, omega, s = f.A.shape[0], f.A.shape[0] // 2, f.numbers[OMEGA], x[f.A.shape[0] + 1]
    stop, law, v = HIGH if side > 0 else LOW, law_at(f, side), e.motion[0]
    by_length = press_gap(f, side, x, s, e, work)
    state, mean, turn = work.resting[0], work.resting[3], e.turn * cmath.exp(1j * s)
    c, p = f.values[law + 1], side * f.values[law + 2]
    touched, released = (c * v + p) / omega, (c * state[N, n] + p) / omega
    for r in range(n):
        e.after[r] = state[r, n] - (f.Z[r] * turn).real
        for k in range(n):
            e.carry[r, k] = state[r, k]
        e.carry[r, 0] = 0.0
        e.carry[r, n + 1] = -released if r == N else 0.0
        e.carry[r, n] = state[r, N] * touched - state[r, 0] * v / omega + e.carry[r, n + 1]
        for j in range(f.parameters):
            e.carry[r, n + 2 + j] = state[r, n + 1 + j] - (f.Z_slopes[j, r] * turn).real
    e.after[0] = f.numbers[stop] - (f.Z[0] * turn).real
    e.after[n] = 1.0
    for k in range(n):
        e.carry[0, k], e.release[k] = 0.0, mean[0, k]
    e.carry[0, n] = e.carry[0, n + 1] = -state[N, n] / omega
    e.pull = mean[0, n]
    e.release[0], e.release[n + 1] = 0.0, by_length
    e.release[n] = (mean[N, n] - mean[0, 0] * v) / omega + mean[0, N] * touched
    for j in range(f.parameters):
        e.carry[0, n + 2 + j] = f.number_slopes[j, stop] - (f.Z_slopes[j, 0] * turn).real
        e.release[n + 2 + j] = mean[0, n + 1 + j]


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
def parts_of(f, side, length):
    """The number of parts in which a contact is computed: their length times its rates is 0.7 at most."""
    law = law_at(f, side)
    rate = 1.0 / f.width + 1.5 * (math.sqrt(f.values[law]) + f.values[law + 1])
    return int(abs(length) / f.numbers[OMEGA] * rate) + 1


@jit
def press_gap(f, side, x, length, e, work):
    """work.resting[0]: as of `begin_contact`, but this length in phase, which may be negative, after the touch."""
    begin_contact(f, x, e, work.resting[0])
    return press_on(f, side, length, e.turn, work)


@jit
def press_on(f, side, length, turn, work):
    """Take work.resting[0] so far ahead, from e^{i phi} = turn on; work.resting[3]: its mean rate of change.

    Returned is the derivative of the mean rate of d by the length.
    """
    n, N, parts = f.A.shape[0], f.A.shape[0] // 2, parts_of(f, side, length)
    state, start, other, mean = work.resting[0], work.resting[1], work.resting[2], work.resting[3]
    step, by_length, power = length / parts, 0.0, 1.0
    put_tables(f, side, step, work)
    copy_motion(state, start)
    if parts == 1:
        put_course(f, state, turn, work)
        for order in range(2, ORDER + 1):
            by_length += (order - 1) * work.cell[order] * power
            power *= step
        apply(f, work.pressing[MEAN], turn, start, mean)
    for k in range(parts):
        apply(f, work.pressing[SUM], turn * cmath.exp(1j * step * k), state, other)
        copy_motion(other, state)
    if parts > 1:
        for place in range(0, n * state.shape[1], LANES):
            put_eight(mean, place, (eight(state, place) - eight(start, place)) * (1.0 / length))
        by_length = (state[N, n] / f.numbers[OMEGA] - mean[0, n]) / length
    return by_length


@jit
def copy_motion(source, target):
    for place in range(0, len(source) * source.shape[1], LANES):
        put_eight(target, place, eight(source, place))


@jit
def apply(f, tables, swing, motion, out):
    """out: the change of a motion, as of `begin_contact`, by a map of (z, cos, sin, 1) and its derivatives."""
    n, wide = f.A.shape[0], motion.shape[1]
    for r in range(n):
        for place in range(0, wide, LANES):
            total = eight(motion, place) * tables[0, r, 0]
            for i in range(1, n):
                total = total + eight(motion, i * wide + place) * tables[0, r, i]
            put_eight(out, r * wide + place, total)
        out[r, n] += tables[0, r, n] * swing.real + tables[0, r, n + 1] * swing.imag + tables[0, r, n + 2]
        for j in range(f.parameters):
            slopes = tables[1 + j, r]
            total = slopes[n] * swing.real + slopes[n + 1] * swing.imag + slopes[n + 2]
            for i in range(n):
                total += slopes[i] * motion[i, n]
            out[r, n + 1 + j] += total


@jit
def put_rates(f, side, rates):
    """rates (3, n, n + 3): omega times those of z by (z, cos, sin, 1), and their derivatives by the parameters."""
    n, N, stop, law = f.A.shape[0], f.A.shape[0] // 2, HIGH if side > 0 else LOW, law_at(f, side)
    forces = n * (n + 1)
    for r in range(n):
        for i in range(n):
            rates[0, r, i] = f.A[r, i]
        for i in range(2):
            rates[0, r, n + i] = f.values[forces + r - N + i * N] if r >= N else 0.0
        rates[0, r, n + 2] = f.A[r, n] + f.A[r, 0] * f.numbers[stop]
        for j in range(f.parameters):
            for i in range(n):
                rates[1 + j, r, i] = f.A_slopes[j, r, i]
            for i in range(2):
                rates[1 + j, r, n + i] = f.slopes[j, forces + r - N + i * N] if r >= N else 0.0
            rates[1 + j, r, n + 2] = f.A_slopes[j, r, n] + f.A_slopes[j, r, 0] * f.numbers[stop]
            rates[1 + j, r, n + 2] += f.A[r, 0] * f.number_slopes[j, stop]
    for i, column in enumerate((0, N, n + 2)):  # k d, c v, p
        sign = -side if i == 2 else -1.0
        rates[0, N, column] += sign * f.values[law + i]
        for j in range(f.parameters):
            rates[1 + j, N, column] += sign * f.slopes[j, law + i]


@jit
def put_tables(f, side, step, work):
    """work.pressing: the map of (z, cos, sin, 1) over a step in phase and its mean rate of change, with derivatives;
    work.courses: Taylor coefficients of its gap."""
    n, omega, tables, rates = f.A.shape[0], f.numbers[OMEGA], work.pressing, work.rates
    wide, power = tables.shape[3], 1.0
    put_rates(f, side, rates)
    for j in range(f.parameters + 1):
        for r in range(n + 3):
            for i in range(wide):
                tables[BEFORE, j, r, i] = tables[SUM, j, r, i] = 1.0 if j == 0 and r == i else 0.0
                tables[MEAN, j, r, i] = 0.0
    for i in range(wide):
        work.courses[0, i] = tables[SUM, 0, 0, i]
    for order in range(1, ORDER + 1):
        put_term(f, rates, 1.0 / (order * omega), tables[BEFORE], tables[TERM])
        for place in range(0, wide, LANES):
            put_eight(work.courses, order * wide + place, eight(tables[TERM, 0], place))
        for j in range(f.parameters + 1):
            for place in range(0, n * wide, LANES):
                value = eight(tables[TERM, j], place)
                put_eight(tables[BEFORE, j], place, value)
                put_eight(tables[MEAN, j], place, eight(tables[MEAN, j], place) + value * power)
                put_eight(tables[SUM, j], place, eight(tables[SUM, j], place) + value * (power * step))
        for place in range(n * wide, (n + 3) * wide, LANES):
            put_eight(tables[BEFORE, 0], place, eight(tables[TERM, 0], place))
        power *= step


@jit
def put_term(f, rates, share, before, term):
    """The Taylor coefficient of the map from that before it; share: 1/(order omega)."""
    n, wide, omega = f.A.shape[0], before.shape[2], f.numbers[OMEGA]
    for place in range(0, wide, LANES):
        for r in range(n):
            total = eight(before[0], place) * rates[0, r, 0]
            for i in range(1, n + 3):
                total = total + eight(before[0], i * wide + place) * rates[0, r, i]
            put_eight(term[0], r * wide + place, total * share)
            for j in range(1, f.parameters + 1):
                slope = total * (-f.number_slopes[j - 1, OMEGA] / omega)
                for i in range(n + 3):
                    slope = slope + eight(before[0], i * wide + place) * rates[j, r, i]
                for i in range(n):
                    slope = slope + eight(before[j], i * wide + place) * rates[0, r, i]
                put_eight(term[j], r * wide + place, slope * share)
        cosine, sine = eight(before[0], n * wide + place), eight(before[0], (n + 1) * wide + place)
        put_eight(term[0], n * wide + place, sine * (-share * omega))
        put_eight(term[0], (n + 1) * wide + place, cosine * (share * omega))
        put_eight(term[0], (n + 2) * wide + place, sine * 0.0)


@jit
def put_course(f, motion, swing, work):
    """work.cell: Taylor coefficients of d over the next step."""
    n = f.A.shape[0]
    for order in range(ORDER + 1):
        row = work.courses[order]
        total = row[n] * swing.real + row[n + 1] * swing.imag + row[n + 2]
        for i in range(n):
            total += row[i] * motion[i, n]
        work.cell[order] = total


@jit
def least_depth(f, side, x, e, work):
    """The least depth at which the gap turns back into the stop during a contact; inf where it does not."""
    parts, nearest, state, other = parts_of(f, side, x[-1]), work.turning, work.resting[0], work.resting[1]
    step = x[-1] / parts
    begin_contact(f, x, e, state)
    put_tables(f, side, step, work)
    nearest[0] = np.inf
    for k in range(parts):
        swing = e.turn * cmath.exp(1j * step * k)
        put_course(f, state, swing, work)
        for order in range(ORDER + 1):
            work.cell[order] *= side
        if step > 0.0:
            extremes_of_cell(work.cell, step * OVERLAP if k + 1 < parts else step, 0.0, np.inf, nearest, work.waiting)
        apply(f, work.pressing[SUM], swing, state, other)
        copy_motion(other, state)
    return nearest[0]
