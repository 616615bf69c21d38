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

from vibro_sweep.engine.continuation.constrained_gap import put_term
from vibro_sweep.engine.continuation.moving_flow import HIGH, LOW, OMEGA, law_at
from vibro_sweep.engine.impulses.extremes import OVERLAP, extremes_of_cell
from vibro_sweep.engine.impulses.taylor_orders import ORDER
from vibro_sweep.engine.simd.jit import jit


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
    for r in range(n):
        for c in range(n + 1 + f.parameters):
            room[3, r, c] = 0.0
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
    power, by_length = 1.0, 0.0
    for r in range(n):
        for c in range(n + 1 + f.parameters):
            before[r, c] = state[r, c]
    course[0] = before[0, n]
    for order in range(1, ORDER + 1):
        next_term(f, side, order, swing, before, term)
        swing *= 1j / order
        course[order] = term[0, n]
        if order > 1:
            by_length += (order - 1) * term[0, n] * power
            power *= step
        for r in range(n):
            for c in range(n + 1 + f.parameters):
                mean[r, c] += term[r, c] * power / parts
                state[r, c] += term[r, c] * power * step
                before[r, c] = term[r, c]
    return by_length


@jit
def next_term(f, side, order, swing, before, term):
    """The Taylor coefficient of this order from that before it; swing: i^{order - 1}/(order - 1)! e^{i phi}."""
    n, N, stop, law = f.A.shape[0], f.A.shape[0] // 2, HIGH if side > 0 else LOW, law_at(f, side)
    share, first = 1.0 / (order * f.numbers[OMEGA]), 1.0 if order == 1 else 0.0
    k, c, p = f.values[law], f.values[law + 1], side * f.values[law + 2]
    for r in range(n):
        put_term(f, order, 1.0, swing, before, term, r)
        change = first * f.A[r, 0] * f.numbers[stop]
        if r == N:
            change -= first * p
            for i in range(n + 1 + f.parameters):
                term[r, i] -= share * (k * before[0, i] + c * before[N, i])
        term[r, n] += share * change
        for j in range(f.parameters):
            slope = first * (f.A_slopes[j, r, 0] * f.numbers[stop] + f.A[r, 0] * f.number_slopes[j, stop])
            moved = change
            if r == N:
                dk, dc, dp = f.slopes[j, law], f.slopes[j, law + 1], side * f.slopes[j, law + 2]
                slope -= dk * before[0, n] + dc * before[N, n] + first * dp
                moved -= k * before[0, n] + c * before[N, n]
            term[r, n + 1 + j] += share * (slope - f.number_slopes[j, OMEGA] / f.numbers[OMEGA] * moved)


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
