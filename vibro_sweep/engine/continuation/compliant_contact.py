"""A contact with a compliant stop as one event: between its touch and its release the stop presses the gap back.

The second unknown of the event is the length s of the contact in phase. With z = y + S the whole motion, d = g - stop,
and k, c, p the stop's stiffness, damping and preload over m_e, the force acts on the gap alone:

    dz/dphi = (A (z, 1) + Re(F e^{i phi}) - e_v (k d + c v + side p))/omega        y+ = z(phi + s) - S(phi + s)

so that no steady motion of the contact is needed. Row 2 of the event is d(phi + s)/s = 0, which is v = 0 at a graze,
s = 0: nothing is singular there. d is 0 at both ends, exactly. E_c is the derivative of z(phi + s) by z. At fixed
phases, with J = (c v + side p)/omega of the touch, and J+ of the release,

    xi+ = E_c (xi - e_g v/omega dphi + e_v J dphi) - e_v J+ (dphi + ds) + ..       gap left out of xi, and of xi+

z, E_c and the derivatives by parameters are summed as Taylor series, in parts that resolve the rates of the contact.
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


@jit
def contact(f, side, x, e, room):
    """`after`, `carry`, `pull` and `release` of a contact, after `approach`."""
    n, N, omega, s = f.A.shape[0], f.A.shape[0] // 2, f.numbers[OMEGA], x[f.A.shape[0] + 1]
    stop, law, v = HIGH if side > 0 else LOW, law_at(f, side), e.motion[0]
    by_length = press_gap(f, side, x, s, e, room)
    state, mean, turn = room[0], room[3], e.turn * cmath.exp(1j * s)
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


@jit
def copy_motion(source, target):
    for place in range(0, len(source) * source.shape[1], LANES):
        put_eight(target, place, eight(source, place))


@jit
def parts_of(f, side, length):
    """The number of parts in which a contact is computed: their length times its rates is a half at most."""
    law = law_at(f, side)
    rate = 1.0 / f.width + 2.0 * (math.sqrt(f.values[law]) + f.values[law + 1])
    return int(abs(length) / f.numbers[OMEGA] * rate) + 1


@jit
def press_gap(f, side, x, length, e, room):
    """room[0]: as of `begin_contact`, but this length in phase, which may be negative, after the touch; else as
    `press_on`."""
    begin_contact(f, x, e, room[0])
    return press_on(f, side, length, e.turn, room, e.course)


@jit
def press_on(f, side, length, turn, room, course):
    """Take room[0] so far ahead, from e^{i phi} = turn on; room[3]: its mean rate of change. Returned is the derivative
    of that of d by the length."""
    n, N, parts, by_length = f.A.shape[0], f.A.shape[0] // 2, parts_of(f, side, length), 0.0
    for place in range(0, n * room.shape[2], LANES):
        put_eight(room[3], place, 0.0 * eight(room[0], place))
    for k in range(parts):
        step = length / parts
        by_length = press(f, side, step, parts, turn * cmath.exp(1j * step * k), room, course)
    if parts == 1:
        return by_length
    return (room[0, N, n] / f.numbers[OMEGA] - room[3, 0, n]) / length


@jit
def press(f, side, step, parts, swing, room, course):
    """Take room[0] a step in phase ahead, from e^{i phi} = swing on, and add its mean rate, over so many, to room[3].

    course : (ORDER + 1,) receives the Taylor coefficients of d
    Returned is the derivative of the mean rate of d by the step.
    """
    n, state, before, term, mean = f.A.shape[0], room[0], room[1], room[2], room[3]
    power, by_length, size = 1.0, 0.0, n * state.shape[1]
    copy_motion(state, before)
    course[0] = before[0, n]
    for order in range(1, ORDER + 1):
        next_term(f, side, order, swing, before, term)
        swing *= 1j / order
        course[order] = term[0, n]
        if order > 1:
            by_length += (order - 1) * term[0, n] * power
            power *= step
        for place in range(0, size, LANES):
            values = eight(term, place)
            put_eight(mean, place, eight(mean, place) + values * (power / parts))
            put_eight(state, place, eight(state, place) + values * (power * step))
            put_eight(before, place, values)
    return by_length


@jit
def next_term(f, side, order, swing, before, term):
    """The Taylor coefficient of this order from that before it; swing: i^{order - 1}/(order - 1)! e^{i phi}."""
    n, N, stop, law = f.A.shape[0], f.A.shape[0] // 2, HIGH if side > 0 else LOW, law_at(f, side)
    omega, forces, wide, first = f.numbers[OMEGA], n * (n + 1), before.shape[1], 1.0 if order == 1 else 0.0
    k, c, p = f.values[law], f.values[law + 1], side * f.values[law + 2]
    share = 1.0 / (order * omega)
    for r in range(n):
        for place in range(0, wide, LANES):
            total = eight(before, place) * (f.A[r, 0] - (k if r == N else 0.0))
            for i in range(1, n):
                total = total + eight(before, i * wide + place) * (f.A[r, i] - (c if r == i == N else 0.0))
            put_eight(term, r * wide + place, total * share)
        constant = first * (f.A[r, n] + f.A[r, 0] * f.numbers[stop] - (p if r == N else 0.0))
        if r >= N:
            constant += f.values[forces + r - N] * swing.real + f.values[forces + r] * swing.imag
        term[r, n] += share * constant
        for j in range(f.parameters):
            slope = first * (f.A_slopes[j, r, n] + f.A_slopes[j, r, 0] * f.numbers[stop])
            slope += first * f.A[r, 0] * f.number_slopes[j, stop]
            if f.moves[j] > 0:
                for i in range(n):
                    slope += f.A_slopes[j, r, i] * before[i, n]
            if r >= N:
                slope += f.slopes[j, forces + r - N] * swing.real + f.slopes[j, forces + r] * swing.imag
            if r == N:
                slope -= f.slopes[j, law] * before[0, n] + f.slopes[j, law + 1] * before[N, n]
                slope -= first * side * f.slopes[j, law + 2]
            term[r, n + 1 + j] += share * slope - f.number_slopes[j, OMEGA] / omega * term[r, n]


@jit
def least_depth(f, side, x, e, work):
    """The least depth at which the gap turns back into the stop during a contact; inf where it does not."""
    parts, step, nearest = parts_of(f, side, x[-1]), x[-1] / parts_of(f, side, x[-1]), work.turning
    begin_contact(f, x, e, work.resting[0])
    nearest[0] = np.inf
    for k in range(parts):
        press(f, side, step, parts, e.turn * cmath.exp(1j * step * k), work.resting, e.course)
        for order in range(ORDER + 1):
            e.course[order] *= side
        if step > 0.0:
            extremes_of_cell(e.course, step * OVERLAP if k + 1 < parts else step, 0.0, np.inf, nearest, work.waiting)
    return nearest[0]
